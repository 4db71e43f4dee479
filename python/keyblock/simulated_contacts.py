"""Contacts of a running simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arguments as arguments
from ._sealed import Sealed
from .record import did_you_mean
from .steering import read_only

if TYPE_CHECKING:
    from . import _core

class _Column(property):
    """A column of contacts, by its name in the program."""

    def __init__(self, name: str, doc: str) -> None:
        super().__init__(lambda contacts: contacts._get(name), doc=doc)
        self.name = name


class Contacts(Sealed):
    """Contacts after a step: an element each in every column. Forces in N per metre thickness, lengths in m. Columns are copies, made when they
    are asked for; they stay as they were at that step.

        slipped = sim.contacts.of("J1")
        slipped[slipped.slip > 5e-3].set_strength(friction=10.0)
    """

    def __init__(self, core: _core.Simulation, joint_names: Sequence[str], of: Contacts | None = None, chosen: np.ndarray | None = None) -> None:
        """Of all contacts, or of those `chosen` of other ones."""
        self._core, self._of, self._chosen = core, of, chosen
        self._step, self._names = core.step, tuple(joint_names)
        self._size = core.contact_count if chosen is None else len(chosen)
        self._columns: dict[str, np.ndarray] = {}

    def _get(self, name: str) -> np.ndarray:
        if name not in self._columns:
            self._fetch([name])
        return self._columns[name]

    def _fetch(self, names: list[str]) -> None:
        of_all = self._core.contact_columns(names) if self._of is None else [self._of._get(name)[self._chosen] for name in names]
        for name, column in zip(names, of_all):
            self._columns[name] = read_only(column)

    def _complete(self) -> None:
        """Before the simulation goes on: what was not asked for yet."""
        self._fetch([column.name for column in vars(Contacts).values() if isinstance(column, _Column) and column.name not in self._columns])

    block_a = _Column("block_a", "The block with the vertex.")
    block_b = _Column("block_b", "The block with the edge.")
    vertex = _Column("vertex", "Into `sim.vertices`. Vertex and edge together say which contact it is, for as long as the run lasts.")
    edge = _Column("edge", "By the vertex where it begins, likewise.")
    state = _Column("state", "0 open, 1 sliding, 2 locked")
    position = _Column("position", "(n, 2)")
    normal = _Column("normal", "(n, 2), unit vectors out of block_b")
    length = _Column("length", "Of joint that belongs to it.")
    gap = _Column("gap", "Negative where the contact is pressed.")
    slip = _Column("slip", "Since the excavation: the magnitude.")
    shear_displacement = _Column("shear_displacement", "The same with its sign: of block_a along (−normal y, normal x).")
    normal_force = _Column("normal_force", "Compression positive.")
    shear_force = _Column("shear_force", "Against (−normal y, normal x) on block_a.")
    friction = _Column("friction", "Degrees, as it acted in the step.")
    cohesion = _Column("cohesion", "Pa, likewise; 0 where there is no bond, or none any more.")
    tension = _Column("tension", "Pa, likewise.")
    joint_code = _Column("joint_code", "Place in `joint_names`.")

    @property
    def joint_names(self) -> list[str]:
        """Of joint sets, trace maps and excavations; "domain"; "" for edges of blocks of the scenario."""
        return list(self._names)

    @property
    def joint(self) -> np.ndarray:
        """What each contact's edge is a piece of, by name."""
        return read_only(np.array(self._names, dtype=object)[self.joint_code])

    def __len__(self) -> int:
        return self._size

    def of(self, joint: str) -> Contacts:
        """Those of one joint set, trace map or excavation."""
        if arguments.text("joint", joint) not in self._names:
            raise KeyError(f"no joint set {joint!r}{did_you_mean(joint, [name for name in self._names if name])}")
        return self[np.array([name == joint for name in self._names])[self.joint_code]]

    def __getitem__(self, which: Any) -> Contacts:
        """Those of a mask, of places, or of a slice: `contacts[contacts.slip > 5e-3]`."""
        if isinstance(which, str):
            raise TypeError(f"columns are attributes: contacts.{which}")
        is_mask = isinstance(which, np.ndarray) and which.dtype == bool and which.shape == (self._size,)
        places = np.flatnonzero(which) if is_mask else np.arange(self._size)[which]
        if places.ndim != 1:
            raise TypeError("contacts are chosen by a mask, by an array of places, or by a slice")
        return Contacts(self._core, self._names, self, places)

    def __iter__(self) -> Any:
        raise TypeError("contacts have columns, such as contacts.slip; a single one has no object of its own")

    def set_strength(self, *unnamed: Any, friction: Any = None, cohesion: Any = None, tension: Any = None) -> None:
        """Gives each of these contacts a strength of its own, in the place of that of its joint, from the next step on: degrees and Pa, a number for
        all or one for each. What is not given stays as it is. Cohesion and tension act where a bond still holds. It stays with the vertex and the
        edge of the contact, also while they do not touch, and is in checkpoints."""
        if unnamed:
            raise TypeError(f"set_strength() takes named values only: set_strength(friction={unnamed[0]!r}), in degrees, or cohesion, or tension, in Pa")
        if friction is None and cohesion is None and tension is None:
            raise TypeError("set_strength() needs friction, cohesion or tension")
        values = [None if value is None else self._of_each(name, value) for name, value in (("friction", friction), ("cohesion", cohesion), ("tension", tension))]
        self._core.set_contact_strengths(self.vertex, self.edge, *values)

    def reset_strength(self) -> None:
        """These contacts have the strength of their joints again."""
        self._core.forget_contact_strengths(self.vertex, self.edge)

    def _of_each(self, name: str, value: Any) -> np.ndarray:
        values = arguments.array(name, value)
        if values.shape not in ((), (self._size,)):
            raise ValueError(f"{name}: found an array of shape {values.shape}; expected a number, or one for each of {self._size} contacts")
        return np.ascontiguousarray(np.broadcast_to(values, (self._size,)))

    def __repr__(self) -> str:
        return f"<{self._size} contacts after step {self._step}>"
