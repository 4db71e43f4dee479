import { emptyBox, sizeOf, union, widened, type Box } from "./box";
import { Arrays, decodeFrames, type Header, type Stage } from "./data";

export const enum Status {
  inPlace = 0,
  loosened = 1,
  fallen = 2,
  excavated = 3,
}
export const statusNames = ["in place", "loosened", "fallen", "excavated"];

export const enum EdgeKind {
  free = 0,
  jointSet = 1,
  traceMap = 2,
  excavation = 3,
  domain = 4,
}

/** Moments at which the page shows the blocks: a fractional index into the frames, −1 for the reference position. */
export type Moment = number;

/** How much larger the picture may be than the rock, for blocks that have moved. */
const mostGrowth = 2;

/** The results of one run, with the questions that the figures ask. */
export class Run {
  readonly stages: Stage[];
  readonly blockCount: number;
  readonly vertexCount: number;
  readonly frameCount: number;
  readonly ringBegin: Uint32Array;
  readonly ringEnd: Uint32Array;
  readonly ringBlock: Uint32Array;
  /** Rings of block b are firstRing[b] … firstRing[b + 1]. */
  readonly firstRing: Uint32Array;
  /** The vertex after each in its ring. */
  readonly next: Uint32Array;
  readonly position: Float32Array;
  readonly edgeKind: Uint8Array;
  readonly edgeIndex: Int32Array;
  readonly order: Uint8Array;
  readonly fixed: Uint8Array;
  readonly area: Float32Array;
  readonly density: Float32Array;
  readonly time: Float64Array;
  readonly stage: Int32Array;
  readonly step: Float64Array;
  readonly status: Uint8Array;
  readonly snapshotFrame: Uint32Array;
  readonly snapshotBegin: Uint32Array;
  readonly pieceVertex: Uint32Array;
  readonly pieceFrom: Uint8Array;
  readonly pieceTo: Uint8Array;
  readonly pieceState: Uint8Array;
  /** By the name of their array, `slip` for "piece.slip"; none for what no joint has. */
  readonly pieceNumbers = new Map<string, Float32Array>();
  /** Force chains, snapshot by snapshot: none in pages of earlier versions. */
  readonly hasChains: boolean;
  readonly chainBlock: Uint32Array;
  readonly chainMiddle: Float32Array;
  readonly chainForce: Float32Array;
  readonly chainHinge: Uint8Array;
  private readonly chainBegin: Uint32Array;
  readonly hasVelocity: boolean;
  private readonly velocity: Float32Array;
  private readonly displacement: Float32Array;
  private readonly stress: Float32Array;
  private extentFound: Box | null = null;

  constructor(
    readonly header: Header,
    readonly arrays: Arrays,
  ) {
    this.stages = header.run.stages;
    this.ringBegin = arrays.get("ring.begin", "u32");
    this.ringEnd = arrays.get("ring.end", "u32");
    this.ringBlock = arrays.get("ring.block", "u32");
    this.position = arrays.get("vertex.position", "f32");
    this.edgeKind = arrays.get("edge.kind", "u8");
    this.edgeIndex = arrays.get("edge.index", "i32");
    this.order = arrays.get("block.order", "u8");
    this.fixed = arrays.get("block.fixed", "u8");
    this.area = arrays.get("block.area", "f32");
    this.density = arrays.get("block.density", "f32");
    this.time = arrays.get("frame.time", "f64");
    this.stage = arrays.get("frame.stage", "i32");
    this.step = arrays.get("frame.step", "f64");
    this.status = arrays.get("frame.status", "u8");
    this.snapshotFrame = arrays.get("snapshot.frame", "u32");
    this.snapshotBegin = arrays.get("snapshot.begin", "u32");
    this.pieceVertex = arrays.get("piece.vertex", "u32");
    this.pieceFrom = arrays.get("piece.from", "u8");
    this.pieceTo = arrays.get("piece.to", "u8");
    this.pieceState = arrays.get("piece.state", "u8");
    for (const name of ["slip", "gap", "lost", "pressure"]) {
      if (arrays.has(`piece.${name}`)) this.pieceNumbers.set(name, arrays.get(`piece.${name}`, "f32"));
    }
    this.blockCount = this.order.length;
    this.vertexCount = this.position.length / 2;
    this.frameCount = this.time.length;
    const f = this.frameCount;
    this.displacement = decodeFrames(
      arrays.get("frame.displacement", "u8"),
      f,
      2 * this.vertexCount,
      header.displacement_quantum,
    );
    this.stress = decodeFrames(
      arrays.get("frame.stress", "u8"),
      f,
      3 * this.blockCount,
      header.stress_quantum,
    );

    this.hasVelocity = arrays.has("frame.velocity");
    this.velocity = this.hasVelocity
      ? decodeFrames(arrays.get("frame.velocity", "u8"), f, 2 * this.blockCount, header.velocity_quantum ?? 1)
      : new Float32Array();
    this.hasChains = arrays.has("chain.begin");
    this.chainBegin = this.hasChains ? arrays.get("chain.begin", "u32") : new Uint32Array();
    this.chainBlock = this.hasChains ? arrays.get("chain.block", "u32") : new Uint32Array();
    this.chainMiddle = this.hasChains ? arrays.get("chain.middle", "f32") : new Float32Array();
    this.chainForce = this.hasChains ? arrays.get("chain.force", "f32") : new Float32Array();
    this.chainHinge = this.hasChains ? arrays.get("chain.hinge", "u8") : new Uint8Array();

    this.firstRing = new Uint32Array(this.blockCount + 1);
    for (const b of this.ringBlock) this.firstRing[b + 1]++;
    for (let b = 0; b < this.blockCount; b++) this.firstRing[b + 1] += this.firstRing[b];
    this.next = new Uint32Array(this.vertexCount);
    for (let r = 0; r < this.ringBegin.length; r++) {
      for (let v = this.ringBegin[r]; v < this.ringEnd[r]; v++) {
        this.next[v] = v + 1 < this.ringEnd[r] ? v + 1 : this.ringBegin[r];
      }
    }
  }

  /** "17" or its name: what the page calls a block. */
  blockName(block: number): string {
    return this.header.model.block_names[block] ?? `block ${block}`;
  }

  stageName(stage: number): string {
    return this.stages[stage]?.name ?? `stage ${stage + 1}`;
  }

  /** Stages of which there are frames or records, ascending. */
  stageCount(): number {
    const last = this.frameCount > 0 ? this.stage[this.frameCount - 1] + 1 : 0;
    return Math.max(this.stages.length, last);
  }

  firstFrame(stage: number): number {
    return this.stage.indexOf(stage);
  }

  lastFrame(stage: number): number {
    return this.stage.lastIndexOf(stage);
  }

  /** The frame whose states hold at a moment. */
  frameOf(moment: Moment): number {
    return Math.min(Math.floor(moment + 1e-6), this.frameCount - 1);
  }

  /** The moment at which the animation stands at a time; of several static frames at one time, the last. */
  momentAtTime(time: number): Moment {
    let f = 0;
    while (f + 1 < this.frameCount && this.time[f + 1] <= time) f++;
    if (f + 1 >= this.frameCount || this.time[f + 1] <= this.time[f]) return f;
    return Math.max(f, f + (time - this.time[f]) / (this.time[f + 1] - this.time[f]));
  }

  momentAtStep(step: number): Moment {
    let f = 0;
    while (f + 1 < this.frameCount && this.step[f + 1] <= step) f++;
    if (f + 1 >= this.frameCount || this.step[f + 1] <= this.step[f]) return f;
    return Math.max(f, f + (step - this.step[f]) / (this.step[f + 1] - this.step[f]));
  }

  private interpolate(values: Float64Array, moment: Moment): number {
    if (moment < 0) return 0;
    const f = this.frameOf(moment);
    const s = moment - f;
    return s > 1e-6 && f + 1 < this.frameCount ? values[f] + s * (values[f + 1] - values[f]) : values[f];
  }

  timeAt(moment: Moment): number {
    return this.interpolate(this.time, moment);
  }

  stepAt(moment: Moment): number {
    return this.interpolate(this.step, moment);
  }

  statusAt(moment: Moment, block: number): Status {
    return moment < 0 ? Status.inPlace : this.status[this.frameOf(moment) * this.blockCount + block];
  }

  /** Displacements since the start at a moment: x of all vertices, then y; linear between frames. */
  displacementAt(moment: Moment, out?: Float32Array): Float32Array {
    const n = 2 * this.vertexCount;
    const result = out ?? new Float32Array(n);
    if (moment < 0 || this.frameCount === 0) return result.fill(0);
    const f = this.frameOf(moment);
    const s = moment - f;
    const a = this.displacement.subarray(f * n, (f + 1) * n);
    if (s < 1e-6 || f + 1 >= this.frameCount) {
      result.set(a);
      return result;
    }
    const b = this.displacement.subarray((f + 1) * n, (f + 2) * n);
    for (let i = 0; i < n; i++) result[i] = a[i] + s * (b[i] - a[i]);
    return result;
  }

  /** Mean Cauchy stress of a block: xx, yy, xy in Pa, compression negative. */
  stressAt(moment: Moment, block: number): [number, number, number] {
    if (moment < 0 || this.frameCount === 0) return [0, 0, 0];
    const at = this.frameOf(moment) * 3 * this.blockCount + block;
    const n = this.blockCount;
    return [this.stress[at], this.stress[at + n], this.stress[at + 2 * n]];
  }

  /** Velocity of the mass centre of a block, m/s. */
  velocityAt(moment: Moment, block: number): [number, number] {
    if (moment < 0 || !this.hasVelocity) return [0, 0];
    const at = this.frameOf(moment) * 2 * this.blockCount + block;
    return [this.velocity[at], this.velocity[at + this.blockCount]];
  }

  /** The contact snapshot that holds at a moment; −1 before the first. */
  private snapshotAt(moment: Moment): number {
    const f = this.frameOf(moment);
    let k = -1;
    while (k + 1 < this.snapshotFrame.length && this.snapshotFrame[k + 1] <= f) k++;
    return k;
  }

  /** The joint pieces that hold at a moment: [begin, end), empty before the first contact snapshot. */
  piecesAt(moment: Moment): [number, number] {
    const k = this.snapshotAt(moment);
    return k < 0 ? [0, 0] : [this.snapshotBegin[k], this.snapshotBegin[k + 1]];
  }

  /** The force chains, likewise. */
  chainsAt(moment: Moment): [number, number] {
    const k = this.snapshotAt(moment);
    return k < 0 || !this.hasChains ? [0, 0] : [this.chainBegin[k], this.chainBegin[k + 1]];
  }

  /** The rock without the fixed frame around a domain; all blocks where there is no domain. */
  extentOfRock(): Box {
    const hasDomain = this.edgeKind.includes(EdgeKind.domain);
    return this.boxOf((b) => !hasDomain || !this.fixed[b]);
  }

  /**
   * What to show of the plane: the rock, of the frame around it only a margin, and the blocks that lie elsewhere when a stage
   * ends. Not those so far away that all else would hardly be seen: pictures are scaled to the structure, not to the stone that flew
   * farthest.
   */
  get extent(): Box {
    return (this.extentFound ??= this.findExtent());
  }

  private findExtent(): Box {
    const rock = this.extentOfRock();
    const margin = 0.03 * sizeOf(rock);
    const start = widened(rock, margin);
    let extent = start;
    for (let k = 0; k < this.stageCount(); k++) {
      const frame = this.lastFrame(k);
      if (frame < 0) continue;
      const at = this.displacementAt(frame);
      for (let v = 0; v < this.vertexCount; v++) {
        at[v] += this.position[2 * v];
        at[this.vertexCount + v] += this.position[2 * v + 1];
      }
      for (let b = 0; b < this.blockCount; b++) {
        if (this.fixed[b] || this.statusAt(frame, b) === Status.excavated) continue;
        const block = widened(this.boxOfBlock(b, at), margin);
        const both = union(start, block);
        if (sizeOf(both) <= mostGrowth * sizeOf(start)) extent = union(extent, both);
      }
    }
    return extent;
  }

  /** Of a block, given the x of all vertices, then y. */
  boxOfBlock(block: number, at: ArrayLike<number>): Box {
    const box = { ...emptyBox };
    const ring = this.firstRing[block];
    for (let v = this.ringBegin[ring]; v < this.ringEnd[ring]; v++) {
      const y = at[this.vertexCount + v];
      box.minX = Math.min(box.minX, at[v]);
      box.maxX = Math.max(box.maxX, at[v]);
      box.minY = Math.min(box.minY, y);
      box.maxY = Math.max(box.maxY, y);
    }
    return box;
  }

  private boxOf(counts: (block: number) => boolean): Box {
    const box = { ...emptyBox };
    for (let r = 0; r < this.ringBegin.length; r++) {
      if (!counts(this.ringBlock[r])) continue;
      for (let v = this.ringBegin[r]; v < this.ringEnd[r]; v++) {
        box.minX = Math.min(box.minX, this.position[2 * v]);
        box.maxX = Math.max(box.maxX, this.position[2 * v]);
        box.minY = Math.min(box.minY, this.position[2 * v + 1]);
        box.maxY = Math.max(box.maxY, this.position[2 * v + 1]);
      }
    }
    return Number.isFinite(box.minX) ? box : { minX: -1, minY: -1, maxX: 1, maxY: 1 };
  }

  /** What all fixed blocks have moved by, of displacements as displacementAt gives them; nothing where they move differently. */
  baseOf(u: Float32Array): [number, number] {
    const n = this.vertexCount;
    let base: [number, number] | null = null;
    for (let r = 0; r < this.ringBegin.length; r++) {
      if (!this.fixed[this.ringBlock[r]]) continue;
      for (let v = this.ringBegin[r]; v < this.ringEnd[r]; v++) {
        base ??= [u[v], u[n + v]];
        const apart = Math.hypot(u[v] - base[0], u[n + v] - base[1]);
        if ((base[0] === 0 && base[1] === 0) || apart > 3 * this.header.displacement_quantum) return [0, 0];
      }
    }
    return base ?? [0, 0];
  }

  /** Blocks that are not fixed. */
  movable(): number {
    return this.blockCount - this.fixed.reduce((sum, f) => sum + f, 0);
  }

  /** The largest displacement of a corner against the base in the last frame, m, and its block. */
  largestDisplacement(): [number, number] {
    const u = this.displacementAt(this.frameCount - 1);
    const [baseX, baseY] = this.baseOf(u);
    let [largest, at] = [0, -1];
    for (let r = 0; r < this.ringBegin.length; r++) {
      if (this.fixed[this.ringBlock[r]]) continue;
      for (let v = this.ringBegin[r]; v < this.ringEnd[r]; v++) {
        const d = Math.hypot(u[v] - baseX, u[this.vertexCount + v] - baseY);
        if (d > largest) [largest, at] = [d, this.ringBlock[r]];
      }
    }
    return [largest, at];
  }

  /** Area of the blocks that are not fixed, m². */
  rockArea(): number {
    return this.area.reduce((sum, a, b) => sum + (this.fixed[b] ? 0 : a), 0);
  }
}
