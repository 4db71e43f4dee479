import { magma, mako, mixed, palette, place, rgbOf, table, viridis, type Rgb, type Scale } from "./colors";
import { css } from "./dom";
import { Elements } from "./elements";
import { Marks } from "./marks";
import { length, niceAbove, stress } from "./format";
import { EdgeKind, Run, Status, statusNames, type Moment } from "./run";

/** What blocks may be coloured by. */
export type BlockField = "displacement" | "mean" | "major" | "minor" | "shear" | "status" | "order" | "plain";
/** What joints may be coloured by. */
export type JointField = "plain" | JointNumber | "state" | "set";
/** Numbers among them. */
type JointNumber = "slip" | "opening" | "lost" | "pressure";

export const blockFields: { value: BlockField; text: string }[] = [
  { value: "displacement", text: "displacement" },
  { value: "mean", text: "mean stress" },
  { value: "major", text: "principal stress, most compressive" },
  { value: "minor", text: "principal stress, least compressive" },
  { value: "shear", text: "largest shear stress" },
  { value: "status", text: "status" },
  { value: "order", text: "polynomial order" },
  { value: "plain", text: "nothing" },
];
interface JointNumberText {
  array: string;
  text: string;
  title: string;
  note: string;
  /** A length, from a thousandth of the largest up; else from nothing up. */
  isLength: boolean;
  format: (value: number) => string;
}
const jointNumbers: Record<JointNumber, JointNumberText> = {
  slip: {
    array: "slip",
    text: "slip",
    title: "Slip of the joints",
    note: "shear displacement since the excavation; less than the scale is not drawn",
    isLength: true,
    format: (v) => length(v, 2),
  },
  opening: {
    array: "gap",
    text: "opening",
    title: "Opening of the joints",
    note: "gap of the contacts; less than the scale is not drawn",
    isLength: true,
    format: (v) => length(v, 2),
  },
  lost: {
    array: "lost",
    text: "strength lost",
    title: "Strength that joints have lost",
    note: "of what slip or opening takes from them; joints with all their strength are not drawn",
    isLength: false,
    format: (v) => `${Math.round(100 * v)} %`,
  },
  pressure: {
    array: "pressure",
    text: "pressure of water",
    title: "Pressure of water in the joints",
    note: "dry joints are not drawn",
    isLength: false,
    format: (v) => stress(v, 2),
  },
};
const isNumber = (field: JointField): field is JointNumber => field in jointNumbers;

/** Those that the joints of a run have. */
export function jointFields(run: Run): { value: JointField; text: string }[] {
  const numbers = (Object.keys(jointNumbers) as JointNumber[]).filter((n) =>
    run.pieceNumbers.has(jointNumbers[n].array),
  );
  return [
    { value: "plain", text: "nothing" },
    ...numbers.map((value) => ({ value, text: jointNumbers[value].text })),
    { value: "state", text: "contact state" },
    { value: "set", text: "joint set" },
  ];
}

const stressTitles: Record<string, string> = {
  mean: "Mean stress (σxx + σyy)/2",
  major: "Most compressive principal stress",
  minor: "Least compressive principal stress",
  shear: "Largest shear stress",
};

/** What a legend shows: a colour bar, or named colours. */
export interface Legend {
  title: string;
  note?: string;
  bar?: { colors: string[]; scale: Scale; format: (value: number) => string };
  classes?: { color: string; name: string; line?: boolean }[];
}

/** Mean displacement vector of a block against the base (Run.baseOf) between two states of all vertices. */
export function blockDisplacement(
  run: Run,
  block: number,
  u: Float32Array,
  since: Float32Array,
): [number, number] {
  const n = run.vertexCount;
  const ring = run.firstRing[block];
  const begin = run.ringBegin[ring];
  const end = run.ringEnd[ring];
  let x = 0;
  let y = 0;
  for (let v = begin; v < end; v++) {
    x += u[v] - since[v];
    y += u[n + v] - since[n + v];
  }
  const [baseX, baseY] = run.baseOf(u);
  const [sinceX, sinceY] = run.baseOf(since);
  return [x / (end - begin) - baseX + sinceX, y / (end - begin) - baseY + sinceY];
}

export interface Principal {
  compressive: number;
  tensile: number;
  shear: number;
  /** Of the most compressive direction, degrees counter-clockwise from +x. */
  angle: number;
}

/** Principal values of a plane stress tensor with compression negative. */
export function principal([xx, yy, xy]: [number, number, number]): Principal {
  const mean = 0.5 * (xx + yy);
  const radius = Math.hypot(0.5 * (xx - yy), xy);
  const tensileAngle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const angle = ((tensileAngle * 180) / Math.PI + 90 + 180) % 180;
  return { compressive: mean - radius, tensile: mean + radius, shear: radius, angle };
}

function percentile(sorted: Float64Array, p: number): number {
  return sorted.length === 0 ? 0 : sorted[Math.round(p * (sorted.length - 1))];
}

/** Colours of one run. Scales are the same for all moments, so that pictures can be compared. */
export class Fields {
  private displacementColors: string[] = [];
  private stressColors: string[] = [];
  private jointColors: string[] = [];
  private readonly scales = new Map<string, Scale>();
  private statusColors: string[] = [];
  private stateStyles: { name: string; color: string; width: number }[] = [];
  private plain = "";
  readonly elements: Elements;
  readonly marks: Marks;

  constructor(readonly run: Run) {
    this.elements = new Elements(run);
    this.marks = new Marks(run);
    this.readTheme();
  }

  readTheme(): void {
    this.elements.readTheme();
    this.plain = css("--rock");
    this.statusColors = [css("--rock"), "#e69f00", "#d55e00", "transparent"];
    this.stateStyles = [
      { name: "open", color: "#56b4e9", width: 1.5 },
      { name: "sliding", color: "#d55e00", width: 2.5 },
      { name: "locked", color: css("--joint"), width: 1.2 },
    ];
    // Little is near the colour of the paper, much is its opposite.
    const dark = css("--scheme") === "dark";
    const towardsInk = (map: Rgb[]) => table(dark ? map : [...map].reverse());
    this.displacementColors = towardsInk(magma);
    this.stressColors = towardsInk(mako);
    // Joints have the dark half of the lightness, and blocks beside them the light half: that is seen without colours, too.
    this.jointColors = towardsInk(dark ? viridis.slice(6) : viridis.slice(0, 5));
  }

  /** Moments whose values set the scales: the ends of the stages. */
  private keyMoments(): Moment[] {
    const ends: Moment[] = [];
    for (let k = 0; k < this.run.stageCount(); k++) {
      const f = this.run.lastFrame(k);
      if (f >= 0) ends.push(f);
    }
    return ends;
  }

  displacementScale(since: Moment): Scale {
    return this.cached(`displacement ${since}`, () => {
      const { run } = this;
      const u0 = run.displacementAt(since);
      const u = new Float32Array(u0.length);
      const values: number[] = [];
      for (const moment of this.keyMoments()) {
        if (moment < since) continue;
        run.displacementAt(moment, u);
        for (let b = 0; b < run.blockCount; b++) {
          if (run.fixed[b] || run.statusAt(moment, b) === Status.excavated) continue;
          const d = Math.hypot(...blockDisplacement(run, b, u, u0));
          if (d > 0) values.push(d);
        }
      }
      const sorted = Float64Array.from(values).sort();
      const largest = percentile(sorted, 1);
      if (!(largest > 0)) return { min: 0, max: 0.001, logarithmic: false };
      const max = niceAbove(largest);
      // A few fallen blocks move metres, the rest millimetres: then only a logarithmic scale shows both.
      if (largest < 30 * percentile(sorted, 0.5)) return { min: 0, max, logarithmic: false };
      const decades = Math.min(5, Math.max(2, Math.ceil(Math.log10(max / percentile(sorted, 0.1)))));
      return { min: max / 10 ** decades, max, logarithmic: true };
    });
  }

  private stressValue(field: BlockField, moment: Moment, block: number): number {
    const tensor = this.run.stressAt(moment, block);
    if (field === "mean") return 0.5 * (tensor[0] + tensor[1]);
    const p = principal(tensor);
    return field === "major" ? p.compressive : field === "minor" ? p.tensile : p.shear;
  }

  private stressScale(field: BlockField): Scale {
    return this.cached(field, () => {
      const { run } = this;
      const values: number[] = [];
      for (const moment of this.keyMoments()) {
        for (let b = 0; b < run.blockCount; b++) {
          if (run.fixed[b] || run.statusAt(moment, b) === Status.excavated) continue;
          values.push(this.stressValue(field, moment, b));
        }
      }
      const sorted = Float64Array.from(values).sort();
      const low = percentile(sorted, 0.02);
      const high = percentile(sorted, 0.98);
      if (field === "shear") return { min: 0, max: high > 0 ? niceAbove(high) : 1, logarithmic: false };
      const min = low < 0 ? -niceAbove(-low) : 0;
      const max = high > 0 && high > -0.02 * min ? niceAbove(high) : 0;
      return min < max ? { min, max, logarithmic: false } : { min: -1, max: 0, logarithmic: false };
    });
  }

  private pieceScale(field: JointNumber): Scale {
    return this.cached(field, () => {
      let largest = 0;
      for (const value of this.piecesBy(field))
        if (Number.isFinite(value)) largest = Math.max(largest, value);
      if (field === "lost") return { min: 0, max: 1, logarithmic: false };
      if (!jointNumbers[field].isLength) return { min: 0, max: niceAbove(largest || 1), logarithmic: false };
      const max = niceAbove(Math.max(largest, 1e-5));
      return { min: max / 1e3, max, logarithmic: true };
    });
  }

  private piecesBy(field: JointNumber): Float32Array {
    return this.run.pieceNumbers.get(jointNumbers[field].array) ?? new Float32Array();
  }

  private cached(key: string, make: () => Scale): Scale {
    const known = this.scales.get(key) ?? make();
    this.scales.set(key, known);
    return known;
  }

  /** Fill colours of all blocks at a moment; `u` and `since` are the displacements of all vertices then and before. */
  blockColors(
    field: BlockField,
    moment: Moment,
    u: Float32Array,
    since: Float32Array,
    sinceMoment: Moment,
    joints: JointField,
  ): string[] {
    const { run } = this;
    const color = this.colorOf(field, moment, u, since, sinceMoment);
    const faded = this.fading(joints);
    return Array.from({ length: run.blockCount }, (_, b) => (run.fixed[b] ? this.plain : faded(color(b))));
  }

  /** What becomes of the colours of blocks beside joints that have colours of a scale: they are paler than all of those. */
  private fading(joints: JointField): (color: string) => string {
    if (!isNumber(joints)) return (color) => color;
    const paper = rgbOf(css("--paper"));
    const known = new Map<string, string>();
    return (color) => {
      const pale = known.get(color) ?? mixed(color, paper, 0.45);
      known.set(color, pale);
      return pale;
    };
  }

  private colorOf(
    field: BlockField,
    moment: Moment,
    u: Float32Array,
    since: Float32Array,
    sinceMoment: Moment,
  ): (block: number) => string {
    const { run } = this;
    const onScale = (map: string[], scale: Scale, value: (block: number) => number) => (block: number) =>
      map[Math.round(place(scale, value(block)) * (map.length - 1))];
    switch (field) {
      case "plain":
        return () => this.plain;
      case "status":
        return (b) => this.statusColors[run.statusAt(moment, b)];
      case "order":
        return (b) => this.orderColor(run.order[b]);
      case "displacement":
        // Before the moment from which displacement counts there is none.
        if (moment < sinceMoment) return () => this.plain;
        return onScale(this.displacementColors, this.displacementScale(sinceMoment), (b) =>
          Math.hypot(...blockDisplacement(run, b, u, since)),
        );
      default:
        return onScale(this.stressMap(field), this.stressScale(field), (b) =>
          this.stressValue(field, moment, b),
        );
    }
  }

  /** Colours from the smallest (most compressive) to the largest value; for the shear stress, from nothing up. */
  private stressMap(field: BlockField): string[] {
    return field === "shear" ? this.stressColors : [...this.stressColors].reverse();
  }

  private orderColor(order: number): string {
    return order === 1 ? this.plain : palette[(order - 2) % palette.length];
  }

  /** Colour and width (px) of a joint piece; null: not drawn. */
  pieceStyle(field: JointField, piece: number): { color: string; width: number } | null {
    const { run } = this;
    // The edge of the domain is no joint: a frame without friction would seem to slide all round.
    if (run.edgeKind[run.pieceVertex[piece]] === EdgeKind.domain) return null;
    if (isNumber(field)) {
      const scale = this.pieceScale(field);
      const value = this.piecesBy(field)[piece];
      if (!(value > scale.min)) return null;
      const t = place(scale, value);
      return { color: this.jointColors[Math.round(t * (this.jointColors.length - 1))], width: 1.2 + 3 * t };
    }
    return this.stateStyles[run.pieceState[piece]];
  }

  /** Colour of the block edge that starts at a vertex, by what it is a piece of; null: not drawn. */
  edgeColor(vertex: number): string | null {
    const index = this.run.edgeIndex[vertex];
    switch (this.run.edgeKind[vertex] as EdgeKind) {
      case EdgeKind.jointSet:
        return palette[index % palette.length];
      case EdgeKind.traceMap:
        return palette[(this.run.header.model.joint_sets.length + index) % palette.length];
      default:
        return null;
    }
  }

  blockLegend(field: BlockField, since: Moment): Legend | null {
    switch (field) {
      case "plain":
        return null;
      case "status":
        return {
          title: "Status of the blocks",
          classes: [0, 1, 2].map((s) => ({ color: this.statusColors[s], name: statusNames[s] })),
        };
      case "order": {
        const orders = [...new Set(this.run.order)].sort((a, b) => a - b);
        return {
          title: "Order of the displacement polynomial",
          classes: orders.map((o) => ({ color: this.orderColor(o), name: `order ${o}` })),
        };
      }
      case "displacement":
        return {
          title: "Displacement of the blocks",
          bar: {
            colors: this.displacementColors,
            scale: this.displacementScale(since),
            format: (v) => length(v, 2),
          },
        };
      default:
        return {
          title: stressTitles[field],
          note:
            field === "shear"
              ? undefined
              : "compression negative; colours end at the 2nd and 98th percentile",
          bar: {
            colors: this.stressMap(field),
            scale: this.stressScale(field),
            format: (v) => stress(v, 2),
          },
        };
    }
  }

  /** All legends of what is shown. */
  legends(look: { blocks: BlockField; joints: JointField; marks: string; since: Moment }): Legend[] {
    const blocks = this.blockLegend(look.blocks, look.since);
    if (blocks?.bar) blocks.bar.colors = blocks.bar.colors.map(this.fading(look.joints));
    return [
      blocks,
      this.jointLegend(look.joints),
      this.elements.legend(),
      this.marks.legend(look.marks),
    ].filter((l) => l !== null);
  }

  jointLegend(field: JointField): Legend | null {
    const { model } = this.run.header;
    switch (field) {
      case "plain":
        return null;
      case "set":
        return {
          title: "Joints by set",
          classes: [...model.joint_sets, ...model.trace_maps].map((name, k) => ({
            color: palette[k % palette.length],
            name,
            line: true,
          })),
        };
      case "state":
        return {
          title: "State of the contacts",
          classes: this.stateStyles.map((s) => ({ color: s.color, name: s.name, line: true })),
        };
      default: {
        const { title, note, format } = jointNumbers[field];
        return { title, note, bar: { colors: this.jointColors, scale: this.pieceScale(field), format } };
      }
    }
  }
}
