#!/usr/bin/env python3
"""A step without one of its accelerators, and without all: the same motion, more slowly."""

import unittest

from program import ROOT, Scenario

NAMES = (
    "kept-factor", "low-rank-update", "local-solve", "increment-history", "earlier-attempt",
    "steady-pairs", "single-precision",
)  # fmt: skip
# These do not change any bit of a small model that is factored.
SAME_BITS = ("local-solve", "steady-pairs", "single-precision")


class Accelerators(Scenario):
    def tunnel(self, *without):
        folder = "-".join(["out", *without])
        options = [word for name in without for word in ("--without", name)]
        self.keyblock(
            "run", ROOT / "examples/01-tunnel.toml", "-o", folder, "--set", "stage.quiet.duration=0.2",
            "--set", "stage.'first earthquake'.duration=0.2", "--set", "stage.after.duration=0.02", *options,
        )  # fmt: skip
        return self.summary(folder)

    def test_each_can_be_switched_off(self):
        whole = self.tunnel()
        slip = whole["stages"][-1]["damage"]["slip_max_m"]
        for without in (*[(name,) for name in NAMES], NAMES):
            with self.subTest(without=without):
                other = self.tunnel(*without)
                self.assertEqual(other["open_close"]["unconverged_steps"], 0)
                self.assertAlmostEqual(other["stages"][-1]["damage"]["slip_max_m"] / slip, 1.0, delta=0.01)
                if without[0] in SAME_BITS and len(without) == 1:
                    self.assertEqual(other["state_hash"], whole["state_hash"])
                if without == ("low-rank-update",):
                    self.assertNotEqual(other["state_hash"], whole["state_hash"])  # the switch does something

    def test_names_that_are_none(self):
        error = self.keyblock("run", "incline.toml", "-o", "out", "--without", "haste", expect=1).stderr
        self.assertIn("haste", error)


if __name__ == "__main__":
    unittest.main()
