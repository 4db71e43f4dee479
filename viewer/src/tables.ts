import type { Damage, Stage } from "./data";
import { column, factList, h, tableBox, type Child } from "./dom";
import { count, duration, fixed, integer, signed, significant } from "./format";
import { stageTime } from "./labels";
import type { Run } from "./run";
import { checks, marginalStages, type Check } from "./verdict";

export function runFacts(run: Run): HTMLElement {
  const { model, run: record, area } = run.header;
  const cut = model.cutting;
  const moving = run.blockCount - run.fixed.reduce((sum, f) => sum + f, 0);
  const orders = [...new Set([...run.order].filter((_, b) => !run.fixed[b]))].sort((a, b) => a - b);
  const box = run.extentOfRock();
  const size = `${significant(box.maxX - box.minX, 4)} × ${significant(box.maxY - box.minY, 4)} m`;
  const facts: [string, Child][] = [
    ["Section", size],
    [
      "Blocks",
      moving === run.blockCount ? integer(moving) : `${integer(moving)} and ${run.blockCount - moving} fixed`,
    ],
    ["Area of the blocks", `${significant(area.blocks_m2, 4)} m²`],
    ["Excavated at the end", `${significant(area.excavated_m2, 4)} m²`],
    ["Order", orders.join(", ") || "–"],
    ["Degrees of freedom", integer(record.dof)],
    [
      "Joints that bound blocks",
      cut.traces > 0 ? `${integer(cut.joints_used)} of ${integer(cut.traces)} traces` : "explicit blocks",
    ],
    ["Seed, realization", `${model.seed}, ${model.realization}`],
    ["Time step", `${significant(1e3 * model.step_size_s, 4)} ms`],
    ["Steps", integer(record.steps)],
    [
      "Wall time",
      `${record.wall_time_s === null ? "not known," : duration(record.wall_time_s)} with ${count(model.threads, "thread")}`,
    ],
    [
      "Per step",
      record.steps > 0 && record.wall_time_s !== null
        ? `${significant((1e3 * record.wall_time_s) / record.steps, 3)} ms`
        : "–",
    ],
    ["Program", `keyblock ${model.version}`],
    ["State hash", h("code", {}, record.state_hash || "–")],
  ];
  if (model.opening_width_m !== null)
    facts.splice(4, 0, ["Opening", `${significant(model.opening_width_m, 3)} m wide`]);
  const [ox, oy] = model.origin;
  if (ox !== 0 || oy !== 0) facts.push(["Local origin", `${significant(ox, 9)} / ${significant(oy, 9)} m`]);
  return factList(facts.filter(([name, value]) => name !== "Excavated at the end" || value !== "0 m²"));
}

const kinds = { settle: "static", shake: "shaking", rest: "dynamic, no shaking" };

function equilibrium(stage: Stage): string {
  if (stage.kind !== "settle") return "–";
  if (!stage.equilibrium_reached) return stage.interrupted ? "not yet" : "not reached";
  return stage.moving.length > 0 ? "of the others" : "reached";
}

export function stageTable(run: Run): HTMLElement {
  const head = [
    column("Stage", "", true),
    column("Kind", "", true),
    column("Excavates", "", true),
    column("Steps"),
    column("Duration", "s"),
    column("Peak acceleration", "m/s²"),
    column("Equilibrium", "", true),
    column("Worst residual", "of weight"),
    column("Still moving"),
    column("Wall time"),
  ];
  const rows = run.stages.map((s) => [
    h("th", { scope: "row" }, s.name, s.interrupted ? h("span", { class: "sub" }, "interrupted") : null),
    h("td", { class: "text" }, kinds[s.kind]),
    h("td", { class: "text" }, s.excavate.map((e) => run.header.model.excavations[e]).join(", ") || "–"),
    h("td", {}, integer(s.steps)),
    h("td", {}, s.kind === "settle" ? "–" : stageTime(s).replace(/ s$/, "")),
    h(
      "td",
      {},
      s.kind === "shake" && s.pga_m_s2 !== null
        ? `${significant(s.pga_m_s2, 3)} (${fixed(s.pga_m_s2 / 9.81, 2)} g)`
        : "–",
    ),
    h("td", { class: "text" }, equilibrium(s)),
    h("td", {}, s.kind === "settle" ? significant(s.worst_residual_ratio, 2) : "–"),
    h(
      "td",
      {},
      s.kind === "settle" && !(s.interrupted && run.header.run.cut_off)
        ? count(s.moving.length, "block")
        : "–",
    ),
    h("td", {}, duration(s.wall_time_s)),
  ]);
  for (const name of run.header.model.stages.slice(run.stages.length))
    rows.push([
      h("th", { scope: "row" }, name),
      h("td", { class: "text", colspan: head.length - 1 }, "not run"),
    ]);
  return tableBox("Stages as they were run", [head], rows);
}

interface Measure {
  name: string;
  unit: string;
  /** At least so many. */
  decimals: number;
  isClosure?: boolean;
  of: (d: Damage) => number | null;
}

const times = (factor: number, x: number | null) => (x === null ? null : factor * x);

const measures: Measure[] = [
  {
    name: "Fallen blocks",
    unit: "",
    decimals: 0,
    of: (d) => (d.fallen_area_m2 === null ? null : d.fallen_blocks),
  },
  { name: "Fallen area", unit: "m²", decimals: 2, of: (d) => d.fallen_area_m2 },
  { name: "Fallen weight", unit: "kN/m", decimals: 1, of: (d) => times(1e-3, d.fallen_weight_n_m) },
  { name: "Equivalent pressure", unit: "kPa", decimals: 1, of: (d) => times(1e-3, d.equivalent_pressure_pa) },
  { name: "Largest block", unit: "kN/m", decimals: 1, of: (d) => times(1e-3, d.largest_fallen_weight_n_m) },
  { name: "Depth behind the wall", unit: "m", decimals: 2, of: (d) => d.fallen_depth_m },
  { name: "Opening filled", unit: "%", decimals: 1, of: (d) => times(100, d.opening_filled_ratio) },
  { name: "Loosened area", unit: "m²", decimals: 2, of: (d) => d.loosened_area_m2 },
  { name: "Largest slip in place", unit: "mm", decimals: 1, of: (d) => times(1e3, d.slip_max_m) },
  { name: "Largest slip ever", unit: "mm", decimals: 1, of: (d) => times(1e3, d.slip_max_ever_m) },
  { name: "Mean slip", unit: "mm", decimals: 2, of: (d) => times(1e3, d.slip_mean_m) },
  { name: "Largest opening in place", unit: "mm", decimals: 1, of: (d) => times(1e3, d.opening_max_m) },
  { name: "Largest opening ever", unit: "mm", decimals: 1, of: (d) => times(1e3, d.opening_max_ever_m) },
  { name: "Slipped joints", unit: "m", decimals: 1, of: (d) => d.slipped_length_m },
  { name: "Opened joints", unit: "m", decimals: 1, of: (d) => d.opened_length_m },
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
 * without excavation, the measures that are not zero throughout, since the start; null where all are.
 */
export function damageTable(run: Run): HTMLElement | null {
  const excavated = run.stages.findIndex((s) => s.excavate.length > 0);
  const shown = measures.filter((m) => excavated >= 0 || run.stages.some((s) => (m.of(s.damage) ?? 0) !== 0));
  if (shown.length === 0) return null;
  const isBound = (m: Measure) => m.isClosure && run.header.model.closure_is_lower_bound;
  const head = [
    column("At the end of"),
    ...shown.map((m) => column(isBound(m) ? `${m.name} (lower bound)` : m.name, m.unit || "number")),
  ];
  const stages = run.stages.slice(Math.max(0, excavated));
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
  const since = excavated >= 0 ? "the first excavation" : "the start";
  const bound = shown.some(isBound)
    ? ". Closure is a lower bound: blocks of order 1 that fit each other are too stiff"
    : "";
  return tableBox(
    `Cumulative since ${since}; in small print the difference to the stage before${bound}`,
    [head],
    rows,
    shown.length < 6 ? "narrow" : "",
  );
}

/** Blocks left moving by static stages, each with a button that shows it. */
export function movingTable(run: Run, show: (block: number, stage: number) => void): HTMLElement | null {
  const stages = marginalStages(run).filter(({ stage }) => stage.moving.length > 0);
  if (stages.length === 0) return null;
  const blocks = new Set(stages.flatMap(({ stage }) => stage.moving.map((m) => m.block)));
  const rows = stages.flatMap(({ stage, index }) =>
    stage.moving.map((m) => [
      h(
        "th",
        { scope: "row" },
        h(
          "button",
          { type: "button", class: "link", click: () => show(m.block, index) },
          run.blockName(m.block),
        ),
      ),
      h("td", { class: "text" }, stage.name),
      h("td", {}, significant(run.area[m.block], 3)),
      h("td", {}, significant((run.area[m.block] * run.density[m.block]) / 1e3, 3)),
      h("td", {}, m.carried === null ? "–" : fixed(100 * m.carried, 0)),
    ]),
  );
  const head = [
    column("Block"),
    column("Stage", "", true),
    column("Area", "m²"),
    column("Mass", "t/m"),
    column("Carried by contacts", "% of weight"),
  ];
  return h(
    "details",
    { open: rows.length <= 12 },
    h("summary", {}, `${count(blocks.size, "block")} still moving at the end of a static stage`),
    tableBox("Blocks still moving", [head], rows, "narrow"),
  );
}

function checksVerdict(all: readonly Check[]): HTMLElement {
  const bad = all.filter((c) => c.good === false).length;
  const unknown = all.filter((c) => c.good === null).length;
  if (bad + unknown === 0)
    return h("p", { class: "finding good" }, "All checks of the computation are passed.");
  const checked = count(all.length, "check");
  const parts = [
    ...(bad > 0
      ? [`${bad} of ${checked} of the computation ${bad === 1 ? "needs" : "need"} attention.`]
      : []),
    ...(unknown > 0
      ? [`${unknown} of ${checked} cannot be made, as the run left no record of its end.`]
      : []),
  ];
  return h("p", { class: "finding attention" }, parts.join(" "));
}

/** The checks with their limits, and above them what they say together. */
export function qualityTable(run: Run): HTMLElement {
  const all = checks(run);
  const verdict = checksVerdict(all);
  const rows = all.map((c) => [
    h("th", { scope: "row" }, c.name),
    h("td", { class: "wrap" }, c.value),
    h("td", { class: "text" }, c.limit),
    c.good === null
      ? h("td", { class: "text" }, "–")
      : h("td", { class: c.good ? "text good" : "text attention" }, c.good ? "✓ passed" : "! look here"),
  ]);
  const head = [column("Check", "", true), column("Found"), column("Wanted", "", true), column("", "", true)];
  const { open_close: oc, steps } = run.header.run;
  const effort = factList([
    [
      "Open-close iterations per step",
      oc
        ? `${significant(oc.mean_iterations, 3)} on average, ${integer(oc.max_iterations)} at most`
        : "not known",
    ],
    [
      "Steps retried with a smaller time step",
      oc ? `${integer(oc.retried_steps)} of ${integer(steps)}` : "not known",
    ],
  ]);
  const { warnings } = run.header.model;
  return h(
    "div",
    {},
    verdict,
    warnings.length > 0 ? h("ul", { class: "warnings" }, ...warnings.map((w) => h("li", {}, w))) : null,
    h("div", { class: "quality" }, tableBox("Checks", [head], rows, "narrow unnamed"), effort),
  );
}

export function cuttingFacts(run: Run): HTMLElement | null {
  const c = run.header.model.cutting;
  if (c.traces === 0) return null;
  const share =
    c.trace_length_m > 0
      ? ` (${fixed((100 * c.removed_length_m) / c.trace_length_m, 0)} % of ${significant(c.trace_length_m, 4)} m)`
      : "";
  return factList([
    ["Traces that meet the domain", integer(c.traces)],
    ["Traces that bound blocks", integer(c.joints_used)],
    [
      "Dead ends and idle joints removed",
      `${count(c.removed_pieces, "piece")}, ${significant(c.removed_length_m, 4)} m${share}`,
    ],
    [
      "Slivers merged into neighbours",
      `${integer(c.merged_slivers)}, ${significant(c.sliver_area_m2, 3)} m² in all`,
    ],
    ["Vertices merged or dropped", integer(c.merged_vertices)],
    ["Area of the domain", `${significant(c.domain_area_m2, 5)} m²`],
  ]);
}
