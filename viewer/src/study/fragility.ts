import { choice, column, h, section, tableBox } from "../dom";
import { integer, significant } from "../format";
import { Chart, curveColors, type ChartSeries } from "./chart";
import type { Fragility, IntensityName, Study } from "./data";
import { percent, shownAs, withUnit } from "./quantities";

/** By what factor the axis goes on beyond the points: further than the curves do (src/study/fragility_groups.cpp). */
const room = 2;

/** Probability of a level of damage over the intensity of the shaking. */
export class FragilityView {
  readonly element: HTMLElement;
  private readonly chart = new Chart();
  private readonly table = h("div");
  private level: string;
  private intensity: IntensityName = "pga_m_s2";

  constructor(private readonly study: Study) {
    const { levels, intensities, confidence } = study.json;
    this.level = levels[0]?.name ?? "";
    const levelText = (l: (typeof levels)[number]) =>
      `${l.name}: ${study.measure(l.measure).title} > ${withUnit(shownAs(study.measure(l.measure)), l.threshold)}`;
    this.element = section(
      "fragility",
      "Fragility",
      h(
        "p",
        {},
        `Probability that damage exceeds a level, against the strongest shaking of the run. Points: share of the realizations, with ${percent(confidence)} intervals. Curve: lognormal, by maximum likelihood, with the band of a jackknife over realizations and records.`,
      ),
      h(
        "div",
        { class: "controls screen-only" },
        choice(
          "level",
          levels.map((l) => ({ value: l.name, text: levelText(l) })),
          this.level,
          (value) => {
            this.level = value;
            this.draw();
          },
        ),
        choice(
          "intensity",
          intensities.map((i) => ({ value: i.name, text: i.title })),
          this.intensity,
          (value) => {
            this.intensity = value as IntensityName;
            this.draw();
          },
        ),
      ),
      this.chart.element,
      this.table,
    );
    this.draw();
  }

  private groups(): Fragility[] {
    return this.study.json.fragility.filter((f) => f.level === this.level && f.intensity === this.intensity);
  }

  private draw(): void {
    const groups = this.groups();
    const { intensities } = this.study.json;
    const kind = intensities.find((i) => i.name === this.intensity)!;
    const all = groups.flatMap((g) => g.points.intensity).filter((x) => x > 0);
    const [min, max] = all.length > 0 ? [Math.min(...all), Math.max(...all)] : [0.1, 10];
    const series: ChartSeries[] = groups.flatMap((g, k) => {
      const color = curveColors[k % curveColors.length];
      const name = this.study.combinationName(g.values);
      const curve: ChartSeries = {
        name,
        color,
        kind: "line",
        x: g.curve.intensity,
        y: g.curve.probability,
        low: g.curve.low,
        high: g.curve.high,
      };
      const points: ChartSeries = {
        name,
        color,
        kind: "points",
        x: g.points.intensity,
        y: g.points.probability,
        low: g.points.low,
        high: g.points.high,
        shift: 5 * (k - 0.5 * (groups.length - 1)),
      };
      return [curve, points];
    });
    this.chart.show({
      title: `Probability of “${this.level}”`,
      note: `over ${kind.title}`,
      xName: `${kind.title} (${kind.unit}), logarithmic`,
      yName: "probability",
      x: { min: min / room, max: max * room, logarithmic: true },
      y: { min: 0, max: 1, logarithmic: false },
      percent: true,
      series,
      marks: groups.flatMap((g) => withoutShaking(g)),
      height: 320,
    });
    this.table.replaceChildren(this.parameters(groups, kind.unit));
  }

  private parameters(groups: Fragility[], unit: string): HTMLElement {
    const q = { name: "", title: "", unit, factor: 1 };
    const range = (e: { low: number | null; high: number | null }) =>
      e.low === null || e.high === null ? "" : `${significant(e.low)} … ${significant(e.high)}`;
    const rows = groups.map((g) => {
      const name = h("th", { scope: "row", class: "text" }, this.study.combinationName(g.values));
      const n = h("td", {}, integer(g.realizations));
      if (g.why !== null) return [name, n, h("td", { class: "text wrap", colspan: 3 }, `no curve: ${g.why}`)];
      return [
        name,
        n,
        h("td", {}, withUnit(q, g.theta.value), h("span", { class: "sub" }, range(g.theta))),
        h("td", {}, significant(g.beta.value), h("span", { class: "sub" }, range(g.beta))),
        h("td", { class: "text wrap" }, g.which_records ?? "", h("span", { class: "sub" }, splitText(g))),
      ];
    });
    return tableBox(
      `Median θ and logarithmic standard deviation β of “${this.level}”, with intervals over realizations and records`,
      [
        [
          column("Curve", "", true),
          column("Realizations"),
          column("θ", unit),
          column("β"),
          column("Intervals", "", true),
        ],
      ],
      rows,
      "narrow",
    );
  }
}

/** The share that exceeds the level without any shaking, which has no place on the axis. */
function withoutShaking(g: Fragility): { y: number; text: string }[] {
  if (g.exceeded_without_shaking === 0) return [];
  const share = g.exceeded_without_shaking / g.without_shaking;
  return [{ y: share, text: `without shaking: ${percent(share)}` }];
}

/** What of β is of the rock, of the record and of the pair. */
function splitText({ sigma }: Fragility): string {
  const { rock, record, rest } = sigma;
  if (rock.value === null || record.value === null) return "";
  const two = (x: number | null) => significant(x, 2);
  return `σ of rock ${two(rock.value)}, of record ${two(record.value)}, of the rest ${two(rest.value)}`;
}

/** Probability of every level in every combination: the points of all curves as numbers. */
export function probabilityTable(study: Study): HTMLElement {
  const { combinations, levels, confidence } = study.json;
  const head = [
    column("Combination", "", true),
    column("Realizations"),
    ...levels.map((l) => {
      const q = shownAs(study.measure(l.measure));
      return column(l.name, `${q.title} > ${withUnit(q, l.threshold)}`);
    }),
  ];
  const rows = combinations.map((c) => [
    h("th", { scope: "row", class: "text" }, study.combinationName(c.values)),
    h("td", {}, integer(c.n)),
    ...c.levels.map((l) =>
      h(
        "td",
        {},
        percent(l.probability),
        h("span", { class: "sub" }, `${percent(l.low)} … ${percent(l.high)}`),
      ),
    ),
  ]);
  return tableBox(
    `Probability of the levels of damage, with ${percent(confidence)} intervals (Wilson)`,
    [head],
    rows,
  );
}
