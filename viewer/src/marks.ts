import { css } from "./dom";
import type { MarkInHeader } from "./data";
import type { Legend } from "./fields";
import { blockDisplacement, principal } from "./fields";
import { length, significant, speed, stress } from "./format";
import { newPath } from "./save/path";
import { Status, type Moment, type Run } from "./run";

type Point = [number, number];

/** Where marks are drawn: blocks as the view has them. */
export interface MarkCanvas {
  context: CanvasRenderingContext2D;
  moment: Moment;
  since: Moment;
  /** Displacements of all vertices then and before. */
  u: Float32Array;
  before: Float32Array;
  /** Drawn positions: x of all vertices, then y. */
  drawn: Float32Array;
  toPixel: (x: number, y: number) => Point;
  /** Pixels per metre. */
  scale: number;
  /** Of widths. */
  fine: number;
}

/** Forces, stresses or velocities over the blocks: what each is stands in src/picture/marks.h, and comes with the page. */
export class Marks {
  readonly all: MarkInHeader[];
  private readonly longestArrow: number;
  private readonly blockSize: number;

  constructor(private readonly run: Run) {
    const { marks } = run.header;
    const missing = (name: string) =>
      (name === "velocity" && !run.hasVelocity) ||
      ((name === "forces" || name === "thrust") && !run.hasChains);
    this.all = (marks?.all ?? []).filter((m) => !missing(m.name));
    this.longestArrow = marks?.longest_arrow ?? 3;
    this.blockSize = Math.sqrt(run.rockArea() / Math.max(1, run.movable()));
  }

  choices(): { value: string; text: string }[] {
    return [{ value: "none", text: "nothing" }, ...this.all.map((m) => ({ value: m.name, text: m.text }))];
  }

  draw(name: string, canvas: MarkCanvas): void {
    const mark = this.all.find((m) => m.name === name);
    if (!mark || canvas.moment < 0) return;
    const { context: c } = canvas;
    c.lineCap = c.lineJoin = "round";
    const draw: Record<string, () => void> = {
      forces: () => this.forces(mark, canvas),
      stress: () => this.crosses(mark, canvas),
      displacement: () => this.arrows(mark, canvas, (b) => this.displacement(canvas, b)),
      velocity: () => this.arrows(mark, canvas, (b) => this.run.velocityAt(canvas.moment, b)),
      outline: () => this.outline(mark, canvas),
      thrust: () => this.thrust(mark, canvas),
    };
    draw[name]?.();
    c.lineCap = "butt";
  }

  legend(name: string): Legend | null {
    const mark = this.all.find((m) => m.name === name);
    if (!mark) return null;
    const text: Record<string, (v: number) => string> = {
      forces: (v) => `${significant(v / 1e3, 2)} kN/m`,
      stress: (v) => stress(v, 2),
      displacement: (v) => length(v, 2),
      velocity: (v) => speed(v, 2),
    };
    const size = text[name]?.(mark.typical);
    const sizes: Record<string, string> = {
      forces: `a line of ${significant(0.75 * mark.drawn)} px is ${size}`,
      stress: `a bar of ${significant(mark.drawn)} sides of a mean block is ${size}`,
      displacement: `an arrow of ${significant(mark.drawn)} sides of a mean block is ${size}`,
      velocity: `an arrow of ${significant(mark.drawn)} sides of a mean block is ${size}`,
    };
    const note = [mark.meaning, sizes[name]].filter((s) => s).join("; ");
    const classes =
      name === "stress"
        ? [
            { color: this.color(mark), name: "compression", line: true },
            { color: "#d55e00", name: "tension", line: true },
          ]
        : [{ color: this.color(mark), name: mark.text, line: true }];
    return { title: mark.text[0].toUpperCase() + mark.text.slice(1), note, classes };
  }

  /** As described, or what can be seen on dark paper. */
  private color(mark: MarkInHeader): string {
    if (css("--scheme") !== "dark") return mark.color;
    return ({ forces: "#e6e8ea", stress: "#7db7ff" } as Record<string, string>)[mark.name] ?? "#ff8fd0";
  }

  private isShown(moment: Moment, block: number): boolean {
    return !this.run.fixed[block] && this.run.statusAt(moment, block) !== Status.excavated;
  }

  /** Mean of the corners of a block, as drawn. */
  private middle({ drawn }: MarkCanvas, block: number): Point {
    const { run } = this;
    const ring = run.firstRing[block];
    const [begin, end] = [run.ringBegin[ring], run.ringEnd[ring]];
    let [x, y] = [0, 0];
    for (let v = begin; v < end; v++) {
      x += drawn[v];
      y += drawn[run.vertexCount + v];
    }
    return [x / (end - begin), y / (end - begin)];
  }

  /** A point of the section that moves with a block, where displacements are exaggerated. */
  private shifted(canvas: MarkCanvas, [x, y]: Point, block: number): Point {
    const { run } = this;
    const v = run.ringBegin[run.firstRing[block]];
    const n = run.vertexCount;
    return [
      x + canvas.drawn[v] - run.position[2 * v] - canvas.u[v],
      y + canvas.drawn[n + v] - run.position[2 * v + 1] - canvas.u[n + v],
    ];
  }

  private displacement(canvas: MarkCanvas, block: number): Point {
    if (canvas.moment < canvas.since) return [0, 0];
    return blockDisplacement(this.run, block, canvas.u, canvas.before);
  }

  private stroke({ context: c, fine }: MarkCanvas, path: Path2D, color: string, width: number): void {
    c.strokeStyle = color;
    c.lineWidth = fine * width;
    c.stroke(path);
  }

  private forces(mark: MarkInHeader, canvas: MarkCanvas): void {
    const { run } = this;
    const paths = new Map<number, Path2D>();
    const [begin, end] = run.chainsAt(canvas.moment);
    for (let k = begin; k < end; k++) {
      const share = run.chainForce[k] / mark.typical;
      if (share < 0.01) continue;
      // Widths are for pictures of 1280 units; those of the page are smaller.
      const width = Math.max(1, Math.round(5 * 0.75 * mark.drawn * Math.min(share, 2)));
      const path = paths.get(width) ?? newPath();
      paths.set(width, path);
      const [a, b] = [run.chainBlock[2 * k], run.chainBlock[2 * k + 1]];
      const at: Point = [run.chainMiddle[2 * k], run.chainMiddle[2 * k + 1]];
      const middle = this.shifted(canvas, at, run.fixed[a] ? b : a);
      path.moveTo(...canvas.toPixel(...(run.fixed[a] ? middle : this.middle(canvas, a))));
      path.lineTo(...canvas.toPixel(...middle));
      path.lineTo(...canvas.toPixel(...(run.fixed[b] ? middle : this.middle(canvas, b))));
    }
    canvas.context.globalAlpha = 0.85;
    for (const [width, path] of paths) this.stroke(canvas, path, this.color(mark), width / 5);
    canvas.context.globalAlpha = 1;
  }

  private crosses(mark: MarkInHeader, canvas: MarkCanvas): void {
    const compression = newPath();
    const tension = newPath();
    for (let b = 0; b < this.run.blockCount; b++) {
      if (!this.isShown(canvas.moment, b)) continue;
      const p = principal(this.run.stressAt(canvas.moment, b));
      const [x, y] = canvas.toPixel(...this.middle(canvas, b));
      const bar = (value: number, degrees: number) => {
        const half =
          (0.5 * mark.drawn * this.blockSize * canvas.scale * Math.abs(value)) / (mark.typical || 1);
        const angle = (degrees * Math.PI) / 180;
        const path = value < 0 ? compression : tension;
        path.moveTo(x - half * Math.cos(angle), y + half * Math.sin(angle));
        path.lineTo(x + half * Math.cos(angle), y - half * Math.sin(angle));
      };
      bar(p.compressive, p.angle);
      bar(p.tensile, p.angle + 90);
    }
    this.stroke(canvas, compression, this.color(mark), 1.3);
    this.stroke(canvas, tension, "#d55e00", 1.3);
  }

  private arrows(mark: MarkInHeader, canvas: MarkCanvas, vector: (block: number) => Point): void {
    const path = newPath();
    const unit = mark.drawn * this.blockSize * canvas.scale;
    for (let b = 0; b < this.run.blockCount; b++) {
      if (!this.isShown(canvas.moment, b) || this.run.statusAt(canvas.moment, b) === Status.fallen) continue;
      const [vx, vy] = vector(b);
      const share = Math.hypot(vx, vy) / mark.typical;
      if (!(share > 0.125)) continue;
      const size = unit * Math.min(share, this.longestArrow);
      const [dx, dy] = [vx / Math.hypot(vx, vy), -vy / Math.hypot(vx, vy)];
      const [x, y] = canvas.toPixel(...this.middle(canvas, b));
      const [tx, ty] = [x + size * dx, y + size * dy];
      const head = 0.3 * Math.min(size, unit);
      path.moveTo(x, y);
      path.lineTo(tx, ty);
      path.moveTo(tx - head * (dx + 0.5 * dy), ty - head * (dy - 0.5 * dx));
      path.lineTo(tx, ty);
      path.lineTo(tx - head * (dx - 0.5 * dy), ty - head * (dy + 0.5 * dx));
    }
    this.stroke(canvas, path, css("--paper"), 3);
    this.stroke(canvas, path, this.color(mark), 1.5);
  }

  private outline(mark: MarkInHeader, canvas: MarkCanvas): void {
    const { run } = this;
    const path = newPath();
    for (let r = 0; r < run.ringBegin.length; r++) {
      if (!this.isShown(canvas.moment, run.ringBlock[r])) continue;
      for (let v = run.ringBegin[r]; v < run.ringEnd[r]; v++) {
        const at = canvas.toPixel(run.position[2 * v], run.position[2 * v + 1]);
        if (v === run.ringBegin[r]) path.moveTo(...at);
        else path.lineTo(...at);
      }
      path.closePath();
    }
    this.stroke(canvas, path, this.color(mark), 0.8);
  }

  /** Through each block that is pressed by two others, between the resultants; a dot where the joint turns about its end. */
  private thrust(mark: MarkInHeader, canvas: MarkCanvas): void {
    const { run } = this;
    const [begin, end] = run.chainsAt(canvas.moment);
    const ofBlock = new Map<number, number[]>();
    const at = (k: number): Point => [run.chainMiddle[2 * k], run.chainMiddle[2 * k + 1]];
    const dots = newPath();
    for (let k = begin; k < end; k++) {
      const blocks = [run.chainBlock[2 * k], run.chainBlock[2 * k + 1]];
      for (const b of blocks) ofBlock.set(b, [...(ofBlock.get(b) ?? []), k]);
      if (!run.chainHinge[k] || run.chainForce[k] < 0.01 * mark.typical) continue;
      const [x, y] = canvas.toPixel(
        ...this.shifted(canvas, at(k), run.fixed[blocks[0]] ? blocks[1] : blocks[0]),
      );
      dots.moveTo(x, y);
      dots.lineTo(x + 0.01, y);
    }
    const line = newPath();
    for (const [b, chains] of ofBlock) {
      if (run.fixed[b] || chains.length !== 2) continue;
      if (Math.max(...chains.map((k) => run.chainForce[k])) < 0.01 * mark.typical) continue;
      line.moveTo(...canvas.toPixel(...this.shifted(canvas, at(chains[0]), b)));
      line.lineTo(...canvas.toPixel(...this.shifted(canvas, at(chains[1]), b)));
    }
    this.stroke(canvas, line, css("--paper"), 4);
    this.stroke(canvas, line, this.color(mark), 2.2);
    this.stroke(canvas, dots, css("--paper"), 12);
    this.stroke(canvas, dots, this.color(mark), 9);
  }
}
