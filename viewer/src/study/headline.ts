import type { Finding } from "../findings";
import { capital, count, integer, significant } from "../format";
import type { Combination, Fragility, Share, Study } from "./data";
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

const range = (share: Share) => `(${percentRange(share.low, share.high)})`;
const shareOf = (share: Share) =>
  `${integer(share.exceeded)} of ${count(share.n, "realization")} ${range(share)}`;

/** That nothing was seen to fall, and how sure that is. */
function nothing(study: Study, share: Share): string {
  return `none of ${count(share.n, "realization")} (probability below ${percent(share.high)}, with ${percent(study.json.confidence)} confidence)`;
}

/** Whether rock falls, by gravity and by the shaking, and how sure that is. */
function fallSentence(study: Study, k: number): string {
  const c = study.json.combinations[k];
  const { since, before, at_shaking } = study.json;
  const start = inCombination(study, c.values);
  const [falls, bring, fallen] = hasOpening(study)
    ? ["rock falls", "brings rock down", "rock had fallen"]
    : ["blocks fall", "brings blocks down", "blocks had fallen"];
  const found = (what: string, share: Share) =>
    capital(`${what} in ${share.exceeded === 0 ? nothing(study, share) : shareOf(share)}.`);
  if (!c.before || !c.added) return found(start + falls, c.falls);
  const early = c.before.falls;
  const when = at_shaking ? "Before it, under gravity alone," : `By the end of “${before}”`;
  const gravity =
    early.exceeded === 0
      ? `${when} nothing had fallen.`
      : `${when} ${fallen} in ${integer(early.exceeded)} of ${integer(early.n)} ${range(early)}.`;
  const added = at_shaking ? `the shaking ${bring}` : `after “${before}” ${falls}`;
  if (since || c.falls.exceeded === 0) return `${found(start + added, c.added.falls)} ${gravity}`;
  return `${found(start + falls, c.falls)} ${found(added, c.added.falls)} ${gravity}`;
}

function hasOpening(study: Study): boolean {
  return study.json.outlines.length > 0;
}

/** Of blocks around no opening: how far they have moved, where none falls. */
function structureSentence(study: Study, k: number): string {
  const c = study.json.combinations[k];
  if (c.falls.exceeded > 0) return fallSentence(study, k);
  const parts = ["displacement_max_m", "rotation_max_deg"].map((name) => {
    const q = shownAs(study.measure(name));
    const at = (p: number) => withUnit(q, c.measures[name].quantiles.find((x) => x.p === p)?.value ?? null);
    return `the ${q.title} is ${at(0.5)} in the median and ${at(0.95)} at 95 %`;
  });
  return `${capital(`${inCombination(study, c.values)}blocks fall in ${nothing(study, c.falls)}.`)} ${capital(parts.join("; "))}.`;
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
  return `Half of the realizations exceed “${f.level}”${study.after()} at a ${kind.title} of ${significant(f.theta.value)} ${kind.unit} (${interval(f.theta)})${of}; β of the fragility curve is ${significant(f.beta.value)} (${interval(f.beta)})${f.records === 1 ? ", for this record only" : ""}.`;
}

/** Whether rock falls with the strongest shaking, before it and by it, and how well that is known. The first is the verdict; none
 * without runs. */
export function headlineFindings(study: Study): Finding[] {
  const { combinations, levels, fragility } = study.json;
  const shaken = strongest(study).slice(0, mostNamed);
  if (shaken.length === 0) return [];
  const plain = (text: string): Finding => ({ grade: "plain", text });
  const sentence = hasOpening(study) ? fallSentence : structureSentence;
  const falls = shaken.map((k) => plain(sentence(study, k)));
  if (levels.length === 0) return [...falls, ...shaken.map((k) => plain(meanSentence(study, k)))];
  const l = tellingLevel(combinations[shaken[0]]);
  const curves = fragility.filter((f) => f.level === levels[l].name && f.intensity === "pga_m_s2");
  return [...falls, ...curves.slice(0, mostNamed).map((f) => plain(curveSentence(study, f)))];
}
