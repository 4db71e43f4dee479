import { column, factList, h, tableBox, type Child } from "../dom";
import { count, duration, integer, significant } from "../format";
import { Marginality, type MeasureSummary, type Study } from "./data";
import { reportOf } from "./pictures";
import { interval, label, percent, plain, shownAs, type Shown } from "./quantities";
import type { Selection } from "./selection";

const head = (first: string): HTMLElement[] => [
  column(first, "", true),
  column("n"),
  column("Mean"),
  column("Std. deviation"),
  column("Smallest"),
  ...["5 %", "25 %", "Median", "75 %", "95 %"].map((p) => column(p)),
  column("Largest"),
];

function cells(q: Shown, s: MeasureSummary): HTMLElement[] {
  const estimate = (e: { value: number | null; low: number | null; high: number | null }) =>
    h("td", {}, plain(q, e.value), h("span", { class: "sub" }, interval(q, e)));
  return [
    h("td", {}, integer(s.n)),
    estimate(s.mean),
    estimate(s.std),
    h("td", {}, plain(q, s.min)),
    ...s.quantiles.map(estimate),
    h("td", {}, plain(q, s.max)),
  ];
}

/** smallest_bootstrap_sample of src/statistics/bootstrap.h */
const fewestForIntervals = 5;

/** All measures of the chosen combination, and the chosen measure in all combinations. */
export class MeasureTables {
  readonly element = h("div");

  constructor(
    private readonly study: Study,
    private readonly selection: Selection,
  ) {
    selection.onChange(() => this.draw());
    this.draw();
  }

  private draw(): void {
    const { study, selection } = this;
    const { combinations, measures, confidence } = study.json;
    const chosen = combinations[selection.combination];
    if (!chosen) return;
    const few = combinations.some((c) => c.n > 0 && c.n < fewestForIntervals);
    const none = few ? `; fewer than ${fewestForIntervals} realizations have none` : "";
    const small = `small print: ${percent(confidence)} bootstrap intervals${none}`;
    const own = measures.map((m) => {
      const q = shownAs(m);
      return [h("th", { scope: "row", class: "text" }, label(q)), ...cells(q, chosen.measures[m.name])];
    });
    const q = shownAs(study.measure(selection.measure));
    const across = combinations.map((c, k) => [
      h(
        "th",
        { scope: "row", class: "text" },
        h(
          "button",
          { type: "button", class: "link", click: () => selection.select(k) },
          study.combinationName(c.values),
        ),
      ),
      ...cells(q, c.measures[q.name]),
    ]);
    this.element.replaceChildren(
      tableBox(`${study.combinationName(chosen.values)}; ${small}`, [head("Measure")], own),
    );
    if (combinations.length > 1)
      this.element.append(
        h("h3", {}, `${label(q)} in all combinations`),
        tableBox(`${label(q)}; ${small}`, [head("Combination")], across),
      );
  }
}

interface Column {
  title: string;
  unit?: string;
  text: boolean;
  key: (run: number) => number | string;
  show: (run: number) => Child;
}

const pageSize = 100;

/** Every run, to be sorted by a click on a column. */
export class RunTable {
  readonly element = h("div", { class: "run-table" });
  private readonly columns: Column[];
  private readonly runs: number[];
  private sorted = 0;
  private descending = false;
  private shown = pageSize;

  constructor(private readonly study: Study) {
    this.columns = this.makeColumns();
    this.runs = Array.from({ length: study.runCount() }, (_, r) => r);
    this.draw();
  }

  private makeColumns(): Column[] {
    const { study } = this;
    const values = (r: number) => study.json.combinations[study.combination[r]]?.values ?? [];
    const numeric = (text: string) => (text !== "" && Number.isFinite(Number(text)) ? Number(text) : text);
    const link = (r: number): Child =>
      study.hasReport[r] ? h("a", { href: reportOf(study, r) }, study.keys[r]) : study.keys[r];
    const state = (r: number) =>
      !study.done[r] ? "failed" : study.marginal[r] === Marginality.yes ? "marginal" : "done";
    const hasVariants = this.study.json.marginal !== null;
    return [
      { title: "Run", text: true, key: (r) => study.keys[r], show: link },
      {
        title: "Realization",
        text: false,
        key: (r) => study.realization[r],
        show: (r) => integer(study.realization[r]),
      },
      ...study.json.axes.map((_, a) => ({
        title: study.axisName(a),
        text: false,
        key: (r: number) => numeric(values(r)[a] ?? ""),
        show: (r: number) => values(r)[a] ?? "",
      })),
      ...(hasVariants
        ? [
            {
              title: "Variant",
              text: true,
              key: (r: number) => study.variantOf(r),
              show: (r: number) => study.variantOf(r) || "–",
            },
          ]
        : []),
      { title: "State", text: true, key: state, show: state },
      ...study.json.measures.map((m) => {
        const q = shownAs(m);
        return {
          title: q.title,
          unit: q.unit,
          text: false,
          key: (r: number) => study.value(r, m.name),
          show: (r: number) => plain(q, study.value(r, m.name)),
        };
      }),
      {
        title: "Wall time",
        text: false,
        key: (r) => study.wallTime[r],
        show: (r) => duration(study.wallTime[r]),
      },
    ];
  }

  private sort(k: number): void {
    this.descending = k === this.sorted ? !this.descending : !this.columns[k].text;
    this.sorted = k;
    const { key } = this.columns[k];
    const sign = this.descending ? -1 : 1;
    // What is not there comes last, either way.
    const absent = (v: number | string) => typeof v === "number" && Number.isNaN(v);
    this.runs.sort((a, b) => {
      const [x, y] = [key(a), key(b)];
      if (absent(x) || absent(y)) return Number(absent(x)) - Number(absent(y)) || a - b;
      if (typeof x === "number" && typeof y === "number") return sign * (x - y) || a - b;
      return sign * String(x).localeCompare(String(y), "en", { numeric: true }) || a - b;
    });
    this.draw();
  }

  private draw(): void {
    const heads = this.columns.map((c, k) => {
      const cell = column(c.title, c.unit ?? "", c.text);
      const button = h("button", { type: "button", class: "sort", click: () => this.sort(k) });
      button.append(...cell.childNodes);
      cell.replaceChildren(button);
      if (k === this.sorted) cell.setAttribute("aria-sort", this.descending ? "descending" : "ascending");
      return cell;
    });
    const rows = this.runs
      .slice(0, this.shown)
      .map((r) => this.columns.map((c) => h("td", { class: c.text ? "text" : "" }, c.show(r))));
    const left = this.runs.length - rows.length;
    this.element.replaceChildren(
      tableBox(`${count(this.runs.length, "run")}; a click on a column sorts by it`, [heads], rows),
    );
    if (left > 0)
      this.element.append(
        h("p", { class: "print-only" }, `Printed are ${integer(rows.length)}; all are in runs.csv.`),
        h(
          "button",
          {
            type: "button",
            class: "screen-only",
            click: () => {
              this.shown += 5 * pageSize;
              this.draw();
            },
          },
          `Show more (${integer(left)} left)`,
        ),
      );
  }
}

/** Runs that failed, with why, and how many are missing by combination. */
export function failedTable(study: Study): HTMLElement | null {
  const { failed } = study.json;
  if (failed.length === 0) return null;
  const rows = failed.map((f) => [
    h("td", { class: "text" }, f.key),
    h("td", {}, integer(f.realization)),
    h("td", { class: "text" }, study.combinationName(f.values)),
    h("td", { class: "text" }, f.variant || "–"),
    h("td", { class: "text wrap" }, f.error || "the measured stage is missing"),
  ]);
  return tableBox(
    count(failed.length, "failed run"),
    [["Run", "Realization", "Combination", "Variant", "Why"].map((t) => column(t, "", t !== "Realization"))],
    rows,
    "narrow",
  );
}

export function howComputed(study: Study): HTMLElement {
  const { json } = study;
  const total = study.wallTime.reduce((sum, t) => sum + t, 0);
  const each = json.combinations.map((c) => c.n);
  const range = each.length > 0 ? [Math.min(...each), Math.max(...each)] : [0, 0];
  return factList([
    ["Realizations in the study", integer(json.realizations)],
    ["Measured by combination", range[0] === range[1] ? integer(range[0]) : `${range[0]} to ${range[1]}`],
    ["Runs", `${integer(json.runs.done)} of ${integer(json.runs.planned)} done`],
    ["Measured at the end of", json.stage ? `“${json.stage}”` : "the last stage"],
    ...(json.since
      ? [
          [
            "Less what was there at the end of",
            `“${json.since}”${json.at_shaking ? ", the last stage before the shaking" : ""}`,
          ] as [string, string],
        ]
      : []),
    ["Confidence", percent(json.confidence)],
    ["Bootstrap resamples", integer(json.bootstrap_resamples)],
    ["Seed of the joints", study.header.seed],
    ["Program", `keyblock ${json.version}`],
    ["Computing time of all runs", duration(total)],
    ["Computing time of a run", `${significant(total / Math.max(1, study.runCount()), 3)} s`],
  ]);
}
