"""Trace maps from arrays and from maps of other libraries."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DataError

if TYPE_CHECKING:
    from .scenario import Scenario

_DEFAULT = "traces"


class TraceMap:
    """Joints mapped one by one: polylines in the coordinates of the domain, m, in sets that have a name."""

    def __init__(
        self,
        lines: Iterable[Any],
        names: Sequence[str] | None = None,
        properties: Mapping[str, Mapping[str, float]] | None = None,
    ) -> None:
        """`lines`: arrays of shape (points, 2). `names`: of the set of each line; lines of one name are one set. Without names all lines are
        one set, "traces". `properties`: strengths and stiffnesses by the name of a set, as {"J1": {"friction": 30.0}}."""
        self.lines = [_line(points, k) for k, points in enumerate(lines)]
        self._is_named = names is not None
        self.names = [_DEFAULT] * len(self.lines) if names is None else [str(name) for name in names]
        if len(self.names) != len(self.lines):
            raise DataError(f"{len(self.lines)} lines, and {len(self.names)} names")
        if not self.lines:
            raise DataError("no lines")
        self.properties = {name: dict(keys) for name, keys in (properties or {}).items()}
        unknown = [name for name in self.properties if name not in self.names]
        if unknown:
            raise DataError(f"properties of {unknown[0]!r}, and there are {', '.join(map(repr, self.sets))}")

    @classmethod
    def from_geodataframe(cls, frame: Any, name: str | None = None, properties: Sequence[str] | Mapping[str, str] = ()) -> TraceMap:
        """From the geometry of a geopandas.GeoDataFrame, or anything alike: LineString, MultiLineString. `name`: the column of the names of
        sets; rows of one name are one set. `properties`: columns of strengths and stiffnesses, such as ["friction", "cohesion"], or
        {"friction": "phi"} where a column has another name; the rows of a set must agree. Rows without a geometry are left out, with a
        warning that names them."""
        told = [_DEFAULT] * len(frame) if name is None else list(_column(frame, name))
        columns = dict(properties) if isinstance(properties, Mapping) else {key: key for key in properties}
        values = {key: list(_column(frame, column)) for key, column in columns.items()}
        index = list(getattr(frame, "index", range(len(frame))))
        lines: list[np.ndarray] = []
        names: list[str] = []
        of_sets: dict[str, dict[str, float]] = {}
        without = []
        for k, (label, geometry) in enumerate(zip(map(str, told), frame.geometry)):
            if geometry is None or getattr(geometry, "is_empty", False):
                without.append(index[k])
                continue
            if _is_missing(told[k]):
                raise DataError(f"row {index[k]!r}: no value in column {name!r}, which names its set")
            for part in getattr(geometry, "geoms", [geometry]):
                if part.geom_type not in ("LineString", "LinearRing"):
                    raise DataError(f"row {index[k]!r}, {label}: a {part.geom_type}, and traces are lines")
                lines.append(np.array([point[:2] for point in part.coords], dtype=float))
                names.append(label)
            _agree(of_sets.setdefault(label, {}), {key: row[k] for key, row in values.items()}, label, index[k])
        if without:
            named = ", ".join(map(repr, without[:10])) + (" …" if len(without) > 10 else "")
            words = f"{'row' if len(without) == 1 else 'rows'} {named} without a geometry"
            if not lines:
                raise DataError(f"no lines: {words}")
            warnings.warn(f"{words}: left out", stacklevel=2)
        return cls(lines, None if name is None else names, of_sets if columns else None)

    def __len__(self) -> int:
        return len(self.lines)

    @property
    def sets(self) -> list[str]:
        """Names, each once, in their order."""
        return list(dict.fromkeys(self.names))

    def add_to(self, scenario: Scenario, **keys: Any) -> None:
        """Appends a [[trace_map]] for each set; `keys` are strengths and stiffnesses of all of them, as friction=30, before which
        properties go."""
        there = set(scenario.trace_map.names)
        tables = []
        for name, lines in self._lines_by_set().items():
            free = name if self._is_named else _free_name(name, there)
            if free in there:
                raise DataError(f"the scenario has a trace map {free!r} already; give another name")
            shape: dict[str, Any] = {"points": lines[0]} if len(lines) == 1 else {"lines": lines}
            own: dict[str, Any] = dict(self.properties[name]) if name in self.properties else {}
            tables.append({"name": free, **shape, **keys, **own})
        scenario.trace_map.extend(tables)

    def _lines_by_set(self) -> dict[str, list[np.ndarray]]:
        sets: dict[str, list[np.ndarray]] = {name: [] for name in self.sets}
        for name, line in zip(self.names, self.lines):
            sets[name].append(line)
        return sets

    def __repr__(self) -> str:
        return f"<keyblock.TraceMap, {len(self)} lines, sets {', '.join(self.sets)}>"


def _free_name(name: str, taken: set[str]) -> str:
    number = 1
    while (free := name if number == 1 else f"{name} {number}") in taken:
        number += 1
    return free


def _column(frame: Any, name: str) -> Any:
    try:
        return frame[name]
    except KeyError:
        there = ", ".join(map(repr, getattr(frame, "columns", frame)))
        raise DataError(f"there is no column {name!r}; there are {there}") from None


def _agree(of_set: dict[str, float], row: dict[str, Any], label: str, index: Any) -> None:
    """Takes the properties of a row over into those of its set."""
    for key, value in row.items():
        if value is None or value != value:  # nothing, or not a number
            continue
        if of_set.setdefault(key, float(value)) != float(value):
            raise DataError(f"row {index!r}: {key} {value} of set {label!r}, which has {of_set[key]} before; give it a set of its own")


def _is_missing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and value != value)


def _line(points: Any, k: int) -> np.ndarray:
    line = np.asarray(points, dtype=float)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
        raise DataError(f"line {k}: an array of shape (points, 2) with two points or more, not {line.shape}")
    if not np.isfinite(line).all():
        raise DataError(f"line {k}: coordinates that are finite numbers")
    return line
