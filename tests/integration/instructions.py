#!/usr/bin/env python3
"""The program has no fused multiply-add but in the kernels that ask for it by name, which other machines compute alike."""

import os
import platform
import re
import shutil
import subprocess
import unittest

FUSED = {"x86_64": re.compile(r"\tvfn?m(add|sub)"), "aarch64": re.compile(r"\tfn?m(add|sub|la|ls)\b")}

# Of the namespace that has the kernels; some names of lambdas within lambdas are beyond objdump's demangling.
KERNELS = re.compile(r"keyblock::linalg::|8keyblock6linalg")


class Instructions(unittest.TestCase):
    @unittest.skipUnless(platform.machine() in FUSED, "no list of instructions for this machine")
    @unittest.skipUnless(shutil.which("objdump"), "needs objdump (binutils)")
    def test_no_fused_multiply_add(self):
        listing = subprocess.run(
            ["objdump", "--disassemble", "--demangle", "--no-show-raw-insn", os.environ["KEYBLOCK"]],
            check=True, capture_output=True, text=True,
        ).stdout
        self.assertGreater(listing.count("\n"), 100_000)
        fused = FUSED[platform.machine()]
        function, found = "", {}
        for line in listing.splitlines():
            if line.endswith(">:"):
                function = line.split("<", 1)[1]
            elif fused.search(line):
                found.setdefault(function, line)
        elsewhere = {name: line for name, line in found.items() if not KERNELS.search(name)}
        self.assertEqual(elsewhere, {})
        if platform.machine() == "x86_64" and found:
            self.assertTrue(any("BlockCholesky" in name for name in found))


if __name__ == "__main__":
    unittest.main()
