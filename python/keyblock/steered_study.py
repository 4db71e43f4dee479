"""Studies whose runs are steered by controllers: each run in a fork of this process, so that functions of a script or a notebook go along."""

from __future__ import annotations

import json
import multiprocessing
import multiprocessing.connection
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._compiled import core as _core
from .errors import DataError

if TYPE_CHECKING:
    from .simulation import Controller, Simulation


def file_of_controllers(folder: str | os.PathLike[str]) -> Path:
    """Names and hashes of the controllers of a study: it is gone on with by the same ones only."""
    return Path(folder) / "controllers.json"


def run_steered(folder: str, workers: int, controllers: Sequence[Any], progress: Callable[[int, int], Any] | None) -> None:
    """Does all runs that are missing, `workers` at a time. A fork that is killed is one failed run."""
    from .controllers import controllers_of

    made = controllers_of(controllers)
    _check_same(Path(folder), made)
    forks = multiprocessing.get_context("fork")
    running: dict[Any, int] = {}
    tried: set[int] = set()
    try:
        while True:
            runs, missing, _ = _core.study_state(folder)
            todo = [run for run in missing if run not in tried]
            for run in todo[: workers - len(running)]:
                fork = forks.Process(target=_work, args=(folder, run, made), daemon=True)
                fork.start()
                running[fork.sentinel] = run
                _forks[fork.sentinel] = fork
                tried.add(run)
            if not running:
                return
            for sentinel in multiprocessing.connection.wait(list(running)):
                _note_end(folder, running.pop(sentinel), _forks.pop(sentinel))
                if progress is not None:
                    progress(len(tried) - len(running) + runs - len(missing), runs)
    finally:
        for sentinel in running:
            fork = _forks.pop(sentinel)
            fork.terminate()
            fork.join()


_forks: dict[Any, Any] = {}


def _check_same(folder: Path, controllers: Sequence[Controller]) -> None:
    named = [[controller.name, controller.hash] for controller in controllers]
    file = file_of_controllers(folder)
    before = json.loads(file.read_text()) if file.exists() else None
    if before is None and list(folder.glob("runs/*/run.json")):
        raise DataError(f"{folder}: runs without controllers are there; take another folder")
    if before is not None and before != named:
        raise DataError(f"{folder}: its runs were steered by {', '.join(name for name, _ in before)}, or by another text of the same; take another folder")
    file.write_text(json.dumps(named) + "\n")


def _work(folder: str, run: int, controllers: Sequence[Controller]) -> None:
    from .simulation import Simulation

    def steer(core: Any) -> Callable[[], None]:
        return Simulation._of_study(core, controllers)._after_step

    try:
        _core.run_of_study_steered(folder, run, [(c.name, c.hash) for c in controllers], steer)
    except BaseException as error:  # the folder says why
        print(f"run {run}: {error}", file=sys.stderr)
        os._exit(2)
    os._exit(0)


def _note_end(folder: str, run: int, fork: Any) -> None:
    fork.join()
    if fork.exitcode is not None and fork.exitcode < 0:
        _core.note_failed_run(folder, run, f"killed by signal {-fork.exitcode}")
