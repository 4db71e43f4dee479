"""Studies and limits from Python: all runs by processes of this machine, or by an executor of another library.

    study = keyblock.run_study(keyblock.Scenario.load("study.toml"), "out/study", workers=4)
    study.table("wide")

Each run is a task that needs the folder and a number only, so that processes on other machines can do it, where they see the folder:
plan_study, then study_task for each run, then collect_study. The workers of run_study are interpreters of their own, which import nothing of
the script that calls it; one that is killed is one failed run.
"""

from __future__ import annotations

import concurrent.futures
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _arguments as arguments
from ._compiled import core as _core
from .progress import Progress, words_of_study
from .record import Record, parse
from .scenario import Scenario, core_of

from .steered_study import run_steered
from .steered_study import file_of_controllers as _controllers_file

if TYPE_CHECKING:
    from .limit import Limit
    from .simulation import Controller, Simulation
    from .study import Study



@dataclass(frozen=True)
class StudyState:
    """How far a study is."""

    runs: int  #: that it asks for
    missing: list[int]  #: neither done nor failed
    failures: list[str]  #: why runs failed, one sentence each


def plan_study(scenario: Scenario, folder: str | os.PathLike[str], *, resume: bool = False) -> list[str]:
    """Makes the plan of a study and puts it into the folder; returns warnings. `resume`: goes on with what is there, and runs that failed are tried
    again. Throws InputError."""
    return _core.plan_study(core_of(scenario), _whole_path(folder), arguments.flag("resume", resume))


def study_state(folder: str | os.PathLike[str]) -> StudyState:
    """How far a study is. Throws InputError where the folder holds no plan."""
    return StudyState(*_core.study_state(arguments.path("folder", folder)))


def study_task(folder: str | os.PathLike[str], run: int) -> int:
    """Does one run of a planned study, in this process; returns its number. A run that fails leaves the reason in the folder."""
    run = arguments.whole("run", run, least=0)
    try:
        _core.run_of_study(arguments.path("folder", folder), run)
    except _core.RunError:
        pass
    return run


def collect_study(folder: str | os.PathLike[str]) -> Study:
    """Gathers the runs that are there into runs.csv, study.json and report.html. Throws InputError where the folder holds no plan."""
    from .study import Study

    path = arguments.path("folder", folder)
    _core.collect_study(path)
    return Study(path)


def run_study(
    scenario: Scenario,
    folder: str | os.PathLike[str],
    *,
    workers: int | None = None,
    executor: concurrent.futures.Executor | None = None,
    resume: bool = False,
    controllers: Sequence[Controller | Callable[[Simulation], Any]] = (),
    progress: Callable[[int, int], Any] | bool | str | None = None,
) -> Study:
    """Runs what is missing of a study, and collects it. `workers`: processes, by default one for each processor. `executor`: anything with the
    `submit` of concurrent.futures, in the place of own processes; its workers must see the folder. `progress`: called with runs that have ended,
    and all; or True, "notebook", "line" as for a run. What is done is never done again: `resume=True` goes on. Ctrl-C ends it in good order.
    `controllers` steer every run; then the processes are forks of this one, so that functions of a script or a notebook go along. A run that a
    controller stops has failed, as a study has no use for a part of a run. Throws InputError, and RunError with the reasons where runs have
    failed, after the others are collected."""
    if controllers and executor is not None:
        raise ValueError("controllers need own processes, and no executor")
    path = _whole_path(folder)
    _core.plan_study(core_of(scenario), path, arguments.flag("resume", resume))
    with Progress(progress, words_of_study) as shown:
        if controllers or _controllers_file(path).exists():
            run_steered(path, _count(workers), controllers, shown.call)
        elif executor is not None:
            _run_all(path, executor, shown.call)
        else:
            _core.run_study(path, _count(workers), _worker_command(), shown.call)
    study = collect_study(path)
    state = study_state(path)
    if state.failures or state.missing:
        failed = len(state.failures) + len(state.missing)
        first = state.failures[0] if state.failures else f"run {state.missing[0]} is missing"
        raise _core.RunError(f"{failed} {'run has' if failed == 1 else 'runs have'} failed; resume=True tries again; the first: {first}")
    return study


def find_limit(
    scenario: Scenario,
    folder: str | os.PathLike[str],
    key: str,
    start: float,
    stop: float,
    *,
    until: str | None = None,
    above: float | None = None,
    since: str = "",
    tolerance: float = 0.02,
    realizations: int = 1,
    scan: int | None = None,
    workers: int | None = None,
    resume: bool = False,
    progress: Callable[[int, int], Any] | bool | str | None = None,
) -> Limit:
    """The value of a number of the scenario at which rock first falls, moves or collapses, as `keyblock limit` finds it: bisection between `start`,
    at which that does not hold, and `stop`, at which it does. `until`: "fallen", "moved", "collapsed" or a measure of summary.json, which
    is to be larger than `above`; None: by the model, as `answer` and `why` of the result tell. `scan`: equal parts of the way that are looked at
    before, to find all limits; None: 8 for the scale of a motion, else 1. Throws InputError, and RunError where a run fails."""
    from .limit import Limit

    path = _whole_path(folder)
    with Progress(progress, words_of_study) as shown:
        _core.find_limit(
            core_of(scenario),
            path,
            key=arguments.text("key", key),
            start=arguments.number("start", start),
            stop=arguments.number("stop", stop),
            until="" if until is None else arguments.text("until", until),
            above=arguments.number_or_none("above", above),
            since=arguments.text("since", since),
            tolerance=arguments.number("tolerance", tolerance),
            realizations=arguments.count("realizations", realizations),
            resume=arguments.flag("resume", resume),
            scan=0 if scan is None else arguments.count("scan", scan, least=0),
            workers=_count(workers),
            command=_worker_command(),
            progress=shown.call,
        )
    return Limit(path)


def find_safety(
    scenario: Scenario,
    folder: str | os.PathLike[str],
    *,
    stage: str | None = None,
    sets: Sequence[str] = (),
    area: float | None = None,
    moved: float | None = None,
    start: float = 0.5,
    stop: float = 5.0,
    tolerance: float = 0.005,
    realizations: int = 1,
    sweep: int | None = None,
    workers: int | None = None,
    resume: bool = False,
    progress: Callable[[int, int], Any] | bool | str | None = None,
) -> Limit:
    """The factor of safety, as `keyblock safety` finds it: what tan(friction), cohesion and tension of joints may be divided by, from the
    equilibrium of `stage` on (None: that of [safety], or the last static one), until rock moves by more than `moved`, m (None: 0.2 % of the block
    size), or does not stand; with `area`, m²: until blocks of more than that move. `sets`: names of the joint sets and trace maps that are reduced, none: all.
    `sweep`: equal parts of the way from `start` to `stop` that are looked at as well. `falls` of the result's realizations tells from where on
    blocks do not stand. Throws InputError, and RunError where a run fails."""
    asked = scenario.copy()
    safety = asked["safety"] if "safety" in asked else asked.setdefault("safety", {})
    if stage is not None:
        safety["stage"] = arguments.text("stage", stage)
    if sets:
        safety["sets"] = arguments.texts("sets", sets)
    if area is not None:
        safety["area"] = arguments.number("area", area)
    if moved is not None:
        safety["moved"] = arguments.number("moved", moved)
    return find_limit(
        asked,
        folder,
        "safety.strength_factor",
        start,
        stop,
        tolerance=tolerance,
        realizations=realizations,
        scan=None if sweep is None else arguments.count("sweep", sweep),
        workers=workers,
        resume=resume,
        progress=progress,
    )


def verify(
    cases: str | os.PathLike[str],
    names: Sequence[str] = (),
    *,
    orders: Sequence[int] = (),
    all: bool = False,
    workers: int | None = None,
    progress: Callable[[int, int], Any] | bool | str | None = None,
) -> Record:
    """Solves problems with known answers, and compares, as `keyblock verify` does; what its JSON has: `passed`, `failed`, `rows`. `cases`: the folder of
    the case files, `verification` of the source. `names`: of case files; none: all but the long ones."""
    with Progress(progress, words_of_study) as shown:
        text = _core.verify(
            arguments.path("cases", cases),
            names=arguments.texts("names", names),
            orders=[arguments.count("orders", order) for order in orders],
            all=arguments.flag("all", all),
            workers=_count(workers),
            progress=shown.call,
        )
    return parse(text, "the table")


def _count(workers: int | None) -> int:
    return (os.cpu_count() or 1) if workers is None else arguments.count("workers", workers, least=1)


def _whole_path(folder: Any) -> str:
    return os.path.abspath(arguments.path("folder", folder))


def _worker_command() -> list[str]:
    """What does one run, given the folder and its number: it imports this package, wherever it is, and nothing of the calling script."""
    package = str(Path(__file__).absolute().parent.parent)
    return [sys.executable, "-c", f"import sys; sys.path.insert(0, {json.dumps(package)}); from keyblock.study_runs import _work; _work()"]


def _work() -> None:
    folder, run = sys.argv[1], int(sys.argv[2])
    try:
        _core.run_of_study(folder, run)
    except (_core.RunError, _core.InputError) as error:
        print(error, file=sys.stderr)
        sys.exit(2)


def _run_all(path: str, executor: concurrent.futures.Executor, progress: Callable[[int, int], Any] | None) -> None:
    """Rounds, as a study with [study.until] may ask for fewer runs once it has some."""
    tried: set[int] = set()
    while True:
        runs, missing, _ = _core.study_state(path)
        todo = [run for run in missing if run not in tried]
        if not todo:
            return
        tasks = {executor.submit(study_task, path, run): run for run in todo[: max(64, len(todo) // 4)]}
        try:
            for task in concurrent.futures.as_completed(tasks):
                _note_end(path, task, tasks[task])
                tried.add(tasks[task])
                if progress is not None:
                    progress(runs - len(missing) + len(tried), runs)
        except BaseException:
            for task in tasks:
                task.cancel()
            raise


def _note_end(path: str, task: concurrent.futures.Future[int], run: int) -> None:
    """A worker that was killed costs the runs that it had, and no others."""
    try:
        task.result()
    except concurrent.futures.BrokenExecutor as error:
        _core.note_failed_run(path, run, f"its worker was ended: {error}")
