/** What the report of a study carries: study.json (docs/study-report.md) and a row per run (src/study/study_page.h). */
import { readPage, type ArrayEntry, type Arrays } from "../data";

export type Maybe = number | null;

export interface Estimate {
  value: Maybe;
  low: Maybe;
  high: Maybe;
}

/** Columns of a curve with its band. */
export interface Band {
  low: Maybe[];
  high: Maybe[];
}

export interface Description {
  n: number;
  mean: Estimate;
  std: Estimate;
  min: Maybe;
  max: Maybe;
  quantiles: (Estimate & { p: number })[];
}

export interface MeasureSummary extends Description {
  running_mean: Band & { n: number[]; mean: Maybe[] };
  exceedance: Band & { value: number[]; probability: number[] };
}

/** Of how many realizations something holds. */
export interface Share {
  /** Realizations that have the measure. */
  n: number;
  exceeded: number;
  probability: Maybe;
  low: number;
  high: number;
}

export interface LevelShare extends Share {
  name: string;
}

/** Damage until the end of `before`, or what came after it. */
export interface DamagePart {
  /** A block has fallen. */
  falls: Share;
  levels: LevelShare[];
  measures: Record<string, Description>;
}

export interface Combination {
  values: string[];
  n: number;
  failed: number;
  pga_m_s2: Maybe;
  pgv_m_s: Maybe;
  arias_m_s: Maybe;
  worst: string | null;
  median: string | null;
  checked: number;
  marginal: number;
  falls: Share;
  levels: LevelShare[];
  measures: Record<string, MeasureSummary>;
  before: DamagePart | null;
  added: DamagePart | null;
  /** How far measures hang on strengths that were drawn. */
  hangs_on: { measure: string; strength: string; rank_correlation: Estimate; first_order_index: Estimate }[];
  map: { n: number; fallen: number[]; fallen_or_loosened: number[] };
}

export type IntensityName =
  | "pga_m_s2"
  | "pgv_m_s"
  | "arias_m_s"
  | "pga_rotd50_m_s2"
  | "pgv_rotd50_m_s"
  | "sa_03_rotd50_m_s2"
  | "sa_10_rotd50_m_s2";

export interface Fragility {
  level: string;
  intensity: IntensityName;
  values: (string | null)[];
  combinations: number[];
  status: string;
  /** Why there is no curve. */
  why: string | null;
  theta: Estimate;
  beta: Estimate;
  realizations: number;
  without_shaking: number;
  exceeded_without_shaking: number;
  records: number;
  /** Of which records the intervals tell; null without a curve. */
  which_records: string | null;
  /** What of β is from rock to rock, from record to record, and of the single pair. */
  sigma: { rock: Estimate; record: Estimate; rest: Estimate };
  pairs: number;
  not_monotone: number;
  points: Band & { intensity: number[]; n: number[]; exceeded: number[]; probability: Maybe[] };
  curve: Band & { intensity: number[]; probability: Maybe[] };
}

export interface Quantity {
  name: string;
  title: string;
  unit: string;
  /** In which pages show it: numbers times the factor. Of measures alone. */
  shown_unit?: string;
  shown_factor?: number;
}

export interface StudyJson {
  title: string;
  version: string;
  realizations: number;
  runs: { planned: number; done: number; failed: number };
  stage: string;
  since: string | null;
  /** At the end of which stage damage counts as there before: since, or the last one before the shaking. */
  before: string | null;
  /** That is the last stage before the shaking. */
  at_shaking: boolean;
  confidence: number;
  bootstrap_resamples: number;
  axes: { key: string; values: string[]; shaking: boolean }[];
  levels: { name: string; measure: string; threshold: number }[];
  measures: Quantity[];
  intensities: Quantity[];
  precision: {
    measure: string;
    half_width: Maybe;
    width: Maybe;
    minimum: number;
    reached: boolean;
  } | null;
  /** Of runs without shaking: realizations, and those where more than the threshold fell in them. */
  control: { realizations: number; still_falling: number; threshold_m2: number } | null;
  marginal: { friction_degrees: number; share: number; smallest_area_m2: number } | null;
  combinations: Combination[];
  fragility: Fragility[];
  grid: { corner: [number, number]; cell_m: Maybe; columns: number; rows: number };
  outlines: [number, number][][];
  /** Openings, rock, joints and loads. */
  ground: { name: string; value: string }[];
  failed: { key: string; realization: number; values: string[]; variant: string; error: string }[];
}

export interface StudyHeader {
  seed: string;
  most_thumbnails: number;
  arrays: ArrayEntry[];
}

/** 0: not known, as no variant was run. */
export const Marginality = { unknown: 0, no: 1, yes: 2 } as const;

/** A study, and the questions that its figures ask. Runs go by their number. */
export class Study {
  readonly json: StudyJson;
  readonly keys: string[];
  readonly errors: Record<string, string>;
  readonly realization: Int32Array;
  readonly combination: Int32Array;
  readonly done: Uint8Array;
  readonly hasReport: Uint8Array;
  readonly marginal: Uint8Array;
  readonly wallTime: Float32Array;
  private readonly variants: string[];
  private readonly variant: Uint8Array;
  private readonly values: Float64Array;
  private readonly thumbnail: Int32Array;
  private readonly runOfKey: Map<string, number>;
  private readonly axisNames: string[];
  private readonly urls = new Map<number, string>();

  constructor(
    readonly header: StudyHeader,
    private readonly arrays: Arrays,
  ) {
    const text = (name: string) => new TextDecoder().decode(arrays.get(name, "u8"));
    this.json = JSON.parse(text("study")) as StudyJson;
    const texts = JSON.parse(text("texts")) as {
      keys: string[];
      variants: string[];
      errors: Record<string, string>;
    };
    this.keys = texts.keys;
    this.variants = texts.variants;
    this.errors = texts.errors;
    this.realization = arrays.get("run.realization", "i32");
    this.combination = arrays.get("run.combination", "i32");
    this.variant = arrays.get("run.variant", "u8");
    this.done = arrays.get("run.done", "u8");
    this.hasReport = arrays.get("run.report", "u8");
    this.marginal = arrays.get("run.marginal", "u8");
    this.wallTime = arrays.get("run.wall_time", "f32");
    this.values = arrays.get("run.measures", "f64");
    this.thumbnail = arrays.get("run.thumbnail", "i32");
    this.runOfKey = new Map(this.keys.map((key, r) => [key, r]));
    const short = this.json.axes.map((axis) => shortName(axis.key));
    this.axisNames = short.map((name, a) =>
      short.indexOf(name) === short.lastIndexOf(name) ? name : this.json.axes[a].key,
    );
  }

  runCount(): number {
    return this.keys.length;
  }

  find(key: string | null): number | undefined {
    return key === null ? undefined : this.runOfKey.get(key);
  }

  hasVariant(name: string): boolean {
    return this.variants.includes(name);
  }

  variantOf(run: number): string {
    return this.variants[this.variant[run]];
  }

  /** NaN where it was not measured. */
  value(run: number, measure: string): number {
    const m = this.json.measures.findIndex((q) => q.name === measure);
    return this.values[run * this.json.measures.length + m];
  }

  measure(name: string): Quantity {
    return this.json.measures.find((q) => q.name === name) ?? { name, title: name, unit: "" };
  }

  axisName(axis: number): string {
    return this.axisNames[axis];
  }

  /** "scale of first earthquake 1.0, order 2": the axes with more than one value, or those that `of` picks. */
  combinationName(values: readonly (string | null)[], of: (axis: number) => boolean = () => true): string {
    const parts = values.flatMap((value, a) =>
      value === null || !of(a) || this.json.axes.length <= a || this.json.axes[a].values.length < 2
        ? []
        : [`${this.axisName(a)} ${value}`],
    );
    return parts.join(", ") || "all runs";
  }

  /** What measures count: " by the shaking", " after “excavated”"; nothing where they count from the first excavation on. */
  after(): string {
    const { since, at_shaking } = this.json;
    if (!since) return "";
    return at_shaking ? " by the shaking" : ` after “${since}”`;
  }

  /** The run's picture as an address for an img element; none where the page has none. */
  pictureUrl(run: number): string | null {
    const k = this.thumbnail[run];
    if (k < 0) return null;
    const made = this.urls.get(k);
    if (made) return made;
    const begin = this.arrays.get("thumbnail.begin", "u32");
    const bytes = this.arrays.get("thumbnail.svg", "u8").slice(begin[k], begin[k + 1]);
    const url = URL.createObjectURL(new Blob([bytes], { type: "image/svg+xml" }));
    this.urls.set(k, url);
    return url;
  }

  pictureCount(): number {
    return this.thumbnail.reduce((sum, k) => sum + (k >= 0 ? 1 : 0), 0);
  }

  /** Runs of a combination, variants left out, by realization. */
  runsOf(combination: number): number[] {
    const runs: number[] = [];
    for (let r = 0; r < this.runCount(); r++)
      if (this.combination[r] === combination && this.variantOf(r) === "") runs.push(r);
    return runs.sort((a, b) => this.realization[a] - this.realization[b]);
  }
}

/** "stage.'first earthquake'.scale" is the "scale of first earthquake"; "rock.order" is the "order". */
export function shortName(key: string): string {
  const words = (text: string) => text.replaceAll("_", " ");
  const inList = /^\w+\.(?:'([^']+)'|"([^"]+)"|([\w-]+))\.(\w+)$/.exec(key);
  if (inList) return `${words(inList[4])} of ${inList[1] ?? inList[2] ?? inList[3]}`;
  const inTable = /^\w+\.(\w+)$/.exec(key);
  return inTable ? words(inTable[1]) : key;
}

export async function readStudy(): Promise<Study> {
  const { header, arrays } = await readPage<StudyHeader>();
  return new Study(header, arrays);
}
