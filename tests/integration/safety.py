#!/usr/bin/env python3
"""keyblock safety: known factors at default settings, both ends, what moves, and what is refused."""

import csv
import json
import math
import unittest

from program import ROOT, Scenario
from study_case import GALLERY

CASES = ROOT / "verification/scenarios"


def degrees(tangent):
    return math.degrees(math.atan(tangent))


class Safety(Scenario):
    def safety(self, *arguments, out="out", expect=0):
        return self.keyblock("safety", *arguments, "-o", out, expect=expect)

    def found(self, out="out"):
        return json.loads((self.folder / out / "limit.json").read_text())

    def bracket(self, out="out"):
        (limit,) = self.found(out)["realizations"]
        self.assertEqual(limit["status"], "found", limit)
        return limit["bracket"]["not_met"], limit["bracket"]["met"]

    def check(self, exact, out="out", tolerance=0.005):
        low, high = self.bracket(out)
        self.assertLess(low / exact - 1, 0.0005)
        self.assertGreater(high / exact - 1, -0.0005)
        self.assertLessEqual((high - low) / high, tolerance)


class KnownFactors(Safety):
    def test_a_block_on_a_plane(self):
        """tan φ / tan α; blocks of any order, any number of contacts, and the same by keyblock run."""
        exact = math.tan(math.radians(45)) / math.tan(math.radians(30))
        incline = [CASES / "limit_incline.toml", "--set", "joints.friction=45"]
        for number, more in enumerate(([], ["rock.order=2"], ["solver.face_contacts=3"], ["rock.order=3", "solver.face_contacts=9"])):
            said = self.safety(*incline, *(word for key in more for word in ("--set", key)), out=f"f{number}").stdout
            self.check(exact, out=f"f{number}")
            self.assertRegex(said, r"The factor of safety is 1\.73\d?: the rock holds to 1\.7\d* and falls from 1\.7\d+ \(“block” .* moves\)\.")
        (limit,) = self.found("f0")["realizations"]
        for trial in limit["trials"]:
            self.keyblock("run", *incline, "--set", f"safety.strength_factor={trial['value']!r}", "-o", f"run-{trial['value']}")
            self.assertEqual(self.summary(f"run-{trial['value']}")["state_hash"], trial["state_hash"])

    def test_columns_that_topple_move_before_they_fall(self):
        """Goodman & Bray (1976): 1.3 times the friction of the limit. They creep and lock again: both ends are told, on either side of it."""
        for name, tangent in (("seven", 0.918696), ("nine", 0.971794), ("six", 0.736190)):
            said = self.safety(CASES / f"limit_{name}_columns.toml", "--set", f"joints.friction={degrees(1.3 * tangent)}", out=name).stdout
            (limit,) = self.found(name)["realizations"]
            self.assertLess(self.bracket(name)[0], 1.3)
            self.assertGreater(self.bracket(name)[0], 1.27)
            self.assertGreater(limit["falls"]["trial"]["value"], 1.3)
            self.assertLess(limit["falls"]["trial"]["value"], 1.32)
            self.assertLessEqual(limit["bracket"]["met"], limit["falls"]["trial"]["value"])
            self.assertRegex(said, r"holds to [\d.]+(,| and) (moves|falls) from")

    def test_cohesion_that_slip_does_not_take(self):
        """(c L + W cos α tan φ)/(W sin α), by all joints and by the plane alone."""
        slope = [CASES / "limit_slope.toml", "--set", "trace_map.bedding.cohesion=50e3", "--set", "trace_map.bedding.residual_cohesion=50e3"]
        for number, sets in enumerate(([], ["--sets", "bedding"], ["--sets", "bedding,joints"])):
            self.safety(*slope, *sets, out=f"s{number}")
            self.check(1.8364, out=f"s{number}")
        self.assertEqual(self.found("s1")["overrides"][-1], 'safety.sets=["bedding"]')
        self.assertIn("The factor of safety of \"bedding\" is 1.8", self.found("s1")["answer"])
        self.assertIn('strength of "bedding" is reduced from the end of "excavated" on', self.found("s1")["why"])

    def test_one_set_alone(self):
        """The crack carries nothing: its strength is of no account."""
        slope = [CASES / "limit_slope.toml", "--sets", "tension crack"]
        said = self.safety(*slope, expect=1).stderr
        self.assertIn("that the criterion holds at neither end", said)

    def test_an_earthquake_that_stays(self):
        """tan φ (cos α + k sin α) / (sin α − k cos α), φ 40°, α 30°; k pushes out of the slope, to the left."""
        a, k = math.radians(30), 0.1
        exact = math.tan(math.radians(40)) * (math.cos(a) - k * math.sin(a)) / (math.sin(a) + k * math.cos(a))
        self.safety(CASES / "limit_slope.toml", "--set", "stage.excavated.k_h=-0.1")
        self.check(exact)


class Stages(Safety):
    SHAKEN = """
[[motion]]
name = "shaking"
x = { amplitude = 3.0, frequency = 2.0, cycles = 3 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "shaking"
"""

    def slope(self, more):
        (self.folder / "slope.toml").write_text((CASES / "limit_slope.toml").read_text() + more)
        return "slope.toml"

    def test_later_stages_are_left_out(self):
        said = self.safety(self.slope(self.SHAKEN), "--workers", 2)
        self.check(math.tan(math.radians(40)) / math.tan(math.radians(30)))
        self.assertNotIn("no stage uses it", said.stderr)
        self.assertIn('from the end of "excavated" on; not run, with what it does: "shaken"', said.stdout)
        (limit,) = self.found()["realizations"]
        self.keyblock("run", "slope.toml", "--set", "safety.strength_factor=1.2", "-o", "run")
        self.assertEqual([stage["name"] for stage in self.summary("run")["stages"]], ["excavated", "strength reduced"])
        self.keyblock("run", "slope.toml", "--set", "safety.moved=0.01", "-o", "whole")
        self.assertEqual([stage["name"] for stage in self.summary("whole")["stages"]], ["excavated", "shaken"])

    def test_a_factor_of_one_moves_nothing(self):
        self.keyblock("run", CASES / "limit_slope.toml", "--set", "safety.strength_factor=1.0", "-o", "run")
        reduced = self.summary("run")["stages"][-1]
        self.assertLess(reduced["damage"]["stage_displacement_m"], 1e-6)
        self.assertEqual(reduced["damage"]["moving_area_m2"], 0.0)

    def test_strength_of_a_stage(self):
        """A stage divides strength as long as it lasts, of all joints or of those that it names, static or dynamic."""
        rest = '\n[[stage]]\nname = "quiet"\nkind = "rest"\nduration = 0.5\nstrength_factor = 2.0\n'
        for number, (names, moves) in enumerate((("", True), ('strength_of = ["bedding"]', True), ('strength_of = ["tension crack", "joints"]', False))):
            self.slope(rest + names + "\n")
            self.keyblock("run", "slope.toml", "--set", "rock.young=1e12", "-o", f"run{number}")
            quiet = self.summary(f"run{number}")["stages"][-1]["damage"]
            # a = g (sin 30° − cos 30° tan 40°/2) for 0.5 s; rock as soft as that of the case springs back by 5 mm as its strength drops.
            way = 0.5 * 9.81 * (0.5 - math.cos(math.radians(30)) * math.tan(math.radians(40)) / 2) * 0.25
            self.assertAlmostEqual(quiet["stage_displacement_m"], way if moves else 0.0, delta=0.01 * way)
            self.assertAlmostEqual(quiet["moving_area_m2"], 341.155 if moves else 0.0, delta=0.1)

    def test_a_tunnel_is_asked_for_an_area(self):
        tunnel = ROOT / "examples/02-tunnel-in-situ.toml"
        self.safety(tunnel, "--area", 0.5, "--sweep", 2, "--tolerance", 0.05, "--workers", 2)
        found = self.found()
        self.assertEqual(found["until"], "moving_area_m2")
        (limit,) = found["realizations"]
        for trial in limit["trials"]:
            self.assertEqual(trial["met"], trial["moving_area_m2"] > 0.5, trial)
        with open(self.folder / "out/map.csv", newline="") as file:
            cells = list(csv.DictReader(file))
        tried = {trial["value"] for trial in limit["trials"]}
        self.assertTrue(cells)
        for cell in cells:
            self.assertTrue(cell["holds_to"] == "" or float(cell["holds_to"]) in tried, cell)
            self.assertLess(math.hypot(float(cell["x_m"]), float(cell["y_m"])), 12.0)
        run = self.summary(f"out/{limit['just_beyond']}")
        self.assertEqual(run["stages"][-1]["kind"], "rest", "a static stage would hold what moves, and prop the rock behind it")
        self.assertGreater(run["stages"][-1]["damage"]["fallen_area_m2"], 0.4)
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("Up to which value rock stays in place", page)

    def test_realizations_and_workers(self):
        self.write("gallery.toml", GALLERY)
        words = ["gallery.toml", "--area", 0.3, "--realizations", 4, "--tolerance", 0.1]
        self.safety(*words, "--workers", 2)
        self.safety(*words, "--workers", 1, out="one")
        self.assertEqual((self.folder / "out/limit.json").read_text(), (self.folder / "one/limit.json").read_text())


class YieldCoefficients(Safety):
    """k_h at which a block on a plane moves: (c L + W cos α tan φ − W sin α)/(W (cos α + sin α tan φ))."""

    def incline(self, alpha, phi, cohesion=0.0, length=1.0, height=1.0):
        """Gravity stays upright, and the plane dips α to the right."""
        c, s = math.cos(math.radians(alpha)), math.sin(math.radians(alpha))
        turned = lambda x, y: [c * x + s * y, -s * x + c * y]  # noqa: E731
        block = lambda a, b, x, y: [turned(a, x), turned(b, x), turned(b, y), turned(a, y)]  # noqa: E731
        self.write(
            "incline.toml",
            f"""
[rock]
density = 2600.0
young = 5.0e10
poisson = 0.2
state = "plane-stress"

[joints]
friction = {phi}
cohesion = {cohesion}
{f"residual_cohesion = {cohesion}" if cohesion else ""}

[time]
step = 0.005

[[block]]
name = "base"
outer = {block(-5.0, 5.0, -1.0, 0.0)}
fixed = true

[[block]]
name = "block"
outer = {block(-length / 2, length / 2, 0.0, height)}

[[stage]]
name = "settled"
kind = "settle"
""",
        )

    def test_of_a_block_on_a_plane(self):
        # α, φ, c, L, height, k_h: the last two with weights of 50 and 180 kN.
        for number, (alpha, phi, cohesion, length, weight, exact) in enumerate(
            ((30, 40, 0, 1.0, 25.506e3, 0.176327), (35, 30, 5e3, 2.0, 50e3, 0.086378), (40, 32, 20e3, 3.0, 180e3, 0.144920))
        ):
            self.incline(alpha, phi, cohesion, length, weight / (2600 * 9.81 * length))
            said = self.safety("incline.toml", "--yield", "--to", 1, "--tolerance", 0.002, out=f"y{number}").stdout
            low, high = self.bracket(f"y{number}")
            # Equilibrium is known to 10⁻⁴ of the weight, and so is the coefficient.
            self.assertLess(low, exact + 1e-4)
            self.assertGreater(high, exact - 1e-4)
            self.assertLessEqual((high - low) / high, 0.002)
            self.assertRegex(said, r"The yield coefficient is 0\.\d+: the rock holds to 0\.\d+ and falls from 0\.\d+ ")
            self.assertIn('a horizontal seismic coefficient acts from the end of "settled" on', said)

    def test_pushes_to_the_side_to_which_the_ground_falls(self):
        self.safety(CASES / "limit_slope.toml", "--yield")
        found = self.found()
        self.assertEqual((found["key"], found["from"], found["to"]), ("safety.k_h", 0.0, -1.0))
        (limit,) = found["realizations"]
        exact = -math.tan(math.radians(10.0))
        self.assertLess(limit["bracket"]["met"], 0.9995 * exact)
        self.assertGreater(limit["bracket"]["not_met"], 1.0005 * exact)
        # The same run by hand.
        trial = limit["trials"][-1]
        self.keyblock("run", CASES / "limit_slope.toml", "--set", f"safety.k_h={trial['value']!r}", "-o", "run")
        self.assertEqual(self.summary("run")["state_hash"], trial["state_hash"])
        self.assertEqual(self.summary("run")["stages"][-1]["name"], "seismic coefficient")

    def test_what_is_refused(self):
        flat = self.safety(CASES / "limit_incline.toml", "--yield", expect=1).stderr
        self.assertIn("above 0 it pushes to the right, below 0 to the left", flat)
        slope = CASES / "limit_slope.toml"
        self.assertIn("in motion, where no seismic coefficient acts", self.safety(slope, "--yield", "--area", 1, expect=1).stderr)
        self.assertIn("not in range", self.safety(slope, "--yield", "--to", 20, expect=1).stderr)


class Mistakes(Safety):
    def refused(self, text, *arguments):
        said = self.safety(CASES / "limit_slope.toml", *arguments, expect=1).stderr
        self.assertIn(text, said)

    def test_what_is_not_there(self):
        self.refused('the name of a joint set, trace map or interface, or "joints": "joints", "bedding" or "tension crack"', "--sets", "beding")
        self.refused("did you mean 'bedding'", "--sets", "beding")
        self.refused("excavated", "--stage", "excavation")
        self.refused("safety.area", "--area", -1)
        self.refused("safety.moved", "--moved", 0)
        self.refused("in motion, where no seismic coefficient acts", "--area", 1, "--set", "stage.excavated.k_h=-0.1")
        self.refused("not in range 0.001000 to 1000", "--to", 1e9)
        self.refused("another value than --from", "--from", 1, "--to", 1)
        self.assertFalse((self.folder / "out").exists())

    def test_a_dynamic_stage(self):
        text = (CASES / "limit_slope.toml").read_text().replace('kind = "settle"', 'kind = "rest"\nduration = 1.0')
        self.write("dynamic.toml", text)
        self.assertIn('no stage of kind "settle"', self.safety("dynamic.toml", expect=1).stderr)
        self.assertIn('of kind "settle", as strength is reduced from an equilibrium', self.safety("dynamic.toml", "--stage", "excavated", expect=1).stderr)

    def test_less_than_one_is_told(self):
        """tan 20° / tan 30° = 0.630: it moves at its own strength."""
        said = self.safety(CASES / "limit_slope.toml", "--set", "joints.friction=20").stdout
        self.assertIn("The factor of safety is 0.63", said)


if __name__ == "__main__":
    unittest.main()
