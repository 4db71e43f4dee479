"""Opens whatever keyblock has written: a run, a study, or a limit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Union

from .errors import NoResultError

if TYPE_CHECKING:
    from .limit import Limit
    from .results import Result
    from .study import Study


def open(path: str | Path) -> Union[Result, Study, Limit]:
    """The results in a folder: `Result` of a run, `Study` of a study, `Limit` of a search for a limit. A path may be that of result.h5.

    Throws NoResultError where there are none, FormatError where this version cannot read them.
    """
    folder = Path(path)
    if folder.is_dir() and not (folder / "result.h5").exists():
        if (folder / "limit.json").exists():
            return open_limit(folder)
        if (folder / "plan.json").exists() or (folder / "study.json").exists():
            return open_study(folder)
    from .results import Result

    return Result(folder)


def open_study(path: str | Path) -> Study:
    """The results of `keyblock study`, by its folder. Throws NoResultError and DamagedError."""
    from .study import Study

    return Study(path)


def open_limit(path: str | Path) -> Limit:
    """The results of `keyblock limit`, by its folder. Throws NoResultError and DamagedError."""
    from .limit import Limit

    return Limit(path)


def run_in(path: Path) -> Path:
    """The folder of a run of a study or a limit. Throws NoResultError where it is not there."""
    if not path.is_dir():
        raise NoResultError(f"{path}: no such run")
    return path
