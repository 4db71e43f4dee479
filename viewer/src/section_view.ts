import { areApart, type Box } from "./box";
import { Camera, type Frame } from "./camera";
import { css, textWidths } from "./dom";
import type { BlockField, Fields, JointField } from "./fields";
import { count } from "./format";
import { hatching } from "./hatching";
import { newPath } from "./save/path";
import { marks, type Mark } from "./axis_marks";
import { Status, type Moment, type Run } from "./run";

export interface Look {
  moment: Moment;
  /** Displacements are shown, and exaggerated, relative to this moment. */
  since: Moment;
  exaggeration: number;
  blocks: BlockField;
  joints: JointField;
  /** A name of src/picture/marks.h, or "none". */
  marks: string;
}

const axisFont = 11; // px
const axisBottom = 24;
/** Least room at the left of the axes, and what labels do not take of it; px. */
const leastAxisLeft = 46;
const besideLabels = 11;

/** Pixels of a block. Smaller ones have no edges, as these could not be told apart. */
const smallestWithEdges = 2.5;
const blocksPerPath = 512;
const piecesPerPath = 2048;

/** Draws the block system on a canvas: one moment, as a Look says, through a camera that can zoom and pan. */
export class SectionView {
  readonly canvas: HTMLCanvasElement;
  look: Look;
  selected = -1;
  hovered = -1;
  private context: CanvasRenderingContext2D;
  private readonly u: Float32Array;
  private readonly since: Float32Array;
  private sinceMoment: Moment = -1;
  /** Drawn positions: x of all vertices, then y. */
  private readonly drawn: Float32Array;
  private width = 0;
  private height = 0;
  private ratio = 1;
  /** Where the picture begins on what it is drawn on, px. */
  private origin: [number, number] = [0, 0];
  private readonly extent: Box;
  private readonly camera: Camera;
  /** The camera while drawing: pixel = (ax + scaleNow x, ay − scaleNow y). */
  private ax = 0;
  private ay = 0;
  private scaleNow = 1;
  private hatch: CanvasPattern | null = null;
  /** Room at the left of the axes: for the widest label since the model was last fitted. */
  private axisLeft = leastAxisLeft;

  constructor(
    readonly run: Run,
    readonly fields: Fields,
    look: Look,
    readonly options: { axes: boolean; label: string; minHeight?: number; maxHeight?: number },
  ) {
    this.look = { ...look };
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", options.label);
    this.context = this.canvas.getContext("2d", { alpha: false })!;
    this.u = new Float32Array(2 * run.vertexCount);
    this.since = new Float32Array(2 * run.vertexCount);
    this.drawn = new Float32Array(2 * run.vertexCount);
    this.extent = run.extent;
    this.camera = new Camera(this.extent);
    this.readTheme();
  }

  readTheme(): void {
    this.hatch = hatching(this.context);
  }

  /** Makes the canvas as wide as given, and as high as the model then is within the limits of the options. */
  resize(width: number): void {
    const height = Math.max(
      this.heightFor(width, this.options.maxHeight ?? Infinity),
      Math.min(this.options.minHeight ?? 0, this.options.maxHeight ?? Infinity),
    );
    this.width = Math.round(width);
    this.height = Math.round(height);
    this.ratio = Math.min(window.devicePixelRatio || 1, 3);
    this.canvas.width = Math.round(this.width * this.ratio);
    this.canvas.height = Math.round(this.height * this.ratio);
    this.canvas.style.width = `${this.width}px`;
    this.canvas.style.height = `${this.height}px`;
  }

  fit(): void {
    this.camera.fit();
    this.axisLeft = leastAxisLeft;
  }

  private innerSize(width: number, height: number): { width: number; height: number } {
    if (!this.options.axes) return { width, height };
    return { width: width - this.axisLeft - 8, height: height - axisBottom - 8 };
  }

  private inner(): Frame {
    const { axes } = this.options;
    return {
      left: axes ? this.axisLeft : 0,
      top: axes ? 8 : 0,
      ...this.innerSize(this.width, this.height),
    };
  }

  toPixel(x: number, y: number): [number, number] {
    return this.camera.toPixel(this.inner(), x, y);
  }

  toModel(px: number, py: number): [number, number] {
    return this.camera.toModel(this.inner(), px, py);
  }

  zoomAt(px: number, py: number, factor: number): void {
    this.camera.zoomAt(this.inner(), px, py, factor);
  }

  zoomCentred(factor: number): void {
    this.camera.zoomCentred(factor);
  }

  pan(dx: number, dy: number): void {
    this.camera.pan(this.inner(), dx, dy);
  }

  /** Centres a block as it is drawn now. */
  showBlock(block: number): void {
    this.update();
    const ring = this.run.firstRing[block];
    const v = this.run.ringBegin[ring];
    this.camera.show(this.drawn[v], this.drawn[this.run.vertexCount + v], 3);
  }

  /** Displacements at the moment of the look, and before. */
  displacements(): { u: Float32Array; since: Float32Array } {
    return { u: this.u, since: this.since };
  }

  private update(): void {
    const { run, look } = this;
    run.displacementAt(look.moment, this.u);
    if (look.since !== this.sinceMoment) {
      run.displacementAt(look.since, this.since);
      this.sinceMoment = look.since;
    }
    const n = run.vertexCount;
    const e = look.exaggeration;
    for (let v = 0; v < n; v++) {
      this.drawn[v] = run.position[2 * v] + this.since[v] + e * (this.u[v] - this.since[v]);
      this.drawn[n + v] =
        run.position[2 * v + 1] + this.since[n + v] + e * (this.u[n + v] - this.since[n + v]);
    }
  }

  isShown(block: number): boolean {
    return this.run.statusAt(this.look.moment, block) !== Status.excavated;
  }

  /** The block under a pixel, −1 for none. */
  blockAt(px: number, py: number): number {
    const [x, y] = this.toModel(px, py);
    const { run, drawn } = this;
    const n = run.vertexCount;
    for (let b = run.blockCount - 1; b >= 0; b--) {
      if (!this.isShown(b)) continue;
      let inside = false;
      for (let r = run.firstRing[b]; r < run.firstRing[b + 1]; r++) {
        const end = run.ringEnd[r];
        for (let v = run.ringBegin[r], w = end - 1; v < end; w = v++) {
          const yv = drawn[n + v];
          const yw = drawn[n + w];
          if (yv > y !== yw > y && x < drawn[v] + ((y - yv) / (yw - yv)) * (drawn[w] - drawn[v]))
            inside = !inside;
        }
      }
      if (inside) return b;
    }
    return -1;
  }

  /** The element under a pixel, −1 for none. */
  elementAt(px: number, py: number): number {
    return this.fields.elements.at(px, py, this.look, (x, y) => this.toPixel(x, y));
  }

  private tracePath(block: number): void {
    const { run, drawn, context: c } = this;
    const n = run.vertexCount;
    for (let r = run.firstRing[block]; r < run.firstRing[block + 1]; r++) {
      for (let v = run.ringBegin[r]; v < run.ringEnd[r]; v++) {
        const x = this.ax + this.scaleNow * drawn[v];
        const y = this.ay - this.scaleNow * drawn[n + v];
        if (v === run.ringBegin[r]) c.moveTo(x, y);
        else c.lineTo(x, y);
      }
      c.closePath();
    }
  }

  /** Height of the picture in a width, at most so much, px. */
  heightFor(width: number, most: number): number {
    const { minX, maxX, minY, maxY } = this.extent;
    const insets = this.options.axes ? [this.axisLeft + 8, axisBottom + 8] : [0, 0];
    return Math.round(Math.min(most, ((maxY - minY) / (maxX - minX)) * (width - insets[0]) + insets[1]));
  }

  /** Pixels of a metre in a picture of this size. */
  metres(width: number, height: number): number {
    return this.camera.scale({ left: 0, top: 0, ...this.innerSize(width, height) });
  }

  /** Draws what is seen on another context than the page's: a part of a figure that is saved. */
  drawOn(
    context: CanvasRenderingContext2D,
    at: { left: number; top: number; width: number; height: number; ratio: number },
  ): void {
    const { context: own, width, height, ratio } = this;
    Object.assign(this, { context, width: at.width, height: at.height, ratio: at.ratio });
    this.origin = [at.left, at.top];
    this.draw();
    Object.assign(this, { context: own, width, height, ratio });
    this.origin = [0, 0];
  }

  draw(): void {
    if (this.width === 0) return;
    this.update();
    if (this.options.axes) this.makeRoomForLabels();
    const { context: c } = this;
    this.scaleNow = this.camera.scale(this.inner());
    [this.ax, this.ay] = this.toPixel(0, 0);
    const inner = this.inner();
    c.setTransform(this.ratio, 0, 0, this.ratio, this.ratio * this.origin[0], this.ratio * this.origin[1]);
    c.fillStyle = css("--paper");
    c.fillRect(0, 0, this.width, this.height);
    c.save();
    c.beginPath();
    c.rect(inner.left, inner.top, inner.width, inner.height);
    c.clip();
    this.drawBlocks();
    this.drawOutlines();
    this.drawJoints();
    this.fields.elements.draw(
      c,
      this.look,
      (x, y) => [this.ax + this.scaleNow * x, this.ay - this.scaleNow * y],
      this.options.axes ? 1 : 0.6,
    );
    this.drawMarks();
    this.drawMarked();
    this.drawOutside();
    c.restore();
    if (this.options.axes) this.drawAxes();
  }

  private drawBlocks(): void {
    const { run, look, context: c } = this;
    const { blocks, moment, since, joints } = look;
    const colors = this.fields.blockColors(blocks, moment, this.u, this.since, since, joints);
    // Paper shows between blocks that fill pixels in part, which makes patterns of small ones: they cover the seams themselves.
    const withEdges = this.blockPixels() >= smallestWithEdges;
    c.lineWidth = 1;
    for (let b = 0; b < run.blockCount; b++) {
      if (!this.isShown(b)) continue;
      c.beginPath();
      this.tracePath(b);
      c.fillStyle = run.fixed[b] ? (this.hatch ?? css("--fixed")) : colors[b];
      c.fill("evenodd");
      if (withEdges || run.fixed[b]) continue;
      c.strokeStyle = colors[b];
      c.stroke();
    }
    if (withEdges) this.strokeBlocks();
  }

  /** The side of a mean block. */
  private blockPixels(): number {
    return this.scaleNow * Math.sqrt(this.run.rockArea() / this.run.blockCount);
  }

  /** The edges of all blocks. */
  private strokeBlocks(): void {
    const { run, look, context: c } = this;
    const pixels = this.blockPixels();
    const small = Math.min(1, pixels / 24);
    c.lineJoin = "round";
    c.lineWidth = 0.35 + 0.45 * small;
    c.strokeStyle = css("--joint");
    c.globalAlpha = look.joints === "plain" || look.joints === "set" ? 0.75 : 0.35;
    // A browser's path takes the longer to grow the longer it is.
    for (let first = 0; first < run.blockCount; first += blocksPerPath) {
      c.beginPath();
      const end = Math.min(run.blockCount, first + blocksPerPath);
      for (let b = first; b < end; b++) if (this.isShown(b)) this.tracePath(b);
      c.stroke();
    }
    c.globalAlpha = 1;
  }

  private drawOutlines(): void {
    const { context: c } = this;
    c.beginPath();
    for (const outline of this.run.header.model.excavation_outlines) {
      outline.forEach(([x, y], k) => {
        const px = this.ax + this.scaleNow * x;
        const py = this.ay - this.scaleNow * y;
        if (k === 0) c.moveTo(px, py);
        else c.lineTo(px, py);
      });
      c.closePath();
    }
    c.lineWidth = this.options.axes ? 2 : 1.25;
    c.strokeStyle = css("--outline");
    c.setLineDash(this.options.axes ? [7, 4] : [4, 2.5]);
    c.stroke();
    c.setLineDash([]);
  }

  private drawJoints(): void {
    const { run, look, context: c, drawn } = this;
    if (look.joints === "plain") return;
    const n = run.vertexCount;
    const fine = this.options.axes ? 1 : 0.75;
    interface Batch {
      color: string;
      width: number;
      path: Path2D;
      pieces: number;
    }
    const batches: Batch[] = [];
    const open = new Map<string, Batch>();
    const add = (color: string, width: number, v: number, from: number, to: number) => {
      const w = run.next[v];
      const key = `${color} ${width.toFixed(1)}`;
      let batch = open.get(key);
      if (!batch || batch.pieces === piecesPerPath) {
        batch = { color, width, path: newPath(), pieces: 0 };
        batches.push(batch);
        open.set(key, batch);
      }
      batch.pieces++;
      const at = (s: number): [number, number] => [
        this.ax + this.scaleNow * (drawn[v] + s * (drawn[w] - drawn[v])),
        this.ay - this.scaleNow * (drawn[n + v] + s * (drawn[n + w] - drawn[n + v])),
      ];
      batch.path.moveTo(...at(from));
      batch.path.lineTo(...at(to));
    };
    if (look.joints === "set") {
      for (let b = 0; b < run.blockCount; b++) {
        if (!this.isShown(b)) continue;
        for (let r = run.firstRing[b]; r < run.firstRing[b + 1]; r++) {
          for (let v = run.ringBegin[r]; v < run.ringEnd[r]; v++) {
            const color = this.fields.edgeColor(v);
            if (color) add(color, 1.2, v, 0, 1);
          }
        }
      }
    } else {
      const [begin, end] = run.piecesAt(look.moment);
      for (let p = begin; p < end; p++) {
        const style = this.fields.pieceStyle(look.joints, p);
        if (style)
          add(style.color, style.width, run.pieceVertex[p], run.pieceFrom[p] / 255, run.pieceTo[p] / 255);
      }
    }
    c.lineCap = "round";
    for (const { color, width, path } of [...batches].sort((a, b) => a.width - b.width)) {
      c.strokeStyle = color;
      c.lineWidth = fine * width;
      c.stroke(path);
    }
    c.lineCap = "butt";
  }

  private drawMarks(): void {
    this.fields.marks.draw(this.look.marks, {
      context: this.context,
      moment: this.look.moment,
      since: this.look.since,
      u: this.u,
      before: this.since,
      drawn: this.drawn,
      toPixel: (x, y) => [this.ax + this.scaleNow * x, this.ay - this.scaleNow * y],
      scale: this.scaleNow,
      fine: this.options.axes ? 1 : 0.7,
    });
  }

  private drawMarked(): void {
    const { context: c } = this;
    for (const [block, width] of [
      [this.hovered, 1.5],
      [this.selected, 2.5],
    ] as const) {
      if (block < 0 || !this.isShown(block)) continue;
      c.beginPath();
      this.tracePath(block);
      c.lineWidth = width + 2;
      c.strokeStyle = css("--paper");
      c.stroke();
      c.lineWidth = width;
      c.strokeStyle = css("--mark");
      c.stroke();
    }
  }

  /** Says how many blocks are not in the picture, unless the reader has zoomed. */
  private drawOutside(): void {
    if (this.camera.isZoomed) return;
    const { run, drawn, context: c } = this;
    const { left, top, width, height } = this.inner();
    const [minX, minY] = this.toModel(left, top + height);
    const [maxX, maxY] = this.toModel(left + width, top);
    let outside = 0;
    for (let b = 0; b < run.blockCount; b++) {
      if (run.fixed[b] || !this.isShown(b)) continue;
      if (areApart(run.boxOfBlock(b, drawn), { minX, minY, maxX, maxY })) outside++;
    }
    if (outside === 0) return;
    const text = `${count(outside, "block")} outside of the picture`;
    c.font = `${axisFont}px ${css("--font")}`;
    c.textAlign = "left";
    c.textBaseline = "middle";
    c.fillStyle = css("--paper");
    c.fillRect(left + 1, top + height - 19, c.measureText(text).width + 10, 18);
    c.fillStyle = css("--ink");
    c.fillText(text, left + 6, top + height - 10);
  }

  /** Marks of the axes in real coordinates, with their labels. */
  private axisMarks(): { x: Mark[]; y: Mark[] } {
    const { left, top, width, height } = this.inner();
    const [ox, oy] = this.run.header.model.origin;
    const [x0, y0] = this.toModel(left, top + height);
    const [x1, y1] = this.toModel(left + width, top);
    return {
      x: marks(x0 + ox, x1 + ox, Math.max(2, width / 90)),
      y: marks(y0 + oy, y1 + oy, Math.max(2, height / 70)),
    };
  }

  private makeRoomForLabels(): void {
    const labels = this.axisMarks().y.map((mark) => mark.text);
    const needed = Math.ceil(Math.max(...textWidths(labels, axisFont))) + besideLabels;
    this.axisLeft = Math.max(this.axisLeft, needed);
  }

  private drawAxes(): void {
    const { context: c } = this;
    const { left, top, width, height } = this.inner();
    const [ox, oy] = this.run.header.model.origin;
    const at = this.axisMarks();
    c.strokeStyle = css("--axis");
    c.fillStyle = css("--muted");
    c.lineWidth = 1;
    c.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
    c.font = `${axisFont}px ${css("--font")}`;
    c.beginPath();
    c.textAlign = "center";
    c.textBaseline = "top";
    let last = left - 7;
    for (const { value, text } of at.x) {
      const [px] = this.toPixel(value - ox, 0);
      c.moveTo(Math.round(px) + 0.5, top + height);
      c.lineTo(Math.round(px) + 0.5, top + height + 4);
      const half = 0.5 * c.measureText(text).width;
      if (px - half < last + 8 || px + half > this.width) continue;
      c.fillText(text, px, top + height + 6);
      last = px + half;
    }
    c.textAlign = "right";
    c.fillText("m", left - 7, top + height + 6);
    c.textBaseline = "middle";
    for (const { value, text } of at.y) {
      const [, py] = this.toPixel(0, value - oy);
      c.moveTo(left - 4, Math.round(py) + 0.5);
      c.lineTo(left, Math.round(py) + 0.5);
      if (py > top + 6 && py < top + height - 2) c.fillText(text, left - 7, py);
    }
    c.stroke();
  }
}
