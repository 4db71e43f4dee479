import { column, h, tableBox } from "../dom";
import { significant } from "../format";
import type { Estimate, Maybe, Study } from "./data";
import { percent, shownAs } from "./quantities";

/** How far the measures of the levels hang on the strengths that were drawn, in every combination. */
export function dependenceTable(study: Study): HTMLElement {
  const { combinations, confidence } = study.json;
  const head = [
    column("Combination", "", true),
    column("Measure", "", true),
    column("Strength", "", true),
    column("Rank correlation", "Spearman, −1 … 1"),
    column("First-order index", "share of the variance"),
  ];
  const number = (x: Maybe): string => (x === null ? "not known" : significant(x, 2));
  const cell = (e: Estimate): HTMLElement =>
    h(
      "td",
      {},
      number(e.value),
      h("span", { class: "sub" }, e.low === null ? "" : `${number(e.low)} … ${number(e.high)}`),
    );
  const rows = combinations.flatMap((c) =>
    c.hangs_on.map((d) => [
      h("th", { scope: "row", class: "text" }, study.combinationName(c.values)),
      h("td", { class: "text" }, shownAs(study.measure(d.measure)).title),
      h("td", { class: "text" }, d.strength),
      cell(d.rank_correlation),
      cell(d.first_order_index),
    ]),
  );
  return tableBox(
    `How far damage hangs on the strengths that were drawn, with ${percent(confidence)} intervals`,
    [head],
    rows,
  );
}
