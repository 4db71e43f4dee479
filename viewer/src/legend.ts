import { place, ticks, type Scale } from "./colors";
import { h, textWidths } from "./dom";
import type { Legend } from "./fields";

/** Of .legend-bar and .legend in style.css, px. */
const barWidth = 360;
const fontSize = 12.5;
/** Between labels, px. */
const space = 8;

/** A legend as HTML, so that it prints sharply and can be read out. */
export function legendElement(legend: Legend): HTMLElement {
  const box = h("div", { class: "legend" }, h("div", { class: "legend-title" }, legend.title));
  if (legend.bar) {
    const { colors, scale, format } = legend.bar;
    const bar = h("div", { class: "legend-bar", "aria-hidden": "true" });
    bar.style.background = `linear-gradient(to right, ${colors.join(",")})`;
    const labels = h("div", { class: "legend-ticks" });
    const write = (width: number) => {
      labels.replaceChildren();
      for (const { value, text, align } of barLabels(scale, format, width)) {
        const tick = h("span", { class: align }, text);
        tick.style.left = `${100 * place(scale, value)}%`;
        labels.append(tick);
      }
    };
    write(barWidth);
    // A narrow window has a shorter bar.
    new ResizeObserver(() => {
      if (labels.clientWidth > 0) write(labels.clientWidth);
    }).observe(labels);
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

interface BarLabel {
  value: number;
  text: string;
  align: "first" | "middle" | "last";
}

/** Labels of a colour bar: its two ends, and of the round values between them those that do not run into others. */
function barLabels(scale: Scale, format: (value: number) => string, barLength: number): BarLabel[] {
  const labels: BarLabel[] = [
    { value: scale.min, text: format(scale.min), align: "first" },
    { value: scale.max, text: format(scale.max), align: "last" },
  ];
  const between = ticks(scale, 4).map((value): BarLabel => ({ value, text: format(value), align: "middle" }));
  const widths = textWidths(
    [...labels, ...between].map((l) => l.text),
    fontSize,
  );
  const taken = labels.map((l, k) => reach(l, scale, barLength, widths[k]));
  for (const [k, label] of between.entries()) {
    const [from, to] = reach(label, scale, barLength, widths[2 + k]);
    if (taken.some(([a, b]) => from < b && a < to)) continue;
    taken.push([from, to]);
    labels.push(label);
  }
  return labels;
}

/** From where to where a label reaches, px, with half of the space to its neighbours on both sides. */
function reach(label: BarLabel, scale: Scale, barLength: number, width: number): [number, number] {
  const x = barLength * place(scale, label.value);
  const from = label.align === "first" ? x : label.align === "last" ? x - width : x - 0.5 * width;
  return [from - 0.5 * space, from + width + 0.5 * space];
}
