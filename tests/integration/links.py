#!/usr/bin/env python3
"""Links in the pages of the repository lead to files, and to headings, that are there."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[2]

FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"\]\((?P<target>[^)\s]+)(?:\s+\"[^\"]*\")?\)")
HEADING = re.compile(r"^#+\s+(?P<text>.*?)\s*#*$", re.MULTILINE)


def anchor(heading):
    """As GitHub and most others make it: lower case, no punctuation, hyphens for spaces."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors(page):
    return {anchor(match["text"]) for match in HEADING.finditer(FENCE.sub("", page.read_text()))}


def problems(root, pages):
    for page in pages:
        text = CODE.sub("", FENCE.sub("", (root / page).read_text()))
        for match in LINK.finditer(text):
            target = match["target"]
            if re.match(r"[a-z]+:", target):
                continue
            path, _, heading = unquote(target).partition("#")
            file = (root / page).parent / path if path else root / page
            if not file.exists():
                yield f"{page}: {target} does not exist"
            elif heading and file.suffix == ".md" and heading not in anchors(file):
                yield f"{page}: {target} is no heading"


def pages_of(root):
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=root, capture_output=True, text=True
    )
    if listed.returncode == 0:
        return [name for name in listed.stdout.split("\n") if name and (root / name).is_file()]
    return [str(p.relative_to(root)) for p in root.rglob("*.md") if not {"build", "node_modules"} & set(p.parts)]


class Repository(unittest.TestCase):
    def test_links_lead_somewhere(self):
        pages = pages_of(ROOT)
        self.assertIn("README.md", pages)
        self.assertEqual(list(problems(ROOT, pages)), [])


class Checker(unittest.TestCase):
    def found(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "a.md").write_text(text)
            (root / "b.md").write_text("# One & two: `three`\n```\n# no heading\n```\n")
            return list(problems(root, ["a.md"]))

    def test_good_links(self):
        self.assertEqual(self.found("# Top\n[b](b.md) [h](b.md#one--two-three) [t](#top) [w](https://x.org/y) ![i](b.md)"), [])

    def test_code_holds_no_links(self):
        self.assertEqual(self.found("`[b](c.md)`\n```\n[b](c.md)\n```\n"), [])

    def test_missing_file(self):
        self.assertEqual(self.found("[b](c.md)"), ["a.md: c.md does not exist"])

    def test_missing_heading(self):
        self.assertEqual(self.found("[b](b.md#no-heading)"), ["a.md: b.md#no-heading is no heading"])


if __name__ == "__main__":
    unittest.main()
