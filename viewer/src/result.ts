import type { Damage } from "./data";
import { factList, h, section, type Child } from "./dom";
import { findingList, type Finding } from "./findings";
import { groundAndLoads } from "./ground";
import { count, fixed, integer, length, significant } from "./format";
import type { Run } from "./run";
import { firstExcavation, findings, lastKnown, marginalStages, sureness } from "./verdict";

type Grade = "good" | "attention" | "bad" | "plain";

/** The result in a few words. */
function badge(run: Run): { words: string; grade: Grade } {
  const found = run.header.model.excavations.length > 0 ? ofRock(run) : ofStructure(run);
  const marginal = marginalStages(run).length > 0 && found.grade === "good";
  return marginal ? { words: `${found.words}, but the case is marginal`, grade: "attention" } : found;
}

function ofRock(run: Run): { words: string; grade: Grade } {
  const excavated = firstExcavation(run);
  const last = lastKnown(run, (d) => d.fallen_area_m2);
  if (excavated < 0 || last < excavated) return { words: "Not known", grade: "attention" };
  const { fallen_blocks, loosened_area_m2 } = run.stages[last].damage;
  if (fallen_blocks > 0) return { words: "Rock falls", grade: "bad" };
  if ((loosened_area_m2 ?? 0) > 0)
    return { words: "No rock falls, but some is loosened", grade: "attention" };
  return { words: "No rock falls", grade: "good" };
}

function ofStructure(run: Run): { words: string; grade: Grade } {
  const stage = [...run.stages].reverse().find((s) => s.standing !== null);
  switch (stage?.standing) {
    case "stands":
      return (stage.damage.loosened_area_m2 ?? 0) > 0
        ? {
            words: `Stands, moved by up to ${length(run.largestDisplacement()[0], 2)}`,
            grade: "attention",
          }
        : { words: "Stands", grade: "good" };
    case "moves":
      return { words: "Moves", grade: "attention" };
    case "unstable":
      return { words: "Does not stand", grade: "bad" };
    case "rocks":
      return { words: "Still rocks", grade: "attention" };
    case "collapsed":
      return { words: "Has collapsed", grade: "bad" };
    default:
      return { words: "Not known", grade: "attention" };
  }
}

/** "crown 1.24 m, right wall 0.40 m": from where rock fell. */
function depths(damage: Damage): string {
  const parts: [string, number | null][] = [
    ["crown", damage.fallen_depth_crown_m],
    ["left wall", damage.fallen_depth_left_m],
    ["right wall", damage.fallen_depth_right_m],
    ["invert", damage.fallen_depth_invert_m],
  ];
  return parts
    .filter(([, depth]) => (depth ?? 0) > 0)
    .map(([name, depth]) => `${name} ${fixed(depth, 2)} m`)
    .join(", ");
}

/** What an engineer asks of the rock that fell; null where none did or it is not known. */
function whatFalls(run: Run): HTMLElement | null {
  const stage = run.stages[lastKnown(run, (d) => d.fallen_weight_n_m)];
  if (!stage || stage.damage.fallen_blocks === 0) return null;
  const { damage, fallen } = stage;
  const largest = fallen.reduce((a, b) => (b.area_m2 > a.area_m2 ? b : a), fallen[0]);
  const weight = (n: number | null) => `${significant(n === null ? null : n / 1e3, 3)} kN/m`;
  const facts: [string, Child][] = [
    [
      "Weight of fallen rock",
      `${weight(damage.fallen_weight_n_m)} (${count(damage.fallen_blocks, "block")}, ${significant(damage.fallen_area_m2, 3)} m²)`,
    ],
    [
      "Largest block",
      `${weight(damage.largest_fallen_weight_n_m)} (${significant(damage.largest_fallen_area_m2, 3)} m²${largest ? `, ${run.blockName(largest.block)}` : ""})`,
    ],
  ];
  if (damage.fallen_depth_m !== null) facts.push(["Depth behind the wall", depths(damage) || "–"]);
  if (damage.largest_block_pressure_pa !== null)
    facts.push([
      "Largest block over its width",
      `${significant(damage.largest_block_pressure_pa / 1e3, 3)} kPa`,
    ]);
  const note = `Weights are per metre of ${damage.fallen_depth_m === null ? "thickness" : "tunnel"}.`;
  const search = run.header.model.pressure_search;
  const support = search
    ? h(
        "details",
        { class: "hint" },
        h("summary", {}, "Which support pressure is needed?"),
        h(
          "p",
          {},
          "The weight of a block over its own width along the wall holds that block alone, without friction. The support pressure that holds all the rock is found by trying: ",
          h("code", {}, search),
        ),
      )
    : null;
  const list = factList(facts);
  list.classList.add("listed");
  return h(
    "div",
    { class: "falls" },
    h("h3", {}, "What falls"),
    list,
    h("p", { class: "hint" }, note),
    support,
  );
}

/** One run tells of one rock mass. */
function realizationFinding(run: Run): Finding {
  const { model } = run.header;
  if (model.joint_sets.length === 0)
    return {
      grade: "plain",
      text: "Nothing in this model is random: the same scenario always gives the same result.",
    };
  return {
    grade: "plain",
    text: `One realization of the joints (number ${integer(model.realization)}) of many: a study of many tells how often rock falls, and how much.`,
  };
}

/** The first screen: what came of the run, how sure that is, how it looks, and of what ground and loads. */
export function resultSection(run: Run, picture: HTMLElement | null, ...below: Child[]): HTMLElement {
  const [verdict, ...others] = findings(run);
  const { words, grade } = badge(run);
  const falls = whatFalls(run);
  return section(
    "verdict",
    "Result",
    h(
      "div",
      { class: picture ? "result" : "result alone" },
      h(
        "div",
        { class: "words" },
        h("p", { class: `badge ${grade}` }, words),
        h("p", { class: "verdict" }, verdict.text),
      ),
      picture,
      h(
        "div",
        { class: "answers" },
        falls ?? (others.length > 0 ? findingList(others) : null),
        h("h3", {}, "How sure is it?"),
        findingList([...sureness(run), realizationFinding(run)]),
      ),
      h("div", { class: "ground", id: "ground" }, h("h3", {}, "Ground and loads"), groundAndLoads(run)),
    ),
    falls ? findingList(others) : null,
    ...below,
  );
}
