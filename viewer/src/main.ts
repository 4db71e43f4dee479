import { Animation } from "./animation";
import { Clock } from "./clock";
import { damageTables } from "./damage_tables";
import { readPage, type Header } from "./data";
import { h, section, type Child } from "./dom";
import { Fields } from "./fields";
import { FinalPicture } from "./final_picture";
import { NowFacts } from "./now_facts";
import { count, integer } from "./format";
import { Pictures } from "./pictures";
import type { Plot } from "./plots";
import { whenPrinting } from "./printing";
import { releasePlots } from "./release_plots";
import { damagePlots, historyPlots, motionPlots, solverPlots } from "./run_plots";
import { resultSection } from "./result";
import { Run } from "./run";
import {
  cuttingFacts,
  breakTable,
  elementTable,
  movingTable,
  programFacts,
  qualityTable,
  stageTable,
} from "./tables";
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
        "Displacement and velocity are relative to the base, whose acceleration the ground motion is. Displacements of blocks are against the fixed blocks, too, where all of these are moved alike. Static steps take no simulated time.",
      ),
      item(
        "Slip is the shear displacement of the two sides of a joint against each other since the excavation; gap is the opening normal to it, negative where contact springs are compressed.",
      ),
      item(
        "A block has fallen when it has moved down, or into the opening, by more than the limit of the scenario: by default 5 % of the width of the opening, and without an opening half of √(area of the block). Loosened means moved by more than 1 cm, or the limit of the scenario, without having fallen. Blocks move against the base: the fixed blocks, where they move alike. Damage is cumulative since the first excavation; the user guide has the definitions.",
      ),
      item(
        "Energies: kinetic + strain + gravity + contact + friction + damping + radiated + numerical − input − water = residual, where friction, damping, radiated and numerical are losses and input is the work of motion, loads and supports, water that of the pressure of water.",
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
  const final = run.frameCount > 0 ? new FinalPicture(run, fields) : null;
  if (final) drawn.push(final);
  if (animation) drawn.push(animation);
  if (pictures) drawn.push(pictures);

  const showBlock = (block: number, stage: number) => {
    clock.pause();
    const frame = run.lastFrame(stage);
    if (frame >= 0) clock.seek(frame);
    animation?.showBlock(block);
  };
  const parts: Child[] = [
    animation
      ? h("button", { type: "button", class: "skip", click: () => animation.focusPlay() }, "To the animation")
      : null,
    head(header),
    resultSection(run, final?.element ?? null, movingTable(run, showBlock)),
  ];
  if (run.stages.length > 0) parts.push(section("stages", "Stages", stageTable(run)));
  const elements = elementTable(run);
  if (elements)
    parts.push(
      section(
        "elements",
        "Elements",
        elements,
        h(
          "p",
          { class: "hint" },
          "Springs, supports, sides of the boundary and walls under pressure. Forces are per metre of thickness. Of springs tension is positive; of all else the force is the size of the resultant.",
        ),
      ),
    );
  const breaks = breakTable(run);
  if (breaks)
    parts.push(
      section(
        "breaks",
        "What broke",
        breaks,
        h(
          "p",
          { class: "hint" },
          "An event is a contact that loses its bond, or all that slip or opening take from its strength, or an element that ruptures. All events are in result.h5 and breaks.csv.",
        ),
      ),
    );
  const damage = damageTables(run);
  if (damage.length > 0) parts.push(section("damage", "Damage by stage", ...damage));
  const release = track(releasePlots(run, clock));
  if (release.length > 0)
    parts.push(
      section(
        "release",
        "Ground reaction",
        h(
          "p",
          { class: "hint" },
          "How far the wall has come into the opening since it was opened, over the share of the forces of the excavated rock that acts no more. Each dot is an equilibrium.",
        ),
        h("div", { class: "plots" }, ...release),
      ),
    );
  if (pictures) parts.push(section("states", "The blocks before and after each stage", pictures.element));
  const motion = track(motionPlots(run, clock));
  if (animation) {
    const falls =
      run.header.model.excavations.length > 0 || run.stages.some((s) => s.damage.fallen_blocks > 0);
    const aside =
      motion.length > 0 || falls
        ? h(
            "div",
            { class: "aside" },
            ...motion,
            ...track(damagePlots(run, clock)),
            falls ? new NowFacts(run, clock).element : null,
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
        (run.header.model.element_histories?.length ?? 0) > 0
          ? "Histories of chosen points and elements"
          : "Histories of chosen points",
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
  parts.push(
    section(
      "run",
      "How it was computed",
      programFacts(run),
      header.model.scenario
        ? h(
            "details",
            {},
            h("summary", {}, "The scenario, as run"),
            h("pre", {}, h("code", {}, header.model.scenario)),
          )
        : null,
    ),
  );
  parts.push(conventions());
  main.replaceChildren(...parts.filter((p): p is Node => p instanceof Node));

  const themeChanged = () => {
    fields.readTheme();
    animation?.view.readTheme();
    pictures?.readTheme();
    final?.readTheme();
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
