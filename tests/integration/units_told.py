#!/usr/bin/env python3
"""Every value of every template a thousand times too large and too small: `keyblock check` has a word on it, or it is listed here why not."""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from program import PROGRAM

TEMPLATES = ("arch", "beam", "column", "slope", "study", "tunnel", "wall")

# What may be anything: patterns of key paths.
ANYTHING = {
    r"seed": "any number will do",
    r"motion.*cycles": "told by the table of what is usual; thousands of cycles take minutes to check",
    r"study\.realizations": "as many as are wanted",
    r"study\.vary\..*": "looked at value by value where it is a key with a unit",
}


def is_numeric(value):
    if isinstance(value, list):
        return bool(value) and all(is_numeric(item) for item in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def scaled(value, factor):
    if isinstance(value, list):
        return [scaled(item, factor) for item in value]
    product = value * factor
    return round(product) if isinstance(value, int) and product == round(product) else product


def segment(key):
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else f"'{key}'"


def numbers_of(value, path=""):
    """Key paths of numbers, and of lists of numbers as one."""
    if is_numeric(value):
        yield path, value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from numbers_of(item, f"{path}.{segment(key)}" if path else segment(key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from numbers_of(item, f"{path}[{index}]")


def check(file, *overrides):
    """The mistakes and warnings of a scenario."""
    words = [word for override in overrides for word in ("--set", override)]
    done = subprocess.run([PROGRAM, "check", str(file), "--json", *words], capture_output=True, text=True, timeout=300)
    if done.returncode not in (0, 1):
        raise AssertionError(f"{overrides}: exit code {done.returncode}: {done.stderr[-500:]}")
    told = json.loads(done.stdout)
    return {mistake["key"] for mistake in told["mistakes"]} | set(told.get("warnings", []))


class UnitsTold(unittest.TestCase):
    def test_values_a_thousand_times_too_large_or_small(self):
        with tempfile.TemporaryDirectory() as folder:
            tries = []
            for name in TEMPLATES:
                file = Path(folder) / f"{name}.toml"
                subprocess.run([PROGRAM, "new", name, "-o", str(file)], check=True, capture_output=True)
                before = check(file)
                for path, value in numbers_of(tomllib.loads(file.read_text())):
                    if value in (0, 0.0) or any(re.fullmatch(pattern, path) for pattern in ANYTHING):
                        continue
                    for factor in (1e3, 1e-3):
                        tries.append((name, file, before, path, value, factor))

            def unnoticed(attempt):
                name, file, before, path, value, factor = attempt
                told = check(file, f"{path}={json.dumps(scaled(value, factor))}")
                return None if told - before else f"{name}: {path} = {value} × {factor:g}"

            with ThreadPoolExecutor(2) as pool:
                missed = [text for text in pool.map(unnoticed, tries) if text]
        print(f"{len(tries)} values, {len(missed)} that nobody noticed", *missed, sep="\n  ", file=sys.stderr)
        self.assertEqual([text for text in missed if not any(re.search(p, text) for p in MEANT)], [])


# What is a good model, though not the one that was meant: patterns of the lines above, with the reason.
MEANT = {
    r"(point|invert|from|to) = ": "a point of a block, or of rock, as good as the one that was meant",
    r"duration = 20.0 × 0.001": "20 ms is as short as the rest of an example",
    r"study\.level": "a level may be as low as anybody likes",
}


if __name__ == "__main__":
    unittest.main()
