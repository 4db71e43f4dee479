/** Numbers as a person reads them. A number that is not there (null, NaN) is a dash. */

type Number_ = number | null | undefined;
const missing = "–";
const minus = (text: string) => text.replace("-", "−");

function present(x: Number_): x is number {
  return typeof x === "number" && Number.isFinite(x);
}

/** `digits` significant digits, no exponent unless very large or small, thousands apart. */
export function significant(x: Number_, digits = 3): string {
  if (!present(x)) return missing;
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e7 || size < 1e-4) {
    const [mantissa, exponent] = x.toExponential(digits - 1).split("e");
    return minus(`${mantissa} × ${powerOfTen(Number(exponent))}`);
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return minus(rounded(x, 0, decimals));
}

export function powerOfTen(exponent: number): string {
  return `10${superscript(exponent)}`;
}

/** Halves go to the even digit, as in what the program prints. */
function rounded(x: number, least: number, most: number): string {
  return x.toLocaleString("en-US", {
    minimumFractionDigits: least,
    maximumFractionDigits: most,
    roundingMode: "halfEven",
  } as Intl.NumberFormatOptions);
}

function superscript(n: number): string {
  const digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
  return [...String(n)].map((c) => (c === "-" ? "⁻" : digits[Number(c)])).join("");
}

export function fixed(x: Number_, decimals: number): string {
  if (!present(x)) return missing;
  const text = rounded(x, decimals, decimals);
  return minus(/^-[0.,]*$/.test(text) ? text.slice(1) : text);
}

export function integer(x: Number_): string {
  return present(x) ? minus(Math.round(x).toLocaleString("en-US")) : missing;
}

/** With its sign always written: the difference to the row above. */
export function signed(x: Number_, decimals: number): string {
  if (!present(x)) return missing;
  const text = fixed(Math.abs(x), decimals);
  return /^[0.,]*$/.test(text) ? "±0" : (x < 0 ? "−" : "+") + text;
}

/** A length in the unit that suits its size. */
export function length(m: Number_, digits = 3): string {
  if (!present(m)) return missing;
  const size = Math.abs(m);
  if (size === 0) return "0 mm";
  if (size < 0.5e-6) return `${significant(m * 1e9, digits)} nm`;
  if (size < 0.5e-3) return `${significant(m * 1e6, digits)} µm`;
  if (size < 1) return `${significant(m * 1e3, digits)} mm`;
  return `${significant(m, digits)} m`;
}

export function stress(pa: Number_, digits = 3): string {
  if (!present(pa)) return missing;
  const size = Math.abs(pa);
  if (size < 1e3) return `${significant(pa, digits)} Pa`;
  if (size < 1e6) return `${significant(pa / 1e3, digits)} kPa`;
  return `${significant(pa / 1e6, digits)} MPa`;
}

/** A speed in mm/s or m/s. */
export function speed(v: Number_, digits = 3): string {
  return `${length(v, digits)}/s`;
}

export function duration(s: Number_): string {
  if (!present(s)) return missing;
  if (s < 120) return `${significant(s, 3)} s`;
  const seconds = Math.round(s);
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min ${seconds % 60} s`;
  const minutes = Math.round(s / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export function count(n: number, singular: string, plural = `${singular}s`): string {
  return `${integer(n)} ${n === 1 ? singular : plural}`;
}

export function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

export const quoted = (name: string) => `“${name}”`;

/** "a", "a and b", "a, b and c". */
export function list(items: readonly string[]): string {
  if (items.length < 2) return items.join("");
  return `${items.slice(0, -1).join(", ")} and ${items[items.length - 1]}`;
}

/** Of 1, 2, 5 times a power of ten: the largest that is not above x > 0. */
export function niceBelow(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x) + 1e-9);
  return [5, 2].map((m) => m * power).find((v) => v <= x * (1 + 1e-9)) ?? power;
}

/** Of the numbers 1, 2, 5 times a power of ten: the smallest that is not below x. */
export function niceAbove(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  for (const m of [1, 2, 5]) if (m * power >= x * (1 - 1e-9)) return m * power;
  return 10 * power;
}
