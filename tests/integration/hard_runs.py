#!/usr/bin/env python3
"""Scenarios whose steps are hard: soft rock, long steps, fast impacts. They end, each step converges, and no block lies in another."""

import unittest

from program import ROOT, Scenario

FOLDER = ROOT / "tests/data/hard"


class HardRuns(Scenario):
    def ends(self, name, overlap, residual):
        """Runs the scenario; bounds of the largest overlap, m, and of the energy residual, as a share."""
        self.keyblock("run", FOLDER / f"{name}.toml", "-o", name, "--threads", 1)
        summary = self.summary(name)
        self.assertEqual(summary["open_close"]["unconverged_steps"], 0, name)
        self.assertLess(summary["max_overlap_m"], overlap, name)
        self.assertLess(abs(summary["energy"]["residual_ratio"]), residual, name)
        return summary

    def test_an_excavation_among_blocks_that_are_held_fast(self):
        # The inertia of a block that a static step holds is 10 to the 9 springs.
        self.ends("held-excavation", 1e-4, 0.01)

    def test_stones_that_fall_on_soft_joints_in_long_steps(self):
        # Of a stone of 10 m2 that falls by 5 m the springs take 25 mm.
        self.ends("soft-joints", 0.025, 0.01)

    def test_blocks_that_fall_far(self):
        # At 40 m/s the springs of blocks of 2 m take some 60 mm.
        self.ends("free-fall", 0.06, 0.01)

    def test_average_acceleration(self):
        self.ends("average-acceleration", 1e-3, 0.01)

    def test_stiff_joints_and_blocks_of_order_2(self):
        self.ends("stiff-joints-order-2", 3e-3, 0.01)

    def test_a_stack_that_tilts_in_static_steps(self):
        # Contacts did 6 % of the energy over what turning made them miss.
        self.ends("tilting-stack", 1e-4, 0.002)

    def test_a_column_that_begins_to_rock(self):
        self.ends("rocking-column", 1e-4, 0.002)

    def test_rock_that_is_damped_beyond_critical(self):
        # With the patience for springs alone 31 of 539 steps ended without convergence, however short they were made.
        self.ends("strong-damping", 1e-3, 0.002)

    def test_a_pinned_block_that_swings_in_static_steps(self):
        # It turned by 40 degrees in a step; the springs that hold it crushed it then, and 99 % of the energy had no account.
        self.ends("pinned-block", 1e-3, 1e-4)


if __name__ == "__main__":
    unittest.main()
