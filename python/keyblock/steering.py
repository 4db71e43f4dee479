"""What a controller sees of a running simulation and changes: blocks, springs, strengths of joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _arguments as arguments
from ._compiled import core as _core
from ._sealed import Sealed
from .record import did_you_mean

if TYPE_CHECKING:
    from .simulation import Simulation

STATUS = ["in place", "loosened", "fallen", "excavated"]


def read_only(array: np.ndarray) -> np.ndarray:
    """A copy of something: what is written into it would be lost."""
    array.flags.writeable = False
    return array


@dataclass(frozen=True)
class SimulatedBlock:
    """One block of a running simulation. What moves is as it is now."""

    _simulation: Simulation
    index: int
    name: str  #: empty for blocks that joints have cut
    excavations: list[str]  #: names of those it lies in
    fixed: bool
    area: float  #: m², in reference position
    density: float  #: kg/m³
    young: float  #: Pa
    poisson: float

    @property
    def vertices(self) -> np.ndarray:
        """(n, 2), m, local coordinates: where they are."""
        first = self._simulation.first_vertex
        return self._simulation.vertices[first[self.index] : first[self.index + 1]]

    @property
    def centroid(self) -> np.ndarray:
        """(2,), m, local coordinates: the mass centre."""
        return self._simulation.centroids[self.index]

    @property
    def velocity(self) -> np.ndarray:
        """(2,), m/s, of the mass centre."""
        return self._simulation.block_velocities[self.index]

    @property
    def stress(self) -> np.ndarray:
        """(3,), Pa: mean xx, yy, xy; tension positive."""
        return self._simulation.stress[self.index]

    @property
    def status(self) -> str:
        """In place, loosened, fallen or excavated."""
        return STATUS[self._simulation.status[self.index]]

    @property
    def mass(self) -> float:
        """kg per metre thickness."""
        return self.density * self.area

    def apply_force(self, force: Any, point: Any = None, slot: int = 0) -> None:
        """As Simulation.apply_force."""
        self._simulation.apply_force(self.index, force, point, slot)


class SimulatedBlocks(Sequence[SimulatedBlock]):
    """All blocks of a running simulation: by index or name, or as arrays with one row per block. The frame, if any, is the last one."""

    def __init__(self, simulation: Simulation, facts: list[tuple[Any, ...]]) -> None:
        self._blocks = [SimulatedBlock(simulation, index, *of) for index, of in enumerate(facts)]
        self.names = [block.name for block in self._blocks]
        self.area = read_only(np.array([block.area for block in self._blocks]))  #: (blocks,), m²
        self.density = read_only(np.array([block.density for block in self._blocks]))  #: (blocks,), kg/m³
        self.young = read_only(np.array([block.young for block in self._blocks]))  #: (blocks,), Pa
        self.poisson = read_only(np.array([block.poisson for block in self._blocks]))  #: (blocks,)
        self.fixed = read_only(np.array([block.fixed for block in self._blocks], dtype=bool))  #: (blocks,)

    def __len__(self) -> int:
        return len(self._blocks)

    @overload
    def __getitem__(self, which: int | str) -> SimulatedBlock: ...
    @overload
    def __getitem__(self, which: slice) -> list[SimulatedBlock]: ...
    def __getitem__(self, which: Any) -> Any:
        return self._blocks[which] if isinstance(which, slice) else self._blocks[self.index_of(which)]

    def __iter__(self) -> Iterator[SimulatedBlock]:
        return iter(self._blocks)

    def index_of(self, which: int | str) -> int:
        """Index of a block, by its name or its index, which counts from 0. Throws KeyError and IndexError."""
        if isinstance(which, str):
            if not which or which not in self.names:
                raise KeyError(f"no block {which!r}{did_you_mean(which, sorted({n for n in self.names if n}))}")
            return self.names.index(which)
        which = arguments.whole("block", which)
        if not -len(self) <= which < len(self):
            raise IndexError(f"there are blocks 0 to {len(self) - 1}, and no block {which}")
        return which % len(self)

    def __repr__(self) -> str:
        return f"<{len(self)} blocks>"


class Spring(Sealed):
    """A [[spring]] of a running simulation."""

    def __init__(self, core: _core.Simulation, index: int) -> None:
        self._core, self._index = core, index

    def _get(self) -> tuple[Any, ...]:
        return self._core.springs[self._index]

    name = property(lambda self: self._get()[0], doc="Of the scenario; empty where it has none.")
    ends = property(lambda self: read_only(np.array([self._get()[1], self._get()[2]])), doc="(2, 2), m, local coordinates.")
    length = property(lambda self: self._get()[3], doc="m")
    stiffness = property(
        lambda self: self._get()[4],
        lambda self, value: self._core.set_spring_stiffness(self._index, arguments.number("stiffness", value)),
        doc="N/m per metre thickness; a spring that gets another one keeps its elongation.",
    )
    force = property(
        lambda self: self._get()[5],
        lambda self, value: self._core.set_spring_force(self._index, arguments.number("force", value)),
        doc="N per metre thickness, tension positive; setting it is pretension: the spring is made as long as that takes.",
    )
    yield_force = property(lambda self: self._get()[6], doc="N per metre thickness; inf: it never yields.")
    is_there = property(lambda self: self._get()[7], doc="Installed, and both its blocks are there.")

    def __repr__(self) -> str:
        return f"<spring {self.name or self._index}: {self.force:g} N/m, {self.stiffness:g} N/m per m, {self.length:g} m>"


class Springs(Sequence[Spring]):
    """By place among [[spring]], or by name."""

    def __init__(self, core: _core.Simulation) -> None:
        self._core = core

    @property
    def names(self) -> list[str]:
        return [spring[0] for spring in self._core.springs]

    def __len__(self) -> int:
        return len(self._core.springs)

    def __getitem__(self, which: Any) -> Any:
        names = self.names
        if isinstance(which, slice):
            return [Spring(self._core, k) for k in range(*which.indices(len(names)))]
        if isinstance(which, str):
            if not which or which not in names:
                raise KeyError(f"no spring {which!r}{did_you_mean(which, [n for n in names if n])}")
            which = names.index(which)
        which = arguments.whole("spring", which)
        if not -len(names) <= which < len(names):
            raise IndexError(f"there are {len(names)} springs")
        return Spring(self._core, which % len(names))

    def __repr__(self) -> str:
        return f"<{len(self)} springs>"


class JointStrength(Sealed):
    """Friction (degrees), cohesion and tension (Pa) of joints, to be read and set. Bonds that have broken stay broken."""

    def __init__(self, core: _core.Simulation, joint: str) -> None:
        self._core, self._joint = core, joint

    def _get(self) -> tuple[float, float, float]:
        return self._core.strength(self._joint)

    def _set(self, name: str, value: float) -> None:
        values = list(self._get())
        values[("friction", "cohesion", "tension").index(name)] = arguments.number(name, value)
        self._core.set_strength(self._joint, *values)

    friction = property(lambda self: self._get()[0], lambda self, value: self._set("friction", value))
    cohesion = property(lambda self: self._get()[1], lambda self, value: self._set("cohesion", value))
    tension = property(lambda self: self._get()[2], lambda self, value: self._set("tension", value))

    def __repr__(self) -> str:
        friction, cohesion, tension = self._get()
        return f"<{self._joint}: friction {friction:g}°, cohesion {cohesion:g} Pa, tension {tension:g} Pa>"


class Strengths(Sealed):
    """By the name of a joint set or trace map, "joints" for all others, or "frame"."""

    def __init__(self, core: _core.Simulation) -> None:
        self._core = core

    def __getitem__(self, joint: str) -> JointStrength:
        strength = JointStrength(self._core, arguments.text("joint", joint))
        strength._get()  # an unknown name is refused here
        return strength
