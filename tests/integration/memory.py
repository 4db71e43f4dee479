#!/usr/bin/env python3
"""Memory: the program asks for pages of 2 MB, in which a large model takes a third of the time; and it says so when it gets no more."""

import os
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["KEYBLOCK"]
TUNNEL = Path(__file__).resolve().parents[2] / "examples/01-tunnel.toml"
MEGABYTE = 1 << 20


def limited(megabytes, *arguments):
    """The program with so much memory, its own code included."""
    size = megabytes * MEGABYTE
    return subprocess.run(
        [PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)),
    )  # fmt: skip


class Memory(unittest.TestCase):
    def test_pages_of_2_mb_are_asked_for(self):
        if "jemalloc" not in subprocess.run(["ldd", PROGRAM], check=True, capture_output=True, text=True).stdout:
            self.skipTest("built without jemalloc")
        options = subprocess.run(
            [PROGRAM, "--version"], check=True, capture_output=True, text=True,
            env={**os.environ, "MALLOC_CONF": "stats_print:true"},
        ).stderr
        self.assertRegex(options, r'opt\.thp: "always"')

    def test_a_program_that_gets_no_more_says_so(self):
        least = next(size for size in range(40, 4000, 10) if limited(size, "--version").returncode == 0)
        with tempfile.TemporaryDirectory(prefix="keyblock-") as folder:
            large = ("--set", "domain.x=[-30.0, 30.0]", "--set", "domain.y=[-30.0, 30.0]", "-o", folder + "/cut")
            said = []
            for more in range(5, 50, 9):
                done = limited(least + more, "cut", TUNNEL, *large)
                self.assertIn(done.returncode, (0, 2), f"{more} MB\n{done.stderr}")
                said += done.stderr.splitlines() if done.returncode == 2 else []
            self.assertRegex(said[0], r"^keyblock: out of memory")
            self.assertTrue(any("out of memory for the cutting of " in line for line in said), said)
            for more in (8, 16):
                done = limited(least + more, "run", TUNNEL, "-o", f"{folder}/run{more}")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertRegex(done.stderr, r"out of memory|allocat")  # our own words, or the words of the library for result files


if __name__ == "__main__":
    unittest.main()
