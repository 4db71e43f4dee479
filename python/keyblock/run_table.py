"""A table over several run folders: one row per run, with what was set in each."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from . import _optional
from ._hdf5 import ResultFile
from .errors import NoResultError
from .record import read

_SET = re.compile(r"^# --set (?P<key>[^=]+)=(?P<value>.*)$")


def run_table(folders: Iterable[str | os.PathLike[str]] | str | os.PathLike[str], stage: str | int = -1) -> Any:
    """One row per run as pandas.DataFrame: its folder, realization, what was set (`--set`, or by keys in Python), state hash, steps, and all measures of
    damage of a stage, by its name or number. `folders`: of runs, or one folder that holds them. Keys that differ between scenarios without having
    been set are columns, too, where their values are numbers, texts or booleans. Throws NoResultError."""
    pandas = _optional.need("pandas", "a table of runs")
    paths = _run_folders(folders)
    rows, documents = [], []
    for path in paths:
        summary = read(path / "summary.json")
        text = _scenario_of(path)
        of_stage = _stage_of(summary, stage, path)
        set_here = _values_set(text)
        rows.append({"folder": str(path), "realization": summary.get("realization"), "state_hash": summary["state_hash"], "steps": summary["steps"]})
        rows[-1] |= set_here | dict(of_stage["damage"])
        documents.append(_flat(_document(text)) | set_here)
    different = {key for document in documents for key in document if any(other.get(key) != document[key] for other in documents)}
    for row, document in zip(rows, documents):
        for key in sorted(different - set(row)):
            row[key] = document.get(key)
    return pandas.DataFrame(rows).set_index("folder")


def _run_folders(folders: Any) -> list[Path]:
    if isinstance(folders, (str, os.PathLike)):
        if (Path(folders) / "summary.json").exists():
            return [Path(folders)]
        inside = sorted(path.parent for path in Path(folders).glob("*/summary.json"))
        if not inside:
            raise NoResultError(f"{folders}: no folder with runs that have ended")
        return inside
    paths = [Path(folder) for folder in folders]
    if not paths:
        raise NoResultError("no folders of runs were given")
    for path in paths:
        if not (path / "summary.json").exists():
            raise NoResultError(f"{path}: no run that has ended")
    return paths


def _scenario_of(path: Path) -> str:
    file = ResultFile(path / "result.h5")
    try:
        return file.texts("scenario")[0]
    finally:
        file.close()


def _stage_of(summary: Mapping[str, Any], which: str | int, path: Path) -> Mapping[str, Any]:
    stages = summary["stages"]
    if isinstance(which, str):
        found = [stage for stage in stages if stage["name"] == which]
        if not found:
            raise KeyError(f"{path} has no stage {which!r}; there are {', '.join(repr(stage['name']) for stage in stages)}")
        return found[0]
    return stages[which]


def _plain(text: str) -> Any:
    """A value of TOML as far as it is a number, a boolean or a text."""
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "'\"" else text


def _values_set(text: str) -> dict[str, Any]:
    found = (_SET.match(line) for line in text.splitlines())
    return {match["key"]: _plain(match["value"]) for match in found if match}


def _document(text: str) -> Mapping[str, Any]:
    try:
        import tomllib
    except ImportError:
        return {}
    return tomllib.loads(text)


def _flat(value: Any, path: str = "") -> dict[str, Any]:
    """Numbers, texts and booleans of a document by their key paths; elements of lists by name or place."""
    if isinstance(value, Mapping):
        return {key: found for name, member in value.items() for key, found in _flat(member, f"{path}.{name}" if path else name).items()}
    if isinstance(value, list):
        names = [item.get("name") if isinstance(item, Mapping) else None for item in value]
        return {
            key: found
            for k, item in enumerate(value)
            if isinstance(item, Mapping)
            for key, found in _flat(item, f"{path}.{names[k]}" if names[k] else f"{path}[{k}]").items()
        }
    return {path: value} if isinstance(value, (bool, int, float, str)) else {}
