#!/usr/bin/env python3
"""The program asks for memory in pages of 2 MB: a large model takes a third of the time where the system gives them only to those who ask."""

import os
import subprocess
import unittest

PROGRAM = os.environ["KEYBLOCK"]


class Memory(unittest.TestCase):
    def test_pages_of_2_mb_are_asked_for(self):
        if "jemalloc" not in subprocess.run(["ldd", PROGRAM], check=True, capture_output=True, text=True).stdout:
            self.skipTest("built without jemalloc")
        options = subprocess.run(
            [PROGRAM, "--version"], check=True, capture_output=True, text=True,
            env={**os.environ, "MALLOC_CONF": "stats_print:true"},
        ).stderr
        self.assertRegex(options, r'opt\.thp: "always"')


if __name__ == "__main__":
    unittest.main()
