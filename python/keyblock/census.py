"""Key blocks: which blocks fall or slide into openings by limit equilibrium, before anything moves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._sealed import Sealed
from .steering import read_only
from .tables import data_frame

if TYPE_CHECKING:
    from . import _core

COLUMNS = ["block", "name", "layer", "x", "y", "area", "depth", "weight", "mode", "factor_of_safety", "force", "joints"]


class KeyBlock(Sealed):
    """A block with a face on an opening, or on one that blocks before it have left. Forces are per metre of opening."""

    def __init__(self, core: _core.KeyBlock) -> None:
        self._core = core

    @property
    def block(self) -> int:
        """Number of the block in `scenario.cut()`, and in a run."""
        return self._core.block

    @property
    def name(self) -> str:
        """Of the scenario; empty where it was cut."""
        return self._core.name

    @property
    def layer(self) -> int:
        """From 1 on, in which it moves: blocks of earlier layers have gone. 0: it stays."""
        return self._core.layer

    @property
    def moves(self) -> bool:
        """Its factor of safety is below 1."""
        return self.layer > 0

    @property
    def centroid(self) -> np.ndarray:
        """(2,), m, real coordinates."""
        return read_only(np.array(self._core.centroid))

    @property
    def area(self) -> float:
        """m²"""
        return self._core.area

    @property
    def depth(self) -> float:
        """m, from the wall to the corner that is farthest from it."""
        return self._core.depth

    @property
    def weight(self) -> float:
        """N/m"""
        return self._core.weight

    @property
    def mode(self) -> str:
        """"falls", "slides", "slides between faces", "stable" or "not removable"."""
        return self._core.mode

    @property
    def factor_of_safety(self) -> float:
        """What resists over what drives; infinite where nothing drives the block."""
        return self._core.factor_of_safety

    @property
    def force(self) -> float:
        """N/m against its motion, that it needs for the wanted factor of safety."""
        return self._core.force

    @property
    def direction(self) -> np.ndarray:
        """(2,), unit vector of its motion; zeros where nothing drives it."""
        return read_only(np.array(self._core.direction))

    @property
    def joints(self) -> tuple[str, ...]:
        """Sets and maps along which it slides."""
        return tuple(self._core.joints)

    def __repr__(self) -> str:
        return f"<key block {self.block}: {self.mode}, F = {self.factor_of_safety:.3g}, {self.area:.3g} m2>"


class Census(Sealed, Sequence[KeyBlock]):
    """The key blocks of one realization, as a sequence to be looked at: those that move by layer, then those that stay."""

    def __init__(self, core: _core.Census) -> None:
        self._core = core
        self._blocks = tuple(KeyBlock(block) for block in core.blocks)

    def __len__(self) -> int:
        return len(self._blocks)

    def __getitem__(self, k: Any) -> Any:
        return self._blocks[k]

    def __iter__(self) -> Iterator[KeyBlock]:
        return iter(self._blocks)

    @property
    def moving(self) -> tuple[KeyBlock, ...]:
        """Blocks with a factor of safety below 1, by layer."""
        return tuple(block for block in self if block.moves)

    @property
    def layers(self) -> int:
        """Number of layers that move, one after the other."""
        return self._core.layers

    @property
    def wall(self) -> float:
        """m, length of the wall of all openings."""
        return self._core.wall

    @property
    def wanted_factor(self) -> float:
        """Factor of safety that the forces are for."""
        return self._core.wanted_factor

    @property
    def assumptions(self) -> str:
        """What is supposed, in a sentence."""
        return self._core.assumptions

    @property
    def areas(self) -> np.ndarray:
        """(blocks that move,), m²."""
        return read_only(np.array([block.area for block in self.moving]))

    @property
    def depths(self) -> np.ndarray:
        """(blocks that move,), m."""
        return read_only(np.array([block.depth for block in self.moving]))

    @property
    def area_per_metre(self) -> float:
        """m² of blocks that move, per metre of wall."""
        return float(self.areas.sum()) / self.wall

    def table(self) -> Any:
        """A pandas.DataFrame with a row for each block: lengths in m, areas in m², weights and forces in N/m."""
        rows = [
            {
                **{name: getattr(block, name) for name in COLUMNS if name not in ("x", "y", "joints")},
                "x": block.centroid[0],
                "y": block.centroid[1],
                "joints": " ".join(block.joints),
            }
            for block in self
        ]
        return data_frame(rows, "key blocks", COLUMNS)

    def __repr__(self) -> str:
        return f"<census of {len(self)} blocks at {self.wall:.3g} m of wall, {len(self.moving)} move>"
