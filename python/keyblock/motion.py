"""Ground motions from arrays and from other libraries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .scenario import Scenario, Table


@dataclass
class Motion:
    """The acceleration of the ground in the section: `x` along it, `y` upwards, at times a `step` apart."""

    step: float  #: s
    x: np.ndarray  #: (n,), m/s²
    y: np.ndarray | None = None  #: (n,), m/s²; None: none

    def __post_init__(self) -> None:
        self.x = _samples(self.x, "x")
        self.y = None if self.y is None else _samples(self.y, "y")
        if not (np.isfinite(self.step) and self.step > 0):
            raise ValueError("step: a time above 0 s")
        if self.y is not None and len(self.y) != len(self.x):
            raise ValueError(f"x has {len(self.x)} samples, and y {len(self.y)}")

    @classmethod
    def from_obspy(cls, *traces: Any, section: float, azimuths: Any = None, factor: float = 1.0) -> Motion:
        """From traces of one station with `data` and `stats.delta`, as ObsPy has them. `section`: degrees from north of the section's +x.
        `azimuths`: one for each trace, degrees from north, or "up"; without them the last letter of `stats.channel` says it: E, N or Z.
        `factor` brings the data to m/s². Nothing is filtered, and no response is taken off."""
        if not traces:
            raise ValueError("no traces")
        steps = {float(trace.stats.delta) for trace in traces}
        if len(steps) > 1:
            raise ValueError(f"traces have different time steps: {sorted(steps)}")
        angles = [_azimuth_of(trace) for trace in traces] if azimuths is None else list(azimuths)
        if len(angles) != len(traces):
            raise ValueError(f"{len(traces)} traces, and {len(angles)} azimuths")
        count = min(len(trace.data) for trace in traces)
        x, y = np.zeros(count), np.zeros(count)
        for trace, angle in zip(traces, angles):
            data = factor * np.asarray(trace.data[:count], dtype=float)
            if angle == "up":
                y += data
            else:
                x += data * np.cos(np.radians(float(angle) - section))
        return cls(steps.pop(), x, y)

    @property
    def duration(self) -> float:
        """s"""
        return self.step * (len(self.x) - 1)

    def add_to(self, scenario: Scenario, name: str, **keys: Any) -> Table:
        """Appends a [[motion]] of this name; `keys` are others of that table, as at="base"."""
        times = np.arange(len(self.x)) * self.step
        rows = {"x": np.column_stack([times, self.x]).tolist()}
        if self.y is not None:
            rows["y"] = np.column_stack([times, self.y]).tolist()
        return scenario.motion.append(name=name, **keys, **rows)


def _samples(values: Any, name: str) -> np.ndarray:
    array = np.asarray(values, dtype=float)
    if array.ndim != 1 or len(array) < 2:
        raise ValueError(f"{name}: a list of at least two accelerations, not an array of shape {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: accelerations that are finite numbers")
    return array


def _azimuth_of(trace: Any) -> float | str:
    channel = str(getattr(trace.stats, "channel", ""))
    known: dict[str, float | str] = {"E": 90.0, "N": 0.0, "Z": "up"}
    if channel[-1:] not in known:
        raise ValueError(f"channel {channel!r} does not say which way it points; give azimuths=")
    return known[channel[-1:]]
