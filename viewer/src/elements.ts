import { mako, place, table, type Scale } from "./colors";
import { css, h } from "./dom";
import type { ElementInModel } from "./data";
import type { Legend } from "./fields";
import { length, list, significant } from "./format";
import type { Moment, Run } from "./run";

/** What an element carries at a moment. */
export interface ElementNow {
  force: number;
  elongation: number;
  yielded: number;
}

type Point = [number, number];

/** How near the pointer is to a line that it is on, px. */
const reach = 6;
const shares: Scale = { min: 0, max: 1, logarithmic: false };

/** Springs, supports and all else that carries a force: what each carries over time, drawn as lines in the section. */
export class Elements {
  readonly catalogue: ElementInModel[];
  private readonly reference: Float32Array;
  private readonly ends: Float32Array;
  private readonly numbers: Float32Array;
  private readonly present: Uint8Array;
  /** By kind, N/m: the largest force in the run of those that have no limit. */
  private readonly largest = new Map<string, number>();
  private colors: string[] = [];

  constructor(private readonly run: Run) {
    this.catalogue = run.header.model.elements ?? [];
    const has = this.count > 0;
    this.reference = has ? run.arrays.get("element.reference", "f32") : new Float32Array();
    this.ends = has ? run.arrays.get("element.ends", "f32") : new Float32Array();
    this.numbers = has ? run.arrays.get("element.numbers", "f32") : new Float32Array();
    this.present = has ? run.arrays.get("element.present", "u8") : new Uint8Array();
    for (let f = 0; f < run.frameCount; f++) {
      this.catalogue.forEach((e, k) => {
        const force = Math.abs(this.now(f, k)?.force ?? 0);
        if (e.limit_n_m === null && force > (this.largest.get(e.kind) ?? 0)) this.largest.set(e.kind, force);
      });
    }
  }

  get count(): number {
    return this.catalogue.length;
  }

  readTheme(): void {
    const dark = css("--scheme") === "dark";
    this.colors = table(dark ? mako : [...mako].reverse());
  }

  /** null: it is not there. */
  now(moment: Moment, k: number): ElementNow | null {
    if (moment < 0 || this.run.frameCount === 0) return null;
    const at = this.run.frameOf(moment) * this.count + k;
    if (this.present[at] === 0) return null;
    const [force, elongation, yielded] = this.numbers.subarray(3 * at, 3 * at + 3);
    return { force, elongation, yielded };
  }

  /** Force over the limit; without one, over the largest force of the kind in the run. */
  private share(k: number, now: ElementNow): number {
    const { kind, limit_n_m: limit } = this.catalogue[k];
    const whole = limit ?? this.largest.get(kind) ?? 0;
    return whole > 0 ? Math.min(1, Math.abs(now.force) / whole) : 0;
  }

  /** Its ends as drawn: displacements since a moment are exaggerated. */
  private line(k: number, moment: Moment, since: Moment, exaggeration: number): [Point, Point] {
    const at = (m: Moment, i: number) =>
      m < 0 || this.run.frameCount === 0
        ? this.reference[4 * k + i]
        : this.ends[4 * (this.run.frameOf(m) * this.count + k) + i];
    const drawn = (i: number) => at(since, i) + exaggeration * (at(moment, i) - at(since, i));
    return [
      [drawn(0), drawn(1)],
      [drawn(2), drawn(3)],
    ];
  }

  /** All that are there, the wider and darker the more of its limit each carries. */
  draw(
    c: CanvasRenderingContext2D,
    look: { moment: Moment; since: Moment; exaggeration: number },
    toPixel: (x: number, y: number) => Point,
    scale = 1,
  ): void {
    c.lineCap = "round";
    this.catalogue.forEach((_, k) => {
      const now = this.now(look.moment, k);
      if (!now) return;
      const [from, to] = this.line(k, look.moment, look.since, look.exaggeration).map((p) => toPixel(...p));
      const share = this.share(k, now);
      const width = scale * (1.6 + 3.4 * share);
      for (const [color, w] of [
        [css("--paper"), width + 2 * scale],
        [this.colors[Math.round(place(shares, share) * (this.colors.length - 1))], width],
      ] as const) {
        c.strokeStyle = c.fillStyle = color;
        c.lineWidth = w;
        c.beginPath();
        c.moveTo(...from);
        c.lineTo(...to);
        c.stroke();
        for (const [x, y] of [from, to]) {
          c.beginPath();
          c.arc(x, y, 0.8 * w, 0, 2 * Math.PI);
          c.fill();
        }
      }
    });
    c.lineCap = "butt";
  }

  /** The element under a pixel; −1 for none. */
  at(
    px: number,
    py: number,
    look: { moment: Moment; since: Moment; exaggeration: number },
    toPixel: (x: number, y: number) => Point,
  ): number {
    let [nearest, found] = [reach, -1];
    this.catalogue.forEach((_, k) => {
      if (!this.now(look.moment, k)) return;
      const [[ax, ay], [bx, by]] = this.line(k, look.moment, look.since, look.exaggeration).map((p) =>
        toPixel(...p),
      );
      const size = (bx - ax) ** 2 + (by - ay) ** 2;
      const s =
        size > 0 ? Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / size)) : 0;
      const apart = Math.hypot(px - ax - s * (bx - ax), py - ay - s * (by - ay));
      if (apart < nearest) [nearest, found] = [apart, k];
    });
    return found;
  }

  legend(): Legend | null {
    if (this.count === 0) return null;
    const free = [...this.largest].map(([kind, force]) => `${kind} ${significant(force / 1e3)} kN/m`);
    const limited = this.catalogue.some((e) => e.limit_n_m !== null);
    return {
      title: limited ? "Force of the elements over their limit" : "Force of the elements",
      note: free.length > 0 ? `100 % without a limit: the largest in the run, ${list(free)}` : undefined,
      bar: { colors: this.colors, scale: shares, format: (v) => `${significant(100 * v)} %` },
    };
  }

  facts(k: number, moment: Moment): Node[] {
    const e = this.catalogue[k];
    const now = this.now(moment, k);
    if (!now) return [h("strong", {}, e.name)];
    const rows: [string, string][] = [
      ["kind", e.kind],
      ["force", `${significant(now.force / 1e3, 4)} kN/m`],
      ["elongation", length(now.elongation)],
    ];
    if (now.yielded !== 0) rows.push(["of it yielded", length(now.yielded)]);
    if (e.limit_n_m !== null)
      rows.push(["of its limit", `${significant((100 * Math.abs(now.force)) / e.limit_n_m)} %`]);
    const facts = h("dl", {});
    for (const [name, value] of rows) facts.append(h("dt", {}, name), h("dd", {}, value));
    return [h("strong", {}, e.name), facts];
  }
}
