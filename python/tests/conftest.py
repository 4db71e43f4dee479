"""Results that the built program has written, once for all tests. Its path is in the environment variable KEYBLOCK."""

from __future__ import annotations

import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("KEYBLOCK", str(ROOT / "build/release/keyblock"))

# The package beside the program has the compiled module.
BUILT = Path(PROGRAM).parent / "python"
sys.path.insert(0, str(BUILT if BUILT.exists() else ROOT / "python"))
os.environ["MPLBACKEND"] = "Agg"

# A small gallery in two joint sets, shaken for half a second, with a point in the crown.
TUNNEL = (ROOT / "tests/data/study/gallery.toml").read_text().split("[study]")[0].replace('"shaken"', '"first earthquake"')
TUNNEL += '\n[[history]]\nname = "crown"\npoint = [0.0, 1.2]\n'

STUDY = (
    TUNNEL.partition("[[history]]")[0]
    + """
[study]
realizations = 6
keep = "all"
since = "excavated"
[[study.vary]]
key = "stage.'first earthquake'.scale"
values = [0.25, 0.5, 1.0, 2.0]
[[study.vary]]
key = "joints.friction"
values = [30.0, 50.0]
[[study.level]]
name = "moderate"
measure = "displacement_max_m"
threshold = 0.0015
"""
)


def keyblock(*words: object, folder: Path) -> str:
    """Runs the program and returns what it said."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, f"{words}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def optional(name: str) -> ModuleType:
    """A package that users need not have; the test is skipped without it, unless CI is set."""
    # A module that was built and cannot be loaded is no reason to skip.
    if os.environ.get("CI") or (name == "keyblock._core" and any((BUILT / "keyblock").glob("_core*.so"))):
        return importlib.import_module(name)
    return pytest.importorskip(name)


@pytest.fixture(scope="session")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder "out" of the documents: tunnel, heading, study and safety."""
    return tmp_path_factory.mktemp("results") / "out"


def _run(out: Path, name: str, scenario: str | Path, *more: object) -> Path:
    if not (out / name).exists():
        out.mkdir(exist_ok=True)
        if isinstance(scenario, str):
            (out / f"{name}.toml").write_text(scenario)
            scenario = out / f"{name}.toml"
        keyblock("run", scenario, "-o", out / name, *more, folder=out)
    return out / name


@pytest.fixture(scope="session")
def tunnel_folder(out: Path) -> Path:
    return _run(out, "tunnel", TUNNEL)


@pytest.fixture(scope="session")
def heading_folder(out: Path) -> Path:
    return _run(out, "heading", ROOT / "examples/10-heading-and-bench.toml")


@pytest.fixture(scope="session")
def anchors_folder(out: Path) -> Path:
    """A block on a spring, and a second one that a stage installs; with histories of the second and of the block."""
    scenario = (ROOT / "verification/scenarios/staged_support.toml").read_text()
    return _run(out, "anchors", scenario + '\n[[history]]\nname = "cell"\nspring = "second"\n', "--set", "spring.first.yield=1e5")


@pytest.fixture(scope="session")
def incline_folder(out: Path) -> Path:
    return _run(out, "incline", ROOT / "examples/03-block-on-incline.toml")


@pytest.fixture(scope="session")
def far_folder(out: Path) -> Path:
    """Concave blocks far from the origin of coordinates."""
    return _run(out, "far", ROOT / "tests/data/concave_blocks.toml")


@pytest.fixture(scope="session")
def study_folder(out: Path) -> Path:
    if not (out / "study").exists():
        out.mkdir(exist_ok=True)
        (out / "study.toml").write_text(STUDY)
        keyblock("study", "run", "study.toml", "-o", "study", "--workers", "2", folder=out)
    return out / "study"


@pytest.fixture(scope="session")
def limit_folder(out: Path) -> Path:
    if not (out / "safety").exists():
        out.mkdir(exist_ok=True)
        scenario = (ROOT / "verification/scenarios/limit_incline.toml").read_text() + '\n[study]\nkeep = "all"\n'
        (out / "safety.toml").write_text(scenario)
        words = ("--key", "joints.friction", "--from", 45, "--to", 5, "--until", "collapsed")
        keyblock("limit", "safety.toml", *words, "-o", "safety", folder=out)
    return out / "safety"


@pytest.fixture
def tunnel(tunnel_folder: Path) -> Iterator[Any]:
    import keyblock

    with keyblock.open(tunnel_folder) as run:
        yield run


@pytest.fixture
def copy(tunnel_folder: Path, tmp_path: Path) -> Path:
    """A result to be damaged."""
    shutil.copytree(tunnel_folder, tmp_path / "copy")
    return tmp_path / "copy"
