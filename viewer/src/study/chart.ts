import { ticks, type Scale } from "../colors";
import { h, svg } from "../dom";
import { significant } from "../format";
import { whenPrinting } from "../printing";

type Values = readonly (number | null)[];

/** A curve with a band, a staircase, or points with bars from `low` to `high`. */
export interface ChartSeries {
  name: string;
  /** A colour, or the name of a custom property that holds it. */
  color: string;
  kind: "line" | "steps" | "points";
  x: readonly number[];
  y: Values;
  low?: Values;
  high?: Values;
  thin?: boolean;
  /** Points get a shift in px, so that bars at the same place can be told apart. */
  shift?: number;
}

export interface ChartOptions {
  title: string;
  note?: string;
  xName: string;
  yName: string;
  x: Scale;
  y: Scale;
  percent?: boolean;
  /** Values of x are counts: no marks between them. */
  wholeX?: boolean;
  series: ChartSeries[];
  /** Horizontal lines. */
  marks?: { y: number; text: string }[];
  /** Vertical lines. */
  limits?: { x: number; text: string }[];
  height?: number;
}

const margin = { left: 52, right: 14, top: 12, bottom: 38 };
const paint = (color: string) => (color.startsWith("--") ? `var(${color})` : color);

/** A chart as a drawing of its own, so that it prints sharply and follows the theme by itself. */
export class Chart {
  readonly element: HTMLElement;
  private readonly target = h("div", { class: "chart-target" });
  private readonly readings = new Map<ChartSeries, HTMLElement>();
  private readonly hair = svg("line", { class: "hair" });
  private width = 0;
  private options: ChartOptions | null = null;
  private readonly caption = h("figcaption");

  constructor() {
    this.element = h("figure", { class: "plot chart" }, this.caption, this.target);
    new ResizeObserver(() => this.draw()).observe(this.target);
    whenPrinting(() => this.draw());
    this.target.addEventListener("pointermove", (event) => this.point(event));
    this.target.addEventListener("pointerleave", () => this.read(null));
  }

  show(options: ChartOptions): void {
    this.options = options;
    this.element.setAttribute("aria-label", options.title);
    this.readings.clear();
    const key = h("span", { class: "plot-key" });
    for (const s of options.series) {
      if (s.kind === "points" && options.series.some((t) => t !== s && t.name === s.name)) continue;
      const swatch = h("span", { class: "swatch line" });
      swatch.style.background = paint(s.color);
      const reading = h("span", { class: "reading" });
      this.readings.set(s, reading);
      key.append(h("span", {}, ...(options.series.length > 1 ? [swatch, s.name] : []), reading));
    }
    this.caption.replaceChildren(
      h("strong", {}, options.title),
      h("span", { class: "unit" }, options.note ?? ""),
      key,
    );
    this.width = 0;
    this.draw();
  }

  private get height(): number {
    return this.options?.height ?? 280;
  }

  private px(x: number): number {
    return margin.left + share(this.options!.x, x) * (this.width - margin.left - margin.right);
  }

  private py(y: number): number {
    return (
      this.height - margin.bottom - share(this.options!.y, y) * (this.height - margin.top - margin.bottom)
    );
  }

  private draw(): void {
    const width = this.target.clientWidth;
    if (!this.options || width <= 0 || width === this.width) return;
    this.width = width;
    const { options } = this;
    const clip = `clip-${Math.random().toString(36).slice(2)}`;
    const bands = svg("g", { "clip-path": `url(#${clip}-bands)` });
    const inner = svg("g", { "clip-path": `url(#${clip})` });
    for (const s of options.series) this.drawBand(bands, s);
    for (const s of options.series) this.drawCurve(inner, s);
    const [across, down] = [
      Math.max(0, width - margin.left - margin.right),
      this.height - margin.top - margin.bottom,
    ];
    const root = svg(
      "svg",
      { width, height: this.height, viewBox: `0 0 ${width} ${this.height}`, role: "img" },
      // Bands end at the axes; lines and points on the edge show their whole width.
      svg(
        "clipPath",
        { id: `${clip}-bands` },
        svg("rect", { x: margin.left, y: margin.top, width: across, height: down }),
      ),
      svg(
        "clipPath",
        { id: clip },
        svg("rect", { x: margin.left - 1, y: margin.top - 6, width: across + 8, height: down + 12 }),
      ),
      this.axes(),
      bands,
      inner,
      this.limits(),
      this.hair,
    );
    this.hair.setAttribute("visibility", "hidden");
    this.target.replaceChildren(root);
  }

  private axes(): SVGGElement {
    const { options, width, height } = this;
    const group = svg("g", { class: "axes" });
    const bottom = height - margin.bottom;
    for (const x of axisTicks(options!.x, Math.max(2, (width - margin.left) / 75))) {
      if (options!.wholeX && !Number.isInteger(x)) continue;
      const at = this.px(x);
      group.append(
        svg("line", { class: "grid", x1: at, x2: at, y1: margin.top, y2: bottom }),
        svg("text", { x: at, y: bottom + 15, "text-anchor": "middle" }, significant(x, 4)),
      );
    }
    for (const y of axisTicks(options!.y, Math.max(2, (height - margin.bottom) / 45))) {
      const at = this.py(y);
      const text = options!.percent ? `${significant(100 * y, 4)} %` : significant(y, 4);
      group.append(
        svg("line", { class: "grid", x1: margin.left, x2: width - margin.right, y1: at, y2: at }),
        svg("text", { x: margin.left - 6, y: at + 4, "text-anchor": "end" }, text),
      );
    }
    group.append(
      svg("path", {
        class: "frame",
        d: `M${margin.left} ${margin.top}V${bottom}H${width - margin.right}`,
      }),
      svg("text", { x: width - margin.right, y: height - 5, "text-anchor": "end" }, options!.xName),
    );
    return group;
  }

  /** Lines that stand for a limit, with their names, over the curves. */
  private limits(): SVGGElement {
    const { options, width, height } = this;
    const group = svg("g");
    const bottom = height - margin.bottom;
    for (const { y, text } of options!.marks ?? []) {
      const at = this.py(y);
      group.append(
        svg("line", { class: "mark", x1: margin.left, x2: width - margin.right, y1: at, y2: at }),
        svg("text", { class: "label", x: width - margin.right, y: at - 4, "text-anchor": "end" }, text),
      );
    }
    for (const [k, { x, text }] of (options!.limits ?? []).entries()) {
      const at = this.px(x);
      const last = at > 0.7 * width;
      group.append(
        svg("line", { class: "mark", x1: at, x2: at, y1: margin.top, y2: bottom }),
        svg(
          "text",
          {
            class: "label",
            x: at + (last ? -4 : 4),
            y: margin.top + 9 + 13 * (k % 4),
            "text-anchor": last ? "end" : "start",
          },
          text,
        ),
      );
    }
    return group;
  }

  private drawBand(into: SVGGElement, s: ChartSeries): void {
    if (!s.low || !s.high || s.kind === "points") return;
    const upper: string[] = [];
    const lower: string[] = [];
    s.x.forEach((x, k) => {
      const [a, b] = [s.low![k], s.high![k]];
      if (a === null || b === null) return;
      if (s.kind === "steps" && upper.length > 0) {
        upper.push(`H${this.px(x).toFixed(1)}`);
        lower.push(`${this.px(x).toFixed(1)} ${lower[lower.length - 1].split(" ")[1]}`);
      }
      upper.push(`${upper.length > 0 ? "L" : "M"}${this.px(x).toFixed(1)} ${this.py(b).toFixed(1)}`);
      lower.push(`${this.px(x).toFixed(1)} ${this.py(a).toFixed(1)}`);
    });
    if (upper.length < 2) return;
    const back = lower.reverse().map((p) => `L${p}`);
    const band = svg("path", { class: "band", d: `${upper.join("")}${back.join("")}Z` });
    band.style.fill = paint(s.color);
    into.append(band);
  }

  private drawCurve(into: SVGGElement, s: ChartSeries): void {
    if (s.kind === "points") {
      this.drawPoints(into, s);
      return;
    }
    let d = "";
    s.x.forEach((x, k) => {
      const y = s.y[k];
      if (y === null) return;
      if (d === "") d = `M${this.px(x).toFixed(1)} ${this.py(y).toFixed(1)}`;
      else if (s.kind === "steps") d += `H${this.px(x).toFixed(1)}V${this.py(y).toFixed(1)}`;
      else d += `L${this.px(x).toFixed(1)} ${this.py(y).toFixed(1)}`;
    });
    if (d === "") return;
    const line = svg("path", { class: s.thin ? "curve thin" : "curve", d });
    line.style.stroke = paint(s.color);
    into.append(line);
  }

  private drawPoints(into: SVGGElement, s: ChartSeries): void {
    s.x.forEach((x, k) => {
      const y = s.y[k];
      if (y === null) return;
      const at = this.px(x) + (s.shift ?? 0);
      const group = svg("g", { class: "point" });
      const [a, b] = [s.low?.[k] ?? null, s.high?.[k] ?? null];
      if (a !== null && b !== null) {
        const [top, bottom] = [this.py(b).toFixed(1), this.py(a).toFixed(1)];
        group.append(svg("path", { d: `M${at} ${bottom}V${top}M${at - 3} ${bottom}h6M${at - 3} ${top}h6` }));
      }
      group.append(svg("circle", { cx: at, cy: this.py(y), r: 3.5 }));
      group.style.stroke = paint(s.color);
      into.append(group);
    });
  }

  private point(event: PointerEvent): void {
    if (!this.options) return;
    const x = event.clientX - this.target.getBoundingClientRect().left;
    const inside = x >= margin.left && x <= this.width - margin.right;
    this.read(inside ? x : null);
  }

  /** Shows the values of all curves at a place, px. */
  private read(at: number | null): void {
    const { options, hair } = this;
    if (!options) return;
    hair.setAttribute("visibility", at === null ? "hidden" : "visible");
    if (at !== null) {
      hair.setAttribute("x1", String(at));
      hair.setAttribute("x2", String(at));
      hair.setAttribute("y1", String(margin.top));
      hair.setAttribute("y2", String(this.height - margin.bottom));
    }
    const x =
      at === null ? null : unshare(options.x, (at - margin.left) / (this.width - margin.left - margin.right));
    for (const [s, reading] of this.readings) {
      const y = x === null ? null : valueAt(s, x);
      const text = y === null ? "" : options.percent ? `${significant(100 * y, 3)} %` : significant(y, 4);
      reading.textContent = text === "" ? "" : ` ${text}`;
    }
  }
}

/** As place() of colors.ts, but not held at the ends. */
function share(scale: Scale, value: number): number {
  return scale.logarithmic
    ? Math.log(value / scale.min) / Math.log(scale.max / scale.min)
    : (value - scale.min) / (scale.max - scale.min);
}

function unshare(scale: Scale, t: number): number {
  return scale.logarithmic
    ? scale.min * (scale.max / scale.min) ** t
    : scale.min + t * (scale.max - scale.min);
}

/**
 * Round values of an axis; on a logarithmic one of few decades 2 and 5 times the powers of ten, too, and at equal distances where
 * there are none of these.
 */
function axisTicks(scale: Scale, wanted: number): number[] {
  if (!scale.logarithmic) return ticks(scale, wanted);
  const decades = Math.log10(scale.max / scale.min);
  const factors = decades < 1 ? [1, 2, 3, 4, 5, 7] : decades < 2.5 ? [1, 2, 5] : [1];
  const found: number[] = [];
  for (let k = Math.floor(Math.log10(scale.min)); 10 ** k <= scale.max; k++)
    for (const f of factors)
      if (f * 10 ** k >= scale.min * (1 - 1e-9) && f * 10 ** k <= scale.max * (1 + 1e-9))
        found.push(f * 10 ** k);
  return found.length < 2 ? ticks({ ...scale, logarithmic: false }, wanted) : found;
}

function valueAt(s: ChartSeries, x: number): number | null {
  let k = -1;
  while (k + 1 < s.x.length && s.x[k + 1] <= x) k++;
  if (k < 0) return null;
  const here = s.y[k];
  if (s.kind === "steps") return here;
  if (s.kind === "points") return null;
  const next = s.y[k + 1] ?? null;
  if (here === null || next === null) return k + 1 < s.x.length ? null : x > s.x[k] ? null : here;
  return here + ((next - here) * (x - s.x[k])) / (s.x[k + 1] - s.x[k]);
}

/** Colours of curves: those of the theme, then others. */
export const curveColors = [
  "--curve-1",
  "--curve-2",
  "--curve-3",
  "#CC79A7",
  "#B8A900",
  "#56B4E9",
  "#7A5C00",
];

/** A linear scale from 0, or from the smallest value where there are negative ones, with some room. */
export function scaleOf(values: Iterable<number | null>): Scale {
  let min = 0;
  let max = 0;
  for (const v of values) {
    if (v === null || !Number.isFinite(v)) continue;
    min = Math.min(min, v);
    max = Math.max(max, v);
  }
  const room = 0.05 * (max - min || 1);
  return { min: min < 0 ? min - room : 0, max: max > 0 ? max + room : min < 0 ? 0 : 1, logarithmic: false };
}
