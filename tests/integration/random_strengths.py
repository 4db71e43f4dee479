#!/usr/bin/env python3
"""Strengths of joints that are drawn: factors of safety over realizations against the exact distribution, and what outputs have."""

import csv
import json
import math
import unittest

from program import ROOT, Scenario

SLOPE = ROOT / "verification/scenarios/limit_slope.toml"  # a block on a plane of 30°
ALPHA = math.radians(30.0)


def normal(mean, std, per="joint", more=""):
    return f'{{ mean = {mean}, std = {std}, distribution = "normal", per = "{per}"{more} }}'


class Random(Scenario):
    def sets(self, **keys):
        """--set of keys of the plane."""
        return [word for key, value in keys.items() for word in ("--set", f"trace_map.bedding.{key}={value}")]

    def found(self, out="out"):
        return json.loads((self.folder / out / "limit.json").read_text())

    def table(self, path):
        with open(self.folder / path, newline="") as file:
            return list(csv.DictReader(file))


class Outputs(Random):
    def test_what_was_drawn_is_in_all_outputs(self):
        sets = self.sets(friction=normal(40, 3), cohesion=normal(20e3, 5e3), residual_cohesion=normal(10e3, 2e3))
        said = self.keyblock("check", SLOPE, *sets).stdout
        self.assertRegex(said, r"friction of “bedding”, drawn: \d\d\.\d+°")
        self.keyblock("run", SLOPE, *sets, "-o", "out")
        friction, cohesion, residual = self.summary("out")["joint_strengths"]
        self.assertEqual((friction["joint"], friction["key"], friction["per"], friction["traces"]), ("bedding", "friction", "joint", 1))
        self.assertEqual(friction["least"], friction["largest"])
        self.keyblock("export", "out", "--format", "csv", "-o", "csv")
        rows = self.table("csv/joints.csv")
        self.assertEqual([(row["name"], row["trace"]) for row in rows], [("bedding", "0"), ("tension crack", "")])
        self.assertAlmostEqual(float(rows[0]["friction"]), friction["mean"], places=9)
        self.assertAlmostEqual(float(rows[0]["cohesion"]), cohesion["mean"], places=6)
        self.assertAlmostEqual(float(rows[0]["residual_cohesion"]), residual["mean"], places=6)
        self.assertAlmostEqual(float(rows[0]["length"]), math.hypot(30.0, 17.32051) - 1.33, delta=0.2)
        self.assertEqual(float(rows[1]["friction"]), 40.0)

    def test_the_same_bits_with_threads_and_without_a_distribution(self):
        sets = self.sets(friction=normal(40, 3))
        for out, threads in (("one", 1), ("two", 2)):
            self.keyblock("run", SLOPE, *sets, "--threads", threads, "-o", out)
        self.assertEqual(self.summary("one")["state_hash"], self.summary("two")["state_hash"])
        drawn = self.summary("one")["joint_strengths"][0]["mean"]
        self.keyblock("run", SLOPE, *self.sets(friction=repr(drawn)), "-o", "number")
        self.assertEqual(self.summary("one")["state_hash"], self.summary("number")["state_hash"], "the trace has the strength that is told")

    def test_a_map_has_strengths_by_trace(self):
        text = SLOPE.read_text()
        begin, end = text.index("[[trace_map]]"), text.index("[[excavation]]")
        self.write("slope.toml", text[:begin] + '[[trace_map]]\nname = "mapped"\nfile = "map.csv"\nfriction = 40\n\n' + text[end:])
        header, plane, crack = "x1,y1,x2,y2,friction,cohesion\n", "20,11.33333,50,28.65384,33,\n", "50,28.65384,50,40,,0\n"
        self.write("map.csv", header + plane + crack)
        said = self.keyblock("safety", "slope.toml", "--tolerance", 0.002, "-o", "out").stdout
        exact = math.tan(math.radians(33)) / math.tan(ALPHA)
        self.assertAlmostEqual(self.found()["realizations"][0]["limit"], exact, delta=0.003 * exact, msg=said)
        feature = '{"type": "Feature", "properties": {"friction": %s}, "geometry": {"type": "LineString", "coordinates": %s}}'
        lines = [feature % ("33", "[[20, 11.33333], [50, 28.65384]]"), feature % ("null", "[[50, 28.65384], [50, 40]]")]
        self.write("map.csv", '{"type": "FeatureCollection", "features": [' + ", ".join(lines) + "]}")
        self.keyblock("safety", "slope.toml", "--tolerance", 0.002, "-o", "json")
        self.assertEqual(self.found("json")["realizations"], self.found()["realizations"])
        for wrong, words in (("95", "a friction angle, at least 0 and below 90°"), ("steep", '"steep"')):
            self.write("map.csv", header + plane.replace(",33,", f",{wrong},"))
            said = self.keyblock("check", "slope.toml", expect=1).stderr
            self.assertIn(words, said)
            self.assertRegex(said, r"map\.csv:2:25: friction")


if __name__ == "__main__":
    unittest.main()
