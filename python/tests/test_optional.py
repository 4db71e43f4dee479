"""What works without the optional packages, and what is said where one is missing. The packages are hidden from a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import BUILT, ROOT, optional

HIDE = """
import sys
hidden = set({hidden!r})
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in hidden:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Finder())
import keyblock as kb
run = kb.open({folder!r}) if {folder!r} else None
"""

ALL = ["pandas", "matplotlib", "xarray", "geopandas", "shapely", "PIL"]


def python(hidden: list[str], folder: Path | str, script: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", HIDE.format(hidden=hidden, folder=str(folder)) + script],
        env={**os.environ, "PYTHONPATH": str(ROOT / "python"), **environment}, capture_output=True, text=True, timeout=100,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_arrays_without_any_optional_package(tunnel_folder, heading_folder):
    said = python(ALL, tunnel_folder, f"""
print(type(run.histories).__name__, sorted(k for k in run.histories if k[0] == "crown")[0])
print(run.histories["time"].shape == run.histories["crown", "ux"].shape)
print(sorted(run.energy)[:2], len(run.energy["time"]) == len(run.energy["kinetic"]))
print(run.stages["first earthquake"].motion["x"].shape == run.stages["first earthquake"].motion["time"].shape)
print(run.summary.blocks, run.frames.at(0.3).vertices.shape == run.blocks.vertices.shape, len(run.contacts()) > 0)
print(sorted(kb.open({str(heading_folder)!r}).release))
""")  # fmt: skip
    assert said.splitlines() == [
        "dict ('crown', 'ax')",
        "True",
        "['contact', 'damping'] True",
        "True",
        "45 True True",
        "['crown', 'excavation', 'mean', 'released', 'springline', 'stage', 'step']",
    ]


def test_a_study_without_pandas(study_folder):
    said = python(["pandas"], study_folder, """
print(len(run.records()), len(run.records("stages")), run.records()[0]["status"])
try: run.table()
except kb.MissingPackageError as error: print(error)
""")  # fmt: skip
    assert said.splitlines() == [
        "48 192 done",
        "a table of runs needs pandas, which is not installed: apt install python3-pandas, or pip install pandas",
    ]


@pytest.mark.parametrize(
    ("hidden", "call", "expected"),
    [
        ("matplotlib", "run.plot()", "a picture needs matplotlib"),
        ("matplotlib", "run.animate('x.mp4')", "a film needs matplotlib"),
        ("xarray", "run.to_xarray()", "Result.to_xarray needs xarray"),
        ("geopandas", "run.to_geodataframe()", "Result.to_geodataframe needs geopandas"),
        ("pandas", "run.blocks.table()", "a table of blocks needs pandas"),
        ("pandas", "run.contacts().table()", "a table of contacts needs pandas"),
    ],
)
def test_what_is_missing_is_named(tunnel_folder, hidden, call, expected):
    said = python([hidden], tunnel_folder, f"try: {call}\nexcept ImportError as error: print(type(error).__name__, error)\n")
    assert said.startswith(f"MissingPackageError {expected}, which is not installed: apt install python3-"), said


def test_a_package_that_lacks_another_one(tunnel_folder):
    optional("matplotlib")
    script = "try: run.animate('x.gif')\nexcept kb.MissingPackageError as error: print(error)\n"
    assert python(["PIL"], tunnel_folder, script) == "a film needs matplotlib, which cannot be imported: No module named 'PIL'\n"


def test_h5py_is_named_too(tunnel_folder):
    script = f"try: kb.open({str(tunnel_folder)!r})\nexcept ImportError as error: print(error)\n"
    assert python(["h5py"], "", script).startswith("reading result.h5 needs h5py, which is not installed: apt install python3-h5py")


def test_a_film_without_ffmpeg(tunnel_folder, tmp_path):
    optional("matplotlib")
    script = "try: run.animate('x.mp4')\nexcept kb.MissingPackageError as error: print(error)\n"
    said = python([], tunnel_folder, script, PATH=str(tmp_path))
    assert said == "a film as MP4 needs the program ffmpeg, which is not installed: apt install ffmpeg, or write a .gif\n"


def test_importing_brings_in_nothing_that_is_not_needed():
    script = "import keyblock.results\nprint(sorted({'pandas', 'matplotlib', 'xarray', 'h5py'} & set(sys.modules)))\n"
    assert python([], "", script) == "[]\n"


def test_names_of_the_package():
    # Those of scenarios and runs are in the package beside the program.
    optional("keyblock._core")
    script = "print(all(hasattr(kb, name) and name in dir(kb) for name in kb.__all__))\n"
    script += "try: kb.opne\nexcept AttributeError as e: print(e)\n"
    assert python([], "", script, PYTHONPATH=str(BUILT)) == "True\nmodule 'keyblock' has no attribute 'opne'\n"


def test_scenarios_without_the_compiled_part():
    script = "try: kb.Scenario\nexcept ImportError as e: print(e)\n"
    said = python([], "", script)
    assert "python3-keyblock" in said and "reading results needs none" in said
