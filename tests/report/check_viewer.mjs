// check_viewer.mjs VIEWER NODE_MODULES: types (tsc, strict) and formatting (prettier) of the report's page.
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

const [viewer, packages] = process.argv.slice(2);
// Beside a copy of the sources, because both tools look for packages above the files they read.
const copy = mkdtempSync(join(tmpdir(), "keyblock-viewer-"));
try {
  cpSync(viewer, copy, {
    recursive: true,
    filter: (path) => !["node_modules", "dist"].includes(basename(path)),
  });
  symlinkSync(packages, join(copy, "node_modules"));
  const run = spawnSync("npm", ["run", "check", "--silent"], {
    cwd: copy,
    stdio: "inherit",
  });
  process.exitCode = run.status ?? 1;
} finally {
  rmSync(copy, { recursive: true });
}
