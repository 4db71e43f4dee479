#!/usr/bin/env python3
"""The C++ library as it is installed, and a program outside the tree that is built against it, by CMake and by pkg-config."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from program import ROOT

BUILD = pathlib.Path(os.environ["KEYBLOCK"]).parent
EXAMPLE = ROOT / "tests/package/example"


# A block that slides to and fro on shaken ground.
SHAKEN = """
rock = { density = 2500.0, young = 1e9, poisson = 0.2 }
joints = { friction = 10.0 }
time = { step = 0.02 }
history = [ { name = "top", block = "stone", point = [2.0, 0.9] } ]
block = [ { name = "floor", outer = [[0, -1], [4, -1], [4, 0], [0, 0]], fixed = true },
          { name = "stone", outer = [[1.5, 0.0], [2.5, 0.0], [2.5, 1.0], [1.5, 1.0]] } ]
motion = [ { name = "sway", x = [[0.0, 0.0], [0.25, 3.0], [0.75, -3.0], [1.25, 3.0], [1.75, -3.0], [2.25, 3.0], [2.75, -3.0], [3.25, 3.0], [3.75, -3.0],
                                 [4.25, 3.0], [4.75, -3.0], [5.25, 3.0]] } ]
stage = [ { name = "shaken", kind = "shake", motion = "sway", duration = 5.2 } ]
"""


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

    def check_manual(self, program):
        """What the program of docs/library.md did with a block that is shaken for 5.2 s."""
        (self.folder / "tunnel.toml").write_text(SHAKEN)
        self.call(program, cwd=self.folder)
        out = self.folder / "out/tunnel"
        as_run = (out / "scenario.toml").read_text()
        self.assertIn("# --set rock.young=4000000000.0\n", as_run)
        self.assertIn('{ name = "pulse", x = [[0.0, 0.0], [0.1, 2.0], [0.2, 0.0]] }', as_run)
        state = json.loads((out / "summary.json").read_text())["state_hash"]
        keyblock = os.environ["KEYBLOCK"]
        self.call(keyblock, "run", "tunnel.toml", "-o", "whole", "--set", "rock.young=4e9", cwd=self.folder)
        whole = json.loads((self.folder / "whole/summary.json").read_text())
        self.assertNotEqual(whole["state_hash"], state)  # the motion was halved for the last 0.2 s
        halved = (out / "histories.csv").read_text().splitlines()
        undisturbed = (self.folder / "whole/histories.csv").read_text().splitlines()
        same = [a == b for a, b in zip(halved, undisturbed)]
        first = same.index(False)
        self.assertAlmostEqual(float(halved[first].split(",")[0]), 5.04, delta=0.03)  # the step after the first one that ends beyond 5 s
        self.assertNotIn(True, same[first:])

    def test_the_manual(self):
        page = (ROOT / "docs/library.md").read_text()
        program, project = (re.search(rf"```{kind}\n(.*?)```", page, re.DOTALL)[1] for kind in ("cpp", "cmake"))
        line = re.search(r"`(g\+\+ [^`]*)`", page)[1]
        (self.folder / "mine.cpp").write_text(program)
        place = {**os.environ, "PKG_CONFIG_PATH": str(next(self.prefix.rglob("keyblock.pc")).parent)}
        libraries = next(self.prefix.rglob("libkeyblock.so")).parent
        self.call("sh", "-c", f"{line} -o by-line -Wl,-rpath,{libraries}", cwd=self.folder, env=place)
        self.check_manual(self.folder / "by-line")
        shutil.rmtree(self.folder / "out")
        shutil.rmtree(self.folder / "whole")
        begin = "cmake_minimum_required(VERSION 3.16)\nproject(mine LANGUAGES CXX)\nadd_executable(mine mine.cpp)\n"
        (self.folder / "CMakeLists.txt").write_text(begin + project)
        self.call("cmake", "-S", self.folder, "-B", self.folder / "build", f"-DCMAKE_PREFIX_PATH={self.prefix}", "-G", "Ninja")
        self.call("cmake", "--build", self.folder / "build")
        self.check_manual(self.folder / "build/mine")

    def test_nothing_else_is_seen(self):
        library = next(self.prefix.rglob("libkeyblock.so"))
        names = self.call("nm", "-D", "--defined-only", "-C", library).splitlines()
        ours = [name for name in names if " T " in name and "keyblock::" in name]
        self.assertGreater(len(ours), 20)
        for name in ours:
            self.assertNotRegex(name, r"keyblock::(simulation|scenario|dynamics|linalg|contact)::")


if __name__ == "__main__":
    unittest.main()
