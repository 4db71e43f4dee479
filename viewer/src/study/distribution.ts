import { h } from "../dom";
import { Chart, curveColors, scaleOf, type ChartSeries } from "./chart";
import type { MeasureSummary, Study } from "./data";
import { label, percent, scaled, shownAs, type Shown } from "./quantities";
import type { Selection } from "./selection";

/** Exceedance curve and running mean of the chosen measure and combination. */
export class Distribution {
  readonly element: HTMLElement;
  private readonly exceedance = new Chart();
  private readonly running = new Chart();

  constructor(
    private readonly study: Study,
    private readonly selection: Selection,
  ) {
    this.element = h("div", { class: "plots two" }, this.exceedance.element, this.running.element);
    selection.onChange(() => this.draw());
    this.draw();
  }

  private summary(combination: number): MeasureSummary | undefined {
    return this.study.json.combinations[combination]?.measures[this.selection.measure];
  }

  private draw(): void {
    const q = shownAs(this.study.measure(this.selection.measure));
    const chosen = this.summary(this.selection.combination);
    if (!chosen) return;
    this.drawExceedance(q, chosen);
    this.drawRunning(q, chosen);
  }

  /** Other combinations that differ from the chosen one in the shaking alone. */
  private others(): number[] {
    const { combinations, axes } = this.study.json;
    const { combination } = this.selection;
    const own = combinations[combination].values;
    const found = combinations.flatMap((c, k) =>
      k !== combination && c.n > 0 && c.values.every((v, a) => axes[a]?.shaking || v === own[a]) ? [k] : [],
    );
    return found.slice(0, curveColors.length - 1);
  }

  private drawExceedance(q: Shown, chosen: MeasureSummary): void {
    const curve = (k: number, s: MeasureSummary, color: string, thin: boolean): ChartSeries => {
      const e = s.exceedance;
      // From the left edge on, all are above.
      const start = Math.min(0, ...e.value) * q.factor;
      const x = [start, ...e.value.map((v) => q.factor * v)];
      const repeat = <T>(values: T[], first: T) => [first, ...values];
      return {
        name: this.study.combinationName(this.study.json.combinations[k].values),
        color,
        kind: "steps",
        x,
        y: repeat<number | null>(e.probability, 1),
        ...(thin ? {} : { low: repeat(e.low, e.low.length > 0 ? 1 : null), high: repeat(e.high, 1) }),
        thin,
      };
    };
    const series = [
      curve(this.selection.combination, chosen, curveColors[0], false),
      ...this.others().map((k, i) => curve(k, this.summary(k)!, curveColors[i + 1], true)),
    ];
    const levels = this.study.json.levels.filter((l) => l.measure === this.selection.measure);
    const x = scaleOf([...series.flatMap((s) => [...s.x])]);
    this.exceedance.show({
      title: "Exceedance",
      note: "share of realizations above a value",
      xName: label(q),
      yName: "share",
      x,
      y: { min: 0, max: 1, logarithmic: false },
      percent: true,
      series,
      limits: levels.map((l) => ({ x: q.factor * l.threshold, text: l.name })).filter((l) => l.x <= x.max),
    });
  }

  private drawRunning(q: Shown, chosen: MeasureSummary): void {
    const { n, mean, low, high } = chosen.running_mean;
    const values = (column: (number | null)[]) => column.map((v) => scaled(q, v));
    // The band of the first few is wider than all that matters.
    const from = Math.min(3, n.length - 1);
    const y = scaleOf([...values(mean), ...values(low).slice(from), ...values(high).slice(from)]);
    this.running.show({
      title: "Running mean",
      note: `${label(q)} of the first n realizations, ${percent(this.study.json.confidence)} band`,
      xName: "realizations",
      yName: label(q),
      x: { min: 1, max: Math.max(2, n[n.length - 1] ?? 2), logarithmic: false },
      wholeX: true,
      y,
      series: [
        {
          name: label(q),
          color: curveColors[0],
          kind: "line",
          x: n,
          y: values(mean),
          low: values(low),
          high: values(high),
        },
      ],
      marks: this.target(q, chosen),
    });
  }

  /** The interval that was asked for, about the mean of all. */
  private target(q: Shown, chosen: MeasureSummary): { y: number; text: string }[] {
    const { precision } = this.study.json;
    const mean = chosen.mean.value;
    if (!precision || precision.measure !== q.name || mean === null) return [];
    const half = Math.max((precision.half_width ?? 0) * Math.abs(mean), 0.5 * (precision.width ?? 0));
    return [
      { y: q.factor * (mean + half), text: "asked for" },
      { y: q.factor * (mean - half), text: "" },
    ];
  }
}
