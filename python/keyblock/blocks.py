"""The blocks in their reference position: outlines, areas, materials, and what the edges are pieces of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, overload

import numpy as np

from . import _optional, record
from ._hdf5 import ResultFile
from .errors import DamagedError
from .rings import Rings

EDGE_KINDS = ["free", "joint set", "trace map", "excavation", "domain"]
JOINT_SET, TRACE_MAP, EXCAVATION, DOMAIN = 1, 2, 3, 4


@dataclass(frozen=True)
class Block:
    """One block in its reference position."""

    index: int
    name: str  #: empty for blocks that joints have cut
    area: float  #: m²
    density: float  #: kg/m³
    young: float  #: Pa; NaN in results of versions that did not keep it
    poisson: float  #: NaN in results of versions that did not keep it
    order: int  #: of the displacement polynomial, at the start
    fixed: bool
    centroid: np.ndarray = field(repr=False)  #: (2,), m
    rings: list[np.ndarray] = field(repr=False)  #: (n, 2), m: outer ring, counter-clockwise; then holes, clockwise
    excavations: list[str] = field(repr=False)  #: names of those it lies in

    @property
    def outline(self) -> np.ndarray:
        """Vertices of the outer ring, (n, 2), m."""
        return self.rings[0]

    @property
    def holes(self) -> list[np.ndarray]:
        return self.rings[1:]


class Blocks(Sequence[Block]):
    """All blocks: by index or name, or as arrays with one row per block. Coordinates are real ones, in m."""

    def __init__(self, file: ResultFile) -> None:
        self._file = file
        what = f"model/record of {file.path}"
        with record.damaged(what):
            self.record: record.Record = record.parse_record(file.texts("model/record")[0], what)
            #: (2,), m: real coordinates less local ones
            self.origin = np.asarray(self.record.origin, dtype=float).reshape(2)
        self.local = file.read("model/vertices")  #: (nv, 2), m: vertices in local coordinates
        self.names = file.texts("model/block_name")
        self.area = file.read("model/block_area")  #: (nb,), m²
        self.density = file.read("model/block_density")  #: (nb,), kg/m³
        self.fixed = file.read("model/block_fixed") != 0  #: (nb,)
        self.order = file.read("model/block_order")  #: (nb,), at the start
        self.centroid = file.read("model/block_centroid") + self.origin  #: (nb, 2), m
        self.edge_kind = file.read("model/edge_kind")  #: (nv,), number in EDGE_KINDS
        self.edge_index = file.read("model/edge_index")  #: (nv,), which of that kind
        #: (nv,), which trace of the joint set or trace map; −1: none, or a result that has not kept it
        self.edge_trace = file.read("model/edge_trace") if file.has("model/edge_trace") else np.full(len(self.edge_kind), -1)
        self.outlines = self._outlines()

    def _outlines(self) -> Rings:
        """The rings of vertices. Throws DamagedError where what was read does not fit together."""
        n, nv = len(self.names), len(self.local)
        columns = (self.area, self.density, self.fixed, self.order, self.centroid)
        try:
            rings = Rings(self._file.read("model/ring_start"), self._file.read("model/block_rings"), nv)
            if any(len(column) != n for column in columns) or rings.blocks != n or not len(self.edge_kind) == len(self.edge_index) == len(self.edge_trace) == nv:
                raise ValueError
        except (ValueError, IndexError):
            raise DamagedError(f"{self._file.path} is damaged: the parts of model do not fit each other") from None
        return rings

    @cached_property
    def vertices(self) -> np.ndarray:
        """Reference positions of all vertices in real coordinates, (nv, 2), m."""
        return self.local + self.origin

    # ── names and materials ──

    @property
    def excavation_outlines(self) -> dict[str, np.ndarray]:
        """By the name of the excavation: (n, 2), m."""
        outlines = self.record.excavation_outlines
        return {name: np.asarray(o).reshape(-1, 2) + self.origin for name, o in zip(self.record.excavation_names, outlines)}

    @cached_property
    def excavation(self) -> np.ndarray:
        """Number of the first excavation that each block lies in, (nb,); −1 for none."""
        start, values = self._file.read("model/block_excavations"), self._file.read("model/excavation")
        return np.array([values[a] if b > a else -1 for a, b in zip(start[:-1], start[1:])], dtype=int)

    def _column(self, name: str) -> np.ndarray:
        """A column that results of earlier versions may not have: NaN there."""
        return self._file.read(name) if self._file.has(name) else np.full(len(self), np.nan)

    @cached_property
    def young(self) -> np.ndarray:
        """Young's modulus, (nb,), Pa."""
        return self._column("model/block_young")

    @cached_property
    def poisson(self) -> np.ndarray:
        """Poisson's ratio, (nb,)."""
        return self._column("model/block_poisson")

    @cached_property
    def _materials(self) -> tuple[np.ndarray, np.ndarray]:
        properties = np.column_stack([self.density, self.young, self.poisson])[~self.fixed]
        table, which = np.unique(np.nan_to_num(properties, nan=-1.0), axis=0, return_inverse=True)
        material = np.full(len(self), -1)
        material[~self.fixed] = which.ravel()
        return np.where(table < 0.0, np.nan, table), material

    @property
    def material(self) -> np.ndarray:
        """Number of the material of each block in `materials`, (nb,); −1 for fixed blocks, which do not deform."""
        return self._materials[1]

    @property
    def materials(self) -> np.ndarray:
        """Density, Young's modulus and Poisson's ratio of each material, (materials, 3): kg/m³, Pa, –."""
        return self._materials[0]

    def edge_names(self, kind: np.ndarray, index: np.ndarray) -> list[str]:
        """Names of joint sets, trace maps and excavations, by the numbers of datasets edge_kind and edge_index; else the kind."""
        of_kind: dict[int, list[str]] = {
            JOINT_SET: self.record.joint_set_names,
            TRACE_MAP: self.record.trace_map_names,
            EXCAVATION: self.record.excavation_names,
        }

        def name(k: int, i: int) -> str:
            names = of_kind.get(k, [])
            return names[i] if 0 <= i < len(names) else EDGE_KINDS[k]

        return [name(int(k), int(i)) for k, i in zip(kind, index)]

    # ── as a sequence ──

    def __len__(self) -> int:
        return len(self.names)

    @overload
    def __getitem__(self, which: int | str) -> Block: ...
    @overload
    def __getitem__(self, which: slice) -> list[Block]: ...
    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            return [self[b] for b in range(*which.indices(len(self)))]
        b = self.index_of(which)
        start, values = self._file.read("model/block_excavations"), self._file.read("model/excavation")
        return Block(
            index=b,
            name=self.names[b],
            area=float(self.area[b]),
            density=float(self.density[b]),
            young=float(self.young[b]),
            poisson=float(self.poisson[b]),
            order=int(self.order[b]),
            fixed=bool(self.fixed[b]),
            centroid=self.centroid[b],
            rings=self.outlines.of(b, self.vertices),
            excavations=[self.record.excavation_names[k] for k in values[start[b] : start[b + 1]]],
        )

    def index_of(self, which: int | str) -> int:
        """Index of a block, by its index or its name. Throws KeyError and IndexError."""
        if isinstance(which, str):
            if which not in self.names:
                raise KeyError(f"no block {which!r}{record.did_you_mean(which, sorted({n for n in self.names if n}))}")
            return self.names.index(which)
        if not -len(self) <= which < len(self):
            raise IndexError(f"there are blocks 0 to {len(self) - 1}, and no block {which}")
        return int(which) % len(self)

    def __iter__(self) -> Iterator[Block]:
        return (self[b] for b in range(len(self)))

    def __repr__(self) -> str:
        return f"<{len(self)} blocks>"

    def table(self) -> Any:
        """One row per block, as pandas.DataFrame."""
        pandas = _optional.need("pandas", "a table of blocks")
        names = self.record.excavation_names
        columns = {
            "name": self.names,
            "area": self.area,
            "density": self.density,
            "young": self.young,
            "poisson": self.poisson,
            "order": self.order,
            "fixed": self.fixed,
            "x": self.centroid[:, 0],
            "y": self.centroid[:, 1],
            "excavation": [names[k] if k >= 0 else "" for k in self.excavation],
        }
        table = pandas.DataFrame(columns, index=pandas.RangeIndex(len(self), name="block"))
        table.attrs["units"] = {"area": "m2", "density": "kg/m3", "young": "Pa", "x": "m", "y": "m"}
        return table
