#!/usr/bin/env python3
"""`keyblock verify`: the quick problems with known answers hold, and the table has the form it should."""

import json
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, Scenario

CASES = ROOT / "verification"

CASE = """
title = "Half a second on an incline"
case = 4
about = "A block & an <incline>."

[[run]]
name = "slide"
scenario = "incline.toml"
orders = [1, 2]

[[run.quantity]]
name = "distance"
unit = "m"
value = "hypot(end('s.ux'), end('s.uy'))"
expected = "FACTOR*0.5*9.81*(sin(rad(30)) - cos(rad(30))*tan(rad(20)))*0.5^2"
tolerance = 1e-3
published = 0.2
"""

ROW = {
    "name": str, "case": int, "quantity": str, "unit": str, "run": str, "order": (int, type(None)), "parameters": dict,
    "computed": (float, int, type(None)), "expected": (float, int, type(None)), "relative_error": (float, int, type(None)),
    "published_dda": (float, int, type(None)), "source": str, "tolerance": (float, int, type(None)),
    "absolute_tolerance": (float, int, type(None)), "pass": bool, "wall_time_s": (float, int),
}  # fmt: skip


class QuickCases(unittest.TestCase):
    def test_hold(self):
        done = subprocess.run([PROGRAM, "verify", "--cases", CASES, "--format", "json"], capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        table = json.loads(done.stdout)
        self.check_form(table)
        wrong = [
            f"{r['name']}, {r['run']}, {r['quantity']}, order {r['order']}, {r['parameters']}: {r['computed']}, expected {r['expected']} {r.get('failure', '')}"
            for r in table["rows"]
            if not r["pass"]
        ]
        self.assertEqual(wrong, [])
        self.assertEqual(done.returncode, 0)
        print(f"{table['passed']} rows of {len(table['cases'])} cases, {table['wall_time_s']:.0f} s", file=sys.stderr)

    def check_form(self, table):
        self.assertEqual(table["passed"] + table["failed"], len(table["rows"]))
        self.assertEqual(sum(c["rows"] for c in table["cases"]), len(table["rows"]))
        for row in table["rows"]:
            for key, kind in ROW.items():
                self.assertIsInstance(row[key], kind, (key, row))
            bounds = ("at_most" in row) + ("at_least" in row)
            self.assertEqual(bounds, 1 if row["expected"] is None else 0, row)

    def test_what_the_generator_writes_is_there(self):
        done = subprocess.run([sys.executable, CASES / "generate.py", "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)


class Verify(Scenario):
    def setUp(self):
        super().setUp()
        self.folder.joinpath("cases").mkdir()
        self.place("slide", CASE.replace("FACTOR", "1"))

    def place(self, name, text):
        self.write(f"cases/{name}.toml", text.replace('"incline.toml"', '"../incline.toml"'))

    def verify(self, *arguments, expect=0):
        return self.keyblock("verify", "--cases", "cases", *arguments, expect=expect)

    def test_table(self):
        text = self.verify().stdout
        self.assertIn("4 slide: Half a second on an incline", text)
        self.assertRegex(text, r"distance, m +1 +0\.2266\d+ +0\.2266\d+ +[-+][\d.e-]+( %)? +0\.2 +0\.1 % +ok\n")
        self.assertIn("all 2 rows of 1 cases hold", text)

    def test_a_row_that_does_not_hold(self):
        self.place("wrong", CASE.replace("FACTOR", "1.01"))
        text = self.verify(expect=1).stdout
        self.assertIn("FAIL", text)
        self.assertIn("2 of 4 rows of 2 cases do not hold", text)
        self.assertIn("all 2 rows", self.verify("slide").stdout)

    def test_one_order(self):
        self.assertEqual([r["order"] for r in json.loads(self.verify("--order", 2, "--format", "json").stdout)["rows"]], [2])
        self.assertIn("nothing to do", self.verify("--order", 7, expect=1).stderr)

    def test_any_number_of_workers(self):
        tables = []
        for workers in (1, 4):
            rows = json.loads(self.verify("--workers", workers, "--format", "json").stdout)["rows"]
            tables.append([(r["order"], r["computed"]) for r in rows])
        self.assertEqual(*tables)

    def test_long_cases(self):
        self.place("slide", CASE.replace("FACTOR", "1").replace("case = 4", "case = 4\nlong = true"))
        self.assertIn("nothing to do", self.verify(expect=1).stderr)
        self.verify("--all")
        self.verify("slide")

    def test_page(self):
        self.assertIn("t.html", self.verify("--format", "html", "-o", "t.html").stdout)
        page = (self.folder / "t.html").read_text()
        self.assertIn("A block &amp; an &lt;incline&gt;.", page)
        self.assertNotIn("http", page)

    def test_mistakes(self):
        self.assertIn("did you mean 'slide'?", self.verify("slid", expect=1).stderr)
        self.assertIn("none of table", self.verify("--format", "pdf", expect=1).stderr)
        self.assertIn("a folder of case files", self.keyblock("verify", "--cases", "gone", expect=1).stderr)
        self.place("slide", CASE.replace("hypot(", "hypo("))
        error = self.verify(expect=1).stderr
        self.assertRegex(error, r"slide\.toml:\d+:9: run\.slide\.quantity\.distance\.value: .*did you mean 'hypot'\?")
        self.place("slide", CASE.replace("FACTOR", "1").replace("orders = [1, 2]", 'set = ["joints.fiction=3"]'))
        self.assertIn("did you mean 'friction'?", self.verify(expect=1).stderr)


if __name__ == "__main__":
    unittest.main()
