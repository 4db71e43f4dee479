import { Animation } from "./animation";
import { Clock } from "./clock";
import { readPage, type Header } from "./data";
import { h, section, type Child } from "./dom";
import { Fields } from "./fields";
import { findingList } from "./findings";
import { NowFacts } from "./now_facts";
import { count, integer } from "./format";
import { Pictures } from "./pictures";
import type { Plot } from "./plots";
import { whenPrinting } from "./printing";
import { damagePlots, historyPlots, motionPlots, solverPlots } from "./run_plots";
import { Run } from "./run";
import { cuttingFacts, damageTable, movingTable, qualityTable, runFacts, stageTable } from "./tables";
import { findings } from "./verdict";
import { start } from "./start";

function head(header: Header): HTMLElement {
  const { model } = header;
  return h(
    "header",
    {},
    h("h1", {}, model.title || "Untitled run"),
    h(
      "div",
      { class: "subtitle" },
      `Discontinuous deformation analysis with keyblock ${model.version} · seed ${model.seed}, realization ${model.realization}`,
    ),
  );
}

function conventions(): HTMLElement {
  const item = (text: string) => h("li", {}, text);
  return section(
    "conventions",
    "Conventions",
    h(
      "ul",
      {},
      item("x points to the right, y up; all forces and energies are per metre of thickness of the section."),
      item("Stress is Cauchy stress, mean over a block; compression is negative."),
      item(
        "Displacement and velocity are relative to the base, whose acceleration the ground motion is. Static steps take no simulated time.",
      ),
      item(
        "Slip is the shear displacement of the two sides of a joint against each other since the excavation; gap is the opening normal to it, negative where contact springs are compressed.",
      ),
      item(
        "A block has fallen when it has left its place for the opening; loosened means moved beyond the limit of the scenario without having fallen. Damage is cumulative since the first excavation; the user guide has the definitions.",
      ),
      item(
        "Energies: kinetic + strain + gravity + contact + friction + damping + numerical − input = residual, where friction, damping and numerical are losses and input is the work of motion, loads and supports.",
      ),
    ),
  );
}

/** Everything that has to be drawn anew when the theme changes. */
interface Drawn {
  redraw(): void;
}

function build(run: Run, main: HTMLElement): void {
  const { header } = run;
  const fields = new Fields(run);
  const clock = new Clock(run);
  const drawn: Drawn[] = [];
  const plots: Plot[] = [];
  const track = (made: Plot[]): HTMLElement[] => {
    plots.push(...made);
    return made.map((p) => p.element);
  };
  const animation = run.frameCount > 0 ? new Animation(run, fields, clock) : null;
  const pictures = run.frameCount > 0 ? new Pictures(run, fields) : null;
  if (animation) drawn.push(animation);
  if (pictures) drawn.push(pictures);

  const showBlock = (block: number, stage: number) => {
    clock.pause();
    const frame = run.lastFrame(stage);
    if (frame >= 0) clock.seek(frame);
    animation?.showBlock(block);
  };
  const found = findings(run);
  const [verdict, ...others] = found;
  const parts: Child[] = [
    head(header),
    section(
      "verdict",
      "Result",
      h("p", { class: "verdict" }, verdict.text),
      findingList(others),
      movingTable(run, showBlock),
    ),
    section(
      "run",
      "What was run",
      runFacts(run),
      run.stages.length > 0 ? stageTable(run) : null,
      header.model.scenario
        ? h(
            "details",
            {},
            h("summary", {}, "The scenario, as run"),
            h("pre", {}, h("code", {}, header.model.scenario)),
          )
        : null,
    ),
  ];
  const damage = damageTable(run);
  if (damage) parts.push(section("damage", "Damage by stage", damage));
  if (pictures) parts.push(section("states", "The blocks before and after each stage", pictures.element));
  const motion = track(motionPlots(run, clock));
  if (animation) {
    const excavated = run.header.model.excavations.length > 0;
    const aside =
      motion.length > 0 || excavated
        ? h(
            "div",
            { class: "aside" },
            ...motion,
            ...track(damagePlots(run, clock)),
            excavated ? new NowFacts(run, clock).element : null,
          )
        : null;
    parts.push(
      section(
        "animation",
        "Animation",
        h("div", { class: aside ? "follow" : "follow alone" }, animation.element, aside),
      ),
    );
    if (run.frameCount < header.recorded_frames) {
      parts.push(
        h(
          "p",
          { class: "hint" },
          `${integer(run.frameCount)} of ${count(header.recorded_frames, "recorded frame")} are in this page; all are in the result file.`,
        ),
      );
    }
  } else if (motion.length > 0) {
    parts.push(section("motion", "Ground motion of the base", h("div", { class: "plots" }, ...motion)));
  }
  const histories = historyPlots(run, clock);
  if (histories.length > 0) {
    parts.push(
      section(
        "histories",
        "Histories of chosen points",
        ...histories.flatMap(({ name, plots: made }) => [
          h("h3", {}, name),
          h("div", { class: "plots" }, ...track(made)),
        ]),
      ),
    );
  }
  parts.push(
    section(
      "quality",
      "Quality of the computation",
      qualityTable(run),
      h("div", { class: "plots" }, ...track(solverPlots(run, clock))),
    ),
  );
  const cutting = cuttingFacts(run);
  if (cutting) parts.push(section("cutting", "From joints to blocks", cutting));
  parts.push(conventions());
  main.replaceChildren(...parts.filter((p): p is Node => p instanceof Node));

  const themeChanged = () => {
    fields.readTheme();
    animation?.view.readTheme();
    pictures?.readTheme();
    drawn.forEach((d) => d.redraw());
    plots.forEach((p) => p.rebuild());
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", themeChanged);
  // Paper is white whatever the screen.
  whenPrinting(themeChanged);
}

void start(async (main) => {
  const { header, arrays } = await readPage();
  build(new Run(header, arrays), main);
});
