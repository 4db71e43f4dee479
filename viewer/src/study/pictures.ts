import { choice, h } from "../dom";
import { count, integer } from "../format";
import { Marginality, type Study } from "./data";
import { shownAs, withUnit } from "./quantities";
import type { Selection } from "./selection";

const area = "fallen_area_m2";

/** The end of a run as a picture that leads to its report, or why there is none. */
function pictureOf(study: Study, run: number, title: string): HTMLElement {
  const url = study.pictureUrl(run);
  const failed = !study.done[run];
  const inside = url
    ? h("img", { src: url, alt: `End of run ${study.keys[run]}`, loading: "lazy" })
    : h("span", { class: "no-picture" }, failed ? "failed" : "not in this page");
  const frame = study.hasReport[run]
    ? h(
        "a",
        { class: "run-picture", href: reportOf(study, run), title: `Report of ${study.keys[run]}` },
        inside,
      )
    : h("span", { class: "run-picture" }, inside);
  const marginal = study.marginal[run] === Marginality.yes;
  if (marginal) frame.classList.add("marginal");
  if (failed) frame.classList.add("failed");
  const q = shownAs(study.measure(area));
  const facts = failed
    ? study.errors[run] || "not measured"
    : `${withUnit(q, study.value(run, area))} fallen${study.after()}${marginal ? " · marginal" : ""}`;
  return h(
    "figure",
    { class: "run" },
    frame,
    h("figcaption", {}, h("strong", {}, title), h("span", {}, facts)),
  );
}

export function reportOf(study: Study, run: number): string {
  return `runs/${encodeURIComponent(study.keys[run])}/report.html`;
}

/** Worst and median run side by side, large. */
export class Extremes {
  readonly element = h("div", { class: "extremes" });

  constructor(
    private readonly study: Study,
    private readonly selection: Selection,
  ) {
    selection.onChange(() => this.draw());
    this.draw();
  }

  private draw(): void {
    const c = this.study.json.combinations[this.selection.combination];
    const figure = (name: string, key: string | null) => {
      const run = this.study.find(key);
      return run === undefined
        ? null
        : pictureOf(this.study, run, `${name}: realization ${this.study.realization[run]}`);
    };
    const figures = [figure("Worst", c?.worst ?? null), figure("Median", c?.median ?? null)];
    this.element.replaceChildren(...figures.filter((f) => f !== null));
  }
}

const pageSize = 240;

/** The ends of all realizations of the chosen combination. */
export class Gallery {
  readonly element: HTMLElement;
  private readonly grid = h("div", { class: "gallery" });
  private readonly more = h("div");
  private order: "realization" | "area" = "realization";

  constructor(
    private readonly study: Study,
    private readonly selection: Selection,
  ) {
    this.element = h(
      "div",
      {},
      h(
        "div",
        { class: "controls screen-only" },
        choice(
          "order",
          [
            { value: "realization", text: "by realization" },
            { value: "area", text: "most fallen first" },
          ],
          this.order,
          (value) => {
            this.order = value as "realization" | "area";
            this.draw();
          },
        ),
      ),
      this.grid,
      this.more,
    );
    selection.onChange(() => this.draw());
    this.draw();
  }

  private draw(): void {
    const { study } = this;
    const runs = study.runsOf(this.selection.combination);
    if (this.order === "area") {
      const key = (r: number) => (study.done[r] ? study.value(r, area) : -1);
      runs.sort((a, b) => key(b) - key(a));
    }
    this.grid.replaceChildren();
    this.add(runs, 0);
  }

  private add(runs: number[], from: number): void {
    const { study } = this;
    const part = runs.slice(from, from + pageSize);
    this.grid.append(...part.map((r) => pictureOf(study, r, `Realization ${study.realization[r]}`)));
    const left = runs.length - from - part.length;
    this.more.replaceChildren(
      left > 0
        ? h(
            "button",
            { type: "button", click: () => this.add(runs, from + pageSize) },
            `Show more (${integer(left)} left)`,
          )
        : "",
    );
  }
}

/** What pictures the page leaves out, if any. */
export function pictureNote(study: Study): string | null {
  const shown = study.pictureCount();
  if (shown < study.header.most_thumbnails) return null;
  return `This page holds the pictures of ${count(shown, "run")}: the worst and the median of every combination, then the first realizations. The others are in runs/KEY/thumbnail.svg.`;
}
