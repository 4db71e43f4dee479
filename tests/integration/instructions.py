#!/usr/bin/env python3
"""The program has no fused multiply-add, which would round otherwise than builds for machines without one."""

import os
import platform
import re
import shutil
import subprocess
import unittest

FUSED = {"x86_64": re.compile(r"\tvfn?m(add|sub)"), "aarch64": re.compile(r"\tfn?m(add|sub|la|ls)\b")}


class Instructions(unittest.TestCase):
    @unittest.skipUnless(platform.machine() in FUSED, "no list of instructions for this machine")
    @unittest.skipUnless(shutil.which("objdump"), "needs objdump (binutils)")
    def test_no_fused_multiply_add(self):
        listing = subprocess.run(
            ["objdump", "--disassemble", "--no-show-raw-insn", os.environ["KEYBLOCK"]],
            check=True, capture_output=True, text=True,
        ).stdout
        self.assertGreater(listing.count("\n"), 100_000)
        fused = FUSED[platform.machine()]
        self.assertEqual([line for line in listing.splitlines() if fused.search(line)], [])


if __name__ == "__main__":
    unittest.main()
