import { h, section, type Child } from "../dom";
import { findingList } from "../findings";
import { count, integer } from "../format";
import { whenPrinting } from "../printing";
import { readStudy, type Study } from "./data";
import { dependenceTable } from "./dependence";
import { Distribution } from "./distribution";
import { resultSection } from "./first_screen";
import { FragilityView, probabilityTable } from "./fragility";
import { FrequencyMaps } from "./frequency_map";
import { Extremes, Gallery, pictureNote } from "./pictures";
import { Selection } from "./selection";
import { failedTable, howComputed, MeasureTables, RunTable } from "./tables";
import { studyFindings } from "./verdict";
import { start } from "../start";

function head(study: Study): HTMLElement {
  const { title, realizations, combinations } = study.json;
  return h(
    "header",
    {},
    h("h1", {}, title || "Untitled study"),
    h(
      "div",
      { class: "subtitle" },
      `${count(realizations, "realization")} of the joints × ${count(combinations.length, "combination")} of values`,
    ),
  );
}

/** The name of the chosen combination, which follows the selection. */
function chosenName(study: Study, selection: Selection): HTMLElement {
  const name = h("p", { class: "chosen" });
  const write = () => {
    const c = study.json.combinations[selection.combination];
    name.textContent = c ? `${study.combinationName(c.values)}: ${count(c.n, "realization")}` : "";
  };
  selection.onChange(write);
  write();
  return name;
}

/** Maps and pictures have no beginning but the excavation, unlike the numbers beside them. */
function wholeHistory(study: Study): HTMLElement | null {
  const { since, at_shaking } = study.json;
  if (!since) return null;
  const text = at_shaking
    ? "Everything since the first excavation: what gravity brought down before the shaking, too."
    : `Everything since the first excavation, not only what came after “${since}”.`;
  return h("p", { class: "hint" }, text);
}

/** Numbers that are differences, where the study measures from a later stage on. */
function onlyLater(study: Study): HTMLElement | null {
  const { stage, since, at_shaking } = study.json;
  if (!since) return null;
  const last = at_shaking ? ", the last stage before the shaking" : "";
  const end = stage ? `“${stage}”` : "the last stage";
  return h(
    "p",
    { class: "hint" },
    `Measures are differences: what was there at the end of ${end} less what was there at the end of “${since}”${last}.`,
  );
}

function statistics(study: Study, selection: Selection): Child[] {
  const { levels, fragility, grid } = study.json;
  const parts: Child[] = [];
  if (fragility.length > 0) parts.push(new FragilityView(study).element);
  if (levels.length > 0) parts.push(section("levels", "Probability of damage", probabilityTable(study)));
  parts.push(
    section(
      "distribution",
      "How much, and how sure",
      chosenName(study, selection),
      onlyLater(study),
      new Distribution(study, selection).element,
    ),
  );
  if (study.json.combinations.some((c) => c.hangs_on.length > 0))
    parts.push(section("hangs-on", "What it hangs on", dependenceTable(study)));
  const mapped = study.json.combinations.some((c) => c.map.n > 0);
  if (mapped && grid.columns > 0) {
    const map = new FrequencyMaps(study, selection);
    parts.push(
      section("map", "Where rock falls", chosenName(study, selection), wholeHistory(study), map.element),
    );
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => map.draw());
    whenPrinting(() => map.draw());
  }
  parts.push(
    section("measures", "Measures of damage", onlyLater(study), new MeasureTables(study, selection).element),
  );
  return parts;
}

function runs(study: Study, selection: Selection): Child[] {
  const parts: Child[] = [];
  const note = pictureNote(study);
  if (study.pictureCount() > 0)
    parts.push(
      section(
        "extremes",
        "Worst and median run",
        chosenName(study, selection),
        wholeHistory(study),
        new Extremes(study, selection).element,
        legend(),
      ),
      section(
        "gallery",
        "Every realization at the end",
        chosenName(study, selection),
        wholeHistory(study),
        note ? h("p", { class: "hint" }, note) : null,
        new Gallery(study, selection).element,
      ),
    );
  parts.push(
    section(
      "runs",
      "All runs",
      h(
        "p",
        {},
        "The same as files: ",
        h("a", { href: "runs.csv" }, "runs.csv"),
        ", one row per run with all stages, and ",
        h("a", { href: "study.json" }, "study.json"),
        ", the statistics.",
      ),
      onlyLater(study),
      new RunTable(study).element,
    ),
  );
  const failed = failedTable(study);
  const missing = Math.max(0, study.json.runs.planned - study.json.runs.done - study.json.runs.failed);
  if (failed || missing > 0)
    parts.push(
      section(
        "failed",
        "Failed and missing runs",
        failed,
        missing > 0
          ? h("p", {}, `${integer(missing)} of ${count(study.json.runs.planned, "planned run")} missing.`)
          : null,
      ),
    );
  return parts;
}

/** Colours of the pictures. */
function legend(): HTMLElement {
  const list = h("ul", { class: "legend-classes" });
  for (const [color, name] of [
    ["var(--rock)", "in place"],
    ["#e69f00", "loosened"],
    ["#d55e00", "fallen"],
  ]) {
    const swatch = h("span", { class: "swatch" });
    swatch.style.background = color;
    list.append(h("li", {}, swatch, name));
  }
  return list;
}

function build(study: Study, main: HTMLElement): void {
  const findings = studyFindings(study);
  const parts: Child[] = [head(study)];
  if (study.json.combinations.length > 0) {
    const selection = new Selection(study);
    parts.push(
      selection.element,
      resultSection(study, selection, findings),
      ...statistics(study, selection),
      ...runs(study, selection),
    );
  } else {
    const [verdict, ...others] = findings;
    parts.push(section("verdict", "Result", h("p", { class: "verdict" }, verdict.text), findingList(others)));
  }
  parts.push(section("method", "How it was computed", howComputed(study)));
  main.replaceChildren(...parts.filter((p): p is Node => p instanceof Node));
}

void start(async (main) => build(await readStudy(), main));
