#!/usr/bin/env python3
"""Packages for Python: the wheel has its libraries within it and gives the bits of the program; the conda recipe lists what CMake looks for."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import zipfile

from program import PROGRAM, ROOT

PYTHON = "/usr/bin/python3"
BUILT = pathlib.Path(PROGRAM).parent / "python/keyblock"

# In a process that uses h5py's own HDF5 as well.
USE = """
import sys
sys.path.insert(0, sys.argv[1])
import h5py, keyblock
scenario = keyblock.Scenario.load(sys.argv[2])
summary = scenario.run(sys.argv[3])
assert keyblock.open(sys.argv[3]).summary.state_hash == summary["state_hash"]
print(summary["state_hash"])
print(*sorted({line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}))
"""

# What CMake looks for, and its package of conda-forge.
CONDA = {
    "fmt": "fmt",
    "Eigen3": "eigen",
    "nlohmann_json": "nlohmann_json",
    "GEOS": "geos",
    "HDF5": "hdf5",
    "ZLIB": "zlib",
    "JEMALLOC": "jemalloc",
    "pybind11": "pybind11",
    "Python3": "python",
    "PkgConfig": "pkg-config",
    "CLI11": "cli11",
    "tomlplusplus": "tomlplusplus",
    "AMD": "suitesparse",
    "Random123": "random123",
}
# Of what has headers alone: the folder that is included.
HEADERS = {"CLI": "CLI11", "toml++": "tomlplusplus", "Random123": "Random123", "Eigen": "Eigen3"}
# Of the system, or of tests alone.
OTHERS = {"Threads", "GTest", "benchmark"}


class Wheel(unittest.TestCase):
    @unittest.skipUnless(shutil.which("patchelf") or os.environ.get("CI"), "patchelf is not installed")
    def test_a_wheel_with_its_libraries(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "keyblock").mkdir()
            for file in [*BUILT.glob("*.py"), *BUILT.glob("*.pyi"), *BUILT.glob("_core*.so"), BUILT / "py.typed"]:
                shutil.copy(file, folder / "keyblock")
            for file in ("pyproject.toml", "setup.py"):
                shutil.copy(ROOT / "python" / file, folder)
            subprocess.run([PYTHON, "setup.py", "--quiet", "bdist_wheel", "--dist-dir", "dist"], cwd=folder, check=True, capture_output=True)
            (plain,) = (folder / "dist").iterdir()
            made = subprocess.run([PYTHON, ROOT / "packaging/portable_wheel.py", plain, folder], check=True, capture_output=True, text=True)
            wheel = pathlib.Path(made.stdout.strip())
            self.assertRegex(wheel.name, r"^keyblock-[\d.]+-cp3\d+-cp3\d+-manylinux_2_\d+_\w+\.whl$")
            with zipfile.ZipFile(wheel) as packed:
                packed.extractall(folder / "site")
                names = packed.namelist()
            self.assertIn("keyblock/_core.pyi", names)
            self.assertIn("keyblock/py.typed", names)
            self.assertTrue(any(re.fullmatch(r"keyblock\.libs/libgeos-[0-9a-f]{8}\.so.*", each) for each in names))
            example = ROOT / "examples/03-block-on-incline.toml"
            done = subprocess.run([PYTHON, "-I", "-c", USE, folder / "site", example, folder / "out"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            state, loaded = done.stdout.splitlines()
            ours = [file for file in loaded.split() if "/keyblock.libs/" in file]
            self.assertTrue(any("libhdf5" in file for file in ours) and any("libgeos_c" in file for file in ours))
            self.assertFalse([file for file in loaded.split() if re.search(r"/usr/.*/lib(geos|fmt|amd)", file)])
            subprocess.run([PROGRAM, "run", example, "-o", folder / "program"], check=True, capture_output=True)
            self.assertEqual(json.loads((folder / "program/summary.json").read_text())["state_hash"], state)

    def test_the_conda_recipe_has_what_cmake_looks_for(self):
        sources = "\n".join(path.read_text() for path in [ROOT / "CMakeLists.txt", *(p for f in ("src", "apps", "bindings", "cmake") for p in (ROOT / f).rglob("CMakeLists.txt"))])
        wanted = set(re.findall(r"find_package\((\w+)", sources)) | set(re.findall(r"pkg_check_modules\((\w+)", sources))
        wanted |= set(re.findall(r"find_library\((\w+)_LIBRARY", sources))
        files = [path for folder in ("src", "apps", "bindings") for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cpp")]
        included = {match for path in files for match in re.findall(r"^#include <([\w+]+)/", path.read_text(), re.MULTILINE)}
        wanted |= {HEADERS[folder] for folder in included if folder in HEADERS}
        self.assertGreater(len(wanted), 8)
        self.assertEqual(wanted - set(CONDA) - OTHERS, set(), "packages without a word here for conda")
        recipe = (ROOT / "packaging/conda/meta.yaml").read_text()
        part = {key: set(re.findall(r"^    - ([\w-]+)", body, re.MULTILINE)) for key, body in re.findall(r"^  (build|host|run):\n((?:    - .*\n)+)", recipe, re.MULTILINE)}
        listed = part["host"] | part["build"]
        for name in wanted - OTHERS:
            self.assertIn(CONDA[name], listed, name)
        dependencies = re.search(r"^dependencies = \[(.*)\]", (ROOT / "python/pyproject.toml").read_text(), re.MULTILINE)[1]
        for name in re.findall(r'"([\w-]+)', dependencies):
            self.assertIn(name, part["run"])
        version = re.search(r'version: "([^"]*)"', recipe)[1]
        self.assertIn(f"VERSION {version}", (ROOT / "CMakeLists.txt").read_text())


if __name__ == "__main__":
    unittest.main()
