"""Ground motions from arrays and from other libraries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arguments as arguments
from .errors import DataError

if TYPE_CHECKING:
    from .scenario import Scenario
    from .scenario_tables import Table

# Shares of a time step. Steps may differ by rounding; beginnings by what no frequency of an earthquake notices.
_SAME_STEP = 1e-6
_SAME_SAMPLE = 0.05
# Degrees: horizontal components nearer to each other are one component.
_SAME_DIRECTION = 1.0


@dataclass
class Motion:
    """The acceleration of the ground in the section: `x` along it, `y` upwards, at times a `step` apart."""

    step: float  #: s
    x: np.ndarray  #: (n,), m/s²
    y: np.ndarray | None = None  #: (n,), m/s²; None: none

    def __post_init__(self) -> None:
        self.x = _samples(self.x, "x")
        self.y = None if self.y is None else _samples(self.y, "y")
        self.step = arguments.number("step", self.step)
        if not (np.isfinite(self.step) and self.step > 0):
            raise DataError("step: a time above 0 s")
        if self.y is not None and len(self.y) != len(self.x):
            raise DataError(f"x has {len(self.x)} samples, and y {len(self.y)}")

    @classmethod
    def from_obspy(
        cls, *traces: Any, section: float, azimuths: Any = None, factor: float = 1.0, calib: bool | None = None
    ) -> Motion:
        """From traces of one station, or a stream of them, with `data` and `stats` as ObsPy has them. `section`: degrees from north of the
        section's +x. `azimuths`: one for each trace, degrees from north, or "up"; without them the last letter of `stats.channel` says it:
        E, N or Z. `factor` brings the data to m/s². `calib`: whether `stats.calib` is a factor, too; must be said where it is not 1.

        Traces are aligned by `stats.starttime`, and their common time is taken. Throws DataError for gaps, for steps that differ by more
        than 1e-6, for beginnings between samples, and for two traces of one component. Nothing is filtered, and no response is taken off."""
        section, factor = arguments.number("section", section), arguments.number("factor", factor)
        all_traces = [trace for given in traces for trace in ([given] if hasattr(given, "stats") else given)]
        if not all_traces:
            raise DataError("no traces")
        step = _step_of(all_traces)
        angles = [_azimuth_of(trace) for trace in all_traces] if azimuths is None else list(azimuths)
        if len(angles) != len(all_traces):
            raise DataError(f"{len(all_traces)} traces, and {len(angles)} azimuths")
        _check_components(all_traces, angles)
        first, count = _common_window(all_traces, step)
        x, y = np.zeros(count), np.zeros(count)
        for trace, angle, begin in zip(all_traces, angles, first):
            data = factor * _calibration(trace, calib) * _data_of(trace)[begin : begin + count]
            if angle == "up":
                y += data
            else:
                x += data * np.cos(np.radians(float(angle) - section))
        return cls(step, x, y)

    @property
    def duration(self) -> float:
        """s"""
        return self.step * (len(self.x) - 1)

    def add_to(self, scenario: Scenario, name: str, **keys: Any) -> Table:
        """Appends a [[motion]] of this name; `keys` are others of that table, as at="base"."""
        times = np.arange(len(self.x)) * self.step
        rows = {"x": np.column_stack([times, self.x])}
        if self.y is not None:
            rows["y"] = np.column_stack([times, self.y])
        return scenario.motion.append(name=name, **keys, **rows)


def _samples(values: Any, name: str) -> np.ndarray:
    _refuse_gaps(values, name)
    if np.asarray(values).dtype.kind in "bcSU":
        raise DataError(f"{name}: accelerations that are real numbers, not {np.asarray(values).dtype}")
    array = np.asarray(values, dtype=float)
    if array.ndim != 1 or len(array) < 2:
        raise DataError(f"{name}: a list of at least two accelerations, not an array of shape {array.shape}")
    if not np.isfinite(array).all():
        raise DataError(f"{name}: accelerations that are finite numbers")
    return array


def _refuse_gaps(values: Any, name: str) -> None:
    masked = int(np.ma.getmaskarray(values).sum()) if np.ma.isMaskedArray(values) else 0
    if masked:
        raise DataError(f"{name}: a gap, {masked} of {len(values)} samples are masked; take a part without gaps, or fill them")


def _label(trace: Any) -> str:
    parts = [str(getattr(trace.stats, part, "")) for part in ("network", "station", "location", "channel")]
    return "trace " + ".".join(part for part in parts if part)


def _data_of(trace: Any) -> np.ndarray:
    _refuse_gaps(trace.data, _label(trace))
    data = np.asarray(trace.data)
    if data.ndim != 1 or data.dtype.kind not in "fiu":
        raise DataError(f"{_label(trace)}: a list of numbers, not an array of {data.dtype} of shape {data.shape}")
    if not np.isfinite(data).all():
        raise DataError(f"{_label(trace)}: {int((~np.isfinite(data)).sum())} samples that are no finite numbers")
    return data.astype(float)


def _step_of(traces: list[Any]) -> float:
    steps = [float(trace.stats.delta) for trace in traces]
    if any(not np.isfinite(step) or abs(step - steps[0]) > _SAME_STEP * steps[0] for step in steps):
        raise DataError(f"traces have different time steps: {', '.join(f'{step:g}' for step in sorted(set(steps)))} s; resample them to one")
    return steps[0]


def _common_window(traces: list[Any], step: float) -> tuple[list[int], int]:
    """First sample of each trace, and how many are common to all."""
    starts: list[Any] = [getattr(trace.stats, "starttime", None) for trace in traces]
    if all(start is None for start in starts):
        begins = [0] * len(traces)
    elif any(start is None for start in starts):
        raise DataError(f"{_label(traces[[s is None for s in starts].index(True)])}: no start time, and others have one")
    else:
        begins = []
        for trace, start in zip(traces, starts):
            samples = float(start - starts[0]) / step
            if abs(samples - round(samples)) > _SAME_SAMPLE:
                raise DataError(
                    f"{_label(trace)} begins {samples:.3f} time steps after {_label(traces[0])}, between its samples; "
                    "interpolate them to the same times (Stream.interpolate of ObsPy)"
                )
            begins.append(round(samples))
    latest = max(begins)
    first = [latest - begin for begin in begins]
    count = min(len(trace.data) - skipped for trace, skipped in zip(traces, first))
    if count < 2:
        raise DataError("the traces have no time in common")
    return first, count


def _check_components(traces: list[Any], angles: list[Any]) -> None:
    stations = {(str(getattr(t.stats, "network", "")), str(getattr(t.stats, "station", ""))) for t in traces}
    if len(stations) > 1:
        raise DataError(f"traces of several stations: {', '.join('.'.join(station) for station in sorted(stations))}")
    for k, angle in enumerate(angles):
        if angle != "up" and not (isinstance(angle, (int, float, np.number)) and np.isfinite(angle)):
            raise DataError(f"azimuth {angle!r}: degrees from north, or \"up\"")
        for other in range(k):
            if _same_direction(angle, angles[other]):
                raise DataError(f"{_label(traces[k])} and {_label(traces[other])} are of one component ({angle}); give one of them")


def _same_direction(a: Any, b: Any) -> bool:
    if "up" in (a, b):
        return bool(a == b)
    return abs((float(a) - float(b) + 90.0) % 180.0 - 90.0) < _SAME_DIRECTION


def _calibration(trace: Any, calib: bool | None) -> float:
    value = float(getattr(trace.stats, "calib", 1.0))
    if value == 1.0 or calib is False:
        return 1.0
    if calib is None:
        raise DataError(
            f"{_label(trace)} has stats.calib = {value:g}; say calib=True to multiply its data by it, or calib=False where that was done"
        )
    return value


def _azimuth_of(trace: Any) -> float | str:
    channel = str(getattr(trace.stats, "channel", ""))
    known: dict[str, float | str] = {"E": 90.0, "N": 0.0, "Z": "up"}
    if channel[-1:] not in known:
        raise DataError(f"channel {channel!r} does not say which way it points; give azimuths=")
    return known[channel[-1:]]
