"""keyblock in Python: read the results of runs, studies and limits, draw them, hand them to other libraries.

    import keyblock
    run = keyblock.open("out/tunnel")

What is not used is not imported: h5py and numpy are needed to read results, all else for a part only.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from .errors import DamagedError, FormatError, KeyblockError, MissingPackageError, NoResultError, UnfinishedWarning

if TYPE_CHECKING:
    from .limit import Limit
    from .opening import open, open_limit, open_study
    from .results import Result
    from .study import Study

__version__ = "0.1.0"

# Where names are defined that are imported when they are first used.
_LAZY = {
    "open": "opening",
    "open_study": "opening",
    "open_limit": "opening",
    "Result": "results",
    "Study": "study",
    "Limit": "limit",
}
_MODULES = {"results", "study", "limit", "plot", "animate", "convert", "blocks", "frames", "contacts"}

__all__ = [
    "DamagedError",
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
    return sorted({*globals(), *__all__, *_MODULES})
