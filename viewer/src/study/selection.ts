import { choice, h } from "../dom";
import type { Study } from "./data";

/** Which combination and which measure the figures show. */
export class Selection {
  combination: number;
  measure: string;
  readonly element: HTMLElement;
  private readonly listeners: (() => void)[] = [];
  private readonly where = h("p", { class: "hint", role: "status" });

  constructor(private readonly study: Study) {
    this.combination = headline(study);
    const { measures } = study.json;
    this.measure = measures.some((m) => m.name === "fallen_area_m2")
      ? "fallen_area_m2"
      : (measures[0]?.name ?? "");
    this.element = h("div", { class: "selection screen-only", role: "group", "aria-label": "What is shown" });
    this.build();
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  select(combination: number): void {
    this.combination = combination;
    this.build();
    for (const listener of this.listeners) listener();
  }

  private build(): void {
    const { study } = this;
    const current = study.json.combinations[this.combination]?.values ?? [];
    const controls = h("div", { class: "controls" });
    study.json.axes.forEach((axis, a) => {
      if (axis.values.length < 2) return;
      controls.append(
        choice(
          study.axisName(a),
          axis.values.map((v) => ({ value: v, text: v })),
          current[a] ?? "",
          (value) => this.change(a, value),
        ),
      );
    });
    controls.append(
      choice(
        "measure",
        study.json.measures.map((m) => ({ value: m.name, text: m.title })),
        this.measure,
        (value) => {
          this.measure = value;
          for (const listener of this.listeners) listener();
        },
      ),
    );
    this.element.replaceChildren(controls, this.where);
  }

  private change(axis: number, value: string): void {
    const { combinations } = this.study.json;
    const wanted = [...(combinations[this.combination]?.values ?? [])];
    wanted[axis] = value;
    const found = combinations.findIndex((c) => c.values.every((v, a) => v === wanted[a]));
    this.where.textContent = found < 0 ? `No run of ${this.study.combinationName(wanted)} is there.` : "";
    this.select(found < 0 ? this.combination : found);
  }
}

/** The combination with the strongest shaking: the first of them. */
export function headline(study: Study): number {
  let best = 0;
  study.json.combinations.forEach((c, k) => {
    if (c.n > 0 && (c.pga_m_s2 ?? -1) > (study.json.combinations[best].pga_m_s2 ?? -1)) best = k;
  });
  return best;
}
