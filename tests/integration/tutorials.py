#!/usr/bin/env python3
"""The tutorials, line by line: what they tell a reader to type works."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from program import PROGRAM, ROOT

BLOCK = re.compile(r"^```(?P<kind>sh|python)\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL)


class Tutorials(unittest.TestCase):
    def follow(self, name):
        text = (ROOT / "docs/tutorials" / f"{name}.md").read_text()
        environment = {
            **os.environ,
            "PATH": f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}",
            "PYTHONPATH": str(pathlib.Path(PROGRAM).parent / "python"),
        }
        with tempfile.TemporaryDirectory() as folder:
            for block in BLOCK.finditer(text):
                command = ["bash", "-euc"] if block["kind"] == "sh" else [sys.executable, "-c"]
                done = subprocess.run([*command, block["code"]], cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
                self.assertEqual(done.returncode, 0, f"{name}: {block['code']}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")

    def test_a_first_block(self):
        self.follow("first-block")

    def test_own_tunnel(self):
        self.follow("own-tunnel")

    def test_study(self):
        self.follow("study")

    def test_slope(self):
        self.follow("slope")

    def test_masonry(self):
        self.follow("masonry")

    def test_arch(self):
        self.follow("arch")


if __name__ == "__main__":
    unittest.main()
