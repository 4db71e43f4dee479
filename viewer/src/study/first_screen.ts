import { column, factList, h, section, tableBox, type Child } from "../dom";
import { findingList, type Finding } from "../findings";
import { capital, fixed, significant } from "../format";
import { whenPrinting } from "../printing";
import type { Description, LevelShare, Share, Study } from "./data";
import { FrequencyMap, frequencyLegend } from "./frequency_map";
import { interval, label, percent, percentRange, plain, shownAs, withUnit } from "./quantities";
import type { Selection } from "./selection";

/** Measures of what falls and moves, for the first screen, as far as a study has them. */
const whatFalls: [string, string][] = [
  ["fallen_area_m2", "Area"],
  ["fallen_weight_n_m", "Weight"],
  ["largest_fallen_weight_n_m", "Largest block"],
  ["largest_block_pressure_pa", "Largest block over its width"],
  ["fallen_depth_m", "Depth behind the wall"],
];
const whatMoves: [string, string][] = [
  ["displacement_max_m", "Largest displacement"],
  ["rotation_max_deg", "Largest rotation"],
  ["hinges", "Hinges"],
];

/** Pixels that the map of the first screen may be wide: with all beside it, it fits a laptop. */
const mapWidth = 280;

/** A part of the damage: before the shaking, added by it, or all. */
interface Part {
  title: string;
  falls: Share;
  levels: LevelShare[];
  measures: Record<string, Description>;
}

function partsOf(study: Study, combination: number): Part[] {
  const c = study.json.combinations[combination];
  const { since, before, at_shaking } = study.json;
  if (!c) return [];
  if (!c.before || !c.added) return [{ ...c, title: "In all" }];
  const parts = [
    { ...c.before, title: at_shaking ? "Before the shaking" : `By the end of “${before}”` },
    { ...c.added, title: at_shaking ? "Added by the shaking" : "After it" },
  ];
  return since ? parts : [...parts, { ...c, title: "In all" }];
}

/** A value, and its interval in small print, if there is one. */
function cell(value: string, range: string, span = 1): HTMLElement {
  const interval = range === "–" ? null : h("span", { class: "sub" }, `(${range})`);
  return h("td", { colspan: span }, value, interval);
}

function shareCell(share: Share): HTMLElement {
  const text = share.n > 0 ? `${share.exceeded} of ${share.n}` : "–";
  return cell(text, percentRange(share.low, share.high), 2);
}

function quantileCells(study: Study, measure: string, d: Description | undefined): HTMLElement[] {
  const q = shownAs(study.measure(measure));
  return [0.5, 0.95].map((p) => {
    const found = d?.quantiles.find((x) => x.p === p) ?? { value: null, low: null, high: null };
    return cell(plain(q, found.value, 2), interval(q, found, 2));
  });
}

/** What falls in the chosen combination: how often, and how much in the median and in the 95 % realization. */
function fallTable(study: Study, combination: number): HTMLElement {
  const { levels, measures, confidence } = study.json;
  const parts = partsOf(study, combination);
  const hasOpening = study.json.outlines.length > 0;
  const name = (...text: Child[]) => h("th", { scope: "row", class: "text" }, ...text);
  const rows: Child[][] = [
    [name(hasOpening ? "Rock falls in" : "Blocks fall in"), ...parts.map((p) => shareCell(p.falls))],
    ...levels.map((level, l) => {
      const q = shownAs(study.measure(level.measure));
      return [
        name(
          level.measure === "fallen_area_m2"
            ? `More than ${withUnit(q, level.threshold)} (${level.name})`
            : `${capital(q.title)} > ${withUnit(q, level.threshold)} (${level.name})`,
        ),
        ...parts.map((p) => shareCell(p.levels[l])),
      ];
    }),
  ];
  const asked = hasOpening ? whatFalls : [...whatFalls, ...whatMoves];
  const known = (m: string) => study.json.combinations.some((c) => (c.measures[m]?.n ?? 0) > 0);
  const shown = asked.filter(([m]) => measures.some((q) => q.name === m) && known(m));
  rows.push([
    name("Of all realizations"),
    ...parts.flatMap(() => ["median", "95 %"].map((t) => h("td", { class: "muted" }, t))),
  ]);
  for (const [m, title] of shown)
    rows.push([
      name(label({ ...shownAs(study.measure(m)), title })),
      ...parts.flatMap((p) => quantileCells(study, m, p.measures[m])),
    ]);
  const head = [
    column("", "", true),
    ...parts.map((p) => h("th", { scope: "colgroup", colspan: 2 }, p.title)),
  ];
  return tableBox(
    `What falls: realizations, and how much; in brackets ${percent(confidence)} intervals`,
    [head],
    rows,
    "narrow what-falls",
  );
}

/** The name of the chosen combination over what is shown of it. */
function nameOf(study: Study, combination: number): string {
  const c = study.json.combinations[combination];
  return c ? study.combinationName(c.values) : "";
}

/** Where rock falls in the chosen combination, as a map that the first screen of a laptop has room for. */
function picture(study: Study, selection: Selection): HTMLElement | null {
  const { combinations, grid } = study.json;
  if (grid.columns <= 0 || !combinations.some((c) => c.map.n > 0)) return null;
  const map = new FrequencyMap(study, selection, "fallen", "Where rock falls", mapWidth);
  const draw = () => map.draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  whenPrinting(draw);
  const legend = frequencyLegend("Share of realizations in which it has fallen");
  return h("div", { class: "where" }, map.element, legend);
}

/** The answer, with a map of where rock falls beside what falls, which follow the selection; ground and loads. */
export function resultSection(study: Study, selection: Selection, findings: readonly Finding[]): HTMLElement {
  const [verdict, ...others] = findings;
  const table = h("div");
  const chosen = h("p", { class: "chosen print-only" });
  const draw = () => {
    table.replaceChildren(fallTable(study, selection.combination));
    chosen.textContent = nameOf(study, selection.combination);
  };
  selection.onChange(draw);
  draw();
  const several = study.json.combinations.length > 1;
  const map = picture(study, selection);
  const isWide = study.json.combinations.some((_, k) => partsOf(study, k).length > 2);
  return section(
    "verdict",
    "Result",
    h(
      "div",
      { class: `first-screen${map ? "" : " alone"}${isWide ? " wide" : ""}` },
      h("div", { class: "answer" }, h("p", { class: "verdict" }, verdict.text), several ? chosen : null),
      map,
      h("div", { class: "falls" }, table, findingList(others)),
      groundAndLoads(study),
    ),
  );
}

/** The range of the strongest shakings, in m/s² and g. */
function shakingFact(study: Study): [string, string][] {
  const all = study.json.combinations.flatMap((c) => (c.n > 0 && c.pga_m_s2 ? [c.pga_m_s2] : []));
  if (all.length === 0) return [];
  const ends = [...new Set([Math.min(...all), Math.max(...all)])];
  const text = (f: (a: number) => string) => ends.map(f).join(" … ");
  return [["PGA", `${text((a) => significant(a, 3))}\u00a0m/s² (${text((a) => fixed(a / 9.81, 2))}\u00a0g)`]];
}

function groundAndLoads(study: Study): HTMLElement | null {
  const facts: [string, string][] = study.json.ground.map(({ name, value }) => [capital(name), value]);
  const all = [...facts, ...shakingFact(study)];
  if (all.length === 0) return null;
  return h("div", { class: "ground", id: "ground" }, h("h3", {}, "Ground and loads"), factList(all));
}
