import { css, h } from "../dom";
import { SvgContext } from "./svg_context";
import { recordPaths } from "./path";

/** What can leave the page: drawn on any context, in px, with its title; and its numbers. */
export interface Figure {
  /** A part of the file name: says what it is. */
  name: string;
  title: string;
  /** Where in the run it is. */
  subtitle: string;
  width: number;
  height: number;
  /** Below the title, whose height is `head`. */
  draw: (c: CanvasRenderingContext2D, ratio: number) => void;
  csv: () => string;
}

export const head = 56;
const edge = 16;
const pngScale = 3;

export function drawFigure(figure: Figure, c: CanvasRenderingContext2D, ratio: number): void {
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.fillStyle = css("--paper");
  c.fillRect(0, 0, figure.width, figure.height);
  c.textAlign = "left";
  c.textBaseline = "alphabetic";
  c.fillStyle = css("--ink");
  c.font = `bold 16px ${css("--font")}`;
  c.fillText(figure.title, edge, 24);
  c.font = `13px ${css("--font")}`;
  c.fillText(figure.subtitle, edge, 44);
  figure.draw(c, ratio);
}

export function asSvg(figure: Figure): string {
  const { context, svg } = SvgContext.on();
  recordPaths(() => drawFigure(figure, context, 1));
  return svg.text(figure.width, figure.height);
}

export function asCanvas(figure: Figure, ratio: number): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(figure.width * ratio);
  canvas.height = Math.round(figure.height * ratio);
  drawFigure(figure, canvas.getContext("2d", { alpha: false })!, ratio);
  return canvas;
}

/** A title as a part of a file name: small letters, digits and hyphens. */
export const fileWord = (text: string): string =>
  text
    .toLowerCase()
    .replace(/[^a-z0-9.]+/g, "-")
    .replace(/^-+|-+$/g, "")
    .slice(0, 60) || "figure";

export function save(blob: Blob, name: string): void {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** The buttons SVG, PNG and CSV of a figure, which is made when one is pressed. */
export function saveButtons(figure: () => Figure, ...more: Node[]): HTMLElement {
  const button = (text: string, label: string, action: (made: Figure) => void) =>
    h("button", { type: "button", title: label, "aria-label": label, click: () => action(figure()) }, text);
  return h(
    "span",
    { class: "save screen-only" },
    button("SVG", "Save as SVG, with legend and title", (made) =>
      save(new Blob([asSvg(made)], { type: "image/svg+xml" }), `${made.name}.svg`),
    ),
    button("PNG", "Save as PNG, three pixels for each of the page", (made) =>
      asCanvas(made, pngScale).toBlob((blob) => blob && save(blob, `${made.name}.png`)),
    ),
    button("CSV", "Save its numbers as CSV", (made) =>
      save(new Blob([made.csv()], { type: "text/csv" }), `${made.name}.csv`),
    ),
    ...more,
  );
}

/** Rows as CSV; texts are quoted where they must be. */
export function csvText(head: string[], rows: (string | number | null)[][]): string {
  const cell = (value: string | number | null) => {
    const text = value === null || Number.isNaN(value) ? "" : String(value);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [head, ...rows].map((row) => row.map(cell).join(",") + "\n").join("");
}
