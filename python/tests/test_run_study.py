"""Studies that Python runs."""

from __future__ import annotations

import concurrent.futures
import json
from pathlib import Path

import pytest
from conftest import ROOT, keyblock, optional

kb = optional("keyblock")
core = optional("keyblock._core")

GALLERY = ROOT / "tests/data/study/gallery.toml"


def scenario() -> kb.Scenario:
    gallery = kb.Scenario.load(GALLERY)
    gallery["study.realizations"] = 2
    return gallery


def measures(folder: Path) -> dict[str, object]:
    return {path.parent.name: json.loads(path.read_text())["stages"] for path in sorted(folder.glob("runs/*/run.json"))}


def test_the_runs_are_those_of_the_program(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        study = kb.run_study(scenario(), tmp_path / "ours", executor=pool, progress=lambda done, runs: told.append((done, runs)))
    keyblock("study", "run", GALLERY, "-o", "theirs", "--set", "study.realizations=2", folder=tmp_path)
    assert measures(tmp_path / "ours") == measures(tmp_path / "theirs")
    runs = len(measures(tmp_path / "ours"))
    assert told[-1] == (runs, runs)
    assert len(study.table()) == runs
    assert (tmp_path / "ours/report.html").exists()


def test_what_is_done_stays(tmp_path: Path) -> None:
    core.plan_study(scenario()._core, str(tmp_path / "out"))
    core.run_of_study(str(tmp_path / "out"), 1)
    first = next(tmp_path.glob("out/runs/*/run.json"))
    before = first.stat().st_mtime_ns
    runs, missing, failures = core.study_state(str(tmp_path / "out"))
    assert (len(missing), failures) == (runs - 1, [])
    with pytest.raises(kb.InputError):
        kb.run_study(scenario(), tmp_path / "out")
    kb.run_study(scenario(), tmp_path / "out", workers=2, resume=True)
    assert first.stat().st_mtime_ns == before
    assert core.study_state(str(tmp_path / "out"))[1] == []


def test_what_cannot_be_a_study(tmp_path: Path) -> None:
    with pytest.raises(kb.InputError, match="save it and load it"):
        kb.run_study(kb.Scenario({"title": "made"}), tmp_path / "out")
    core.plan_study(scenario()._core, str(tmp_path / "out"))
    with pytest.raises(kb.InputError, match="less than"):
        core.run_of_study(str(tmp_path / "out"), 10**6)
    with pytest.raises(kb.InputError):
        core.study_state(str(tmp_path))
    with pytest.raises(TypeError):
        core.plan_study(None, "out")
