import type { Damage, Stage } from "./data";
import { column, h, tableBox } from "./dom";
import { fixed, signed } from "./format";
import { stageTime } from "./labels";
import type { Run } from "./run";
import { firstExcavation } from "./verdict";

interface Measure {
  name: string;
  unit: string;
  /** At least so many. */
  decimals: number;
  isClosure?: boolean;
  of: (d: Damage) => number | null;
}

const times = (factor: number, x: number | null) => (x === null ? null : factor * x);

const rockMeasures: Measure[] = [
  {
    name: "Fallen blocks",
    unit: "",
    decimals: 0,
    of: (d) => (d.fallen_area_m2 === null ? null : d.fallen_blocks),
  },
  { name: "Fallen area", unit: "m²", decimals: 2, of: (d) => d.fallen_area_m2 },
  { name: "Fallen weight", unit: "kN/m", decimals: 1, of: (d) => times(1e-3, d.fallen_weight_n_m) },
  {
    name: "Largest block over its width",
    unit: "kPa",
    decimals: 1,
    of: (d) => times(1e-3, d.largest_block_pressure_pa),
  },
  { name: "Largest block", unit: "kN/m", decimals: 1, of: (d) => times(1e-3, d.largest_fallen_weight_n_m) },
  { name: "Depth, crown", unit: "m", decimals: 2, of: (d) => d.fallen_depth_crown_m },
  { name: "Depth, left wall", unit: "m", decimals: 2, of: (d) => d.fallen_depth_left_m },
  { name: "Depth, right wall", unit: "m", decimals: 2, of: (d) => d.fallen_depth_right_m },
  { name: "Depth, invert", unit: "m", decimals: 2, of: (d) => d.fallen_depth_invert_m },
  { name: "Opening filled", unit: "%", decimals: 1, of: (d) => times(100, d.opening_filled_ratio) },
  { name: "Loosened area", unit: "m²", decimals: 2, of: (d) => d.loosened_area_m2 },
];

const jointMeasures: Measure[] = [
  { name: "Largest slip ever", unit: "mm", decimals: 1, of: (d) => times(1e3, d.slip_max_ever_m) },
  { name: "Largest slip in place", unit: "mm", decimals: 1, of: (d) => times(1e3, d.slip_max_m) },
  { name: "Mean slip in place", unit: "mm", decimals: 2, of: (d) => times(1e3, d.slip_mean_m) },
  { name: "Slipped ever", unit: "m", decimals: 1, of: (d) => d.slipped_length_ever_m },
  { name: "Largest opening ever", unit: "mm", decimals: 1, of: (d) => times(1e3, d.opening_max_ever_m) },
  { name: "Largest opening in place", unit: "mm", decimals: 1, of: (d) => times(1e3, d.opening_max_m) },
  { name: "Opened ever", unit: "m", decimals: 1, of: (d) => d.opened_length_ever_m },
  {
    name: "Closure, vertical",
    unit: "mm",
    decimals: 2,
    isClosure: true,
    of: (d) => times(1e3, d.closure_vertical_m),
  },
  {
    name: "Closure, horizontal",
    unit: "mm",
    decimals: 2,
    isClosure: true,
    of: (d) => times(1e3, d.closure_horizontal_m),
  },
  { name: "Largest displacement", unit: "mm", decimals: 1, of: (d) => times(1e3, d.displacement_max_m) },
  { name: "Largest rotation", unit: "°", decimals: 1, of: (d) => d.rotation_max_deg },
  { name: "Hinges", unit: "", decimals: 0, of: (d) => (d.rotation_max_deg === null ? null : d.hinges) },
];

/** Decimals with which the largest value of a column has two digits. */
function decimalsOf(m: Measure, stages: readonly Stage[]): number {
  const largest = Math.max(...stages.map((s) => Math.abs(m.of(s.damage) ?? 0)));
  if (m.decimals === 0 || !(largest > 0)) return m.decimals;
  return Math.min(6, Math.max(m.decimals, 1 - Math.floor(Math.log10(largest))));
}

function stageCell(stage: Stage): HTMLElement {
  const peak = stage.pga_m_s2 === null ? "not known" : `${fixed(stage.pga_m_s2 / 9.81, 2)} g`;
  const facts =
    stage.kind === "shake"
      ? `${stageTime(stage)}, peak ${peak}`
      : stage.kind === "rest"
        ? `${stageTime(stage)} at rest`
        : "static";
  return h(
    "th",
    { scope: "row" },
    stage.name,
    h("span", { class: "sub" }, stage.interrupted ? `${facts}, interrupted` : facts),
  );
}

/**
 * Damage at the end of each stage since the first excavation, and below each number what the stage added. Of a run
 * without excavation, the measures that are not zero throughout, since the start; empty where all are.
 */
export function damageTables(run: Run): HTMLElement[] {
  const excavated = firstExcavation(run);
  const stages = run.stages.slice(Math.max(0, excavated));
  const since = excavated >= 0 ? "the first excavation" : "the start";
  const isBound = (m: Measure) => m.isClosure && run.header.model.closure_is_lower_bound;
  return [
    table(`Rock, cumulative since ${since}; in small print the difference to the stage before`, rockMeasures),
    table("Joints and walls, likewise; “in place”: without joints beside fallen blocks", jointMeasures),
  ].filter((t) => t !== null);

  function table(caption: string, measures: readonly Measure[]): HTMLElement | null {
    const shown = measures.filter((m) => excavated >= 0 || stages.some((s) => (m.of(s.damage) ?? 0) !== 0));
    if (shown.length === 0 || stages.length === 0) return null;
    const head = [
      column("At the end of"),
      ...shown.map((m) => column(isBound(m) ? `${m.name} (lower bound)` : m.name, m.unit || "number")),
    ];
    const bound = shown.some(isBound)
      ? ". Closure is a lower bound: blocks of order 1 that fit each other are too stiff"
      : "";
    const rows = stages.map((stage, k) => [
      stageCell(stage),
      ...shown.map((m) => {
        const decimals = decimalsOf(m, stages);
        const now = m.of(stage.damage);
        const before = k > 0 ? m.of(stages[k - 1].damage) : null;
        const change = now !== null && before !== null ? signed(now - before, decimals) : "";
        return h("td", {}, fixed(now, decimals), h("span", { class: "sub" }, change));
      }),
    ]);
    return tableBox(caption + bound, [head], rows, shown.length < 6 ? "narrow" : "");
  }
}
