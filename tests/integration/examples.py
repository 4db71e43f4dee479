#!/usr/bin/env python3
"""Every example is without mistakes and runs: all its stages, each cut short."""

import tomllib
import unittest

from program import ROOT, Scenario

EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))


def shortened(path):
    """Overrides that leave a few steps of each stage."""
    scenario = tomllib.loads(path.read_text())
    step = scenario["time"]["step"]
    for index, stage in enumerate(scenario["stage"]):
        key = f"stage.{index}."
        yield f"{key}max_steps=5" if stage["kind"] == "settle" else f"{key}duration={10 * step}"


class Examples(Scenario):
    def test_are_numbered_without_gaps(self):
        self.assertEqual([p.name[:2] for p in EXAMPLES], [f"{k + 1:02}" for k in range(len(EXAMPLES))])
        self.assertGreater(len(EXAMPLES), 0)

    def test_check_finds_nothing(self):
        for path in EXAMPLES:
            with self.subTest(path.name):
                done = self.keyblock("check", path)
                self.assertIn(": ok", done.stdout)
                self.assertEqual(done.stderr, "")

    def test_run(self):
        for path in EXAMPLES:
            with self.subTest(path.name):
                overrides = [word for override in shortened(path) for word in ("--set", override)]
                self.keyblock("run", path, "-o", path.stem, *overrides)
                stages = self.summary(path.stem)["stages"]
                self.assertEqual([s["interrupted"] for s in stages], [False] * len(overrides[::2]))
                self.assertTrue(all(s["steps"] > 0 for s in stages))


if __name__ == "__main__":
    unittest.main()
