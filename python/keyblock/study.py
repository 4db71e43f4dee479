"""The results of a study: runs.csv and study.json as tables, fragility curves and maps.

    study = keyblock.open_study("out/study")
    study.table("long")
    study.fragility("moderate", "pga_m_s2")[0].plot()
"""

from __future__ import annotations

import csv
import warnings
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import record, tables
from .errors import DamagedError, FormatError, NoResultError, UnfinishedWarning
from .fragility import Fragility
from .maps import FrequencyMap

if TYPE_CHECKING:
    from .results import Result

_PLAN_FORMAT = 1
_FORMS = ["wide", "stages", "long"]


class Study:
    """A study, as far as its runs are done and collected."""

    def __init__(self, path: str | Path, *, warn: bool = True) -> None:
        """`path` is the folder of the study. Throws NoResultError, FormatError and DamagedError."""
        self.path = Path(path)
        if not (self.path / "plan.json").exists() and not (self.path / "study.json").exists():
            raise NoResultError(f"{self.path}: no folder of a study: it has neither a plan.json nor a study.json")
        check_plan(self.path)
        if not (self.path / "study.json").exists():
            raise NoResultError(f"{self.path}: the study was not collected yet: keyblock study collect {self.path}")
        self.summary: record.Record = record.read(self.path / "study.json")
        missing = [name for name in ("title", "runs", "axes", "levels", "measures", "combinations") if name not in self.summary]
        if missing:
            raise DamagedError(f"{self.path / 'study.json'} is damaged: it has no {', '.join(missing)}")
        if warn and (why := self.unfinished):
            warnings.warn(f"{self.path}: {why}", UnfinishedWarning, stacklevel=2)

    @property
    def unfinished(self) -> str:
        """What is missing, in a sentence; empty where all runs were tried."""
        runs = self.summary["runs"]
        missing = runs["planned"] - runs["done"] - runs["failed"]
        return f"{missing} of {runs['planned']} runs are not done yet" if missing > 0 else ""

    @property
    def title(self) -> str:
        return str(self.summary["title"])

    @property
    def axes(self) -> dict[str, list[Any]]:
        """Keys that vary, and their values."""
        return {axis["key"]: [number_or_text(value) for value in axis["values"]] for axis in self.summary["axes"]}

    @property
    def measures(self) -> list[str]:
        """Names of the measures of damage."""
        return [measure["name"] for measure in self.summary["measures"]]

    @property
    def failed(self) -> list[record.Record]:
        """Runs that were not measured: `key`, `realization`, `values`, `variant`, `error`."""
        return list(self.summary["failed"])

    # ── the runs ──

    @cached_property
    def _rows(self) -> tuple[list[str], list[list[str]]]:
        path = self.path / "runs.csv"
        try:
            with path.open(newline="", encoding="utf-8") as file:
                names, *rows = list(csv.reader(file))
        except FileNotFoundError:
            raise NoResultError(f"{path}: no such file: keyblock study collect {self.path}") from None
        except (ValueError, csv.Error) as error:
            raise DamagedError(f"{path} is damaged: {error}") from None
        if any(len(row) != len(names) for row in rows):
            raise DamagedError(f"{path} is damaged: a row has more or fewer cells than the first")
        return [plain_text(name) for name in names], rows

    def _stage_columns(self, names: list[str]) -> dict[str, tuple[str, str]]:
        """Of the columns STAGE.MEASURE: stage and measure."""
        known = {*self.measures, *(i["name"] for i in self.summary["intensities"])}
        parts = {name: name.rpartition(".") for name in names if name not in self.axes}
        return {name: (stage, measure) for name, (stage, dot, measure) in parts.items() if dot and measure in known}

    def records(self, form: str = "wide", *, variants: bool = False) -> list[dict[str, Any]]:
        """The rows of `table` as dictionaries, without pandas. What is empty in runs.csv is None."""
        if form not in _FORMS:
            raise ValueError(f"form = {form!r}; expected {', '.join(map(repr, _FORMS))}")
        names, rows = self._rows
        of_stages = self._stage_columns(names)
        found: list[dict[str, Any]] = []
        for row in rows:
            run = {name: number_or_text(cell) for name, cell in zip(names, row)}
            run["variant"] = run["variant"] or ""
            if not variants and run["variant"]:
                continue
            found += [run] if form == "wide" else _by_stage(run, of_stages) if form == "stages" else _by_measure(run, of_stages)
        return found

    def table(self, form: str = "wide", *, variants: bool = False) -> Any:
        """The runs as pandas.DataFrame.

        "wide": a row per run, columns as in runs.csv. "stages": a row per run and stage, a column per measure. "long": a row per run,
        stage and measure, with its `value`. Runs of marginality (variants) are left out unless asked for. Units are those in the names.
        """
        return tables.data_frame(self.records(form, variants=variants), "runs")

    def run(self, key: str) -> Result:
        """The results of a run, by its key in runs.csv. Throws NoResultError unless the study kept them (keep = "all")."""
        from .results import Result

        return Result(self.path / "runs" / key)

    # ── statistics ──

    def combination(self, values: dict[str, Any] | None = None) -> record.Record:
        """Statistics of a combination of values, as in study.json. Throws KeyError unless `values` leave just one."""
        return self.summary["combinations"][self._combination_at(values or {})]

    def _combination_at(self, values: dict[str, Any]) -> int:
        keys = list(self.axes)
        for key in values:
            if key not in keys:
                raise KeyError(f"no axis {key!r}{record.did_you_mean(key, keys)}")
        wanted = {key: number_or_text(str(value)) for key, value in values.items()}
        of_all = [self._values(c) for c in self.summary["combinations"]]
        found = [k for k, known in enumerate(of_all) if all(known[key] == value for key, value in wanted.items())]
        if len(found) != 1:
            raise KeyError(f"{len(found)} combinations have {wanted or 'any values'}; axes and values: {self.axes}")
        return found[0]

    def _values(self, combination: record.Record) -> dict[str, Any]:
        return dict(zip(self.axes, map(number_or_text, combination["values"])))

    def statistics(self, measure: str = "fallen_area_m2") -> Any:
        """Mean, deviation and quantiles of a measure, a row per combination, as pandas.DataFrame. `mean_low`, `mean_high`: its interval."""
        if measure not in self.measures:
            raise KeyError(f"no measure {measure!r}{record.did_you_mean(measure, self.measures)}")
        rows = []
        for combination in self.summary["combinations"]:
            m = combination["measures"][measure]
            row = self._values(combination) | {"n": m["n"], "min": m["min"], "max": m["max"]}
            row |= {"mean": m["mean"]["value"], "mean_low": m["mean"]["low"], "mean_high": m["mean"]["high"], "std": m["std"]["value"]}
            rows.append(row | {f"q{100 * q['p']:g}": q["value"] for q in m["quantiles"]})
        return tables.data_frame(rows, "statistics")

    def probabilities(self) -> Any:
        """Probability that damage exceeds each level, a row per combination and level, with Wilson's interval, as pandas.DataFrame."""
        names = ("n", "exceeded", "probability", "low", "high")
        rows = [
            self._values(c) | {"pga_m_s2": c["pga_m_s2"], "level": level["name"]} | {name: level[name] for name in names}
            for c in self.summary["combinations"]
            for level in c["levels"]
        ]
        return tables.data_frame(rows, "probabilities")

    def fragility(self, level: str | None = None, intensity: str | None = None) -> list[Fragility]:
        """Fragility curves of a level of damage over an intensity: one for each group of combinations that differ in their shaking alone.

        Without level or intensity: those of all. A group without a curve has its points, and `why`.
        """
        levels = {found["name"]: found for found in self.summary["levels"]}
        intensities = {found["name"]: found for found in self.summary["intensities"]}
        for name, known in ((level, levels), (intensity, intensities)):
            if name is not None and name not in known:
                raise KeyError(f"no level or intensity {name!r}{record.did_you_mean(name, known)}")
        keys = [axis["key"] for axis in self.summary["axes"]]
        return [
            Fragility.of(found, levels[found["level"]], intensities[found["intensity"]], keys)
            for found in self.summary["fragility"]
            if level in (None, found["level"]) and intensity in (None, found["intensity"])
        ]

    def risk(self, folder: str | Path | None = None) -> record.Record:
        """How often a year each level is exceeded: risk.json, as `keyblock risk` wrote it. `folder`: of its -o.

        Throws NoResultError where there is none.
        """
        path = (Path(folder) if folder is not None else self.path / "risk") / "risk.json"
        if not path.exists():
            raise NoResultError(f"{path}: no such file: keyblock risk {self.path} --settings risk.toml")
        return record.read(path)

    @property
    def maps(self) -> list[FrequencyMap]:
        """Where rock falls, a map per combination."""
        return [self._map(k) for k, c in enumerate(self.summary["combinations"]) if c.get("map")]

    def map(self, values: dict[str, Any] | None = None) -> FrequencyMap:
        """The map of one combination: ``study.map({"stage.shaken.scale": 4.0})``."""
        k = self._combination_at(values or {})
        if not self.summary["combinations"][k].get("map"):
            raise NoResultError(f"{self.path}: no run of this combination has a map")
        return self._map(k)

    def _map(self, k: int) -> FrequencyMap:
        combination = self.summary["combinations"][k]
        return FrequencyMap.of(combination["map"], self.summary["grid"], self.summary["outlines"], self._values(combination))

    def __repr__(self) -> str:
        runs = self.summary["runs"]
        return f"<keyblock study {str(self.path)!r}: {self.title!r}, {runs['done']} of {runs['planned']} runs, axes {list(self.axes)}>"


def check_plan(folder: Path) -> None:
    """Throws FormatError where the plan of a study or a limit has a format that is not known."""
    if not (folder / "plan.json").exists():
        return
    found = record.read(folder / "plan.json").get("format")
    if found != _PLAN_FORMAT:
        raise FormatError(
            f"{folder / 'plan.json'} has format {found}, and this package reads format {_PLAN_FORMAT}: take a keyblock of the same version"
        )


def plain_text(cell: str) -> str:
    """Without the apostrophe that keeps spreadsheets from running a text."""
    return cell[1:] if len(cell) > 1 and cell[0] == "'" and cell[1] in "=+-@\t\r" else cell


def number_or_text(cell: str) -> Any:
    """A cell as int or float where it is a number, as None where it is empty, else as text."""
    if cell == "":
        return None
    for kind in (int, float):
        try:
            return kind(cell)
        except ValueError:
            continue
    return plain_text(cell)


def _of_run(run: dict[str, Any], of_stages: dict[str, tuple[str, str]]) -> dict[str, Any]:
    return {name: value for name, value in run.items() if name not in of_stages}


def _by_stage(run: dict[str, Any], of_stages: dict[str, tuple[str, str]]) -> list[dict[str, Any]]:
    rows: dict[str, dict[str, Any]] = {}
    for name, (stage, measure) in of_stages.items():
        rows.setdefault(stage, _of_run(run, of_stages) | {"stage": stage})[measure] = run[name]
    return list(rows.values())


def _by_measure(run: dict[str, Any], of_stages: dict[str, tuple[str, str]]) -> list[dict[str, Any]]:
    common = _of_run(run, of_stages)
    return [common | {"stage": stage, "measure": measure, "value": run[name]} for name, (stage, measure) in of_stages.items()]
