"""Trace maps from arrays and from maps of other libraries."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .scenario import Scenario


class TraceMap:
    """Joints mapped one by one: polylines in the coordinates of the domain, m."""

    def __init__(self, lines: Iterable[Any], names: Sequence[str] | None = None) -> None:
        """`lines`: arrays of shape (points, 2). `names`: one for each; by default trace 1, trace 2, …"""
        self.lines = [_line(points, k) for k, points in enumerate(lines)]
        self.names = [f"trace {k + 1}" for k in range(len(self.lines))] if names is None else [str(n) for n in names]
        if len(self.names) != len(self.lines):
            raise ValueError(f"{len(self.lines)} lines, and {len(self.names)} names")

    @classmethod
    def from_geodataframe(cls, frame: Any, name: str | None = None) -> TraceMap:
        """From the geometry of a geopandas.GeoDataFrame, or anything alike: LineString, MultiLineString. `name`: the column of names."""
        lines: list[np.ndarray] = []
        names: list[str] = []
        labels = [str(value) for value in frame[name]] if name else [f"trace {k + 1}" for k in range(len(frame))]
        for label, geometry in zip(labels, frame.geometry):
            parts = list(getattr(geometry, "geoms", [geometry]))
            for k, part in enumerate(parts):
                if part.geom_type not in ("LineString", "LinearRing"):
                    raise ValueError(f"{label}: a {part.geom_type}, and traces are lines")
                lines.append(np.array(part.coords)[:, :2])
                names.append(label if len(parts) == 1 else f"{label}, part {k + 1}")
        return cls(lines, names)

    def __len__(self) -> int:
        return len(self.lines)

    def add_to(self, scenario: Scenario, **keys: Any) -> None:
        """Appends a [[trace_map]] for each line; `keys` are strengths and stiffnesses, as friction=30."""
        there = [table.to_dict() for table in scenario.trace_map]
        added = [
            {"name": name, "points": line.tolist(), **keys}
            for name, line in zip(self.names, self.lines)
        ]
        scenario["trace_map"] = [*there, *added]


def _line(points: Any, k: int) -> np.ndarray:
    line = np.asarray(points, dtype=float)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2:
        raise ValueError(f"line {k}: an array of shape (points, 2) with two points or more, not {line.shape}")
    if not np.isfinite(line).all():
        raise ValueError(f"line {k}: coordinates that are finite numbers")
    return line
