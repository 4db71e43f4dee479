import { significant } from "../format";
import type { Estimate, Quantity } from "./data";

export interface Shown {
  name: string;
  title: string;
  unit: string;
  factor: number;
}

export function shownAs(q: Quantity): Shown {
  return { name: q.name, title: q.title, unit: q.shown_unit ?? q.unit, factor: q.shown_factor ?? 1 };
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
