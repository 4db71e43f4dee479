import type { Stage } from "./data";
import { fixed, integer, significant } from "./format";
import type { Run, Moment } from "./run";

/** Decimals of a time within a stage, s: more where the stage is short. */
function decimals(stage: Stage): number {
  const whole = stage.planned_duration ?? stage.duration;
  return whole > 0 ? Math.min(6, Math.max(2, 2 - Math.floor(Math.log10(whole)))) : 2;
}

/** How long a dynamic stage has lasted: "20 s", or "14.04 of 20 s" where it was interrupted. */
export function stageTime(stage: Stage): string {
  if (!stage.interrupted) return `${significant(stage.duration, 4)} s`;
  const whole = stage.planned_duration === null ? "" : ` of ${significant(stage.planned_duration, 4)}`;
  return `${fixed(stage.duration, decimals(stage))}${whole} s`;
}

/** "first earthquake · 3.42 s of 20 s · run time 5.42 s · step 2,710": where in the run a moment is. */
export function momentLabel(run: Run, moment: Moment): string {
  if (moment < 0 || run.frameCount === 0) return "reference position";
  const stage = run.stage[run.frameOf(moment)];
  const record = run.stages[stage];
  const time = run.timeAt(moment);
  const parts = [run.stageName(stage)];
  const first = run.firstFrame(stage);
  if (record?.kind === "settle" || (!record && run.time[first] === run.time[run.lastFrame(stage)])) {
    parts.push("static");
  } else {
    const start = record ? record.start_time : run.time[first];
    const planned = record && !record.interrupted ? record.duration : (record?.planned_duration ?? 0);
    const whole = planned > 0 ? ` of ${significant(planned, 4)}` : "";
    const places = record ? decimals(record) : 2;
    parts.push(`${fixed(time - start, places)}${whole} s`, `run time ${fixed(time, places)} s`);
  }
  parts.push(`step ${integer(run.stepAt(moment))}`);
  return parts.join(" · ");
}

/** Moments from which displacements may be counted: the start, and the start of each later stage. */
export function sinceChoices(run: Run): { value: string; text: string }[] {
  const choices = [{ value: "-1", text: "the start" }];
  for (let k = 1; k < run.stageCount(); k++) {
    const f = run.lastFrame(k - 1);
    if (f >= 0 && run.firstFrame(k) >= 0)
      choices.push({ value: String(f), text: `the start of “${run.stageName(k)}”` });
  }
  return choices;
}

/** The moment before the first excavation, from which damage counts; the start without one. */
export function damageStart(run: Run): Moment {
  const k = run.stages.findIndex((stage) => stage.excavate.length > 0);
  return k > 0 ? run.lastFrame(k - 1) : -1;
}
