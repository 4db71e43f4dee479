import type { Damage, Stage } from "./data";
import type { Finding } from "./findings";
import { capital, count, fixed, integer, length, list, quoted, significant } from "./format";
import { stageTime } from "./labels";
import type { Run } from "./run";
import { standingFindings } from "./standing";

/** Peak ground acceleration as "1.18 m/s² (0.12 g)". */
export function acceleration(a: number): string {
  return `${significant(a, 3)}\u00a0m/s² (${fixed(a / 9.81, 2)}\u00a0g)`;
}

function fallen(blocks: number, area: number | null): string {
  return `${count(blocks, "block")} (${significant(area, 3)}\u00a0m²)`;
}

/** Settle stages that ended, but not in equilibrium: the case is marginal, and what moved is listed. */
export function marginalStages(run: Run): { index: number; stage: Stage }[] {
  return run.stages
    .map((stage, index) => ({ index, stage }))
    .filter(
      ({ stage }) =>
        stage.kind === "settle" &&
        !stage.interrupted &&
        (!stage.equilibrium.reached || stage.equilibrium.moving.length > 0),
    );
}

/** The stage that opens the first excavation; −1: none has. */
export function firstExcavation(run: Run): number {
  return run.stages.findIndex((s) => s.excavate.length > 0);
}

/** What happened to the rock, in sentences. The first is the verdict. */
export function findings(run: Run): Finding[] {
  const excavated = firstExcavation(run);
  return excavated >= 0
    ? [...damageFindings(run, excavated), ...closureFindings(run), ...slipFindings(run)]
    : [...standingFindings(run), ...slipFindings(run)];
}

/** What makes the result less sure, and what the checks say that is not in these sentences yet. */
export function sureness(run: Run): Finding[] {
  const marginal = marginalFindings(run);
  const others = checks(run).filter((c) => c.name !== marginalCheck || marginal.length === 0);
  return [
    ...(run.header.run.interrupted ? [interruption(run)] : []),
    ...marginal,
    checksFinding(others, marginal.length > 0 ? "other " : ""),
    ...sliverFindings(run),
  ];
}

/** Joints that cutting may have locked. */
function sliverFindings(run: Run): Finding[] {
  const c = run.header.model.cutting;
  const found: Finding[] = [];
  if (c.merged_across_joints > 0)
    found.push({
      grade: "plain",
      text: `${count(c.merged_slivers, "sliver")} merged, ${integer(c.merged_across_joints)} of them across a joint that runs through. Teeth of rock of up to ${length(c.highest_tooth_m, 2)} hold the joint there.`,
    });
  if (c.slivers_left > 0)
    found.push({
      grade: "plain",
      text: `${count(c.slivers_left, "sliver")} left in the model, as the scenario asks. Their corners can hold the joints beside them.`,
    });
  return found;
}

/** Where a run stopped: "within “first earthquake”, after 14.04 of 20 s". */
function whereItStopped(run: Run): string {
  const last = run.stages[run.stages.length - 1];
  if (!last) return "before its first stage";
  if (!last.interrupted) return `after ${quoted(last.name)}`;
  const after = last.kind === "settle" ? count(last.steps, "static step") : stageTime(last);
  return `within ${quoted(last.name)}, after ${after}`;
}

function interruption(run: Run): Finding {
  const left = run.header.model.stages.slice(run.stages.length).map(quoted);
  const notRun = left.length === 0 ? "" : `; ${list(left)} ${left.length === 1 ? "was" : "were"} not run`;
  const text = run.header.run.cut_off
    ? `The run was cut off ${whereItStopped(run)}, step ${integer(run.header.run.steps)}${notRun}. It was killed, or still goes on. Blocks are counted in the last recorded frame. Numbers that only the end of a stage gives are missing.`
    : `The run was interrupted ${whereItStopped(run)}${notRun}. The numbers hold for what was computed until then.`;
  return { grade: "attention", text };
}

/** The last stage of which something is known. */
export function lastKnown(run: Run, measure: (damage: Damage) => number | null): number {
  let k = run.stages.length - 1;
  while (k >= 0 && measure(run.stages[k].damage) === null) k--;
  return k;
}

/** The last stage before the first shaking of the opening; −1 where nothing shakes it. See last_before_shaking in src/simulation. */
function lastBeforeShaking(run: Run, excavated: number): number {
  const first = run.stages.findIndex((s, k) => k >= excavated && s.kind === "shake");
  return first <= 0 ? -1 : first - 1;
}

/** What came down before the shaking, and what the shaking added: ": 9 blocks (3 m²) before the shaking; …". */
function splitAtShaking(run: Run, excavated: number, last: number): string {
  const before = lastBeforeShaking(run, excavated);
  if (before < 0 || before >= last) return "";
  const [early, end] = [run.stages[before].damage, run.stages[last].damage];
  if (end.fallen_blocks === 0) return ", neither before the shaking nor by it";
  const blocks = end.fallen_blocks - early.fallen_blocks;
  const area = (end.fallen_area_m2 ?? 0) - (early.fallen_area_m2 ?? 0);
  const all = end.fallen_blocks > 1 ? "all " : "";
  if (early.fallen_blocks === 0) return `, ${all}by the shaking`;
  if (blocks === 0) return `, ${all}before the shaking, which added nothing`;
  return `: ${fallen(early.fallen_blocks, early.fallen_area_m2)} before the shaking, and the shaking added ${fallen(blocks, area)}`;
}

function damageFindings(run: Run, excavated: number): Finding[] {
  const { stages } = run;
  const openings = list(run.header.model.excavations);
  const last = lastKnown(run, (d) => d.fallen_area_m2);
  if (last < excavated)
    return [{ grade: "attention", text: `Nothing is known of the time after the excavation (${openings}).` }];
  const end = stages[last].damage;
  const loosenedArea = end.loosened_area_m2 ?? 0;
  const loosened =
    loosenedArea > 0 ? `${significant(loosenedArea, 3)} m² more are loosened` : "nothing more is loosened";
  const split = splitAtShaking(run, excavated, last);
  const filled =
    end.opening_filled_ratio === null
      ? ` since the excavation (${openings})${split}`
      : `${split}; the opening (${openings}) is ${fixed(100 * end.opening_filled_ratio, 1)}\u00a0% filled`;
  const verdict =
    end.fallen_blocks > 0
      ? `${fallen(end.fallen_blocks, end.fallen_area_m2)} ${end.fallen_blocks === 1 ? "has" : "have"} fallen${filled}; ${loosened}.`
      : `No block has fallen since the excavation (${openings})${split}; ${loosened.replace(" more", "")}.`;
  const result: Finding[] = [{ grade: "plain", text: verdict }];
  const parts: string[] = [];
  for (let k = excavated; k <= last; k++) {
    const { name, kind, pga_m_s2: pga, damage } = stages[k];
    const before = k > 0 ? stages[k - 1].damage : { fallen_blocks: 0, fallen_area_m2: 0 };
    const blocks = damage.fallen_blocks - before.fallen_blocks;
    const area = (damage.fallen_area_m2 ?? 0) - (before.fallen_area_m2 ?? 0);
    const stage = `${quoted(name)}${kind === "shake" && pga !== null ? `, peak ${acceleration(pga)}` : ""}`;
    if (blocks > 0) parts.push(`${fallen(blocks, area)} came down in ${stage}`);
    else if (kind === "shake") parts.push(`nothing further came down in ${stage}`);
  }
  if (end.fallen_blocks > 0 && parts.length > 0)
    result.push({ grade: "plain", text: `${capital(list(parts))}.` });
  return result;
}

/** By how much the opening has closed; none where it has not, or nothing is known. */
function closureFindings(run: Run): Finding[] {
  const end = run.stages[lastKnown(run, (d) => d.fallen_area_m2)]?.damage;
  if (!end) return [];
  const both = [end.closure_vertical_m, end.closure_horizontal_m];
  if (both.every((x) => x === 0)) return [];
  const [vertical, horizontal] = both.map((x) => length(x));
  const fallen = both.includes(null) ? " (–: a point of the wall is on a block that has fallen)" : "";
  const bound =
    run.header.model.closure_is_lower_bound && both.some((x) => x !== null)
      ? "; this is a lower bound, as blocks of order 1 that fit each other are too stiff"
      : "";
  return [
    {
      grade: "plain",
      text: `Closure of the opening: vertical ${vertical}, horizontal ${horizontal}${fallen}${bound}.`,
    },
  ];
}

function slipFindings(run: Run): Finding[] {
  const k = lastKnown(run, (d) => d.slip_max_ever_m);
  const end = run.stages[k]?.damage;
  if (!end || !((end.slip_max_ever_m ?? 0) > 0)) return [];
  const { slip_limit_m: slip, opening_limit_m: opening } = run.header.model;
  const beyond = (limit: number | null) =>
    limit === null ? " beyond the limit" : ` by more than ${length(limit)}`;
  const slipped = `${significant(end.slipped_length_ever_m, 3)}\u00a0m of joint slipped${beyond(slip)} and ${significant(end.opened_length_ever_m, 3)}\u00a0m opened${beyond(opening)}`;
  const when =
    k < run.stages.length - 1 ? `By the end of ${quoted(run.stages[k].name)} joints had` : "Joints";
  const left =
    end.fallen_blocks > 0
      ? ` In place at the end: up to ${length(end.slip_max_m)} (mean ${length(end.slip_mean_m)}).`
      : ` In the end the mean is ${length(end.slip_mean_m)}.`;
  return [
    {
      grade: "plain",
      text: `${when} slipped by up to ${length(end.slip_max_ever_m)}; ${slipped}.${left}`,
    },
  ];
}

/** Static stages that ended with moving blocks, or without equilibrium; none: nothing is to be said. */
function marginalFindings(run: Run): Finding[] {
  const stages = marginalStages(run);
  if (stages.length === 0) return [];
  const falls = run.header.model.excavations.length > 0 ? "What falls" : "What comes of it";
  const text = `This case is marginal: ${list(stages.map(({ stage }) => leftOver(run, stage)))}. ${falls} may depend on small differences of the model.`;
  return [{ grade: "attention", text }];
}

const marginalCheck = "Marginal static stages";

export interface Check {
  name: string;
  value: string;
  limit: string;
  /** null: it was not measured. */
  good: boolean | null;
}

/** How far the numbers can be trusted. */
export function checks(run: Run): Check[] {
  const {
    open_close: oc,
    max_overlap_m,
    max_overlap_at: at,
    errors,
    max_area_change,
    made_ratio,
    energy,
    steps,
    cut_off,
  } = run.header.run;
  const unknown = { value: "not known", good: null };
  const overlap = max_overlap_m ?? Infinity;
  const overlapIsSmall = overlap < 1e-3;
  const overlapPlace =
    at && !overlapIsSmall
      ? `, of blocks ${at.blocks[0]} and ${at.blocks[1]}, at ${fixed(at.time_s, 2)}\u00a0s in ${quoted(at.stage)}`
      : "";
  const residual = energy.residual_ratio ?? Infinity;
  const { warnings } = run.header.model;
  const result: Check[] = [
    {
      name: "Input that seems odd",
      limit: "none",
      value: warnings.length === 0 ? "none" : `${count(warnings.length, "warning")}, listed above`,
      good: warnings.length === 0,
    },
    {
      name: "Errors of the computation",
      limit: "none",
      ...(cut_off
        ? unknown
        : { value: errors.length === 0 ? "none" : errors.join("; "), good: errors.length === 0 }),
    },
    {
      name: "Steps that did not converge",
      limit: "none",
      ...(oc === null
        ? unknown
        : {
            value: `${integer(oc.unconverged_steps)} of ${integer(steps)}`,
            good: oc.unconverged_steps === 0,
          }),
    },
    {
      name: "Largest true overlap of two blocks",
      limit: "below 1\u00a0mm",
      ...(cut_off ? unknown : { value: `${length(max_overlap_m)}${overlapPlace}`, good: overlapIsSmall }),
    },
    {
      name: "Energy residual, of the largest term",
      limit: "below 1\u00a0%",
      ...(cut_off && energy.residual_ratio === null
        ? unknown
        : {
            value: `${significant(Number.isFinite(residual) ? 100 * residual : null, 2)} %`,
            good: residual < 0.01,
          }),
    },
    {
      name: "Energy made by the time integration, of the largest other term",
      limit: "below 10\u00a0%",
      ...(cut_off
        ? unknown
        : { value: `${significant(100 * (made_ratio ?? 0), 2)} %`, good: (made_ratio ?? 0) < 0.1 }),
    },
    {
      name: "Largest change of a block's area, elastic strain included",
      limit: "below 1\u00a0%",
      ...(cut_off
        ? unknown
        : {
            value: `${significant(max_area_change === null ? null : 100 * max_area_change, 2)} %`,
            good: (max_area_change ?? Infinity) < 0.01,
          }),
    },
  ];
  const settled = run.stages.filter((s) => s.kind === "settle" && !s.interrupted);
  if (settled.length > 0) {
    const marginal = marginalStages(run).map(({ stage }) => leftOver(run, stage));
    result.push({
      name: marginalCheck,
      value: marginal.length === 0 ? `0 of ${settled.length}` : list(marginal),
      limit: "none",
      good: marginal.length === 0,
    });
  }
  return result;
}

const lowerCase = (text: string) => text.charAt(0).toLowerCase() + text.slice(1);

/** What checks say together. */
export function checksFinding(all: readonly Check[], other = ""): Finding {
  const failed = list(all.flatMap((c) => (c.good === false ? [lowerCase(c.name)] : [])));
  const bad = all.filter((c) => c.good === false).length;
  const unknown = all.filter((c) => c.good === null).length;
  if (bad + unknown === 0)
    return { grade: "good", text: `All ${other}checks of the computation are passed.` };
  const checked = count(all.length, `${other}check`);
  const parts = [
    ...(bad > 0 ? [`${bad} of ${checked} ${bad === 1 ? "needs" : "need"} attention: ${failed}.`] : []),
    ...(unknown > 0
      ? [`${unknown} of ${checked} cannot be made, as the run left no record of its end.`]
      : []),
  ];
  return { grade: "attention", text: parts.join(" ") };
}

/** What makes a static stage marginal: "“excavated”: mechanism of 3 blocks (1.2 m² in all)". */
function leftOver(run: Run, stage: Stage): string {
  const area = stage.equilibrium.moving.reduce((sum, m) => sum + run.area[m.block], 0);
  const size =
    area > 0
      ? ` (${significant(area, 3)}\u00a0m²${stage.equilibrium.moving.length > 1 ? " in all" : ""})`
      : "";
  const verdict =
    stage.equilibrium.verdict === "not reached" ? "equilibrium not reached" : stage.equilibrium.verdict;
  return `${quoted(stage.name)}: ${verdict}${size}`;
}
