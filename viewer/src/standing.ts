import type { Stage } from "./data";
import type { Finding } from "./findings";
import { capital, count, fixed, length, list, quoted, significant } from "./format";
import type { Run } from "./run";

/** The stage up to which it is known how the blocks stand; −1: none. */
function lastJudged(run: Run): number {
  let k = run.stages.length - 1;
  while (k >= 0 && run.stages[k].standing === null) k--;
  return k;
}

/** Of a run without an opening: whether the blocks stand, move or have collapsed. The first sentence is the verdict. */
export function standingFindings(run: Run): Finding[] {
  if (run.frameCount === 0 && run.stages.length === 0)
    return [{ grade: "attention", text: "No frame was recorded: there is nothing to draw." }];
  const k = lastJudged(run);
  if (k < 0)
    return [
      { grade: "attention", text: "It is not known whether it stands: no stage has ended." },
      ...moved(run, null),
    ];
  const stage = run.stages[k];
  return [
    { grade: stage.standing === "stands" ? "plain" : "attention", text: verdict(run, k) },
    ...moved(run, stage),
  ];
}

function verdict(run: Run, k: number): string {
  const stage = run.stages[k];
  const end = quoted(stage.name);
  switch (stage.standing) {
    case "collapsed": {
      const all = run.movable();
      const fell = stage.damage.fallen_blocks;
      const first = run.stages.find((s) => s.damage.fallen_blocks > 0) ?? stage;
      const what =
        fell === all
          ? `It has collapsed: ${all === 1 ? "its block has" : `all ${count(all, "block")} have`} fallen`
          : `A part of it has collapsed: ${fell} of ${count(all, "block")} ${fell === 1 ? "has" : "have"} fallen`;
      return `${what}. The first fell in ${quoted(first.name)}.`;
    }
    case "moves":
      return stage.kind === "settle"
        ? `It moves: ${stage.equilibrium.verdict} at the end of ${end} (${movingNames(run, stage)}).`
        : `It moves: at the end of ${end} blocks go at up to ${significant(stage.largest_speed_m_s, 2)}\u00a0m/s.`;
    case "rocks":
      return `It still rocks at the end of ${end}, at up to ${significant(stage.largest_speed_m_s, 2)}\u00a0m/s. A stage of kind "rest" tells what comes of it.`;
    case "unstable":
      return `It does not stand: at the end of ${end} it is ${stage.equilibrium.verdict}.`;
    case "unsettled":
      return `It is not known whether it stands: ${end} ended without equilibrium.`;
    default:
      return `It stands at the end of ${end}.`;
  }
}

function movingNames(run: Run, stage: Stage): string {
  const most = 4;
  const names = stage.equilibrium.moving.slice(0, most).map((m) => run.blockName(m.block));
  const left = stage.equilibrium.moving.length - names.length;
  return list(left > 0 ? [...names, `${left} more`] : names);
}

/** Degrees: what is less is not told. */
const leastRotation = 0.01;

/** How far, how much turned, and which joints have become hinges. */
function moved(run: Run, stage: Stage | null): Finding[] {
  const [distance, block] = run.largestDisplacement();
  const parts = [
    distance > 0
      ? `the largest displacement is ${length(distance)} (${run.blockName(block)})`
      : "nothing has moved",
  ];
  const damage = stage?.damage;
  const turned = damage?.rotation_max_deg ?? 0;
  if (turned >= leastRotation) parts.push(`the largest rotation of a block is ${angle(turned)}`);
  const found: Finding[] = [{ grade: "plain", text: `${capital(list(parts))}.` }];
  if (damage && damage.hinges > 0) {
    const limit = run.header.model.opening_limit_m;
    const beyond = limit === null ? "" : ` by more than ${length(limit)}`;
    found.push({
      grade: "plain",
      text: `${count(damage.hinges, "joint")} between blocks in place ${damage.hinges === 1 ? "is a hinge: open" : "are hinges: open"} at one end${beyond} and closed at the other.`,
    });
  }
  return found;
}

function angle(degrees: number): string {
  return `${degrees < 0.1 ? significant(degrees, 2) : fixed(degrees, degrees < 10 ? 1 : 0)}°`;
}
