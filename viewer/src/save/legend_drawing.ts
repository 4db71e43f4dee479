import { place, ticks } from "../colors";
import { css } from "../dom";
import type { Legend } from "../fields";

const width = 330;
const gap = 40;
const barHeight = 12;

/** Height of legends that are drawn side by side, px. */
export function legendsHeight(legends: Legend[], whole: number): number {
  return 74 * Math.ceil(legends.length / columns(whole));
}

const columns = (whole: number) => Math.max(1, Math.floor((whole + gap) / (width + gap)));

/** Legends below a picture, on a canvas as in the page. */
export function drawLegends(
  c: CanvasRenderingContext2D,
  legends: Legend[],
  left: number,
  top: number,
  whole: number,
): void {
  legends.forEach((legend, k) => {
    const x = left + (width + gap) * (k % columns(whole));
    const y = top + 74 * Math.floor(k / columns(whole));
    drawLegend(c, legend, x, y);
  });
}

function drawLegend(c: CanvasRenderingContext2D, legend: Legend, x: number, y: number): void {
  c.textBaseline = "alphabetic";
  c.textAlign = "left";
  c.fillStyle = css("--ink");
  c.font = `bold 12px ${css("--font")}`;
  c.fillText(legend.title, x, y + 12);
  c.font = `11px ${css("--font")}`;
  let below = y + 34;
  if (legend.bar) {
    const { colors, scale, format } = legend.bar;
    colors.forEach((color, k) => {
      c.fillStyle = color;
      c.fillRect(x + (width * k) / colors.length, y + 18, width / colors.length + 0.6, barHeight);
    });
    c.fillStyle = css("--ink");
    c.fillText(format(scale.min), x, y + 43);
    const last = format(scale.max);
    c.textAlign = "right";
    c.fillText(last, x + width, y + 43);
    c.textAlign = "center";
    for (const value of ticks(scale, 4)) {
      const at = place(scale, value);
      if (at > 0.2 && at < 0.8) c.fillText(format(value), x + at * width, y + 43);
    }
    below = y + 58;
  }
  c.textAlign = "left";
  let along = x;
  for (const { color, name, line } of legend.classes ?? []) {
    c.fillStyle = color;
    c.fillRect(along, line ? below - 5 : below - 10, 18, line ? 3 : 11);
    c.fillStyle = css("--ink");
    c.fillText(name, along + 23, below);
    along += 36 + c.measureText(name).width;
  }
  if (!legend.note) return;
  c.fillStyle = css("--muted");
  c.font = `10px ${css("--font")}`;
  const words = legend.note.length > 68 ? `${legend.note.slice(0, 66)}…` : legend.note;
  c.fillText(words, x, legend.bar ? y + 58 : below + 16);
}
