// format_test.mjs VIEWER NODE_MODULES: numbers as the report writes them (format.ts).
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import test from "node:test";

const [viewer, packages] = process.argv.slice(2);
const { build } = createRequire(resolve(packages, "unused.js"))("esbuild");
const bundle = await build({
  entryPoints: [join(viewer, "src/format.ts")],
  bundle: true,
  format: "esm",
  write: false,
});
const source = Buffer.from(bundle.outputFiles[0].text).toString("base64");
const format = await import(`data:text/javascript;base64,${source}`);

/** Of each case: what is expected, and the arguments. */
function check(name, cases) {
  test(name, () => {
    for (const [expected, ...values] of cases)
      assert.equal(format[name](...values), expected, `${name}(${values})`);
  });
}

check("duration", [
  ["–", null],
  ["0 s", 0],
  ["0.193 s", 0.1934],
  ["120 s", 119.9],
  ["2 min 0 s", 120],
  ["2 min 0 s", 120.4],
  ["2 min 1 s", 120.6],
  ["119 min 59 s", 7199.4],
  ["2 h 0 min", 7199.6],
  ["2 h 1 min", 7261],
  ["27 h 47 min", 99999],
]);
check("significant", [
  ["–", Number.NaN],
  ["0", 0],
  ["0", -0],
  ["−1.23", -1.234],
  ["12,300", 12300, 3],
  ["12,345", 12345.4, 3],
  ["1", 0.99996],
  ["0.0001", 0.0001],
  ["9.99 × 10⁻⁵", 0.0000999],
  ["1.00 × 10⁷", 1e7],
  ["−2.5 × 10¹²", -2.5e12, 2],
]);
check("fixed", [
  ["–", undefined],
  ["0.00", -0.004, 2],
  ["−0.01", -0.006, 2],
  ["1,234.5", 1234.5, 1],
]);
check("signed", [
  ["±0", 0, 2],
  ["±0", -0.004, 2],
  ["+0.01", 0.01, 2],
  ["−12.8", -12.82, 1],
]);
check("integer", [
  ["–", Number.POSITIVE_INFINITY],
  ["−1,000", -1000],
]);
check("length", [
  ["0 mm", 0],
  ["12 nm", 1.2e-8],
  ["7.67 µm", 7.67e-6],
  ["−2.02 mm", -0.00202],
  ["5.5 m", 5.5],
]);
check("stress", [
  ["999 Pa", 999],
  ["−1 kPa", -1000],
  ["2.5 MPa", 2.5e6],
]);
check("count", [
  ["1 block", 1, "block"],
  ["0 blocks", 0, "block"],
  ["1,609 vertices", 1609, "vertex", "vertices"],
]);
check("list", [
  ["", []],
  ["a", ["a"]],
  ["a and b", ["a", "b"]],
  ["a, b and c", ["a", "b", "c"]],
]);
check("niceAbove", [
  [1, 1],
  [2, 1.0001],
  [0.5, 0.3],
  [10, 5.1],
  [200, 200],
]);
