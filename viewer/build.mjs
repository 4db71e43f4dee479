// node build.mjs [--out FOLDER] [--packages NODE_MODULES]: bundles src/ into two HTML files, the templates of report.html
// of a run (with uPlot) and of a study.
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
const out = option("out", join(here, "dist"));
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

/** One page: its styles and its program put into page.html. */
async function build(file, style, script) {
  const parts = {
    style: await bundle(style),
    script: (await bundle(script)).replaceAll("</script", "<\\/script"),
  };
  const page = (await readFile(join(here, "src", "page.html"), "utf8")).replace(
    /@@(style|script)@@/g,
    (_, name) => parts[name],
  );
  for (const mark of ["@@title@@", "@@header@@", "@@arrays@@"]) {
    if (page.split(mark).length !== 2) throw new Error(`the page must hold ${mark} exactly once`);
  }
  await writeFile(join(out, file), page);
}

await mkdir(out, { recursive: true });
await build("template.html", "style.css", "main.ts");
await build("study_template.html", "study/style.css", "study/main.ts");
