/** What report.html carries: facts as JSON and numbers as packed arrays (src/report/page_data.h says how). */

/**
 * null: not known, as the run left no record of the end of the stage; or there is no such number, as closure while a wall point is on
 * a fallen block. "max" and "length" are of joints in place, "ever" of those beside fallen blocks, too: the largest up to then.
 */
export interface Damage {
  /** Holds where the area of the fallen blocks is known. */
  fallen_blocks: number;
  hinges: number;
  [measure: string]: number | null;
}

/** A column of damage, described once in src/record/damage_fields.h. */
export interface DamageMeasure {
  name: string;
  table: "rock" | "joints" | "elements";
  title: string;
  /** Numbers times the factor are in this unit. */
  unit: string;
  factor: number;
  /** At least so many. */
  decimals: number;
  /** It is known where this measure is a number. */
  known_with: string;
}

/** The fields of record/stage_fields.h that a page has. Numbers that may be null are not known of a stage that was killed. */
export interface Stage {
  name: string;
  kind: "settle" | "shake" | "rest";
  excavate: number[];
  /** Names of the supports that come to life at its start. */
  install: string[];
  /** Seismic coefficients of a static stage, over the weight. */
  k_h: number;
  k_v: number;
  /** What the strength of joints is divided by while it lasts; names of these joints, none: of all. */
  strength_factor: number;
  strength_of: string[];
  scale: number;
  tolerance: number;
  steps: number;
  start_time: number;
  duration: number;
  /** What the duration is unless the stage is interrupted; null for static stages. */
  planned_duration: number | null;
  pga_m_s2: number | null;
  pgv_m_s: number | null;
  arias_m_s: number | null;
  wall_time_s: number | null;
  interrupted: boolean;
  /** It ended before its duration, as nothing moved any more; what it waits for before that may be. */
  still: boolean;
  waits_for: { what: string; until_s: number } | null;
  /** Of static stages. */
  equilibrium: {
    reached: boolean;
    /** What it came to: "in equilibrium", "mechanism of 3 blocks"; null of dynamic ones. */
    verdict: string | null;
    worst_residual_ratio: number | null;
    /** Of a block that is not moving, while it was out of balance: the largest. */
    largest_way_m: number | null;
    largest_way_share: number | null;
    /** −1: none. */
    unstable_block: number;
    /** Blocks that move without bound: what each does, and the share of its weight that contacts carry. */
    moving: {
      block: number;
      carried: number | null;
      group: number;
      movement: "mechanism" | "falling" | "partly held";
    }[];
  };
  /** Of a run without excavations; null: with them, or not known. */
  standing: "stands" | "moves" | "rocks" | "collapsed" | "fallen" | "unsettled" | "unstable" | null;
  /** The blocks by which that is told. */
  movers: {
    blocks: number;
    weight_n_m: number | null;
    heaviest: number | null;
    heaviest_weight_n_m: number | null;
    way_m: number | null;
  };
  /** Of a block at its end. */
  largest_speed_m_s: number | null;
  /** By order. */
  blocks_by_order: number[];
  /** Of excavations opened in parts, by number: how far the wall has come inwards, at each equilibrium. */
  release: {
    excavation: number;
    step: number;
    released: number;
    crown_m: number | null;
    springline_m: number | null;
    mean_m: number | null;
  }[];
  damage: Damage;
  /** Blocks that have fallen by its end; `wall`: the part of the outline behind which the deepest corner lay. */
  fallen: {
    block: number;
    area_m2: number;
    weight_n_m: number;
    depth_m: number | null;
    wall: "crown" | "left" | "right" | "invert" | null;
  }[];
}

export interface Header {
  model: {
    title: string;
    version: string;
    seed: string;
    realization: number;
    threads: number;
    step_size_s: number;
    origin: [number, number];
    scenario: string;
    block_names: Record<string, string>;
    /** All that were planned, by name. */
    stages: string[];
    joint_sets: string[];
    trace_maps: string[];
    excavations: string[];
    excavation_outlines: [number, number][][];
    /** The command that finds the support pressure which holds the rock; empty where none is asked for. */
    pressure_search?: string;
    histories: string[];
    /** Springs, supports and all else that carries a force. Pages of earlier versions do not have them. */
    elements?: ElementInModel[];
    /** Histories of what an element carries, by its number. */
    element_histories?: { name: string; element: number }[];
    opening_width_m: number | null;
    slip_limit_m: number | null;
    opening_limit_m: number | null;
    /** Of input that seems odd. */
    warnings: string[];
    /** Blocks of order 1 are too stiff for it. */
    closure_is_lower_bound: boolean;
    /** What the rock is and what acts on it. */
    ground: { name: string; value: string }[];
    cutting: {
      traces: number;
      joints_used: number;
      trace_length_m: number;
      removed_length_m: number;
      removed_pieces: number;
      merged_slivers: number;
      merged_vertices: number;
      domain_area_m2: number;
      sliver_area_m2: number;
      /** Slivers that were merged across a joint that runs through; the highest tooth that this left. */
      merged_across_joints: number;
      highest_tooth_m: number;
      /** Blocks that only the tolerances that were given keep from being merged. */
      slivers_left: number;
      /** Of rock bridges that bound blocks. */
      bridge_length_m: number;
    };
  };
  area: { blocks_m2: number; excavated_m2: number };
  run: {
    steps: number;
    wall_time_s: number | null;
    dof: number;
    state_hash: string;
    open_close: {
      mean_iterations: number;
      max_iterations: number;
      retried_steps: number;
      unconverged_steps: number;
    } | null;
    max_overlap_m: number | null;
    max_overlap_at: { blocks: [number, number]; x: number; y: number; time_s: number; stage: string } | null;
    /** Errors of the computation, in words. */
    errors: string[];
    max_area_change: number | null;
    /** Energy that the time integration made, over the largest other term. */
    made_ratio: number | null;
    energy: Record<string, number | null>;
    /** Springs, supports and other elements. Pages of earlier versions do not have them. */
    elements?: ElementAtEnd[];
    /** What broke of each joint or element. Pages of earlier versions do not have it. */
    breaks?: BreakCount[];
    stages: Stage[];
    interrupted: boolean;
    /** There is no record of the end: the run was killed, or still goes on. */
    cut_off: boolean;
  };
  recorded_frames: number;
  displacement_quantum: number;
  /** Pages of earlier versions do not have it, nor marks. */
  velocity_quantum?: number;
  marks?: { longest_arrow: number; all: MarkInHeader[] };
  stress_quantum: number;
  step_columns: string[];
  damage_measures: DamageMeasure[];
  /** The smallest number of steps from one row of a stage to the next; 0 where there are none. */
  steps_between_rows: number;
  arrays: ArrayEntry[];
}

export interface BreakCount {
  name: string;
  mode: "tension" | "shear" | "opening";
  edge_kind: string;
  /** −1: a joint. */
  element: number;
  events: number;
  length_m: number;
  first_s: number;
  first_stage: number;
  last_s: number;
  last_stage: number;
}

export interface ElementInModel {
  name: string;
  kind: string;
  limit_n_m: number | null;
}

/** A spring, a support or another element: what it carries at the end, and carried at the most. */
export interface ElementAtEnd {
  name: string;
  kind: string;
  present: boolean;
  /** Of springs tension is positive. */
  force_n_m: number;
  elongation_m: number;
  yielded_m: number;
  peak_force_n_m: number;
  peak_time_s: number;
  peak_stage: string | null;
  limit_n_m: number | null;
  utilization: number | null;
  has_yielded: boolean;
  has_ruptured: boolean;
}

/** What may be drawn over the blocks, described in src/picture/marks.h. */
export interface MarkInHeader {
  name: string;
  text: string;
  meaning: string;
  /** Of the typical size: width in units of a picture, or length in sides of a mean block. */
  drawn: number;
  typical: number;
  color: string;
}

/** Where an array lies in the unpacked bytes. */
export interface ArrayEntry {
  name: string;
  type: string;
  offset: number;
  count: number;
}

const readers = {
  u8: Uint8Array,
  u32: Uint32Array,
  i32: Int32Array,
  f32: Float32Array,
  f64: Float64Array,
} as const;
type Readers = typeof readers;

/** The unpacked arrays, by name. */
export class Arrays {
  constructor(
    private readonly entries: ArrayEntry[],
    private readonly buffer: ArrayBuffer,
  ) {}

  has(name: string): boolean {
    return this.entries.some((e) => e.name === name);
  }

  get<T extends keyof Readers>(name: string, type: T): InstanceType<Readers[T]> {
    const entry = this.entries.find((e) => e.name === name);
    if (!entry || entry.type !== type) throw new Error(`the report holds no array ${name} of type ${type}`);
    return new readers[type](this.buffer, entry.offset, entry.count) as InstanceType<Readers[T]>;
  }
}

/** Inverse of encode_frames (src/report/frame_codec.h), row after row. */
export function decodeFrames(
  bytes: Uint8Array,
  frames: number,
  columns: number,
  quantum: number,
): Float32Array {
  const n = frames * columns;
  const values = new Float32Array(n);
  const row = new Int32Array(columns);
  for (let f = 0, at = 0; f < frames; f++) {
    let d = 0;
    for (let i = 0; i < columns; i++, at++) {
      const z = bytes[at] | (bytes[n + at] << 8) | (bytes[2 * n + at] << 16) | (bytes[3 * n + at] << 24);
      d = (d + ((z >>> 1) ^ -(z & 1))) | 0;
      const value = (row[i] + d) | 0;
      row[i] = value;
      values[at] = quantum * value;
    }
  }
  return values;
}

export async function unpack(base64: string): Promise<ArrayBuffer> {
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/** The header and the arrays of this page. */
export async function readPage<H extends { arrays: ArrayEntry[] } = Header>(): Promise<{
  header: H;
  arrays: Arrays;
}> {
  const text = (id: string) => document.getElementById(id)?.textContent?.trim() ?? "";
  const header = JSON.parse(text("header")) as H;
  return { header, arrays: new Arrays(header.arrays, await unpack(text("arrays"))) };
}
