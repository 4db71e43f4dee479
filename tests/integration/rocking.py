#!/usr/bin/env python3
"""What a rocking block keeps of its angular velocity at a change of its corner, by the damping of a joint that the step resolves."""

import csv
import itertools
import math
import statistics
import unittest

from program import Scenario

# Half-sizes in m, of Housner's (1963) block.
HALF_WIDTH, HALF_HEIGHT = 0.2, 0.6
SLENDERNESS = math.atan(HALF_WIDTH / HALF_HEIGHT)
HOUSNER = 1.0 - 1.5 * math.sin(SLENDERNESS) ** 2

BLOCK = """
[rock]
density = 2600.0
young = 5e10
poisson = 0.2
[joints]
friction = 60.0
{joints}
[time]
step = {step}
[[block]]
name = "base"
outer = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "a"
outer = [{outline}]
[[history]]
name = "l"
block = "a"
point = {left}
[[history]]
name = "r"
block = "a"
point = {right}
[[stage]]
name = "rocks"
kind = "rest"
duration = 4.0
[solver]
{solver}
"""


def point(x, y):
    return f"[{x:.12f}, {y:.12f}]"


class Rocking(Scenario):
    def restitutions(self, step, joints="", solver=""):
        """ω of each change of the corner over that of the one before, which no fall between has changed."""
        angle = 0.5 * SLENDERNESS
        c, s = math.cos(angle), math.sin(angle)

        def turned(x, y):
            return c * x + s * y, c * y - s * x

        corners = [(-2 * HALF_WIDTH, 0.0), (0.0, 0.0), (0.0, 2 * HALF_HEIGHT), (-2 * HALF_WIDTH, 2 * HALF_HEIGHT)]
        inside = 1e-6
        self.write("rocks.toml", BLOCK.format(
            step=step, joints=joints, solver=solver, outline=", ".join(point(*turned(*corner)) for corner in corners),
            left=point(*turned(-2 * HALF_WIDTH + inside, inside)), right=point(*turned(-inside, inside)),
        ))  # fmt: skip
        self.keyblock("run", "rocks.toml", "-o", "out", "--force")
        speeds, largest, side = [], 0.0, None
        with open(self.folder / "out/histories.csv", newline="") as file:
            for row in csv.DictReader(file):
                height = float(row["r.uy"]) - float(row["l.uy"]) - 2 * HALF_WIDTH * s
                spin = math.hypot(*(float(row[f"r.{v}"]) - float(row[f"l.{v}"]) for v in ("vx", "vy"))) / (2 * HALF_WIDTH)
                if side is not None and (height > 0.0) != side:
                    speeds.append(largest)
                    largest = 0.0
                side = height > 0.0
                largest = max(largest, spin)
        return [after / before for before, after in itertools.pairwise(speeds)]

    def test_stiff_joints_lose_what_housner_says(self):
        for step in (0.002, 0.001):
            kept = self.restitutions(step)[:4]
            self.assertAlmostEqual(statistics.geometric_mean(kept), HOUSNER, delta=0.02, msg=f"{step} s: {kept}")

    def test_the_damping_of_a_joint_that_the_step_resolves(self):
        """The table of the guide: whatever the stiffness and the step."""
        for damping, expected in ((0.0, 0.96), (0.05, 0.95), (0.2, 0.93), (0.5, 0.91), (1.0, 0.885)):
            for stiffness, step in ((1e10, 0.0005), (1e10, 0.0002), (3e9, 0.0005)):
                kept = self.restitutions(step, f"normal_stiffness = {stiffness}", f"contact_damping = {damping}")[1:5]
                mean = statistics.geometric_mean(kept)
                self.assertAlmostEqual(mean, expected, delta=0.015, msg=f"{damping}, {stiffness} Pa/m, {step} s: {kept}")


if __name__ == "__main__":
    unittest.main()
