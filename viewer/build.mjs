// node build.mjs [--out FILE] [--packages NODE_MODULES]: bundles src/ and uPlot into one HTML file, the template of report.html.
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));

function option(name, fallback) {
  const at = process.argv.indexOf(`--${name}`);
  return at < 0 ? fallback : resolve(process.argv[at + 1]);
}

const packages = option("packages", join(here, "node_modules"));
const out = option("out", join(here, "dist", "template.html"));
const esbuild = createRequire(join(packages, "index.js"))("esbuild");

async function bundle(entry) {
  const result = await esbuild.build({
    entryPoints: [join(here, "src", entry)],
    nodePaths: [packages],
    bundle: true,
    minify: true,
    write: false,
    target: "es2022",
    format: "iife",
    legalComments: "inline",
    logLevel: "warning",
  });
  return result.outputFiles[0].text.trim();
}

const parts = {
  style: await bundle("style.css"),
  script: (await bundle("main.ts")).replaceAll("</script", "<\\/script"),
};
const page = (await readFile(join(here, "src", "page.html"), "utf8")).replace(
  /@@(style|script)@@/g,
  (_, name) => parts[name],
);
for (const mark of ["@@title@@", "@@header@@", "@@arrays@@"]) {
  if (page.split(mark).length !== 2) throw new Error(`the page must hold ${mark} exactly once`);
}
await mkdir(dirname(out), { recursive: true });
await writeFile(out, page);
