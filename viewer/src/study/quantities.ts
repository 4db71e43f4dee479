import { significant } from "../format";
import type { Estimate, Quantity } from "./data";

/** In what unit a measure is shown, where that is not its own. */
const shown: Record<string, { factor: number; unit: string }> = {
  fallen_weight_n_m: { factor: 1e-3, unit: "kN/m" },
  largest_fallen_weight_n_m: { factor: 1e-3, unit: "kN/m" },
  largest_block_pressure_pa: { factor: 1e-3, unit: "kPa" },
  opening_filled_ratio: { factor: 100, unit: "%" },
  displacement_max_m: { factor: 1e3, unit: "mm" },
  slip_max_m: { factor: 1e3, unit: "mm" },
  slip_max_ever_m: { factor: 1e3, unit: "mm" },
  slip_mean_m: { factor: 1e3, unit: "mm" },
  opening_max_m: { factor: 1e3, unit: "mm" },
  opening_max_ever_m: { factor: 1e3, unit: "mm" },
  closure_vertical_m: { factor: 1e3, unit: "mm" },
  closure_horizontal_m: { factor: 1e3, unit: "mm" },
};

export interface Shown {
  name: string;
  title: string;
  unit: string;
  factor: number;
}

export function shownAs(q: Quantity): Shown {
  const own = shown[q.name] ?? { factor: 1, unit: q.unit };
  return { name: q.name, title: q.title, ...own };
}

/** "fallen area (m²)" */
export function label(q: Shown): string {
  return q.unit ? `${q.title} (${q.unit})` : q.title;
}

export function scaled(q: Shown, x: number | null): number | null {
  return x === null || !Number.isFinite(x) ? null : q.factor * x;
}

/** The number alone. */
export function plain(q: Shown, x: number | null, digits = 3): string {
  return significant(scaled(q, x), digits);
}

export function withUnit(q: Shown, x: number | null, digits = 3): string {
  const text = plain(q, x, digits);
  if (q.unit === "" || text === "–") return text;
  return q.unit === "°" ? `${text}°` : `${text}\u00a0${q.unit}`;
}

/** "0.8 … 1.4"; a dash where there is no interval. */
export function interval(q: Shown, e: { low: number | null; high: number | null }, digits = 3): string {
  return e.low === null || e.high === null ? "–" : `${plain(q, e.low, digits)} … ${plain(q, e.high, digits)}`;
}

/** Half the width of an interval over its estimate; null where that says nothing. */
export function relativeHalfWidth(e: Estimate): number | null {
  if (e.value === null || e.low === null || e.high === null || !(Math.abs(e.value) > 0)) return null;
  return (0.5 * (e.high - e.low)) / Math.abs(e.value);
}

export function percent(p: number | null, digits = 2): string {
  return p === null ? "–" : `${significant(100 * p, digits)}\u00a0%`;
}

/** "25–44 %": of a proportion, in whole per cent. */
export function percentRange(low: number | null, high: number | null): string {
  if (low === null || high === null) return "–";
  return `${Math.round(100 * low)}\u2060–\u2060${Math.round(100 * high)}\u00a0%`; // word joiners: no break at the dash
}
