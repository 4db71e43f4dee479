"""Runs the program as a user does. The path of the program is in the environment variable KEYBLOCK."""

import contextlib
import json
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("KEYBLOCK", str(ROOT / "build/release/keyblock"))

# A block that slides down an incline: two blocks, one contact, a fraction of a second.
INCLINE = """
title = "A block on an incline"

[rock]
density = 2600.0
young = 1.0e9
poisson = 0.2
state = "plane-stress"

[joints]
friction = 20.0

[time]
step = 0.001

[[block]]
name = "base"
outer = [[0.0, 0.0], [10.0, 0.0], [0.0, 5.773502691896258]]
fixed = true

[[block]]
name = "slider"
outer = [[1.0, 5.196152422706632], [1.866025403784439, 4.696152422706632], [2.366025403784439, 5.562177826491071], [1.5, 6.062177826491071]]

[[history]]
name = "s"
block = "slider"
point = [1.433, 5.63]

[[stage]]
name = "slide"
kind = "rest"
duration = 0.5
"""


def wait_for(condition, what, seconds=30.0):
    """What the condition returns, once that is true. Throws TimeoutError."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.02)
    raise TimeoutError(f"waited in vain: {what}")


def process_of(words, folder=None):
    """The id of a process whose command line contains these words, one after the other, and which runs in the folder."""
    wanted = "\0".join(words) + "\0"
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        with contextlib.suppress(OSError), open(f"/proc/{entry}/cmdline", errors="replace") as file:
            if wanted in file.read() and (folder is None or os.path.samefile(f"/proc/{entry}/cwd", folder)):
                return int(entry)
    return None


class Scenario(unittest.TestCase):
    """A test in a folder of its own that holds incline.toml."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="keyblock-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scenario = self.write("incline.toml", INCLINE)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def keyblock(self, *arguments, expect=0):
        """Runs the program and returns what it wrote; fails unless it exits with `expect`."""
        done = subprocess.run(
            [PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60
        )
        self.assertEqual(done.returncode, expect, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def summary(self, directory):
        return json.loads((self.folder / directory / "summary.json").read_text())
