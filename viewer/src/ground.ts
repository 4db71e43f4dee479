import type { Stage } from "./data";
import { factList, type Child } from "./dom";
import { capital, integer, quoted, significant } from "./format";
import type { Run } from "./run";
import { acceleration } from "./verdict";

function shaking(stage: Stage): [string, Child] {
  const scale = stage.scale === 1 ? "" : `, with the motion × ${significant(stage.scale, 3)}`;
  const peak = stage.pga_m_s2 === null ? "not known" : acceleration(stage.pga_m_s2);
  return [`PGA in ${quoted(stage.name)}`, `${peak}${scale}`];
}

/** What the rock is and what acts on it. */
export function groundAndLoads(run: Run): HTMLElement {
  const box = run.extentOfRock();
  const still = run.blockCount - run.movable();
  return factList([
    [
      "Size of the model",
      `${significant(box.maxX - box.minX, 4)} × ${significant(box.maxY - box.minY, 4)} m`,
    ],
    ["Blocks", still === 0 ? integer(run.movable()) : `${integer(run.movable())} and ${still} fixed`],
    ...run.header.model.ground.map(({ name, value }): [string, Child] => [capital(name), value]),
    ...run.stages.filter((s) => s.kind === "shake").map(shaking),
  ]);
}
