"""The state of all blocks at the moments that a run has kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Union, overload

import numpy as np

from . import record
from ._hdf5 import ResultFile
from .blocks import Blocks
from .elements import Elements

#: When: a simulated time in s, the name of a stage (its end), or None (the last moment).
When = Union[float, str, None]

STATUS = ["in place", "loosened", "fallen", "excavated"]
LOOSENED, FALLEN, EXCAVATED = 1, 2, 3


@dataclass
class Moments:
    """Rows over time that belong together: frames, or snapshots of the contacts."""

    time: np.ndarray  #: (n,), s
    stage: np.ndarray  #: (n,), number of the stage
    step: np.ndarray  #: (n,), step of the run
    stage_names: list[str]
    what: str  #: in messages

    @staticmethod
    def read(file: ResultFile, group: str, stage_names: list[str], what: str) -> Moments:
        time = file.complete_times(group)
        n = slice(0, len(time))
        return Moments(time, file.read(f"{group}/stage", n), file.read(f"{group}/step", n), stage_names, what)

    def __len__(self) -> int:
        return len(self.time)

    def index(self, when: When) -> int:
        """Of the nearest row in time; of several at that time, the last. Of a stage: its last row.

        Throws ValueError where there are no rows, or the time is not one of the run; KeyError where no stage has the name.
        """
        if len(self) == 0:
            raise ValueError(f"there are no {self.what} yet")
        if when is None:
            return len(self) - 1
        if isinstance(when, str):
            return self._end_of(when)
        return self._nearest(float(when))

    def _end_of(self, stage: str) -> int:
        if stage not in self.stage_names:
            raise KeyError(f"no stage {stage!r}{record.did_you_mean(stage, self.stage_names)}")
        rows = np.flatnonzero(self.stage == self.stage_names.index(stage))
        if rows.size == 0:
            raise ValueError(f"there are no {self.what} of stage {stage!r}: the run has not come to it")
        return int(rows[-1])

    def _nearest(self, time: float) -> int:
        first, last = float(self.time[0]), float(self.time[-1])
        spacing = float(np.diff(self.time).max(initial=0.0))
        if not first - spacing - 1e-9 <= time <= last + spacing + 1e-9:
            raise ValueError(f"no {self.what} at {time:g} s: there are some from {first:g} to {last:g} s")
        apart = np.abs(self.time - time)
        return int(np.flatnonzero(apart == apart.min())[-1])

    def nearest_to(self, time: float, step: int) -> int:
        """The row nearest in time; of several, the nearest in steps. −1 where there is none."""
        if len(self) == 0:
            return -1
        apart = np.abs(self.time - time)
        rows = np.flatnonzero(apart == apart.min())
        return int(rows[np.argmin(np.abs(self.step[rows] - step))])

    def stage_name(self, row: int) -> str:
        stage = int(self.stage[row])
        return self.stage_names[stage] if stage < len(self.stage_names) else f"stage {stage}"


@dataclass
class Frame:
    """All blocks at one moment. Arrays are read when they are asked for; nv vertices, nb blocks."""

    index: int
    time: float  #: s
    stage: str  #: name
    step: int  #: of the run
    _file: ResultFile = field(repr=False)
    _blocks: Blocks = field(repr=False)

    @cached_property
    def displacement(self) -> np.ndarray:
        """Of the vertices since the start, (nv, 2), m."""
        return self._file.read("frames/displacement", self.index)

    @cached_property
    def local(self) -> np.ndarray:
        """Where the vertices are, in local coordinates, (nv, 2), m."""
        return self._blocks.local + self.displacement

    @property
    def vertices(self) -> np.ndarray:
        """Where the vertices are, in real coordinates, (nv, 2), m."""
        return self.local + self._blocks.origin

    def rings(self, block: int) -> list[np.ndarray]:
        """Outlines of a block as it lies: outer ring, then holes, each (n, 2), m."""
        return [ring + self._blocks.origin for ring in self._blocks.outlines.of(block, self.local)]

    @cached_property
    def velocity(self) -> np.ndarray:
        """Of the mass centres, (nb, 2), m/s; NaN in results of versions that did not keep it."""
        if not self._file.has("frames/velocity"):
            return np.full((len(self._blocks), 2), np.nan)
        return self._file.read("frames/velocity", self.index)

    @cached_property
    def stress(self) -> np.ndarray:
        """Mean Cauchy stress xx, yy, xy of the blocks, (nb, 3), Pa; tension positive."""
        return self._file.read("frames/stress", self.index)

    @cached_property
    def status(self) -> np.ndarray:
        """(nb,), number in `STATUS`: 0 in place, 1 loosened, 2 fallen, 3 excavated."""
        return self._file.read("frames/status", self.index)

    @property
    def status_names(self) -> list[str]:
        """(nb,), in words."""
        names = self._file.values("frames/status", STATUS)
        return [names[s] for s in self.status]

    @property
    def is_there(self) -> np.ndarray:
        """Whether each block is not excavated, (nb,)."""
        return self.status != EXCAVATED

    @cached_property
    def elements(self) -> Elements:
        """What springs, supports and other elements carry."""
        return Elements(self._file, self._blocks, self.index)

    @cached_property
    def order(self) -> np.ndarray:
        """Of the displacement polynomials, (nb,)."""
        return self._file.read("frames/order", self.index)

    @cached_property
    def centroid(self) -> np.ndarray:
        """Centroids as they lie, in real coordinates, (nb, 2), m."""
        return self._blocks.outlines.centroids(self.local) + self._blocks.origin

    @cached_property
    def block_displacement(self) -> np.ndarray:
        """Of the centroids since the start, (nb, 2), m."""
        return self._blocks.outlines.centroids(self.local) - self._blocks.outlines.centroids(self._blocks.local)

    @cached_property
    def principal(self) -> tuple[np.ndarray, np.ndarray]:
        """Principal stresses, (nb, 2), Pa, the larger (tension) first; and the angle of the first from +x, (nb,), radians."""
        xx, yy, xy = self.stress.astype(float).T
        radius = np.hypot(0.5 * (xx - yy), xy)
        mean = 0.5 * (xx + yy)
        return np.column_stack([mean + radius, mean - radius]), 0.5 * np.arctan2(2.0 * xy, xx - yy)


class Frames(Sequence[Frame]):
    """All frames of a run. Nothing but their times is read before it is asked for."""

    def __init__(self, file: ResultFile, blocks: Blocks, stage_names: list[str]) -> None:
        self._file = file
        self._blocks = blocks
        self.moments = Moments.read(file, "frames", stage_names, "frames")
        self._drawn: Frame | None = None

    @property
    def time(self) -> np.ndarray:
        """(frames,), s of simulated time. Static steps take none, so that times may be equal."""
        return self.moments.time

    @property
    def stage(self) -> np.ndarray:
        """(frames,), numbers of the stages."""
        return self.moments.stage

    @property
    def step(self) -> np.ndarray:
        """(frames,), steps of the run."""
        return self.moments.step

    def __len__(self) -> int:
        return len(self.moments)

    @overload
    def __getitem__(self, which: int) -> Frame: ...
    @overload
    def __getitem__(self, which: slice) -> list[Frame]: ...
    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            return [self[k] for k in range(*which.indices(len(self)))]
        if not -len(self) <= which < len(self):
            raise IndexError(f"there are {len(self)} frames, and no frame {which}")
        k, m = int(which) % len(self), self.moments
        return Frame(k, float(m.time[k]), m.stage_name(k), int(m.step[k]), self._file, self._blocks)

    def __iter__(self) -> Iterator[Frame]:
        return (self[k] for k in range(len(self)))

    def at(self, when: When = None) -> Frame:
        """The frame nearest to a simulated time in s; at the end of a stage, by its name; the last one for None."""
        return self[self.moments.index(when)]

    def rings(self, block: int, when: When = None) -> list[np.ndarray]:
        """Frame.rings of the frame at a time. One block after another of one moment costs one reading of the file."""
        index = self.moments.index(when)
        if self._drawn is None or self._drawn.index != index:
            self._drawn = self[index]
        return self._drawn.rings(block)

    def __repr__(self) -> str:
        span = f", {self.time[0]:g} to {self.time[-1]:g} s" if len(self) else ""
        return f"<{len(self)} frames{span}>"
