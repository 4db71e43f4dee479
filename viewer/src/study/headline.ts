import type { Finding } from "../findings";
import { capital, count, integer, significant } from "../format";
import type { Combination, Fragility, LevelShare, Study } from "./data";
import { percent, percentRange, shownAs, withUnit } from "./quantities";
import { headline } from "./selection";

/** So many groups that differ in more than the shaking get a sentence of their own. */
const mostNamed = 6;

/** Combinations with the strongest shaking, which differ in the other axes. */
function strongest(study: Study): number[] {
  const { axes, combinations } = study.json;
  const first = combinations[headline(study)];
  if (!first) return [];
  return combinations.flatMap((c, k) =>
    c.n > 0 && c.values.every((v, a) => !axes[a]?.shaking || v === first.values[a]) ? [k] : [],
  );
}

/** The level that tells most here: the one whose probability is nearest to one half. */
function tellingLevel(c: Combination): number {
  let best = 0;
  c.levels.forEach((level, l) => {
    if (Math.abs((level.probability ?? 0) - 0.5) < Math.abs((c.levels[best].probability ?? 0) - 0.5))
      best = l;
  });
  return best;
}

/** "With scale of quake 3, ": of which combination a sentence speaks. */
function inCombination(study: Study, values: readonly (string | null)[]): string {
  const name = study.combinationName(values);
  return name === "all runs" ? "" : `With ${name}, `;
}

/** "lose more than 0.6 m² of rock": what it is to exceed a level. */
function exceeding(study: Study, l: number, plural: boolean): string {
  const { measure, threshold } = study.json.levels[l];
  const q = shownAs(study.measure(measure));
  const [lose, have] = plural ? ["lose", "have"] : ["loses", "has"];
  if (measure === "fallen_area_m2") return `${lose} more than ${withUnit(q, threshold)} of rock`;
  if (measure === "fallen_blocks") return `${lose} more than ${count(threshold, "block")}`;
  return `${have} ${q.title} above ${withUnit(q, threshold)}`;
}

/** "9 of 20 had lost more than that". */
function hadExceeded(study: Study, l: number, share: LevelShare): string {
  const lost = study.json.levels[l].measure.startsWith("fallen") ? "lost" : "had";
  return `${integer(share.exceeded)} of ${integer(share.n)} had ${lost} more than that`;
}

const range = (share: LevelShare) => `(${percentRange(share.low, share.high)})`;

/** How many realizations exceed a level, and of these how many before the shaking and by it. */
function probabilitySentence(study: Study, k: number, l: number): string {
  const c = study.json.combinations[k];
  const { since, before, at_shaking } = study.json;
  const own = c.levels[l];
  const exceed = exceeding(study, l, own.exceeded !== 1);
  const text = `${inCombination(study, c.values)}${integer(own.exceeded)} of ${count(own.n, "realization")} ${exceed}${study.after()} ${range(own)}`;
  if (!c.before || !c.added) return `${capital(text)}.`;
  const earlier = c.before.levels[l];
  const had = hadExceeded(study, l, earlier);
  if (since)
    return `${capital(text)}; ${had} ${at_shaking ? "before it, under gravity alone" : `by the end of “${before}”`} ${range(earlier)}.`;
  const later = c.added.levels[l];
  const lose = later.exceeded === 1 ? "loses" : "lose";
  const more = study.json.levels[l].measure.startsWith("fallen") ? `${lose} more than that` : "add that";
  return `${capital(text)}: ${had} before the shaking, under gravity alone ${range(earlier)}, and ${integer(later.exceeded)} ${more} by the shaking ${range(later)}.`;
}

/** Of a study without levels. */
function meanSentence(study: Study, k: number): string {
  const c = study.json.combinations[k];
  const q = shownAs(study.measure("fallen_area_m2"));
  const area = (part: Pick<Combination, "measures"> | Combination["before"]) => {
    const mean = part?.measures["fallen_area_m2"]?.mean;
    const known = mean?.low !== null && mean?.low !== undefined;
    const interval = known ? ` (${withUnit(q, mean.low)} to ${withUnit(q, mean.high)})` : "";
    return `${withUnit(q, mean?.value ?? null)}${interval}`;
  };
  const text = `${inCombination(study, c.values)}${area(c)} of rock falls${study.after()} on average of ${count(c.n, "realization")}`;
  if (!c.before) return `${capital(text)}.`;
  const when = study.json.at_shaking ? "before the shaking" : `by the end of “${study.json.before}”`;
  return study.json.since
    ? `${capital(text)}; ${area(c.before)} had fallen ${when}.`
    : `${capital(text)}: ${area(c.before)} ${when}, ${area(c.added)} by it.`;
}

/** The median of a curve over PGA, or why there is no curve. */
function curveSentence(study: Study, f: Fragility): string {
  const name = study.combinationName(f.values);
  const of = name === "all runs" ? "" : `, ${name}`;
  const kind = study.json.intensities.find((i) => i.name === f.intensity)!;
  if (f.why !== null) return `No fragility curve of “${f.level}” over ${kind.title}${of}: ${f.why}.`;
  const interval = (e: Fragility["theta"]) => `${significant(e.low)} … ${significant(e.high)}`;
  return `Half of the realizations exceed “${f.level}”${study.after()} at a ${kind.title} of ${significant(f.theta.value)} ${kind.unit} (${interval(f.theta)})${of}; β of the fragility curve is ${significant(f.beta.value)} (${interval(f.beta)}).`;
}

/** What came down, before the shaking and by it, with the strongest shaking. The first is the verdict; none without runs. */
export function headlineFindings(study: Study): Finding[] {
  const { combinations, levels, confidence, fragility } = study.json;
  const shaken = strongest(study);
  if (shaken.length === 0) return [];
  const plain = (text: string): Finding => ({ grade: "plain", text });
  if (levels.length === 0) return shaken.slice(0, mostNamed).map((k) => plain(meanSentence(study, k)));
  const l = tellingLevel(combinations[shaken[0]]);
  const curves = fragility.filter((f) => f.level === levels[l].name && f.intensity === "pga_m_s2");
  return [
    ...shaken.slice(0, mostNamed).map((k) => plain(probabilitySentence(study, k, l))),
    plain(
      `That is the level “${levels[l].name}”. In brackets: ${percent(confidence)} confidence interval of the probability.`,
    ),
    ...curves.slice(0, mostNamed).map((f) => plain(curveSentence(study, f))),
  ];
}
