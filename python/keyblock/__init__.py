"""keyblock in Python: make, run and steer scenarios; read the results of runs, studies and limits, draw them, hand them to other libraries.

    import keyblock
    scenario = keyblock.Scenario.load("tunnel.toml")
    scenario.run("out/tunnel")
    run = keyblock.open("out/tunnel")

What is not used is not imported: h5py and numpy are needed to read results, all else for a part only.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .errors import DamagedError, DataError, FormatError, KeyblockError, MissingPackageError, NoResultError, UnfinishedWarning

if TYPE_CHECKING:
    from ._compiled import Diagnostic, InputError, RunError
    from .limit import Limit
    from .motion import Motion
    from .opening import open, open_limit, open_study
    from .results import Result
    from .study_runs import StudyState, collect_study, find_limit, find_safety, plan_study, run_study, study_state, study_task, verify
    from .run_table import run_table
    from .scenario import Scenario
    from .simulation import Controller, Simulation, controller
    from .study import Study
    from .traces import TraceMap

__version__ = "0.1.0"

# Where names are defined that are imported when they are first used.
_LAZY = {
    "Scenario": "scenario",
    "Simulation": "simulation",
    "Controller": "simulation",
    "controller": "simulation",
    "Motion": "motion",
    "run_study": "study_runs",
    "plan_study": "study_runs",
    "study_task": "study_runs",
    "study_state": "study_runs",
    "collect_study": "study_runs",
    "find_limit": "study_runs",
    "find_safety": "study_runs",
    "verify": "study_runs",
    "StudyState": "study_runs",
    "run_table": "run_table",
    "TraceMap": "traces",
    "InputError": "_compiled",
    "RunError": "_compiled",
    "Diagnostic": "_compiled",
    "open": "opening",
    "open_study": "opening",
    "open_limit": "opening",
    "Result": "results",
    "Study": "study",
    "Limit": "limit",
}
_MODULES = {"scenario", "simulation", "motion", "traces", "steering", "cut", "census", "results", "study", "limit", "plot", "animate", "convert", "blocks", "frames", "contacts"}

__all__ = [
    "Controller",
    "Diagnostic",
    "InputError",
    "Motion",
    "RunError",
    "Scenario",
    "Simulation",
    "TraceMap",
    "controller",
    "run_study",
    "plan_study",
    "study_task",
    "study_state",
    "collect_study",
    "find_limit",
    "find_safety",
    "verify",
    "StudyState",
    "run_table",
    "DamagedError",
    "DataError",
    "FormatError",
    "KeyblockError",
    "MissingPackageError",
    "NoResultError",
    "UnfinishedWarning",
    "Limit",
    "Result",
    "Study",
    "open",
    "open_limit",
    "open_study",
]


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        value = getattr(importlib.import_module(f"{__name__}.{_LAZY[name]}"), name)
        globals()[name] = value
        return value
    if name in _MODULES:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*(name for name in globals() if name.startswith("__")), *__all__, *_MODULES})
