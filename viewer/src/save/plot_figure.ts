import { place, ticks, type Scale } from "../colors";
import { css } from "../dom";
import { niceAbove, significant } from "../format";
import type { PlotOptions, Series } from "../plots";
import { csvText, fileWord, head, type Figure } from "./figure";

const width = 900;
const height = 420;
const left = 84;
const right = 24;
const bottom = 64;

const colorOf = (s: Series) => (s.color.startsWith("--") ? css(s.color) : s.color);

function scaleOf(options: PlotOptions): Scale {
  if (options.range) return { min: options.range[0], max: options.range[1], logarithmic: false };
  const values = options.series
    .flatMap((s) => Array.from(s.values))
    .filter((v): v is number => v !== null && Number.isFinite(v) && (!options.logarithmic || v > 0));
  const [low, high] = values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  if (!(low <= high)) return { min: 0, max: 1, logarithmic: false };
  if (options.logarithmic)
    return {
      min: 10 ** Math.floor(Math.log10(low)),
      max: 10 ** Math.max(Math.ceil(Math.log10(high)), Math.floor(Math.log10(low)) + 1),
      logarithmic: true,
    };
  const most = high > 0 ? niceAbove(high) : 0;
  const least = low < 0 ? -niceAbove(-low) : 0;
  return { min: least, max: most > least ? most : 1, logarithmic: false };
}

/** A plot with its title, axes and key, apart from the page's canvas. */
export function plotFigure(options: PlotOptions, run: string): Figure {
  const x: Scale = {
    min: options.xRange?.[0] ?? options.x[0] ?? 0,
    max: options.xRange?.[1] ?? options.x[options.x.length - 1] ?? 1,
    logarithmic: false,
  };
  if (!(x.max > x.min)) x.max = x.min + 1;
  return {
    name: fileWord(`${run.slice(0, 30)} ${options.title}`),
    title: `${options.title}, ${options.unit.replaceAll("_", "")}`,
    subtitle: run,
    width,
    height,
    draw: (c) => drawPlot(c, options, x, scaleOf(options)),
    csv: () =>
      csvText(
        [options.xName, ...options.series.map((s) => `${s.name || options.title} (${options.unit})`)],
        Array.from({ length: options.x.length }, (_, k) => [
          options.x[k],
          ...options.series.map((s) => s.values[k] ?? null),
        ]),
      ),
  };
}

function drawPlot(c: CanvasRenderingContext2D, options: PlotOptions, x: Scale, y: Scale): void {
  const box = { left, top: head + 10, width: width - left - right, height: height - head - 10 - bottom };
  const px = (v: number) => box.left + box.width * place(x, v);
  const py = (v: number) => box.top + box.height * (1 - place(y, v));
  c.font = `12px ${css("--font")}`;
  c.lineWidth = 1;
  const grid = (from: [number, number], to: [number, number]) => {
    c.strokeStyle = css("--grid");
    c.beginPath();
    c.moveTo(...from);
    c.lineTo(...to);
    c.stroke();
  };
  c.fillStyle = css("--ink");
  c.textBaseline = "middle";
  c.textAlign = "right";
  for (const v of ticks(y, 6)) {
    grid([box.left, py(v)], [box.left + box.width, py(v)]);
    c.fillText(significant(v, 4), box.left - 8, py(v));
  }
  c.textBaseline = "alphabetic";
  c.textAlign = "center";
  for (const v of ticks(x, 8)) {
    grid([px(v), box.top], [px(v), box.top + box.height]);
    c.fillText(significant(v, 4), px(v), box.top + box.height + 18);
  }
  c.fillText(options.xName, box.left + 0.5 * box.width, box.top + box.height + 36);
  c.strokeStyle = css("--axis");
  c.strokeRect(box.left, box.top, box.width, box.height);
  for (const s of options.series) drawSeries(c, s, options.x, px, py);
  drawKey(c, options, box.left, box.top + box.height + 54);
}

function drawSeries(
  c: CanvasRenderingContext2D,
  s: Series,
  x: ArrayLike<number>,
  px: (v: number) => number,
  py: (v: number) => number,
): void {
  c.strokeStyle = colorOf(s);
  c.lineWidth = s.width ?? 1.4;
  c.beginPath();
  let down = false;
  let before = 0;
  for (let k = 0; k < x.length; k++) {
    const v = s.values[k];
    if (v === null || v === undefined || !Number.isFinite(v)) {
      down = false;
      continue;
    }
    if (down && s.style === "steps") c.lineTo(px(x[k]), before);
    if (down) c.lineTo(px(x[k]), py(v));
    else c.moveTo(px(x[k]), py(v));
    [down, before] = [true, py(v)];
  }
  c.stroke();
}

function drawKey(c: CanvasRenderingContext2D, options: PlotOptions, from: number, y: number): void {
  if (options.series.length < 2) return;
  let at = from;
  c.textAlign = "left";
  for (const s of options.series) {
    c.fillStyle = colorOf(s);
    c.fillRect(at, y - 5, 18, 3);
    c.fillStyle = css("--ink");
    const name = s.name.replaceAll("_", "");
    c.fillText(name, at + 23, y);
    at += 42 + c.measureText(name).width;
  }
}
