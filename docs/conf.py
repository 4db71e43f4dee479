"""The site of keyblock: `./dev docs` builds it from the pages of this folder into build/docs/html. Warnings are errors."""

import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILT = ROOT / "build/release/python"
sys.path.insert(0, str(BUILT if BUILT.exists() else ROOT / "python"))
sys.path.insert(0, str(ROOT / "docs"))

project = "keyblock"
author = "the keyblock maintainers"
copyright = "the keyblock maintainers"  # noqa: A001
release = re.search(r"VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text().split("project(", 1)[1]).group(1)

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "cpp_api"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["site"]
myst_heading_anchors = 5
myst_enable_extensions = ["dollarmath"] if os.environ.get("KEYBLOCK_DOLLARMATH") else []
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_mock_imports = [] if BUILT.exists() else ["keyblock._core", "keyblock._build"]
html_theme = "furo"
html_title = f"keyblock {release}"
html_show_sphinx = False
html_static_path = ["images"]
# Fonts and scripts are those of the theme: the site works offline.
html_theme_options = {"source_repository": "", "navigation_with_keys": True}
suppress_warnings = ["misc.highlighting_failure"]


# The table of known answers as `./dev docs` has let the program write it.
_table = ROOT / "build/docs/verification-results.md"
_page = _table.read_text() if _table.exists() else "# Problems with known answers: the table\n\nNot computed for this site: `keyblock verify --all`.\n"
(ROOT / "docs/verification-results.md").write_text(_page)


def _read_source(app, name, source):
    """Pages of the repository that are not of the site become plain words."""
    text = re.sub(r"\[([^\]]+)\]\((?:\.\./)+[^)]*\.md(?:#[^)]*)?\)(?<!docs)", _outside(app, name), source[0])
    source[0] = text.replace("](decisions/)", "](decisions/index.md)")


def _outside(app, name):
    folder = (pathlib.Path(app.srcdir) / name).parent

    def replace(match):
        target = match[0].rpartition("](")[2].rstrip(")").partition("#")[0]
        inside = (folder / target).resolve().is_relative_to(pathlib.Path(app.srcdir).resolve())
        return match[0] if inside else match[1]

    return replace


def _mark_examples(app, what, name, obj, options, lines):
    """Indented lines of a docstring are code."""
    marked, code = [], False
    for line in lines:
        starts = line.startswith("    ") and not code and (not marked or not marked[-1].strip())
        if starts:
            marked += ["::", ""]
        code = line.startswith("    ") or (code and not line.strip())
        marked.append(line)
    lines[:] = marked


def setup(app):
    app.connect("source-read", _read_source)
    app.connect("autodoc-process-docstring", _mark_examples)
