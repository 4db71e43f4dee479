"""Studies from Python: all runs by processes of this machine, or by an executor of another library.

    study = keyblock.run_study(keyblock.Scenario.load("study.toml"), "out/study", workers=4)
    study.table("wide")

Each run is a task that needs the folder and a number only, so that processes on other machines can do it, where they see the folder.
"""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ._compiled import core as _core
from .progress import Progress, words_of_study

if TYPE_CHECKING:
    from .scenario import Scenario
    from .study import Study


def study_task(folder: str, run: int) -> int:
    """Does one run of a planned study, in this process; returns its number. A run that fails leaves the reason in the folder."""
    try:
        _core.run_of_study(folder, run)
    except _core.RunError:
        pass
    return run


def run_study(
    scenario: Scenario,
    folder: str | os.PathLike[str],
    *,
    workers: int | None = None,
    executor: concurrent.futures.Executor | None = None,
    resume: bool = False,
    progress: Callable[[int, int], Any] | bool | str | None = None,
) -> Study:
    """Runs what is missing of a study, and collects it. `scenario` was loaded from a file. `workers`: processes, by default one for each
    processor. `executor`: anything with the `submit` of concurrent.futures, in the place of own processes; its workers must see the folder.
    `progress`: called with runs that have ended, and all; or True, "notebook", "line" as for a run. What is done is never done again:
    `resume=True` goes on. Throws InputError, and RunError with the reasons where runs have failed, after the others are collected."""
    path = os.path.abspath(os.fspath(folder))
    _core.plan_study(scenario._core, path, resume)
    with Progress(progress, words_of_study) as shown:
        if executor is not None:
            _run_all(path, executor, shown.call)
        else:
            count = workers or os.cpu_count() or 1
            spawned = multiprocessing.get_context("spawn")  # threads of the parent do not come along
            with concurrent.futures.ProcessPoolExecutor(count, mp_context=spawned) as own:
                _run_all(path, own, shown.call)
    _core.collect_study(path)
    _, missing, failures = _core.study_state(path)
    if failures or missing:
        first = failures[0] if failures else f"run {missing[0]} is missing"
        raise _core.RunError(f"{len(failures) + len(missing)} runs have failed; resume=True tries them again; the first: {first}")
    from .study import Study

    return Study(path)


def _run_all(path: str, executor: concurrent.futures.Executor, progress: Callable[[int, int], Any] | None) -> None:
    """Rounds, as a study with [study.until] may ask for fewer runs once it has some."""
    tried: set[int] = set()
    while True:
        runs, missing, _ = _core.study_state(path)
        todo = [run for run in missing if run not in tried]
        if not todo:
            return
        tasks = [executor.submit(study_task, path, run) for run in todo[: max(64, len(todo) // 4)]]
        try:
            for task in concurrent.futures.as_completed(tasks):
                tried.add(task.result())
                if progress is not None:
                    progress(runs - len(missing) + len(tried), runs)
        except BaseException:
            for task in tasks:
                task.cancel()
            raise
