#!/usr/bin/env python3
"""The site is built without a warning, and each page of docs/ is in it. Skipped (77) without Sphinx, MyST and furo, unless CI is set."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Of the C++ headers: some of each kind, the last ones of their headers among them.
PUBLIC = ["cut(int realization = 0)", "bool advance()", "hooks", "block_b", "run_of_study(", "collect_study(", "missing", "frame(std::size_t k)", "hint",
          "RunError", "set_motion_scale(double factor)", "char *version()", "while (run.advance())"]  # fmt: skip
PRIVATE = ["parts_", "Document", "Override", "KEYBLOCK_API", "nodiscard", "///"]


def main():
    missing = [name for name in ("sphinx", "myst_parser", "furo") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"not installed: {', '.join(missing)}", file=sys.stderr)
        return 1 if os.environ.get("CI") else 77
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        words = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-d", out / "trees", ROOT / "docs", out / "html"]
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
        print(done.stdout, done.stderr)
        if done.returncode != 0:
            return 1
        lost = [page for page in sorted((ROOT / "docs").rglob("*.md")) if not (out / "html" / page.relative_to(ROOT / "docs").with_suffix(".html")).exists()]
        print("pages that are not there:", lost)
        names = re.sub(r"<[^>]*>", "", (out / "html/cpp-api.html").read_text())
        wrong = [name for name in PUBLIC if name not in names] + [name for name in PRIVATE if name in names]
        print("names of C++ that are not there, or should not be:", wrong)
        return 1 if lost or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
