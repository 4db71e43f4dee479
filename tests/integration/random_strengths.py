#!/usr/bin/env python3
"""Strengths of joints that are drawn: factors of safety over realizations against the exact distribution, and what outputs have."""

import csv
import json
import math
import re
import shlex
import signal
import statistics
import subprocess
import unittest

from program import PROGRAM, ROOT, Scenario, wait_for
from study_case import GALLERY

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


class Pages(Random):
    def snippet(self, page, heading, language):
        text = (ROOT / "docs" / page).read_text().split(heading, 1)[1]
        return re.search(rf"```{language}\n(.*?)```", text, re.DOTALL)[1]

    def test_what_pages_say_runs(self):
        gallery = GALLERY.replace("friction = 25.0\n", "", 1)
        keys = self.snippet("guide/joints.md", "## Random strengths", "toml").split('name = "bedding"\n')[1]
        self.write("gallery.toml", gallery.replace('name = "flat"\n', 'name = "flat"\n' + keys) + self.snippet("studies.md", "**Latin hypercube.**", "toml"))
        self.assertRegex(self.keyblock("check", "gallery.toml").stdout, r"friction of “flat”, drawn: 3\d.* on the mean of \d+ traces")
        self.keyblock("new", "slope")
        words = shlex.split(self.snippet("slopes.md", "## How likely is failure", "sh"))
        words[words.index("100")] = "4"
        self.assertIn("probability of a factor below 1: ", self.keyblock(*words[1:]).stdout)
        self.assertEqual(len(self.found("out/likely")["realizations"]), 4)


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
        hashes = [[trial["state_hash"] for trial in self.found(out)["realizations"][0]["trials"]] for out in ("out", "json")]
        self.assertEqual(*hashes)
        for wrong, words in (("95", "a friction angle, at least 0 and below 90°"), ("steep", '"steep"')):
            self.write("map.csv", header + plane.replace(",33,", f",{wrong},"))
            said = self.keyblock("check", "slope.toml", expect=1).stderr
            self.assertIn(words, said)
            self.assertRegex(said, r"map\.csv:2:25: friction")


class ManyRealizations(Random):
    """F = tan φ / tan α + c L / (W sin α) of each draw, of the slope of docs/slopes.md: 1.8364 at 40° and 50 kPa."""

    FRICTION, COHESION = (28.0, 2.5), (12e3, 4e3)
    SLOPE_OF_COHESION = (1.8364 - math.tan(math.radians(40)) / math.tan(ALPHA)) / 50e3

    def factor(self, strengths):
        return math.tan(math.radians(strengths["bedding.friction"])) / math.tan(ALPHA) + self.SLOPE_OF_COHESION * strengths["bedding.cohesion"]

    def search(self, count, out, *more, per="joint", tolerance=0.05):
        cohesion = normal(*self.COHESION, per)
        sets = self.sets(friction=normal(*self.FRICTION, per), cohesion=cohesion, residual_cohesion=cohesion)
        return ["safety", SLOPE, *sets, "--from", 0.6, "--to", 1.6, "--tolerance", tolerance, "--realizations", count, "--set", 'study.keep="measures"', "-o", out, *more]

    def parts(self, n=4000):
        """Quantiles of tan φ / tan α and of the share of cohesion."""
        deviates = [statistics.NormalDist().inv_cdf((k + 0.5) / n) for k in range(n)]
        friction = [math.tan(math.radians(self.FRICTION[0] + self.FRICTION[1] * z)) / math.tan(ALPHA) for z in deviates]
        return friction, [self.SLOPE_OF_COHESION * max(0.0, self.COHESION[0] + self.COHESION[1] * z) for z in deviates]

    def holds(self, estimate, exact):
        self.assertLessEqual(estimate["low"], exact)
        self.assertGreaterEqual(estimate["high"], exact)

    def test_the_probability_of_failure_and_what_it_hangs_on(self):
        """Against exact numbers, after the search was killed and resumed."""
        process = subprocess.Popen([PROGRAM, *map(str, self.search(100, "out", "--workers", 2))], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_for(lambda: len(list((self.folder / "out").glob("runs/*/run.json"))) > 40, "forty runs")
        process.send_signal(signal.SIGKILL)
        process.wait()
        said = self.keyblock(*self.search(100, "out", "--workers", 2, "--resume")).stdout
        found = self.found()
        realizations, failure, mean = found["realizations"], found["probability_below_1"], found["mean"]
        for realization in realizations:
            factor = self.factor(realization["strengths"])
            self.assertLess(realization["bracket"]["not_met"], 1.001 * factor)
            self.assertGreater(realization["bracket"]["met"], 0.999 * factor)
        friction, cohesion = self.parts()
        mean_factor = statistics.mean(friction) + statistics.mean(cohesion)
        below = sum(statistics.NormalDist(statistics.mean(cohesion), statistics.pstdev(cohesion)).cdf(1.0 - f) for f in friction) / len(friction)
        self.assertEqual(failure["n"], 100)
        self.holds(failure, below)
        self.holds(mean, mean_factor)
        self.assertIn("probability of a factor below 1: ", said)
        limits = [realization["limit"] for realization in realizations]
        self.assertAlmostEqual(mean["value"], statistics.mean(limits), places=9)
        self.assertAlmostEqual(mean["standard_deviation"], statistics.stdev(limits), places=9)
        reach = 1.98421695 * statistics.stdev(limits) / 10  # t of 99 degrees of freedom
        self.assertAlmostEqual(mean["high"] - mean["value"], reach, places=6)
        drawn = [realization["strengths"]["bedding.friction"] for realization in realizations]
        self.assertAlmostEqual(statistics.mean(drawn), self.FRICTION[0], delta=3 * self.FRICTION[1] / 10)
        self.assertAlmostEqual(statistics.stdev(drawn), self.FRICTION[1], delta=3 * self.FRICTION[1] / math.sqrt(200))
        # Of a sum of independent parts each index is its share of the variance.
        variances = {"bedding.friction": statistics.pvariance(friction), "bedding.cohesion": statistics.pvariance(cohesion)}
        hangs_on = {one["strength"]: one for one in found["hangs_on"]}
        self.assertEqual(set(hangs_on), {"bedding.friction", "bedding.cohesion", "bedding.residual_cohesion"})
        for name, variance in variances.items():
            self.holds(hangs_on[name]["first_order_index"], variance / sum(variances.values()))
            self.holds(hangs_on[name]["rank_correlation"], 6 / math.pi * math.asin(0.5 * math.sqrt(variance / sum(variances.values()))))
        rows = {row["quantity"]: row for row in self.table("out/statistics.csv")}
        self.assertEqual(float(rows["mean"]["value"]), mean["value"])
        self.assertEqual(float(rows["probability below 1"]["high"]), failure["high"])
        self.assertEqual([float(row["bedding.friction"]) for row in self.table("out/limits.csv")], drawn)
        page = (self.folder / "out/report.html").read_text()
        for words in ("probability that it is below 1", "What it hangs on", "friction of “bedding”"):
            self.assertIn(words, page)

    def test_any_number_of_workers_and_a_latin_hypercube(self):
        hypercube = ("--set", 'study.sampling="latin_hypercube"')
        for out, workers in (("one", 1), ("two", 2)):
            self.keyblock(*self.search(10, out, "--workers", workers, *hypercube, per="realization", tolerance=0.4))
        self.assertEqual((self.folder / "one/limit.json").read_text(), (self.folder / "two/limit.json").read_text())
        for key, (mean, std) in (("friction", self.FRICTION), ("cohesion", self.COHESION)):
            share = [statistics.NormalDist(mean, std).cdf(one["strengths"][f"bedding.{key}"]) for one in self.found("one")["realizations"]]
            self.assertEqual(sorted(int(10 * u) for u in share), list(range(10)))
        said = self.keyblock("check", SLOPE, *hypercube).stderr
        self.assertIn("no strength is drawn once in each realization", said)


if __name__ == "__main__":
    unittest.main()
