import type { Finding } from "../findings";
import { capital, count, integer, list, significant } from "../format";
import type { Combination, Estimate, Study } from "./data";
import { headlineFindings } from "./headline";
import { percent, relativeHalfWidth, shownAs, withUnit, type Shown } from "./quantities";
import { headline } from "./selection";

/** What the study says, in sentences. The first is the verdict. */
export function studyFindings(study: Study): Finding[] {
  const found = headlineFindings(study);
  if (found.length === 0)
    return [{ grade: "attention", text: "No run has ended: there is nothing to tell yet." }, ...gaps(study)];
  return [
    ...found,
    ...controlFindings(study),
    ...precisionFindings(study),
    ...gaps(study),
    ...marginalFindings(study),
  ];
}

/** The end of the running mean with its band: what the precision is measured by. */
function finalMean(c: Combination, measure: string): Estimate | null {
  const running = c.measures[measure]?.running_mean;
  const last = (running?.n.length ?? 0) - 1;
  return last < 0 ? null : { value: running.mean[last], low: running.low[last], high: running.high[last] };
}

interface Row {
  c: Combination;
  mean: Estimate;
}

/** All realizations gave the same: that is no interval, and says nothing of how well the mean is known. */
const flat = ({ c, mean }: Row) => c.n > 1 && mean.low !== null && mean.low === mean.high;

/** Where there is no interval, there are too few realizations for one. */
const halfWidth = (mean: Estimate) =>
  mean.low === null || mean.high === null ? Infinity : 0.5 * (mean.high - mean.low);

/** Whether enough realizations were run. */
function precisionFindings(study: Study): Finding[] {
  const { precision, combinations } = study.json;
  const q = shownAs(study.measure(precision?.measure ?? "fallen_area_m2"));
  const rows = combinations.flatMap((c) => {
    const mean = finalMean(c, q.name);
    return c.n > 0 && mean ? [{ c, mean }] : [];
  });
  if (rows.length === 0) return [];
  if (!precision) return [knownTo(study, q)];
  const level = percent(study.json.confidence);
  const asked = [
    precision.half_width === null ? [] : [`± ${percent(precision.half_width)} of the mean`],
    precision.width === null ? [] : [`a width of ${withUnit(q, precision.width)}`],
  ].flat();
  const goal = `${asked.join(" or ")} (${level} interval of the mean ${q.title})`;
  const still = rows.filter(flat);
  const same =
    still.length > 0
      ? ` No variation yet in ${count(still.length, "combination")}: all realizations gave the same ${q.title}.`
      : "";
  if (precision.reached)
    return [{ grade: "good", text: `Enough realizations: every combination is known to ${goal}.${same}` }];
  return [
    {
      grade: "attention",
      text: `Not enough realizations: ${shortfall(study, rows, goal)}.${same}${needed(study, rows)}`,
    },
  ];
}

/** How well the mean is known where no precision was asked for. */
function knownTo(study: Study, q: Shown): Finding {
  const c = study.json.combinations[headline(study)];
  const mean = finalMean(c, q.name);
  if (!mean || mean.low === null || mean.high === null)
    return { grade: "attention", text: "Too few realizations for confidence intervals." };
  if (flat({ c, mean }))
    return {
      grade: "attention",
      text: `Mean ${q.title} there: ${withUnit(q, mean.value)}. No variation yet: all ${count(c.n, "realization")} gave the same, so that nothing can be said of how well it is known.`,
    };
  const half = relativeHalfWidth(mean);
  return {
    grade: "plain",
    text: `Mean ${q.title} there: ${withUnit(q, mean.value)}, known to ± ${withUnit(q, halfWidth(mean), 2)}${half === null ? "" : ` or ± ${percent(half)}`} (half the ${percent(study.json.confidence)} interval). No precision was asked for.`,
  };
}

/** Half the width that the precision asks for. */
function limitOf(study: Study, mean: Estimate): number {
  const { precision } = study.json;
  return Math.max((precision?.half_width ?? 0) * Math.abs(mean.value ?? 0), 0.5 * (precision?.width ?? 0));
}

function tooWide(study: Study, rows: Row[]): Row[] {
  return rows.filter((row) => !flat(row) && halfWidth(row.mean) > limitOf(study, row.mean) * (1 + 1e-9));
}

/** What is short of the precision asked for: combinations, or realizations. */
function shortfall(study: Study, rows: Row[], goal: string): string {
  const { axes, precision, realizations } = study.json;
  const planned = axes.reduce((product, axis) => product * axis.values.length, 1);
  const still = precision!.width === null ? rows.filter(flat).length : 0;
  const below = tooWide(study, rows).length + still + Math.max(0, planned - rows.length);
  if (below > 0)
    return `${below} of ${count(planned, "combination")} ${below === 1 ? "is" : "are"} known less well than ${goal}`;
  return realizations < precision!.minimum
    ? `${integer(realizations)} of the ${integer(precision!.minimum)} that are run in any case`
    : `some of the first ${integer(realizations)} are missing`;
}

/** The width of an interval goes with the root of the number of realizations. */
function needed(study: Study, rows: Row[]): string {
  const found = tooWide(study, rows).flatMap(({ c, mean }) => {
    const ratio = halfWidth(mean) / limitOf(study, mean);
    return Number.isFinite(ratio) ? [{ c, n: c.n * ratio * ratio }] : [];
  });
  found.sort((a, b) => a.n - b.n);
  const guess = ({ c, n }: { c: Combination; n: number }) =>
    `${study.combinationName(c.values)} about ${integer(Number(n.toPrecision(2)))}`;
  const ends = found.length > 1 ? [found[0], found[found.length - 1]] : found;
  return ends.length > 0 ? ` Realizations that would be needed: ${list(ends.map(guess))}.` : "";
}

/** Runs that failed or are missing. */
function gaps(study: Study): Finding[] {
  const { runs } = study.json;
  const missing = Math.max(0, runs.planned - runs.done - runs.failed);
  const parts: string[] = [];
  if (runs.failed > 0) parts.push(`${count(runs.failed, "run")} failed`);
  if (missing > 0)
    parts.push(
      `${count(missing, "run")} of ${integer(runs.planned)} ${missing === 1 ? "is" : "are"} missing`,
    );
  if (parts.length === 0) return [];
  return [
    {
      grade: "attention",
      text: `${capital(list(parts))}; the statistics leave them out. If they are those with most damage, the true figures are worse.`,
    },
  ];
}

/** Whether gravity had brought down what it could before the shaking. */
function controlFindings(study: Study): Finding[] {
  const { control } = study.json;
  if (!control || control.realizations === 0) return [];
  const of = `${integer(control.still_falling)} of ${count(control.realizations, "realization")}`;
  if (control.still_falling === 0)
    return [
      {
        grade: "good",
        text: `Without shaking nothing more came down: ${count(control.realizations, "control run")}.`,
      },
    ];
  return [
    {
      grade: "attention",
      text: `Rock was still coming down by gravity in ${of}: more than ${significant(control.threshold_m2)} m² fell in the run without shaking. It is taken off here. A rest before the shaking with until = "still" lets it come down before.`,
    },
  ];
}

function marginalFindings(study: Study): Finding[] {
  const { marginal, combinations } = study.json;
  if (!marginal) return [];
  const checked = combinations.reduce((sum, c) => sum + c.checked, 0);
  const found = combinations.reduce((sum, c) => sum + c.marginal, 0);
  if (checked === 0) return [];
  const release = study.hasVariant("released") ? " or an immediate release" : "";
  return [
    {
      grade: found > 0 ? "attention" : "good",
      text: `${integer(found)} of ${count(checked, "checked run")} ${found === 1 ? "is" : "are"} marginal: friction ± ${significant(marginal.friction_degrees)}°${release} changes the fallen area by more than ${percent(marginal.share)} of the larger.`,
    },
  ];
}
