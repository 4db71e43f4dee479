#!/usr/bin/env python3
"""Names, lists and rules that were changed one by one: every answer is JSON, every wrong element a mistake, every rule the same work."""

import csv
import itertools
import json
import math
import os
import subprocess
import unittest

from program import INCLINE, PROGRAM, Scenario

# Control characters, what JSON escapes, direction marks, ends of lines, ends of Unicode, and what is more than one character.
CODES = [*range(0x01, 0x20), 0x22, 0x5C, 0x7F, 0x80, 0x85, 0x9B, 0xA0, 0xAD, 0x200B, 0x200C, 0x200D, 0x200E, 0x2028, 0x2029, 0x202A, 0x202E, 0x2066,
         0x61C, 0xFEFF, 0xFFF9, 0xFFFD, 0xFFFF, 0xE000, 0x1F600, 0xE0001, 0x10FFFF]  # fmt: skip
CHARACTERS = [*map(chr, CODES), "\U0001f468\u200d\U0001f469\u200d\U0001f467", "\u65e5\u672c"]
NO_UTF8 = (b"\xff", b"\xc3\x28", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xc0\xaf")
FILES = ("a\nb.toml", 'a"b.toml', "\u00e9.toml", "a\u202eb.toml", b"a\xffb.toml", "a\x1b[31mb.toml", "\U0001f600.toml", "a\\b.toml")


def quoted(text):
    return '"' + "".join(f"\\U{ord(c):08x}" for c in text) + '"'


class JsonOfNames(Scenario):
    def told(self, file):
        done = subprocess.run([PROGRAM, "check", file, "--json"], cwd=self.folder, capture_output=True)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        told = json.loads(done.stdout)
        self.assertEqual(told["ok"], done.returncode == 0)
        return told

    def test_whatever_names_and_words_hold(self):
        for character in CHARACTERS:
            name = quoted("sl" + character + "ide")
            self.write("names.toml", INCLINE.replace('name = "slide"', f"name = {name}"))
            self.assertEqual(self.told("names.toml")["mistakes"], [], ascii(character))
            self.write("names.toml", INCLINE.replace('kind = "rest"', f"kind = {quoted('r' + character)}"))
            (mistake,) = self.told("names.toml")["mistakes"]
            self.assertEqual(mistake["key"], "stage.slide.kind", ascii(character))

    def test_bytes_that_are_no_utf8(self):
        for raw in NO_UTF8:
            (self.folder / "raw.toml").write_bytes(INCLINE.encode().replace(b"A block", b"A block" + raw))
            self.assertEqual(len(self.told("raw.toml")["mistakes"]), 1, raw)

    def test_names_of_files(self):
        for name in FILES:
            path = os.path.join(os.fsencode(self.folder), os.fsencode(name))
            with open(path, "w") as file:
                file.write(INCLINE.replace("density = 2600.0", "density = -1"))
            (mistake,) = self.told(name)["mistakes"]
            self.assertEqual(mistake["key"], "rock.density", name)


# What no element of a list of tables is.
WRONG = ("1", "[]", '"x"', "true", "1979-01-01", "nan")
# Lists by an element that is right, and what else refers to its elements by their names.
LISTS = {
    "excavation": ('{name="E1"}', '[[stage]]\nexcavate=["E1"]\n'),
    "excavation with a pressure": ('{name="E1",pressure={ a=1.0 }}', '[[stage]]\nname="a"\nexcavate=["E1"]\nrelease={E1=0.5}\nkind="settle"\n'),
    "spring": ('{name="K1"}', '[[stage]]\ninstall=["K1"]\n'),
    "spring that is installed": (
        '{name="K1",from=[0.0,0.0],to=[1.0,1.0],stiffness=1.0}',
        '[[stage]]\nname="a"\nkind="rest"\nduration=1.0\ninstall=["K1"]\n',
    ),
    "stage": (
        '{name="S1",kind="rest",duration=1.0},{name="S2",kind="rest",duration=1.0}',
        '[study]\nstage="S2"\nsince="S1"\n[[excavation]]\nname="E"\npressure={S1=1.0}\n',
    ),
    "motion": ('{name="m", x={amplitude=1.0,frequency=1.0,cycles=1}}', '[[stage]]\nname="s"\nkind="shake"\nmotion="m"\n'),
    "block": (
        '{name="b",outer=[[0,0],[1,0],[1,1]]}',
        '[[load]]\nblock="b"\npoint=[0.5,0.2]\nforce=[1.0,1.0]\n[[support]]\nblock="b"\npoints=[[0.0,0.0]]\n'
        '[[history]]\nname="h"\nblock="b"\npoint=[0.5,0.2]\n[[spring]]\nfrom=[0.5,0.2]\nfrom_block="b"\nto=[0.6,0.2]\nstiffness=1.0\n',
    ),
    "joint_set": (
        '{name="J",dip=10.0,dip_direction=90.0,spacing=1.0,length=2.0,gap=0.0}',
        '[domain]\nx=[0,10]\ny=[0,10]\n[study]\n[[study.vary]]\nkey="joint_set.J.dip"\nvalues=[1.0]\n',
    ),
    "region": ("{outer=[[0,0],[1,0],[1,1]],density=1000.0}", "[domain]\nx=[0,10]\ny=[0,10]\n"),
    "trace_map": ('{name="J",points=[[0,0],[10,10]]}', "[domain]\nx=[0,10]\ny=[0,10]\n"),
    "history": ('{name="J",point=[0,0]}', "[domain]\nx=[0,10]\ny=[0,10]\n"),
}
REST = "[rock]\ndensity=2600.0\nyoung=1e9\npoisson=0.2\n[joints]\nfriction=20.0\n[time]\nstep=0.005\n"


class WrongElements(Scenario):
    def test_before_and_after_those_that_are_right(self):
        for (name, (right, others)), wrong, is_first, rest in itertools.product(LISTS.items(), WRONG, (True, False), ("", REST)):
            key = name.split()[0]
            elements = [wrong, right] if is_first else [right, wrong]
            self.write("list.toml", f"{key} = [{', '.join(elements)}]\n" + others + rest)
            done = subprocess.run([PROGRAM, "check", "list.toml", "--json"], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 1, (name, wrong, is_first, done.stderr))
            place = 0 if is_first else right.count("{name=") or 1
            keys = [mistake["key"] for mistake in json.loads(done.stdout)["mistakes"]]
            self.assertIn(f"{key}[{place}]", keys, (name, wrong, is_first))


# A block that slides to and fro on a shaken base.
SHAKEN = """
title = "block on a shaken base"
[rock]
density = 2500.0
young = 1e9
poisson = 0.2
[joints]
friction = 20.0
[time]
step = {step}
[[block]]
name = "base"
outer = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "a"
outer = [[0, 0], [1, 0], [1, 1], [0, 1]]
[[history]]
name = "s"
block = "a"
point = [0.5, 0.0]
[[motion]]
name = "m"
x = {{ amplitude = 6.0, frequency = 4.0, cycles = 4 }}
[[stage]]
name = "S"
kind = "settle"
[[stage]]
name = "Q"
kind = "shake"
motion = "m"
duration = 1.0
[solver]
{solver}
"""


class WorkByKind(Scenario):
    """What the ground puts in and friction takes out is the work of the forces on the way that is seen, whatever the rule."""

    def energy_and_way(self, solver, step):
        self.write("shaken.toml", SHAKEN.format(step=step, solver=solver))
        self.keyblock("run", "shaken.toml", "-o", "out", "--force")
        with open(self.folder / "out/histories.csv", newline="") as file:
            places = [float(row["s.ux"]) for row in csv.DictReader(file)]
        return self.summary("out")["energy"], sum(abs(b - a) for a, b in itertools.pairwise(places))

    def test_input_and_friction(self):
        weight = 2500.0 * 9.81
        rules = ('integrator = "shi"', 'integrator = "generalized-alpha"', 'integrator = "generalized-alpha"\nspectral_radius = 0.8')
        for rule, step in itertools.product(rules, (0.001, 0.004, 0.01)):
            with self.subTest(rule=rule, step=step):
                energy, way = self.energy_and_way(rule, step)
                self.assertLess(energy["residual_ratio"], 0.001)
                heat = math.tan(math.radians(20.0)) * weight * way
                self.assertAlmostEqual(energy["friction"] / heat, 1.0, delta=0.01)
                stored = energy["kinetic"] + energy["strain"] + energy["contact"]
                self.assertAlmostEqual(energy["input"] / (heat + stored), 1.0, delta=0.02)


if __name__ == "__main__":
    unittest.main()
