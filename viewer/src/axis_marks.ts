import { ticks } from "./colors";
import { fixed } from "./format";

export interface Mark {
  value: number;
  text: string;
}

/** Round values between two others, written with as many decimals as tell them apart. */
export function marks(min: number, max: number, wanted: number): Mark[] {
  const values = ticks({ min, max, logarithmic: false }, wanted);
  const step = values.length > 1 ? values[1] - values[0] : max - min;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-6));
  return values.map((value) => ({ value, text: fixed(value, decimals) }));
}
