"""Contacts of the blocks at the moments that a run has kept: where they are, and what they carry."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from . import _optional
from ._hdf5 import ResultFile
from .blocks import Blocks
from .frames import Frame, Moments, When

STATES = ["open", "sliding", "locked"]
OPEN, SLIDING, LOCKED = 0, 1, 2

_COLUMNS = ["block_a", "block_b", "state", "position", "normal", "length", "gap", "slip", "shear_displacement", "normal_force", "shear_force"]
# Those that results of earlier versions do not have: zero there.
_NEWER = ["water_pressure"]

# Sine of the largest angle between an edge of one block and the edge of the other that it lies on.
_ALONG = 0.3


def _distances(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Of points (m, 2) from the nearest of the segments a to b, each (n, 2)."""
    along, to = b - a, points[:, None, :] - a
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip((to * along).sum(axis=2) / length, 0.0, 1.0)
    return np.sqrt(((to - share[:, :, None] * along) ** 2).sum(axis=2).min(axis=1))


@dataclass
class Contacts:
    """All contacts at one moment, a row for each; block_a has the vertex, block_b the edge. Forces are per metre of thickness."""

    time: float  #: s
    stage: str  #: name
    step: int  #: of the run
    block_a: np.ndarray = field(repr=False)  #: (n,)
    block_b: np.ndarray = field(repr=False)  #: (n,)
    state: np.ndarray = field(repr=False)  #: (n,), number in `STATES`: 0 open, 1 sliding, 2 locked
    position: np.ndarray = field(repr=False)  #: (n, 2), m, real coordinates
    normal: np.ndarray = field(repr=False)  #: (n, 2), unit vectors out of block_b
    length: np.ndarray = field(repr=False)  #: (n,), m, of joint that belongs to the contact
    gap: np.ndarray = field(repr=False)  #: (n,), m, negative where it is pressed
    slip: np.ndarray = field(repr=False)  #: (n,), m, since the excavation: the magnitude
    shear_displacement: np.ndarray = field(repr=False)  #: (n,), m, of block_a against block_b along `tangent`: the slip with its sign
    normal_force: np.ndarray = field(repr=False)  #: (n,), N/m, compression positive
    shear_force: np.ndarray = field(repr=False)  #: (n,), N/m
    water_pressure: np.ndarray = field(repr=False)  #: (n,), Pa, of the water in the joint: the forces are effective ones beside it
    edge_kind: np.ndarray = field(repr=False)  #: (n,), number in `keyblock.blocks.EDGE_KINDS`
    edge_index: np.ndarray = field(repr=False)  #: (n,), which joint set, trace map or excavation
    _blocks: Blocks = field(repr=False)

    def __len__(self) -> int:
        return len(self.block_a)

    @property
    def state_names(self) -> list[str]:
        return [STATES[s] for s in self.state]

    @cached_property
    def edge_names(self) -> list[str]:
        """Name of the joint set, trace map or excavation of each contact."""
        return self._blocks.edge_names(self.edge_kind, self.edge_index)

    @cached_property
    def tangent(self) -> np.ndarray:
        """Unit vectors along the edges, in the direction of `shear_displacement`, (n, 2)."""
        return np.column_stack([-self.normal[:, 1], self.normal[:, 0]])

    @property
    def force(self) -> np.ndarray:
        """On block_a, (n, 2), N/m. That on block_b is the opposite."""
        return self.normal_force[:, None] * self.normal - self.shear_force[:, None] * self.tangent

    def force_on(self, block: int | str) -> np.ndarray:
        """Sum of the contact forces on a block, (2,), N/m."""
        b = self._blocks.index_of(block)
        return self.force[self.block_a == b].sum(axis=0) - self.force[self.block_b == b].sum(axis=0)

    @cached_property
    def slip_of_blocks(self) -> np.ndarray:
        """The largest slip of a joint of each block, (nb,), m; NaN for blocks without contacts."""
        slip = np.full(len(self._blocks), -np.inf)
        for side in (self.block_a, self.block_b):
            np.maximum.at(slip, side, self.slip)
        return np.where(np.isinf(slip), np.nan, slip)

    def stretches(self, local: np.ndarray) -> np.ndarray:
        """Ends of the stretch of joint that belongs to each contact, (n, 2, 2), m, real coordinates.

        It begins at the contact and goes the way the edge of block_a goes. `local` are the positions of all vertices at the same moment.
        """
        side = self._sides(local)
        along = self.length[:, None] * self.tangent
        begin = self.position - 0.5 * (1.0 - side)[:, None] * along
        return np.stack([begin, begin + along], axis=1)

    def _sides(self, local: np.ndarray) -> np.ndarray:
        """Where block_a lies along each edge, seen from the vertex: 1 ahead, −1 behind, 0 on both sides."""
        rings, n = self._blocks.outlines, len(self)
        # Each contact beside every vertex of its block_a.
        order = np.argsort(rings.vertex_block, kind="stable")
        first = np.searchsorted(rings.vertex_block[order], np.arange(rings.blocks + 1))
        count = (first[1:] - first[:-1])[self.block_a]
        contact = np.repeat(np.arange(n), count)
        within = np.arange(len(contact)) - np.repeat(np.cumsum(count) - count, count)
        vertex = order[first[self.block_a][contact] + within]
        distance = np.hypot(*(local[vertex] - (self.position - self._blocks.origin)[contact]).T)
        nearest = np.lexsort((distance, contact))[np.cumsum(count) - count] if n else np.zeros(0, dtype=int)
        at = vertex[nearest]
        before = np.empty_like(rings.next_vertex)
        before[rings.next_vertex] = np.arange(len(before))
        side = np.zeros(n)
        for neighbour in (rings.next_vertex[at], before[at]):
            edge = local[neighbour] - local[at]
            t = self.tangent
            lies_along = np.abs(t[:, 0] * edge[:, 1] - t[:, 1] * edge[:, 0]) < _ALONG * np.hypot(*edge.T)
            side += np.where(lies_along, np.sign((t * edge).sum(axis=1)), 0.0)
        return self._within_edges(np.clip(side, -1.0, 1.0), local)

    def _within_edges(self, side: np.ndarray, local: np.ndarray) -> np.ndarray:
        """Of stretches on both sides of their vertex: those that reach beyond the outline of block_b go to the other side alone."""
        rings = self._blocks.outlines
        for k in np.flatnonzero(side == 0.0):
            own = np.flatnonzero(rings.vertex_block == self.block_b[k])
            at = self.position[k] - self._blocks.origin
            along = 0.5 * self.length[k] * self.tangent[k]
            beyond = _distances(np.array([at - along, at + along]), local[own], local[rings.next_vertex[own]]) > 0.05 * self.length[k]
            side[k] = float(beyond[0]) - float(beyond[1])
        return side

    def table(self) -> Any:
        """One row per contact, as pandas.DataFrame, in SI units."""
        pandas = _optional.need("pandas", "a table of contacts")
        table = pandas.DataFrame(
            {
                "block_a": self.block_a,
                "block_b": self.block_b,
                "state": pandas.Categorical.from_codes(self.state, STATES),
                "x": self.position[:, 0],
                "y": self.position[:, 1],
                "nx": self.normal[:, 0],
                "ny": self.normal[:, 1],
                "length": self.length,
                "gap": self.gap,
                "slip": self.slip,
                "shear_displacement": self.shear_displacement,
                "normal_force": self.normal_force,
                "shear_force": self.shear_force,
                "water_pressure": self.water_pressure,
                "edge": self.edge_names,
            }
        )
        metres = dict.fromkeys(("x", "y", "length", "gap", "slip", "shear_displacement"), "m")
        table.attrs["units"] = metres | {"normal_force": "N/m", "shear_force": "N/m", "water_pressure": "Pa"}
        return table


class ContactSnapshots:
    """The moments at which contacts were kept: the ends of stages, and every second or so."""

    def __init__(self, file: ResultFile, blocks: Blocks, stage_names: list[str]) -> None:
        self._file = file
        self._blocks = blocks
        moments = Moments.read(file, "contacts", stage_names, "contacts")
        self._end = file.read("contacts/end")[: len(moments)]
        complete = int(np.searchsorted(self._end, min(file.shape(f"contacts/{self._in_file(name)}")[0] for name in _COLUMNS), "right"))
        self.moments = Moments(moments.time[:complete], moments.stage[:complete], moments.step[:complete], stage_names, "contacts")

    def _in_file(self, name: str) -> str:
        """Earlier files have the shear displacement under the name of its magnitude."""
        return "slip" if name == "shear_displacement" and not self._file.has("contacts/shear_displacement") else name

    def __len__(self) -> int:
        return len(self.moments)

    @property
    def time(self) -> np.ndarray:
        """(snapshots,), s."""
        return self.moments.time

    def at(self, when: When = None) -> Contacts:
        """At the snapshot nearest to a time in s; at the end of a stage, or of the run."""
        return self.read(self.moments.index(when))

    def near(self, frame: Frame) -> Contacts | None:
        """At the snapshot nearest to a frame; None where there is none yet."""
        row = self.moments.nearest_to(frame.time, frame.step)
        return self.read(row) if row >= 0 else None

    def read(self, row: int) -> Contacts:
        begin = int(self._end[row - 1]) if row > 0 else 0
        rows = slice(begin, int(self._end[row]))
        columns = {name: self._file.read(f"contacts/{self._in_file(name)}", rows) for name in (*_COLUMNS, "edge_kind", "edge_index")}
        for name in _NEWER:
            has = self._file.has(f"contacts/{name}")
            columns[name] = self._file.read(f"contacts/{name}", rows) if has else np.zeros(len(columns["gap"]))
        columns["slip"] = np.abs(columns["slip"])
        columns["position"] = columns["position"] + self._blocks.origin
        m = self.moments
        return Contacts(float(m.time[row]), m.stage_name(row), int(m.step[row]), _blocks=self._blocks, **columns)
