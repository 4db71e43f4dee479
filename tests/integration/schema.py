#!/usr/bin/env python3
"""The schema of scenarios: it accepts all of them, and finds mistakes."""

import copy
import json
import subprocess
import tomllib
import unittest

import jsonschema
from program import PROGRAM, ROOT

# They are wrong on purpose, or have nothing but joints.
FOLDERS = ("examples", "verification/scenarios", "tests/data/hard", "benchmarks/hard-tunnels", "apps/keyblock/templates")


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

    def test_the_shipped_one_is_that_of_the_program(self):
        self.assertEqual((ROOT / "examples/keyblock.schema.json").read_text(), self.text)
        for file in sorted((ROOT / "examples").glob("*.toml")):
            self.assertEqual(file.read_text().splitlines()[0], "#:schema ./keyblock.schema.json", file.name)


if __name__ == "__main__":
    unittest.main()
