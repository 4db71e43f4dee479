import type { Stage } from "./data";
import { column, factList, h, tableBox, type Child } from "./dom";
import { count, duration, fixed, integer, length, significant } from "./format";
import { stageTime } from "./labels";
import type { Run } from "./run";
import { checks, checksFinding, marginalStages } from "./verdict";

/** How it was computed: what tells nothing of the rock. */
export function programFacts(run: Run): HTMLElement {
  const { model, run: record, area } = run.header;
  const cut = model.cutting;
  const orders = [...new Set([...run.order].filter((_, b) => !run.fixed[b]))].sort((a, b) => a - b);
  const facts: [string, Child][] = [
    ["Order of the displacements", orders.join(", ") || "–"],
    ["Time step", `${significant(1e3 * model.step_size_s, 4)} ms`],
    ["Steps", integer(record.steps)],
    ["Area of the blocks", `${significant(area.blocks_m2, 4)} m²`],
    ["Excavated at the end", `${significant(area.excavated_m2, 4)} m²`],
    [
      "Joints that bound blocks",
      cut.traces > 0 ? `${integer(cut.joints_used)} of ${integer(cut.traces)} traces` : "explicit blocks",
    ],
    ["Degrees of freedom", integer(record.dof)],
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
    ["Seed, realization", `${model.seed}, ${model.realization}`],
    ["Program", `keyblock ${model.version}`],
    ["State hash", h("code", {}, record.state_hash || "–")],
  ];
  const [ox, oy] = model.origin;
  if (ox !== 0 || oy !== 0) facts.push(["Local origin", `${significant(ox, 9)} / ${significant(oy, 9)} m`]);
  return factList(facts.filter(([name, value]) => name !== "Excavated at the end" || value !== "0 m²"));
}

const kinds = { settle: "static", shake: "shaking", rest: "dynamic, no shaking" };

/** What a static stage came to, in the words of the program. */
function equilibrium(stage: Stage): string {
  if (stage.kind !== "settle") return "–";
  return stage.interrupted && !stage.equilibrium.reached ? "not yet" : (stage.equilibrium.verdict ?? "–");
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
    column("Moved before it"),
    column("Moving"),
    column("Wall time"),
  ];
  const rows = run.stages.map((s) => [
    h("th", { scope: "row" }, s.name, s.interrupted ? h("span", { class: "sub" }, "interrupted") : null),
    h("td", { class: "text" }, kinds[s.kind]),
    h(
      "td",
      { class: "text" },
      s.excavate.map((e) => run.header.model.excavations[e]).join(", ") || "–",
      s.k_h || s.k_v ? h("span", { class: "sub" }, `k_h ${s.k_h ?? 0}, k_v ${s.k_v ?? 0}`) : null,
      s.install?.length ? h("span", { class: "sub" }, `installs ${s.install.join(", ")}`) : null,
    ),
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
    h("td", {}, s.kind === "settle" ? significant(s.equilibrium.worst_residual_ratio, 2) : "–"),
    h("td", {}, s.kind === "settle" ? length(s.equilibrium.largest_way_m, 2) : "–"),
    h(
      "td",
      {},
      s.kind === "settle" && !(s.interrupted && run.header.run.cut_off)
        ? count(s.equilibrium.moving.length, "block")
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

/** Springs, supports and other elements; null where there are none. */
export function elementTable(run: Run): HTMLElement | null {
  const elements = run.header.run.elements ?? [];
  if (elements.length === 0) return null;
  const head = [
    column("Name", "", true),
    column("Kind", "", true),
    column("Largest force", "kN/m"),
    column("In stage", "", true),
    column("Of its limit", "%"),
    column("Force at the end", "kN/m"),
    column("Elongation"),
    column("Yielded"),
  ];
  const kilo = (n: number) => significant(n / 1e3, 4);
  const rows = elements.map((e) => [
    h("th", { scope: "row" }, e.name),
    h("td", { class: "text" }, e.kind),
    h("td", {}, kilo(e.peak_force_n_m)),
    h("td", { class: "text" }, e.peak_stage ?? "–"),
    h(
      "td",
      {},
      e.utilization === null ? "–" : significant(100 * e.utilization, 3),
      e.has_yielded ? h("span", { class: "sub" }, "reached") : null,
    ),
    h("td", {}, e.has_ruptured ? "broken" : e.present ? kilo(e.force_n_m) : "not there"),
    h("td", {}, length(e.elongation_m, 2)),
    h("td", {}, e.yielded_m === 0 ? "–" : length(e.yielded_m, 2)),
  ]);
  return tableBox("What each carries, and carried at the most", [head], rows);
}

/** What broke, and when; null where nothing did. */
export function breakTable(run: Run): HTMLElement | null {
  const breaks = run.header.run.breaks ?? [];
  if (breaks.length === 0) return null;
  const head = [
    column("Name", "", true),
    column("By", "", true),
    column("Events"),
    column("Length", "m"),
    column("First", "", true),
    column("Last", "", true),
  ];
  const moment = (time: number, stage: number) =>
    `${fixed(time, 3)} s, ${run.header.model.stages[stage] ?? stage}`;
  const rows = breaks.map((b) => [
    h("th", { scope: "row" }, b.name || b.edge_kind),
    h("td", { class: "text" }, b.mode),
    h("td", {}, b.events),
    h("td", {}, b.element < 0 ? significant(b.length_m, 3) : "–"),
    h("td", { class: "text" }, moment(b.first_s, b.first_stage)),
    h("td", { class: "text" }, moment(b.last_s, b.last_stage)),
  ]);
  return tableBox("What broke in all of the run", [head], rows, "narrow");
}

/** Blocks left moving by static stages, each with a button that shows it. */
export function movingTable(run: Run, show: (block: number, stage: number) => void): HTMLElement | null {
  const stages = marginalStages(run).filter(({ stage }) => stage.equilibrium.moving.length > 0);
  if (stages.length === 0) return null;
  const blocks = new Set(stages.flatMap(({ stage }) => stage.equilibrium.moving.map((m) => m.block)));
  const rows = stages.flatMap(({ stage, index }) =>
    stage.equilibrium.moving.map((m) => [
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
      h("td", { class: "text" }, m.movement),
      h("td", {}, significant(run.area[m.block], 3)),
      h("td", {}, significant((run.area[m.block] * run.density[m.block]) / 1e3, 3)),
      h("td", {}, m.carried === null ? "–" : fixed(100 * m.carried, 0)),
    ]),
  );
  const head = [
    column("Block"),
    column("Stage", "", true),
    column("Movement", "", true),
    column("Area", "m²"),
    column("Mass", "t/m"),
    column("Carried by contacts", "% of weight"),
  ];
  return h(
    "details",
    { open: rows.length <= 12 },
    h("summary", {}, `${count(blocks.size, "block")} moving at the end of a static stage`),
    tableBox("Moving blocks, and how much of their weight contacts carry", [head], rows, "narrow"),
  );
}

/** The checks with their limits, and above them what they say together. */
export function qualityTable(run: Run): HTMLElement {
  const all = checks(run);
  const { grade, text } = checksFinding(all);
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
    h("p", { class: `finding ${grade}` }, text),
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
  const across =
    c.merged_across_joints > 0 ? `; ${integer(c.merged_across_joints)} across a joint that runs through` : "";
  return factList([
    ["Traces that meet the domain", integer(c.traces)],
    ["Traces that bound blocks", integer(c.joints_used)],
    [
      "Dead ends and idle joints removed",
      `${count(c.removed_pieces, "piece")}, ${significant(c.removed_length_m, 4)} m${share}`,
    ],
    ...(c.bridge_length_m > 0
      ? ([["Rock bridges that bound blocks", `${significant(c.bridge_length_m, 4)} m`]] as [string, string][])
      : []),
    [
      "Slivers merged into neighbours",
      `${integer(c.merged_slivers)}, ${significant(c.sliver_area_m2, 3)} m² in all${across}`,
    ],
    ["Vertices merged or dropped", integer(c.merged_vertices)],
    ["Area of the domain", `${significant(c.domain_area_m2, 5)} m²`],
  ]);
}
