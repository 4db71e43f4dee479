#!/usr/bin/env python3
"""keyblock cut --census: what it says and writes, what it refuses, and what falls in runs of the same rock."""

import csv
import json
import math
import re
import unittest

from program import ROOT, Scenario

# Three joint sets around a tunnel, under self-weight.
ROCK = """
title = "Key blocks"
accept_warnings = ["order-1"]
[section]
azimuth = 90.0
[domain]
x = [-6.0, 6.0]
y = [-6.0, 6.0]
[rock]
density = 2500.0
young = 5.0e9
poisson = 0.22
[joints]
friction = 38.0
[[joint_set]]
name = "J1"
dip = 70.0
dip_direction = 90.0
spacing = { mean = 1.0, std = 0.2, distribution = "normal" }
length = { mean = 3.0, std = 1.0, distribution = "normal" }
gap = { mean = 0.6, std = 0.1, distribution = "normal" }
[[joint_set]]
name = "J2"
dip = 60.0
dip_direction = 270.0
spacing = { mean = 1.1, std = 0.2, distribution = "normal" }
length = { mean = 2.5, std = 0.8, distribution = "normal" }
gap = { mean = 0.6, std = 0.1, distribution = "normal" }
[[joint_set]]
name = "bedding"
dip = 5.0
dip_direction = 90.0
spacing = { mean = 0.9, std = 0.1, distribution = "normal" }
length = { mean = 4.0, std = 1.0, distribution = "normal" }
gap = { mean = 0.3, std = 0.1, distribution = "normal" }
"""
TUNNEL = """
[[excavation]]
name = "tunnel"
shape = "horseshoe"
invert = [0.0, -2.0]
width = 4.0
wall_height = 2.0
"""
STAGES = """
[time]
step = 0.002
[[stage]]
name = "in place"
kind = "settle"
[[stage]]
name = "excavated"
kind = "settle"
excavate = ["tunnel"]
[[stage]]
name = "quiet"
kind = "rest"
duration = 6.0
until = "still"
"""


class KeyBlocks(Scenario):
    def setUp(self):
        super().setUp()
        self.write("rock.toml", ROCK + TUNNEL + STAGES)

    def census(self, *arguments, out="cut"):
        self.keyblock("cut", "rock.toml", "-o", out, "--census", *arguments)
        return json.loads((self.folder / out / "census.json").read_text())

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def test_what_is_written_and_said(self):
        said = self.keyblock("cut", "rock.toml", "-o", "cut", "--census", "--realization", 1).stdout
        census = json.loads((self.folder / "cut/census.json").read_text())
        moving = [block for block in census["blocks"] if block["layer"]]
        self.assertGreater(len(moving), 5)
        self.assertIn(census["assumptions"], said)
        self.assertIn(f"Blocks that move: {len(moving)}, in {census['layers']} layers", said)
        for block in moving:
            self.assertLess(block["factor_of_safety"], 1.0)
            self.assertGreater(block["force_n_m"], 0.0)
            self.assertLessEqual(block["force_n_m"], block["weight_n_m"] * (1 + 1e-12))
            self.assertAlmostEqual(block["weight_n_m"], 2500.0 * 9.81 * block["area_m2"])
            self.assertEqual(bool(block["joints"]), block["mode"] != "falls")
        self.assertAlmostEqual(census["totals"]["moving_area_m2"], sum(block["area_m2"] for block in moving))
        self.assertAlmostEqual(census["totals"]["area_m2_per_m"], census["totals"]["moving_area_m2"] / census["wall_m"])
        # The floor, two walls and a half circle in 48 chords.
        self.assertAlmostEqual(census["wall_m"], 8.0 + 6.2832, delta=0.01)
        rows = self.rows("cut/census.csv")
        self.assertEqual([int(row["block"]) for row in rows if row["layer"] != "0"], [block["block"] for block in moving])
        self.assertEqual({row["realization"] for row in rows}, {"1"})
        picture = (self.folder / "cut/blocks.svg").read_text()
        self.assertIn(">falls<", picture)
        self.assertIn(">slides<", picture)
        printed = self.keyblock("cut", "rock.toml", "-o", "again", "--census", "--realization", 1, "--json").stdout
        self.assertEqual(json.loads(printed), census)

    def test_without_it_nothing_changes(self):
        self.keyblock("cut", "rock.toml", "-o", "plain")
        self.keyblock("cut", "rock.toml", "-o", "cut", "--census")
        self.assertEqual(sorted(p.name for p in (self.folder / "plain").iterdir()), ["blocks.geojson", "blocks.svg", "summary.json"])
        self.assertEqual(self.summary("plain"), self.summary("cut"))

    def test_realizations_have_means_with_intervals(self):
        census = self.census("--realizations", 12)
        self.assertEqual(census, self.census("--realizations", 12, out="again"))
        gathered = census["over_realizations"]
        self.assertEqual(gathered["realizations"], 12)
        self.assertEqual(gathered["failed"], [])
        for name in ("moving_blocks", "moving_area_m2", "first_layer_area_m2", "blocks_per_m", "area_m2_per_m", "largest_area_m2", "largest_depth_m"):
            each = [one[name] for one in gathered["each"]]
            mean = gathered["measures"][name]["mean"]
            self.assertAlmostEqual(mean["value"], sum(each) / 12)
            self.assertLess(mean["low"], mean["value"])
            self.assertGreater(mean["high"], mean["value"])
            self.assertEqual(gathered["measures"][name]["max"], max(each))
        alone = self.census("--realization", 7, out="seven")
        self.assertEqual(alone["totals"]["moving_area_m2"], gathered["each"][7]["moving_area_m2"])
        self.assertEqual({int(row["realization"]) for row in self.rows("cut/census.csv")}, set(range(12)))

    def test_forces_are_for_the_factor_that_is_wanted(self):
        usual, high = self.census(), self.census("--factor", 3, out="high")
        self.assertEqual((usual["wanted_factor"], high["wanted_factor"]), (1.5, 3.0))
        self.assertEqual([block["factor_of_safety"] for block in usual["blocks"]], [block["factor_of_safety"] for block in high["blocks"]])
        self.assertGreater(high["totals"]["force_n_m"], usual["totals"]["force_n_m"])

    def test_what_is_refused(self):
        self.write("rock.toml", ROCK)
        said = self.keyblock("cut", "rock.toml", "-o", "cut", "--census", expect=1).stderr
        self.assertRegex(said, r"rock\.toml:\d+:\d+: excavation: found nothing; expected rock with a free face")
        self.assertFalse((self.folder / "cut/census.json").exists())
        self.write("rock.toml", ROCK.replace("[section]", "gravity = [0.0, 0.0]\n[section]", 1) + TUNNEL)
        self.assertIn("gravity", self.keyblock("cut", "rock.toml", "-o", "cut", "--census", expect=1).stderr)
        self.write("rock.toml", ROCK + TUNNEL)
        for words in (("--factor", 2), ("--realizations", 5), ("--census", "--factor", 0.5), ("--census", "--realizations", 0)):
            self.keyblock("cut", "rock.toml", "-o", "cut", *words, expect=1)

    def test_rock_with_a_free_top_needs_no_excavation(self):
        self.write("rock.toml", ROCK + '[boundary]\nbase = "rigid"\nsides = "roller"\n')
        census = self.census()
        self.assertAlmostEqual(census["wall_m"], 12.0)
        self.assertEqual(census["layers"], 0)

    def test_a_slope_has_its_factor_of_safety(self):
        (command,) = re.findall(r"^keyblock (cut .*--census.*)$", (ROOT / "docs/slopes.md").read_text(), re.MULTILINE)
        self.keyblock("new", "slope")
        alpha, phi = math.radians(30), math.radians(40)
        for k_h in (0.0, 0.2):  # to the left: out of the slope
            self.keyblock(*command.split(), "--set", f"stage.excavated.k_h={-k_h}")
            census = json.loads((self.folder / "out/census/census.json").read_text())
            (block,) = [block for block in census["blocks"] if block["joints"] == ["bedding"]]
            normal, driving = math.cos(alpha) - k_h * math.sin(alpha), math.sin(alpha) + k_h * math.cos(alpha)
            self.assertAlmostEqual(block["factor_of_safety"], normal / driving * math.tan(phi), places=6)
            self.assertEqual(census["layers"], 0 if k_h == 0.0 else 1)

    def test_what_is_left_out_is_told(self):
        self.write("rock.toml", ROCK + TUNNEL + 'pressure = 1.0e4\n')
        said = self.keyblock("cut", "rock.toml", "-o", "cut", "--census").stderr
        self.assertIn("leaves out the pressure of [[excavation]]", said)

    def test_the_examples_of_the_guide(self):
        page = (ROOT / "docs/guide/limits.md").read_text()
        one, many = re.findall(r"^keyblock (cut .*--census.*)$", page, re.MULTILINE)
        self.keyblock("new", "tunnel")
        said = self.keyblock(*many.replace("--realizations 200", "--realizations 6").split()).stdout
        self.assertIn("6 realizations, intervals of 95 %", said)
        said = self.keyblock(*one.replace("examples/", f"{ROOT}/examples/").split()).stdout
        # As limit tells of the run just beyond the factor of safety: "7 blocks (5.94 kN/m) have fallen, the heaviest block 34 (3.156 kN/m)".
        census = json.loads((self.folder / "out/census/census.json").read_text())
        self.assertAlmostEqual(census["totals"]["moving_weight_n_m"], 5940.0, delta=5.0)
        shown = re.search(r"^keyblock cut .*--census.*?```\n```\n(.*?)^```", page, re.MULTILINE | re.DOTALL)[1]
        for line in shown.splitlines():
            if line != "…":
                self.assertIn(line + "\n", said)


class AgainstRuns(Scenario):
    """A run has the stress that the weight of the rock puts into it, and joints clamp blocks: it lets fewer go. What it lets go, the census has."""

    def fallen_or_loose(self, realization, *arguments):
        out = f"run{realization}"
        self.keyblock("run", "rock.toml", "-o", out, "--realization", realization, *arguments)
        self.keyblock("export", out, "--format", "csv")
        with open(self.folder / out / "csv/blocks.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        last = rows[-1]["frame"]
        return {int(row["block"]) for row in rows if row["frame"] == last and row["status"] in ("fallen", "loosened")}

    def moving(self, realization, *arguments):
        self.keyblock("cut", "rock.toml", "-o", "cut", "--census", "--realization", realization, *arguments)
        census = json.loads((self.folder / "cut/census.json").read_text())
        return {block["block"] for block in census["blocks"] if block["layer"]}

    def test_what_falls_is_in_the_census(self):
        self.write("rock.toml", ROCK + TUNNEL + STAGES)
        fell = counted = 0
        for realization in (1, 2, 5, 6, 8):
            loose, moving = self.fallen_or_loose(realization), self.moving(realization)
            self.assertLessEqual(loose, moving, f"realization {realization}")
            fell, counted = fell + len(loose), counted + len(moving)
        self.assertGreater(fell, 30)
        self.assertGreater(counted, fell)

    def test_without_friction_to_clamp_them_all_of_it_falls(self):
        self.write("rock.toml", ROCK + TUNNEL + STAGES)
        little = ("--set", "joints.friction=3.0")
        self.assertLessEqual(self.moving(0, *little), self.fallen_or_loose(0, *little))


if __name__ == "__main__":
    unittest.main()
