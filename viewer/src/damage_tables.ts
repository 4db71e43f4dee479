import type { Damage, DamageMeasure, Stage } from "./data";
import { column, h, tableBox } from "./dom";
import { fixed, signed } from "./format";
import { stageTime } from "./labels";
import type { Run } from "./run";
import { firstExcavation } from "./verdict";

type Measure = DamageMeasure;

/** In the unit of its column; null: not known. */
function valueOf(m: Measure, d: Damage): number | null {
  const value = d[m.name];
  return value === undefined || value === null || d[m.known_with] === null ? null : m.factor * value;
}

/** Decimals with which the largest value of a column has two digits. */
function decimalsOf(m: Measure, stages: readonly Stage[]): number {
  const largest = Math.max(...stages.map((s) => Math.abs(valueOf(m, s.damage) ?? 0)));
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
  const hasLimits = run.header.model.elements?.some((e) => e.limit_n_m !== null) ?? false;
  const isBound = (m: Measure) => m.name.startsWith("closure_") && run.header.model.closure_is_lower_bound;
  return [
    table(`Rock, cumulative since ${since}; in small print the difference to the stage before`, "rock"),
    table("Joints and walls, likewise; “in place”: without joints beside fallen blocks", "joints"),
    hasLimits ? table("Elements, since the start of the run", "elements") : null,
  ].filter((t) => t !== null);

  function table(caption: string, name: Measure["table"]): HTMLElement | null {
    const measures = run.header.damage_measures.filter((m) => m.table === name);
    const shown = measures.filter(
      (m) => excavated >= 0 || stages.some((s) => (valueOf(m, s.damage) ?? 0) !== 0),
    );
    if (shown.length === 0 || stages.length === 0) return null;
    const head = [
      column("At the end of"),
      ...shown.map((m) => column(isBound(m) ? `${m.title} (lower bound)` : m.title, m.unit || "number")),
    ];
    const bound = shown.some(isBound)
      ? ". Closure is a lower bound: blocks of order 1 that fit each other are too stiff"
      : "";
    const rows = stages.map((stage, k) => [
      stageCell(stage),
      ...shown.map((m) => {
        const decimals = decimalsOf(m, stages);
        const now = valueOf(m, stage.damage);
        const before = k > 0 ? valueOf(m, stages[k - 1].damage) : null;
        const change = now !== null && before !== null ? signed(now - before, decimals) : "";
        return h("td", {}, fixed(now, decimals), h("span", { class: "sub" }, change));
      }),
    ]);
    return tableBox(caption + bound, [head], rows, shown.length < 6 ? "narrow" : "");
  }
}
