#!/usr/bin/env python3
"""The schema of scenarios: it accepts all of them, and finds mistakes."""

import copy
import json
import math
import random
import subprocess
import tempfile
import tomllib
import unittest

import jsonschema
from program import PROGRAM, ROOT

# They are wrong on purpose, or have nothing but joints.
FOLDERS = ("examples", "verification/scenarios", "tests/data/hard", "benchmarks/hard-tunnels", "apps/keyblock/templates")

# At an edge of something, or of another kind.
VALUES = [0, 1, -1, 0.0, -0.5, 1e-300, 1e300, 90, 90.0, 89.999, 0.5, 360, 360.0, 361, 24, 1.5, True, "", "auto", "x", "frame", "still", "nope", [], [1],
          [1, 2], [2, 1], [1.0, 2.0, 3.0], {}, {"mean": 1.0}, {"mean": 0.0, "distribution": "constant"}, [[0, 0], [1, 1]], "up", math.inf, 2**53 + 1]  # fmt: skip
TRIES = 400


def places(value, path=()):
    """Of all that is in a document, but points of long lists."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) and len(value) < 30 else ()
    for key, item in items:
        yield from places(item, (*path, key))


def toml(value, depth=0):
    if isinstance(value, dict):
        pairs = [f"{json.dumps(key)} = {toml(item, depth + 1)}" for key, item in value.items()]
        return "{ " + ", ".join(pairs) + " }" if depth else "\n".join(pairs) + "\n"
    if isinstance(value, list):
        return "[" + ", ".join(toml(item, depth + 1) for item in value) + "]"
    if isinstance(value, float):
        return "inf" if value == math.inf else repr(value)
    return json.dumps(value)


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = subprocess.run([PROGRAM, "schema"], capture_output=True, text=True, check=True).stdout
        cls.text = text
        cls.schema = json.loads(text)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def problems(self, document):
        return [f"{'/'.join(map(str, error.absolute_path))}: {error.message[:200]}" for error in self.validator.iter_errors(document)]

    def test_all_scenarios_are_accepted(self):
        files = [file for folder in FOLDERS for file in sorted((ROOT / folder).glob("*.toml"))]
        self.assertGreater(len(files), 100)
        for file in files:
            with self.subTest(file=file.name):
                self.assertEqual(self.problems(tomllib.loads(file.read_text())), [])

    def check(self, file):
        """Whether the program takes a scenario."""
        done = subprocess.run([PROGRAM, "check", str(file), "--json"], capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 1), f"{file}: {done.stderr[-500:]}")
        self.assertEqual(json.loads(done.stdout)["ok"], done.returncode == 0, file)
        return done.returncode == 0

    def test_what_the_program_takes_the_schema_takes(self):
        """Of every scenario in the repository and of those that fuzzers begin with. The schema may take more."""
        files = [file for folder in ("apps", "benchmarks", "examples", "python", "tests", "verification") for file in (ROOT / folder).rglob("*.toml")]
        files += (ROOT / "tests/fuzz/corpus/scenario").iterdir()
        refused = 0
        for file in sorted(set(files)):
            try:
                document = tomllib.loads(file.read_text())
            except (tomllib.TOMLDecodeError, UnicodeDecodeError):
                continue
            problems = self.problems(document)
            if not problems:
                continue
            refused += 1
            with self.subTest(file=file.name):
                self.assertFalse(self.check(file), problems[:3])
        self.assertGreater(refused, 10, "those that are wrong on purpose")

    def test_scenarios_that_were_changed(self):
        """One value of a scenario becomes another one, is taken out or put in a list: what the program takes, the schema takes."""
        draw = random.Random(1)
        scenarios = [file for folder in FOLDERS[3:] + FOLDERS[:1] for file in sorted((ROOT / folder).glob("*.toml"))]
        refused = 0
        for _ in range(TRIES):
            file = draw.choice(scenarios)
            document = tomllib.loads(file.read_text())
            place = draw.choice(list(places(document)))
            holder = document
            for key in place[:-1]:
                holder = holder[key]
            kind = draw.choice(["set", "set", "set", "delete", "wrap", "negate"])
            if kind == "delete":
                del holder[place[-1]]
            elif kind == "wrap":
                holder[place[-1]] = [holder[place[-1]]]
            elif kind == "negate" and isinstance(holder[place[-1]], float):
                holder[place[-1]] *= -1.0
            else:
                holder[place[-1]] = copy.deepcopy(draw.choice(VALUES))
            problems = self.problems(document)
            if not problems:
                continue
            refused += 1
            with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=ROOT / "examples") as changed:
                changed.write(toml(document))
                changed.flush()
                self.assertFalse(self.check(changed.name), (file.name, place, problems[:3]))
        self.assertGreater(refused, TRIES // 4)

    def test_mistakes_are_found(self):
        right = tomllib.loads((ROOT / "examples/01-tunnel.toml").read_text())
        self.assertEqual(self.problems(right), [])

        def spoil(change):
            wrong = copy.deepcopy(right)
            change(wrong)
            return self.problems(wrong)

        self.assertTrue(spoil(lambda s: s["rock"].update(colour="grey")))
        self.assertTrue(spoil(lambda s: s["rock"].update(density=-3.0)))
        self.assertTrue(spoil(lambda s: s["rock"].update(young="stiff")))
        self.assertTrue(spoil(lambda s: s["rock"].update(state="plain-strain")))
        self.assertTrue(spoil(lambda s: s["joint_set"][0].update(dip=120.0)))
        self.assertTrue(spoil(lambda s: s["joint_set"][0]["spacing"].update(mena=1.0)))
        self.assertTrue(spoil(lambda s: s["stage"][0].pop("name")))
        self.assertTrue(spoil(lambda s: s["stage"][0].update(kind="setle")))
        self.assertTrue(spoil(lambda s: s["domain"].update(x=[1.0, 2.0, 3.0])))
        self.assertTrue(spoil(lambda s: s.update(tunnel={})))
        self.assertTrue(spoil(lambda s: s["motion"][0]["components"][0].update(file=3)))

    def test_elements_of_rows_and_of_what_may_be_of_several_kinds(self):
        right = {
            "rock": {"density": 2600.0, "young": 1e9, "poisson": 0.2},
            "motion": [{"name": "m", "x": [[0, 0.0], [1, 2.0]]}, {"name": "n", "x": {"amplitude": 1, "frequency": 2, "cycles": 1}}],
            "joint_set": [{"name": "J", "dip": 1, "dip_direction": 1, "spacing": 1, "length": {"mean": 1.0, "distribution": "constant"}, "gap": 0}],
            "excavation": [{"name": "E", "shape": "circle", "center": [0, 0], "diameter": 1, "pressure": [[0, 1e3], [1, 2e3]]}],
            "stage": [{"name": "s", "kind": "settle", "release": {"E": 0.5}}],
            "gravity": 9.81,
        }
        self.assertEqual(self.problems(right), [])

        def spoil(change):
            wrong = copy.deepcopy(right)
            change(wrong)
            return self.problems(wrong)

        for rows in ([[0, "x"]], [[0, 1, 2]], [0, 1], [], "x"):
            self.assertTrue(spoil(lambda s, rows=rows: s["motion"][0].update(x=rows)), rows)
            self.assertTrue(spoil(lambda s, rows=rows: s["excavation"][0].update(pressure=rows)), rows)
        self.assertTrue(spoil(lambda s: s["motion"][1]["x"].update(amplitude="x")))
        self.assertTrue(spoil(lambda s: s["joint_set"][0].update(gap=[1])))
        self.assertTrue(spoil(lambda s: s["excavation"][0].update(pressure=["still"])))
        self.assertTrue(spoil(lambda s: s["excavation"][0].update(pressure={"s": "still"})))
        self.assertTrue(spoil(lambda s: s["stage"][0].update(release="all")))
        self.assertTrue(spoil(lambda s: s.update(gravity="down")))
        self.assertTrue(spoil(lambda s: s["rock"].update(order=[1])))

    def test_the_shipped_one_is_that_of_the_program(self):
        self.assertEqual((ROOT / "examples/keyblock.schema.json").read_text(), self.text)
        for file in sorted((ROOT / "examples").glob("*.toml")):
            self.assertEqual(file.read_text().splitlines()[0], "#:schema ./keyblock.schema.json", file.name)


if __name__ == "__main__":
    unittest.main()
