#!/usr/bin/env python3
"""keyblock limit: known answers, and the same answer for any number of workers and after it was killed."""

import csv
import json
import math
import re
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ROOT, Scenario, wait_for
from study_case import GALLERY

CASES = ROOT / "verification/scenarios"
INCLINE = CASES / "limit_incline.toml"

# A column of one block, 1 m wide and 4 m high, tips beyond atan(1/4).
COLUMN = """
title = "A column on a tilting table"
[rock]
density = 2600.0
young = 5.0e10
poisson = 0.2
[joints]
friction = 60.0
[time]
step = 0.005
[[block]]
name = "table"
outer = [[-5.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-5.0, 0.0]]
fixed = true
[[block]]
name = "column"
outer = [[-0.5, 0.0], [0.5, 0.0], [0.5, 4.0], [-0.5, 4.0]]
[[stage]]
name = "settle"
kind = "settle"
"""

# A block is pushed along a floor.
PUSHED = COLUMN.replace("60.0", "30.0").replace("4.0]", "1.0]") + """
[[load]]
block = "column"
point = [-0.5, 0.01]
force = [1000.0, 0.0]
"""


class Limit(Scenario):
    def limit(self, *arguments, out="out", expect=0):
        return self.keyblock("limit", *arguments, "-o", out, expect=expect)

    def found(self, out="out"):
        return json.loads((self.folder / out / "limit.json").read_text())

    def check_bracket(self, expected, tolerance, out="out"):
        result = self.found(out)
        (limit,) = result["realizations"]
        bracket = limit["bracket"]
        values = sorted(bracket.values())
        self.assertEqual(limit["status"], "found")
        self.assertLessEqual(values[1] - values[0], result["tolerance"] * max(abs(v) for v in values))
        self.assertLess(abs(limit["limit"] / expected - 1), tolerance, limit)
        return limit


class KnownAnswers(Limit):
    def test_friction_of_an_incline(self):
        done = self.limit(INCLINE, "--key", "joints.friction", "--from", 45, "--to", 5, "--until", "collapsed", "--tolerance", 0.005)
        limit = self.check_bracket(30.0, 0.005)
        self.assertIn("joints.friction = 45: stands, not met\n", done.stdout)
        self.assertIn(f"just beyond it: out/{limit['just_beyond']}/report.html\n", done.stdout)
        for trial in limit["trials"]:
            self.assertEqual(trial["met"], trial["value"] < 29.999, trial)
            self.assertTrue((self.folder / "out" / trial["run"] / "report.html").exists())

    def test_strength_factor_of_an_incline(self):
        """tan 45° / tan 30°."""
        self.limit(INCLINE, "--set", "joints.friction=45", "--key", "joints.strength_factor", "--from", 1, "--to", 3,
                   "--until", "collapsed", "--tolerance", 0.005)  # fmt: skip
        self.check_bracket(math.sqrt(3), 0.005)

    def test_tilt_of_a_column(self):
        self.write("column.toml", COLUMN)
        self.limit("column.toml", "--key", "tilt", "--from", 0, "--to", 45, "--until", "collapsed", "--tolerance", 0.005)
        self.check_bracket(math.degrees(math.atan(0.25)), 0.01)

    def test_load_factor_of_a_pushed_block(self):
        self.write("pushed.toml", PUSHED)
        self.limit("pushed.toml", "--key", "load_factor", "--from", 0, "--to", 100, "--until", "collapsed", "--tolerance", 0.005)
        self.check_bracket(2600 * 9.81 * math.tan(math.radians(30)) / 1000, 0.005)

    def test_the_strength_at_which_an_anchor_yields(self):
        """A block on a spring, with ballast of a fifth of its weight: the spring yields below 1.2 times the weight, and is at 80 % of 1.5 times that."""
        weight = 2600.0 * 9.81
        hung = CASES / "staged_support.toml"
        words = (hung, "--key", "spring.first.yield", "--from", 2.0 * weight, "--to", 1.1 * weight, "--tolerance", 0.005)
        self.limit(*words, "--until", "yielded_elements")
        self.check_bracket(1.2 * weight, 0.005)
        said = self.limit(*words, "--until", "largest_utilization", "--above", 0.8, out="used")
        self.check_bracket(1.5 * weight, 0.005, out="used")
        self.assertIn("largest utilization of an element", said.stdout)

    def test_the_strength_at_which_a_bolt_yields(self):
        """Of a block that hangs on it, one bolt every 2 m."""
        weight = 2 * 2600.0 * 9.81
        block = '[[block]]\nname = "{}"\nouter = [[0, {}], [2, {}], [2, {}], [0, {}]]\nfixed = {}\n'
        keys = "diameter = 0.025\nspacing = 2.0\nyield = 400e3\ngrout_stiffness = 8e9\ngrout_strength = 400e3\n"
        self.write(
            "hung.toml",
            "[rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.2\n[joints]\nfriction = 30\n[time]\nstep = 0.002\n"
            + block.format("roof", 1, 1, 3, 3, "true")
            + block.format("hung", 0, 0, 1, 1, "false")
            + '[[bolt]]\nname = "b"\nfrom = [1, 0]\nto = [1, 2.5]\n'
            + keys
            + '[[stage]]\nname = "hangs"\nkind = "settle"\n',
        )
        words = ("hung.toml", "--key", "bolt.b.yield", "--from", 400e3, "--to", 40e3, "--tolerance", 0.005)
        self.limit(*words, "--until", "yielded_elements")
        self.check_bracket(2 * weight, 0.005)

    def test_pressure_under_a_key_block(self):
        self.limit(CASES / "held_block.toml", "--key", "excavation.room.pressure", "--from", 5e4, "--to", 0, "--until", "moved", "--tolerance", 0.005)
        self.check_bracket(2600 * 9.81, 0.01)


# A block of 0.5 m × 2 m under one sine. It overturns, stands again, and overturns (Housner's equation, integrated: 2.85, 6.7, 7.27 g b/h).
ROCKING = COLUMN.replace("[[-0.5, 0.0], [0.5, 0.0], [0.5, 4.0], [-0.5, 4.0]]", "[[-0.25, 0.0], [0.25, 0.0], [0.25, 2.0], [-0.25, 2.0]]") + """
[[motion]]
name = "pulse"
x = { amplitude = 2.4525, frequency = 2.13, cycles = 1 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "pulse"
"""


class DefaultCriterion(Limit):
    def slope(self, more=""):
        self.keyblock("new", "slope", "--force")
        text = (self.folder / "slope.toml").read_text() + more
        self.write("slope.toml", text)
        return ("slope.toml", "--tolerance", 0.005)

    def test_a_slope_has_its_factor_of_safety(self):
        """tan 40° / tan 30°, whether the last stage is static or not."""
        for name, more in (("static", ""), ("in_motion", '\n[[stage]]\nname = "quiet"\nkind = "rest"\nduration = 2.0\n')):
            said = self.limit(*self.slope(more), "--key", "joints.strength_factor", "--from", 1, "--to", 3, out=name).stdout
            self.check_bracket(1.4534, 0.005, out=name)
            self.assertRegex(said, r"\nThe factor of safety is 1\.45\d: at 1\.45\d the blocks stand, .* at 1\.4\d\d block 2 \(8701 kN/m\) moves\.\n")
            self.assertIn("--until collapsed is the default for a slope", said)
            self.assertEqual(self.found(name)["until"], "collapsed")
            self.assertIn("a slope", self.found(name)["why"])
            page = (self.folder / name / "report.html").read_text()
            for words in ("The factor of safety is 1.45", "Ground and loads", "Just beyond the limit", "friction φ"):
                self.assertIn(words, page)
            self.assertEqual(self.found(name)["warnings"], [])

    def test_warnings_of_the_scenario_are_on_the_page(self):
        self.limit(*self.slope(), "--set", "rock.density=26", "--key", "joints.strength_factor", "--from", 1, "--to", 3)
        (warning,) = [text for text in self.found()["warnings"] if "rock.density" in text]
        self.assertIn("usual is", warning)
        self.assertIn('<p class="warning"><b>warning:</b> ', (self.folder / "out/report.html").read_text())

    def test_the_page_on_slopes_says_what_the_program_says(self):
        self.keyblock("new", "slope", "--force")
        page = (ROOT / "docs/slopes.md").read_text()
        blocks = re.findall(r"```sh\nkeyblock ((?:limit|safety) (?:slope|wet)\.toml [^\n]*)\n```\n```\n(.*?)\n```", page, re.DOTALL)
        water, dam, earthquake = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
        self.write("wet.toml", (self.folder / "slope.toml").read_text() + water)
        self.assertEqual(len(blocks), 4)
        for words, printed in blocks:
            said = self.keyblock(*words.split()).stdout
            for line in printed.split("…\n")[-1].splitlines():
                self.assertIn(line + "\n", said, words)
        rock = 'title = "Dam"\n[rock]\ndensity = 2400\nyoung = 5e10\npoisson = 0.2\nstate = "plane-strain"\n[joints]\nfriction = 30\n'
        settle = '[time]\nstep = 0.005\n[[stage]]\nname = "full"\nkind = "settle"\n'
        self.write("dam.toml", rock + dam + settle)
        self.limit("dam.toml", "--key", "joints.strength_factor", "--from", 1, "--to", 4, "--tolerance", 0.002, out="dam")
        self.check_bracket(2.223868, 0.004, out="dam")
        slope = re.sub(r"(?ms)^\[boundary\].*?\n\n", "", (self.folder / "slope.toml").read_text())
        self.write("shaken.toml", slope + earthquake)
        self.keyblock("run", "shaken.toml", "-o", "shaken")
        self.assertAlmostEqual(self.summary("shaken")["stages"][-1]["damage"]["displacement_max_m"], 0.06, delta=0.005)
        self.limit("shaken.toml", "--key", "stage.earthquake.scale", "--from", 0, "--to", 4, "--workers", 2, out="scale")
        self.assertEqual(self.found("scale")["until"], "moved")

    def test_cohesion_that_slip_does_not_take_is_that_of_limit_equilibrium(self):
        """(c L + W cos α tan φ)/(W sin α) = 1.8364, whatever the number of contacts; by the factor of all joints and of the plane alone."""
        words = ["--from", 1, "--to", 3, "--set", "trace_map.bedding.cohesion=50e3"]
        kept = [*words, "--set", "trace_map.bedding.residual_cohesion=50e3"]
        for contacts in (2, 9):
            self.limit(*self.slope(), "--key", "joints.strength_factor", *kept, "--set", f"solver.face_contacts={contacts}", out=f"by-{contacts}")
            self.check_bracket(1.8364, 0.005, out=f"by-{contacts}")
        said = self.limit(*self.slope(), "--key", "trace_map.bedding.strength_factor", *kept, out="plane").stdout
        self.assertIn("The factor of safety of “bedding” is 1.84", said)
        lost = self.limit(*self.slope(), "--key", "trace_map.bedding.strength_factor", *words, out="lost")
        self.assertIn("residual_cohesion = 50000 keeps it, as limit equilibrium does", lost.stderr)
        self.assertIn("residual_cohesion", " ".join(self.found("lost")["warnings"]))

    def test_a_slab_with_cohesion_that_leans_on_its_toe(self):
        """Its heel gapes. (c L + W cos α tan φ)/(W sin α), L 6 m, h 3 m, α 50°, on joints of given stiffness."""
        slab = [ROOT / "tests/data/odd/cohesive_slide.toml", "--key", "joints.strength_factor", "--from", 0.2, "--to", 6, "--until", "collapsed"]
        for number, more in enumerate(([], ["rock.order=2"], ["solver.face_contacts=5"], ["rock.order=3", "solver.face_contacts=9"])):
            sets = [word for key in ["joints.residual_cohesion=60e3", *more] for word in ("--set", key)]
            self.limit(*slab, "--tolerance", 0.004, *sets, out=f"slab-{number}")
            self.check_bracket(1.611, 0.005, out=f"slab-{number}")

    def test_a_slope_that_is_asked_when_rock_falls_says_what_moves(self):
        rest = '\n[[stage]]\nname = "quiet"\nkind = "rest"\nduration = 2.0\n'
        said = self.limit(*self.slope(rest), "--key", "joints.strength_factor", "--from", 1, "--to", 3, "--until", "fallen").stdout
        self.assertRegex(said, r"at 1\.4[56]\d? already block 2 \(8701 kN/m\) moves; --until collapsed asks for that")
        self.assertAlmostEqual(self.found()["realizations"][0]["moves_already"]["value"] / 1.4534, 1.0, delta=0.006)

    def test_moved_counts_what_a_static_stage_names(self):
        self.limit(*self.slope(), "--key", "joints.strength_factor", "--from", 1, "--to", 3, "--until", "moved", "--above", 100)
        self.check_bracket(1.4534, 0.005)
        self.keyblock("run", "slope.toml", "-o", "run", "--set", "joints.strength_factor=1.5")
        damage = self.summary("run")["stages"][0]["damage"]
        self.assertAlmostEqual(damage["loosened_area_m2"], 341.155, delta=0.1)
        self.assertLess(damage["displacement_max_m"], 1.0)

    def test_a_pier_on_soft_joints_falls_where_its_joints_say(self):
        """Rigid blocks on continuous joints, by hand: verification/joint_pressure.py. With stiff shear joints shift no weight outwards."""
        words = [CASES / "soft_pier.toml", "--key", "tilt", "--from", 0, "--to", 20, "--until", "collapsed", "--tolerance", 0.001]
        self.limit(*words, out="soft")
        self.check_bracket(9.483, 0.002, out="soft")
        self.limit(*words, "--set", "joints.shear_stiffness=1e10", out="stiff")
        self.check_bracket(9.528, 0.002, out="stiff")

    def test_seismic_coefficients_and_gravity(self):
        """tan(φ − α) = tan 10°, of the weight; horizontal gravity likewise, and gravity itself where a plane has cohesion."""
        words = self.slope()
        self.limit(*words, "--key", "stage.excavated.k_h", "--from", 0, "--to", -0.5, out="k_h")
        self.check_bracket(-math.tan(math.radians(10)), 0.005, out="k_h")
        said = self.limit(*words, "--key", "stage.excavated.k_h", "--from", 0, "--to", 0.5, out="uphill", expect=1).stderr
        self.assertIn("or give it the other sign", said)
        self.limit(*words, "--key", "gravity[0]", "--from", 0, "--to", -5, out="g")
        self.check_bracket(-9.81 * math.tan(math.radians(10)), 0.005, out="g")
        self.assertEqual(self.found("g")["unit"], "m/s²")
        # A block that hangs on a bond with tension.
        self.write("pushed.toml", PUSHED.replace("force = [1000.0, 0.0]", "force = [10000.0, 0.0]"))
        self.limit("pushed.toml", "--key", "gravity", "--from", 20, "--to", 1, "--tolerance", 0.005, out="down")
        self.check_bracket(10000 / 2600 / math.tan(math.radians(30)), 0.005, out="down")
        self.limit("pushed.toml", "--key", "load[0].force[0]", "--from", 0, "--to", 1e5, "--tolerance", 0.005, out="force")
        self.check_bracket(2600 * 9.81 * math.tan(math.radians(30)), 0.005, out="force")

    def test_a_column_that_rocks_has_not_collapsed(self):
        self.keyblock("new", "column")
        # The template waits until all is still; a rest of a second is not enough.
        text = (self.folder / "column.toml").read_text()
        self.write("column.toml", re.sub(r'duration = \S+( .*)?\nuntil = "still".*', "duration = 1.0", text))
        said = self.limit("column.toml", "--key", "stage.shaken.scale", "--from", 0, "--to", 10).stdout
        limit = self.check_bracket(4.10, 0.02)
        self.assertIn("judged after a rest until all is still", said)
        self.assertRegex(said, r"The scale of the motion at the limit is 4\.\d+ \(PGA 16\.\d m/s²\): ")
        self.assertEqual(self.found()["scan"], 8)
        stages = json.loads((self.folder / "out" / limit["just_beyond"] / "summary.json").read_text())["stages"]
        self.assertEqual([stage["name"] for stage in stages], ["stands", "shaken", "after", "until still"])

    def test_all_limits_of_a_rocking_block(self):
        self.write("rocking.toml", ROCKING)
        words = ("rocking.toml", "--key", "stage.shaken.scale", "--from", 1, "--to", 15, "--scan", 14)
        said = self.limit(*words, "--workers", 2).stdout
        (limit,) = self.found()["realizations"]
        limits = [found["limit"] for found in limit["limits"]]
        self.assertEqual(len(limits), 3)
        self.assertAlmostEqual(limits[0], 2.85, delta=0.06)
        self.assertAlmostEqual(limits[2], 7.27, delta=0.15)
        self.assertIn("There are 3 limits: beyond the first the criterion ceases to hold at 6.", said)
        self.limit(*words, "--workers", 1, out="one")
        self.assertEqual((self.folder / "one/limit.json").read_text(), (self.folder / "out/limit.json").read_text())
        values = [line.split(" = ")[1].split(":")[0] for line in said.splitlines() if line.startswith("stage.shaken.scale = ")]
        self.assertEqual(len(values), len(set(values)))

    def test_a_wall_that_is_not_met_is_told_the_right_criterion(self):
        words = (CASES / "limit_wall.toml", "--key", "load_factor", "--from", 1, "--to", 5)
        self.limit(*words, "--tolerance", 0.005, out="right")
        self.check_bracket(1.9556, 0.005, out="right")
        said = self.limit(*words, "--until", "fallen", out="wrong", expect=1).stderr
        self.assertIn("holds at neither end", said)
        self.assertRegex(said, r"at 1\.9\d* already .* move.*; --until collapsed asks for that")

    def test_an_opening_in_motion_is_asked_what_falls(self):
        self.write("gallery.toml", GALLERY)
        self.limit("gallery.toml", "--key", "joints.strength_factor", "--from", 0.5, "--to", 8, "--tolerance", 0.2)
        self.assertEqual(self.found()["until"], "fallen")


class Reproducible(Limit):
    FRICTION = (INCLINE, "--key", "joints.friction", "--from", 45, "--to", 5, "--until", "collapsed")

    def setUp(self):
        super().setUp()
        self.write("gallery.toml", GALLERY)
        self.realizations = ("gallery.toml", "--key", "joints.strength_factor", "--from", 0.5, "--to", 8, "--tolerance", 0.2,
                             "--realizations", 6)  # fmt: skip

    def test_any_number_of_workers(self):
        for workers in (1, 2, 5):
            self.limit(*self.FRICTION, "--workers", workers, out=f"w{workers}")
            self.assertEqual((self.folder / f"w{workers}/limit.json").read_text(), (self.folder / "w1/limit.json").read_text())

    def test_realizations_have_a_median_and_an_interval(self):
        done = self.limit(*self.realizations, "--workers", 2)
        self.limit(*self.realizations, "--workers", 1, out="one")
        self.assertEqual(self.found(), self.found("one"))
        result = self.found()
        self.assertEqual([limit["realization"] for limit in result["realizations"]], list(range(6)))
        self.assertEqual({limit["status"] for limit in result["realizations"]} - {"found", "met at both ends", "met at no end"}, set())
        low, high = result["median"]["interval"]
        self.assertLessEqual(low, result["median"]["value"])
        self.assertLessEqual(result["median"]["value"], high)
        self.assertRegex(done.stdout, r"limits of \d of 6 realizations: median [≥≤ ]*[\d.]+ \(95 % interval ")
        self.assertRegex(done.stdout, r"\nquantiles: 5 % [≥≤ ]*[\d.]+ \(\? … [≥≤ ]*[\d.]+\), 25 % ")
        self.assertEqual([quantile["p"] for quantile in result["quantiles"]], [0.05, 0.25, 0.5, 0.75, 0.95])
        shares = result["met_share"]["share"]
        self.assertEqual(shares, sorted(shares))
        with open(self.folder / "out/limits.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["realization"]) for row in rows], list(range(6)))
        for row, limit in zip(rows, result["realizations"], strict=True):
            self.assertEqual(row["status"], limit["status"])
            self.assertEqual(float(row["limit"]) if row["limit"] else None, limit["limit"])
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("Realizations in which the criterion is met", page)

    def test_killed_and_resumed(self):
        self.limit(*self.realizations, out="whole")
        words = [PROGRAM, "limit", *map(str, self.realizations), "-o", "out"]
        for stop in (signal.SIGKILL, signal.SIGINT):
            process = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            before = self.runs()
            wait_for(lambda: len(self.runs()) >= len(before) + 3, "runs that are done")
            process.send_signal(stop)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, -stop if stop == signal.SIGKILL else 2)
            self.assertFalse(self.found()["complete"])
            words += ["--resume"] if "--resume" not in words else []
            time.sleep(0.3)  # the runs at hand end with it
        before = self.runs()
        self.limit(*self.realizations, "--resume")
        self.assertEqual((self.folder / "out/limit.json").read_text(), (self.folder / "whole/limit.json").read_text())
        after = self.runs()
        self.assertEqual({run: after[run] for run in before}, before)

    def test_interrupted_it_keeps_the_bracket(self):
        words = [PROGRAM, "limit", *map(str, self.FRICTION), "--tolerance", "0.00002", "--workers", "1", "-o", "out"]
        process = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        wait_for(lambda: len(self.runs()) >= 5, "runs that are done")
        process.send_signal(signal.SIGINT)
        said, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, errors)
        result = self.found()
        self.assertFalse(result["complete"])
        (limit,) = result["realizations"]
        self.assertEqual(limit["status"], "open")
        self.assertGreater(limit["bracket"]["not_met"], 30.0 - 1e-9)
        self.assertLess(limit["bracket"]["met"], 30.0)
        for met in (True, False):
            self.assertIn(limit["bracket"]["met" if met else "not_met"], [trial["value"] for trial in limit["trials"] if trial["met"] == met])
        self.assertRegex(said, r"\nbetween [\d.]+° and [\d.]+° so far\.?\n", "and of no other limit")
        self.assertIn(" so far", result["answer"])

    def runs(self):
        return {path.parent.name: path.stat().st_mtime_ns for path in (self.folder / "out/runs").glob("*/run.json")}

    def test_a_trial_is_that_of_the_run_command(self):
        self.limit(*self.FRICTION)
        trial = self.found()["realizations"][0]["trials"][-1]
        self.keyblock("run", INCLINE, "-o", "alone", "--set", f"joints.friction={trial['value']}")
        self.assertEqual(self.summary("alone")["state_hash"], trial["state_hash"])

    def test_finer_from_what_is_there(self):
        self.limit(*self.FRICTION)
        before = self.runs()
        self.limit(*self.FRICTION, "--tolerance", 0.001, "--resume")
        after = self.runs()
        self.assertEqual({run: after[run] for run in before}, before)
        self.assertGreater(len(after), len(before))
        self.assertLess(len(self.found()["realizations"][0]["trials"]), len(after) + 1)


class SinceAStage(Limit):
    def test_what_gravity_brought_down_does_not_count(self):
        """A block of the roof falls before the stage that is looked at, whatever the key is."""
        held = (CASES / "held_block.toml").read_text()
        stages = held + '\n[[stage]]\nname = "later"\nkind = "rest"\nduration = 0.1\n'
        self.write("fallen.toml", stages)
        name = re.findall(r'\[\[stage\]\]\s*name = "([^"]+)"', stages)[-2]
        words = ("fallen.toml", "--key", "excavation.room.pressure", "--from", 10, "--to", 0, "--until", "fallen")
        self.assertIn("count from a later stage with --since", self.limit(*words, expect=1).stderr)
        said = self.limit(*words, "--since", name, "--resume", expect=1)
        self.assertIn("holds at neither end", said.stderr)
        self.assertIn(f'fallen area of more than 0 m² since the end of "{name}"', said.stdout)
        self.assertEqual(self.found()["since"], name)
        said = self.limit(*words, "--since", "latr", "--resume", expect=1).stderr
        self.assertIn('--since: found "latr"; expected a stage before the last one: ', said)
        said = self.limit(*words[:-1], "collapsed", "--since", name, "--resume", expect=1).stderr
        self.assertIn("expected nothing, as collapsed is how the blocks are at the end", said)


class Refusals(Limit):
    def refused(self, *arguments):
        return self.limit(INCLINE, "--until", "collapsed", *arguments, expect=1).stderr

    def test_ends_that_tell_nothing(self):
        key = ("--key", "joints.friction")
        said = self.refused(*key, "--from", 5, "--to", 45)
        self.assertIn("--from 5: joints.friction: found that the criterion holds, and that it does not at --to", said)
        self.assertIn("exchange --from and --to", said)
        self.assertIn("--to 50: joints.friction: found that the criterion holds at neither end", self.refused(*key, "--from", 45, "--to", 50, "--resume"))
        said = self.refused(*key, "--from", 4, "--to", 5, "--resume")
        self.assertIn("--from 4: joints.friction: found that the criterion holds at both ends", said)
        self.assertEqual(self.found()["realizations"][0]["status"], "met at both ends")
        said = self.limit(INCLINE, "--key", "damage.slip", "--from", 0.01, "--to", 0.02, out="none", expect=1).stderr
        self.assertIn("the key has no effect on this model", said)

    def test_keys_and_numbers(self):
        for words, said in (
            ("--key joints.frction --from 1 --to 2", "--set joints.frction=1.0: joints.frction: found an unknown key"),
            ("--key rock.order --from 1 --to 2", "--set rock.order=1.0: rock.order: found the number 1.0; expected an integer"),
            ("--key joints.friction --from 45 --to 95", "--set joints.friction=95.0: joints.friction: found the number 95.0"),
            ("--key joints.friction --from 4 --to 4", "--to: found 4, as --from; expected another value"),
            ("--key joints.friction --from 4 --to inf", "--to: found inf; expected a number"),
            ("--key joints.friction --from 4 --to 5 --tolerance 0", "--tolerance: found 0; expected above 0"),
            ("--key joints.friction --from 4 --to 5 --above 1", "--above: found 1"),
        ):
            self.assertIn(said, self.refused(*words.split()), words)
        self.assertFalse((self.folder / "out").exists())

    def test_measures_that_the_scenario_has_no_number_for(self):
        for measure in ("largest_utilization", "yielded_elements"):
            said = self.limit(INCLINE, "--key", "joints.friction", "--from", 45, "--to", 5, "--until", measure, expect=1).stderr
            self.assertIn("no [[spring]] or [[bolt]] has a yield", said)
            self.assertFalse((self.folder / "out").exists())
        said = self.limit(INCLINE, "--key", "joints.friction", "--from", 45, "--to", 5, "--until", "fallen_depth_m", expect=1).stderr
        self.assertIn("this model has no fallen_depth_m: it is null in summary.json", said)

    def test_folders_of_others(self):
        key = ("--from", 45, "--to", 5)
        self.limit(INCLINE, "--until", "collapsed", "--key", "joints.friction", *key)
        self.assertIn("found a limit of ", self.refused("--key", "joints.friction", *key))
        self.assertIn("found a limit of joints.friction", self.refused("--key", "joints.strength_factor", "--from", 1, "--to", 3, "--resume"))
        self.assertIn("rock.young", self.refused("--key", "joints.friction", *key, "--resume", "--set", "rock.young=4e10"))
        for words in (("study", "run", INCLINE, "-o", "out", "--resume"), ("study", "collect", "out")):
            self.assertIn("found the runs of a limit", self.keyblock(*words, expect=1).stderr)
        self.keyblock("study", "run", INCLINE, "-o", "study")
        self.assertIn("found a study", self.limit(INCLINE, "--key", "joints.friction", *key, "--resume", out="study", expect=1).stderr)
        self.keyblock("run", INCLINE, "-o", "run")
        self.assertIn("found the results of a run", self.limit(INCLINE, "--key", "joints.friction", *key, out="run", expect=1).stderr)

    def test_the_page_stands_alone(self):
        self.limit(INCLINE, "--until", "moved", "--key", "joints.friction", "--from", 45, "--to", 5, "--set", "title=<b>&\"")
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("<h1>&lt;b&gt;&amp;&quot;</h1>", page)
        self.assertNotIn("http", page.replace("http://www.w3.org", ""))
        for trial in self.found()["realizations"][0]["trials"]:
            self.assertIn(f'href="{trial["run"]}/report.html"', page)


if __name__ == "__main__":
    unittest.main()
