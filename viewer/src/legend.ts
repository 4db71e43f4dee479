import { place, ticks } from "./colors";
import { h } from "./dom";
import type { Legend } from "./fields";

/** A legend as HTML, so that it prints sharply and can be read out. */
export function legendElement(legend: Legend): HTMLElement {
  const box = h("div", { class: "legend" }, h("div", { class: "legend-title" }, legend.title));
  if (legend.bar) {
    const { colors, scale, format } = legend.bar;
    const bar = h("div", { class: "legend-bar", "aria-hidden": "true" });
    bar.style.background = `linear-gradient(to right, ${colors.join(",")})`;
    const labels = h("div", { class: "legend-ticks" });
    for (const value of ticks(scale, 4)) {
      const tick = h("span", {}, format(value));
      const at = 100 * place(scale, value);
      tick.style.left = `${at}%`;
      if (at < 6) tick.classList.add("first");
      else if (at > 94) tick.classList.add("last");
      labels.append(tick);
    }
    box.append(bar, labels);
  }
  if (legend.classes) {
    const list = h("ul", { class: "legend-classes" });
    for (const { color, name, line } of legend.classes) {
      const swatch = h("span", { class: line ? "swatch line" : "swatch" });
      swatch.style.background = color;
      list.append(h("li", {}, swatch, name));
    }
    box.append(list);
  }
  if (legend.note) box.append(h("div", { class: "legend-note" }, legend.note));
  return box;
}
