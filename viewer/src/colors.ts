/** Colours: perceptually uniform maps as a few anchors, between which is interpolated, and palettes for classes. */

export type Rgb = [number, number, number];

const parse = (hex: string): Rgb => [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16)) as Rgb;
const anchors = (text: string): Rgb[] => text.split(" ").map(parse);

export const viridis = anchors(
  "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725",
);
/** Magma from its second anchor on; its light end is paler here, so that rock at rest is calm. */
export const magma = anchors("150e38 3b0f70 641a80 8c2981 b73779 de4968 f7705c fe9f6d fecf92 f4efdf");
export const mako = anchors("2e1e3b 413d7b 37659e 348fa7 40b7ad 8bdab2 def5e5");

/** Colour of t in [0, 1]. */
export function sample(map: readonly Rgb[], t: number): string {
  const x = Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), 1) * (map.length - 1);
  const i = Math.min(Math.floor(x), map.length - 2);
  const a = map[i];
  const b = map[i + 1];
  const mixed = a.map((c, k) => Math.round(c + (x - i) * (b[k] - c)));
  return `rgb(${mixed.join(",")})`;
}

/** 64 colours of a map, so that drawing makes no strings. */
export function table(map: readonly Rgb[], reversed = false): string[] {
  return Array.from({ length: 64 }, (_, i) => sample(map, reversed ? 1 - i / 63 : i / 63));
}

/** For classes, told apart with defective colour vision, too (Okabe & Ito 2008). */
export const palette = [
  "#0072B2",
  "#D55E00",
  "#009E73",
  "#CC79A7",
  "#E69F00",
  "#56B4E9",
  "#7A5C00",
  "#B8A900",
];

/** A colour "rgb(r,g,b)" mixed with another, of which it keeps so large a share. */
export function mixed(color: string, with_: Rgb, share: number): string {
  const parts = /rgb\((\d+),(\d+),(\d+)\)/.exec(color);
  if (!parts) return color;
  return `rgb(${with_.map((c, k) => Math.round(share * Number(parts[k + 1]) + (1 - share) * c)).join(",")})`;
}

export function rgbOf(hex: string): Rgb {
  return parse(hex.slice(1));
}

export interface Scale {
  min: number;
  max: number;
  logarithmic: boolean;
}

/** Place of a value on a scale, 0 … 1, held at the ends. */
export function place(scale: Scale, value: number): number {
  const t = scale.logarithmic
    ? Math.log(Math.max(value, scale.min) / scale.min) / Math.log(scale.max / scale.min)
    : (value - scale.min) / (scale.max - scale.min);
  return t > 0 ? Math.min(t, 1) : 0;
}

/** Round values on a scale to write beside it. */
export function ticks(scale: Scale, wanted = 5): number[] {
  const found: number[] = [];
  if (scale.logarithmic) {
    const first = Math.ceil(Math.log10(scale.min) - 1e-9);
    for (let k = first; 10 ** k <= scale.max * (1 + 1e-9); k++) found.push(10 ** k);
    return found;
  }
  const rough = (scale.max - scale.min) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999) ?? rough;
  for (let k = Math.ceil(scale.min / step - 1e-9); k * step <= scale.max + 1e-9 * step; k++)
    found.push(k * step);
  return found;
}
