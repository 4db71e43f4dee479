"""Studies that Python runs."""

from __future__ import annotations

import concurrent.futures
import concurrent.futures.process
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import BUILT, ROOT, keyblock, optional

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
    with pytest.raises(kb.InputError, match="domain"):
        kb.run_study(kb.Scenario({"title": "made"}), tmp_path / "out")
    core.plan_study(scenario()._core, str(tmp_path / "out"))
    with pytest.raises(kb.InputError, match="less than"):
        core.run_of_study(str(tmp_path / "out"), 10**6)
    with pytest.raises(kb.InputError):
        core.study_state(str(tmp_path))
    with pytest.raises(TypeError):
        core.plan_study(None, "out")
    with pytest.raises(ValueError, match="at least 1"):
        kb.run_study(scenario(), tmp_path / "out", workers=0, resume=True)


def incline() -> kb.Scenario:
    slope = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    slope.stage[0].duration = 0.05
    slope.study = {"realizations": 1, "vary": [{"key": "joints.friction", "values": [20.0, 25.0]}]}
    return slope


def test_a_script_needs_no_guard(tmp_path: Path) -> None:
    """The snippet of the manual as a file: workers import nothing of it."""
    (tmp_path / "script.py").write_text(
        "import keyblock as kb\n"
        f"scenario = kb.Scenario.load({str(ROOT / 'examples/03-block-on-incline.toml')!r})\n"
        "scenario.stage[0].duration = 0.05\n"
        "scenario['study'] = {'realizations': 1, 'vary': [{'key': 'joints.friction', 'values': [20.0, 25.0]}]}\n"
        "print('once')\n"
        "study = kb.run_study(scenario, 'out', workers=2)\n"
        "print(len(study.table()))\n"
    )
    done = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(BUILT)}, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["once", "2"]


def test_scenarios_made_in_python_are_studied(tmp_path: Path) -> None:
    made = kb.Scenario(incline().to_dict())
    assert made._core.is_made
    ours = kb.run_study(made, tmp_path / "made", workers=2)
    theirs = kb.run_study(incline(), tmp_path / "loaded", workers=2)
    assert list(ours.table("stages").displacement_max_m) == list(theirs.table("stages").displacement_max_m)
    first = next((tmp_path / "made/runs").glob("*/run.json"))
    before = first.stat().st_mtime_ns
    kb.run_study(made, tmp_path / "made", workers=1, resume=True)
    assert first.stat().st_mtime_ns == before


def test_a_worker_that_is_killed_is_one_failed_run(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    study = incline()
    study.study.vary[0].values = [20.0, 25.0, 26.0]
    study.stage[0].duration = 3.0  # long enough to be met
    study.time.step = 1e-4
    killed: list[int] = []

    def kill_the_first() -> None:
        end = time.monotonic() + 60.0
        while not killed and time.monotonic() < end:
            mine = [int(p) for p in os.listdir("/proc") if p.isdigit() and _is_worker(int(p), str(folder))]
            if mine:
                os.kill(mine[0], signal.SIGKILL)
                killed.append(mine[0])
            time.sleep(0.005)

    killer = threading.Thread(target=kill_the_first)
    killer.start()
    with pytest.raises(kb.RunError, match="1 run has failed"):
        kb.run_study(study, folder, workers=1)
    killer.join()
    state = kb.study_state(folder)
    assert killed and len(state.failures) == 1 and "SIGKILL" in state.failures[0] and state.missing == []
    assert len(list(folder.glob("runs/*/run.json"))) == 2
    kb.run_study(study, folder, workers=1, resume=True)
    assert kb.study_state(folder).failures == []


def _is_worker(process: int, folder: str) -> bool:
    try:
        words = Path(f"/proc/{process}/cmdline").read_bytes().split(b"\0")
        parent = int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
    except (OSError, ValueError):
        return False
    return parent == os.getpid() and folder.encode() in words


def test_an_executor_that_breaks_costs_its_runs(tmp_path: Path) -> None:
    class Breaks(concurrent.futures.Executor):
        def submit(self, function, /, *args, **kwargs):  # type: ignore[no-untyped-def]
            future: concurrent.futures.Future[int] = concurrent.futures.Future()
            if args[1] == 0:
                future.set_exception(concurrent.futures.process.BrokenProcessPool("killed"))
            else:
                future.set_result(function(*args))
            return future

    with pytest.raises(kb.RunError, match="its worker was ended"):
        kb.run_study(incline(), tmp_path / "out", executor=Breaks())
    assert len(list(tmp_path.glob("out/runs/*/run.json"))) == 1


def test_the_parts_of_a_study(tmp_path: Path) -> None:
    assert kb.plan_study(incline(), tmp_path / "out") == []
    assert kb.study_state(tmp_path / "out").missing == [0, 1]
    assert kb.study_task(tmp_path / "out", 1) == 1
    assert kb.study_state(tmp_path / "out") == kb.StudyState(2, [0], [])
    assert len(kb.collect_study(tmp_path / "out").table()) >= 1


def test_limits_are_those_of_the_program(tmp_path: Path) -> None:
    file = ROOT / "verification/scenarios/limit_incline.toml"
    ours = kb.find_limit(kb.Scenario.load(file), tmp_path / "ours", "joints.friction", 45.0, 5.0, until="collapsed", workers=2)
    keyblock("limit", file, "--key", "joints.friction", "--from", "45", "--to", "5", "--until", "collapsed", "-o", "theirs", folder=tmp_path)
    theirs = kb.open(tmp_path / "theirs")
    assert ours.value == theirs.value and ours.interval == theirs.interval
    with pytest.raises(kb.InputError, match="joints.frictoin|frictoin"):
        kb.find_limit(kb.Scenario.load(file), tmp_path / "wrong", "joints.frictoin", 45.0, 5.0)


def test_a_limit_takes_its_criterion_from_the_model(tmp_path: Path) -> None:
    scenario = kb.Scenario.load(ROOT / "verification/scenarios/limit_slope.toml")
    none = kb.find_limit(scenario, tmp_path / "none", "stage.excavated.k_h", 0.0, -0.05)
    assert math.isnan(none.value) and none.limits == [] and none.bound in repr(none) and none.bound == "at most -0.05"
    found = kb.find_limit(scenario, tmp_path / "out", "stage.excavated.k_h", 0.0, -0.5, scan=3, workers=2)
    assert found.value == pytest.approx(-math.tan(math.radians(10.0)), rel=0.02)
    assert (found.summary.until, found.summary.scan) == ("collapsed", 3)
    assert "a slope" in found.summary.why


def test_the_factor_of_safety_is_that_of_the_program(tmp_path: Path) -> None:
    scenario = kb.Scenario.load(ROOT / "verification/scenarios/limit_slope.toml")
    ours = kb.find_safety(scenario, tmp_path / "ours", sets=["bedding"], workers=2)
    keyblock("safety", ROOT / "verification/scenarios/limit_slope.toml", "--sets", "bedding", "-o", "theirs", folder=tmp_path)
    assert ours.value == kb.open(tmp_path / "theirs").value == pytest.approx(math.tan(math.radians(40)) / math.tan(math.radians(30)), rel=0.005)
    (found,) = ours.realizations
    assert found["falls"]["trial"]["value"] == found["bracket"]["met"] and found["falls"]["stands_to"] == found["bracket"]["not_met"]
    assert "safety" not in scenario, "the scenario that was given stays as it was"
    with pytest.raises(kb.InputError, match="did you mean 'bedding'"):
        kb.find_safety(scenario, tmp_path / "wrong", sets=["beding"])


def test_problems_with_known_answers() -> None:
    told: list[int] = []
    table = kb.verify(ROOT / "verification", ["incline"], orders=[1], workers=2, progress=lambda done, runs: told.append(done))
    assert table.failed == 0 and table.passed == len(table.rows) > 0 and told
    with pytest.raises(kb.InputError, match="no case 'inclin'"):
        kb.verify(ROOT / "verification", ["inclin"])


def test_results_are_exported_and_tabled(tmp_path: Path) -> None:
    slope = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    slope.stage[0].duration = 0.1
    for friction in (10.0, 20.0):
        slope.joints.friction = friction
        slope.run(tmp_path / "runs" / f"{friction:g}")
    other = slope.copy()
    other.rock.density = 3000.0
    other.run(tmp_path / "runs/other")
    with kb.open(tmp_path / "runs/10") as run:
        files = run.export("csv")
        assert (tmp_path / "runs/10/csv/contacts.csv") in files
        assert "slip,shear_displacement" in (tmp_path / "runs/10/csv/contacts.csv").read_text().splitlines()[0]
        with pytest.raises(kb.InputError, match="geojson"):
            run.export("xls")
    optional("pandas")
    table = kb.run_table(tmp_path / "runs")
    assert list(table["joints.friction"]) == [10.0, 20.0, 20.0]
    assert table.displacement_max_m.iloc[0] > table.displacement_max_m.iloc[1]
    assert list(table["rock.density"])[-1] == 3000.0
    with pytest.raises(kb.NoResultError):
        kb.run_table(tmp_path)


def test_controllers_steer_every_run(tmp_path: Path) -> None:
    threshold = 1e-3

    @kb.controller(every=2)
    def weaken(sim: kb.Simulation) -> None:
        if sim.contacts.slip.max(initial=0.0) > threshold:
            sim.strength["joints"].friction = 5.0

    study = kb.run_study(incline(), tmp_path / "out", workers=2, controllers=[weaken])
    table = study.table("stages").sort_values("joints.friction")
    for friction, moved in zip(table["joints.friction"], table.displacement_max_m):
        alone = incline()
        alone.joints.friction = float(friction)
        summary = alone.run(controllers=[weaken])
        assert summary["stages"][-1]["damage"]["displacement_max_m"] == pytest.approx(moved, rel=1e-12)
    with pytest.raises(kb.DataError, match="another text"):
        kb.run_study(incline(), tmp_path / "out", resume=True)
    kb.run_study(incline(), tmp_path / "out", resume=True, controllers=[weaken])

    def fails(sim: kb.Simulation) -> None:
        if sim.step == 3:
            raise ValueError("mine")

    with pytest.raises(kb.RunError, match="ValueError: mine"):
        kb.run_study(incline(), tmp_path / "fails", workers=2, controllers=[fails])
    with pytest.raises(kb.RunError, match="a controller has stopped the run"):
        kb.run_study(incline(), tmp_path / "stops", workers=2, controllers=[lambda sim: sim.stop()])
    with pytest.raises(kb.RunError, match="killed by signal 9"):
        kb.run_study(incline(), tmp_path / "killed", workers=2, controllers=[lambda sim: os.kill(os.getpid(), signal.SIGKILL)])


def test_a_simulation_of_a_study_ends_with_its_run(tmp_path: Path) -> None:
    """In this process: what Python keeps of it says that the run has ended."""
    kb.plan_study(incline(), tmp_path / "out")
    kept: list[object] = []

    def steer(simulation: object) -> object:
        kept.append(simulation)
        return lambda: None

    core.run_of_study_steered(str(tmp_path / "out"), 0, [], steer)
    for use in (lambda: kept[0].time, lambda: kept[0].vertices, lambda: kept[0].advance(1), lambda: kept[0].finish()):
        with pytest.raises(RuntimeError, match="the run has ended"):
            use()
    kept[0].stop()
