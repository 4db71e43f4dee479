#!/usr/bin/env python3
"""The C++ library as it is installed, and a program outside the tree that is built against it, by CMake and by pkg-config."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from program import ROOT

BUILD = pathlib.Path(os.environ["KEYBLOCK"]).parent
EXAMPLE = ROOT / "tests/package/example"


class Library(unittest.TestCase):
    def call(self, *words, **options):
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, **options)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.prefix = self.folder / "usr"
        self.call("cmake", "--install", BUILD, "--component", "library", "--prefix", self.prefix)

    def check_program(self, program, **options):
        out = self.folder / f"{program.name}-out"
        said = self.call(program, ROOT / "examples/03-block-on-incline.toml", out, **options)
        self.assertIn("blocks 2\n", said)
        self.assertIn("braked 1\n", said)
        self.assertIn("refused rock.young\n", said)
        self.assertTrue((out / "report.html").stat().st_size > 1000)

    def test_a_program_outside_the_tree(self):
        build = self.folder / "build"
        self.call("cmake", "-S", EXAMPLE, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-G", "Ninja")
        self.call("cmake", "--build", build)
        self.check_program(build / "outside")

    def test_by_pkg_config(self):
        description = next(self.prefix.rglob("keyblock.pc"))
        # It goes by its own place: the tree may be moved.
        moved = self.prefix.rename(self.folder / "moved")
        description = moved / description.relative_to(self.prefix)
        self.prefix = moved
        flags = self.call("pkg-config", "--cflags", "--libs", "keyblock", env={**os.environ, "PKG_CONFIG_PATH": str(description.parent)})
        program = self.folder / "by-pkg-config"
        self.call(shutil.which("g++"), "-std=c++20", EXAMPLE / "main.cpp", "-o", program, *flags.split())
        libraries = next(self.prefix.rglob("libkeyblock.so")).parent
        self.check_program(program, env={**os.environ, "LD_LIBRARY_PATH": str(libraries)})

    def test_nothing_else_is_seen(self):
        library = next(self.prefix.rglob("libkeyblock.so"))
        names = self.call("nm", "-D", "--defined-only", "-C", library).splitlines()
        ours = [name for name in names if " T " in name and "keyblock::" in name]
        self.assertGreater(len(ours), 20)
        for name in ours:
            self.assertNotRegex(name, r"keyblock::(simulation|scenario|dynamics|linalg|contact)::")


if __name__ == "__main__":
    unittest.main()
