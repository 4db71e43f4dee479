"""Blocks as they are cut, before anything moves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import need
from ._sealed import Sealed
from .steering import read_only

if TYPE_CHECKING:
    from . import _core


class CutBlock(Sealed):
    """One block, to be looked at: other blocks come from another scenario. Lengths in m, real coordinates."""

    def __init__(self, core: _core.Block) -> None:
        self._name, self._area = core.name, core.area
        self._excavations = tuple(core.excavations)
        self._rings = tuple(read_only(np.array(ring)) for ring in core.rings)
        self._edges = tuple(tuple(ring) for ring in core.edges)

    @property
    def name(self) -> str:
        """Of the scenario; empty where it was cut."""
        return self._name

    @property
    def area(self) -> float:
        """m²"""
        return self._area

    @property
    def excavations(self) -> tuple[str, ...]:
        """Those that hold it."""
        return self._excavations

    @property
    def rings(self) -> tuple[np.ndarray, ...]:
        """(n, 2) each: the outer one, then the holes."""
        return self._rings

    @property
    def edges(self) -> tuple[tuple[str, ...], ...]:
        """Of each ring, what each edge is a piece of: it runs from the corner of its number to the next."""
        return self._edges

    @property
    def polygon(self) -> np.ndarray:
        """The outer ring, counter-clockwise: (n, 2)."""
        return self.rings[0]

    @property
    def holes(self) -> tuple[np.ndarray, ...]:
        """Inner rings, clockwise."""
        return self.rings[1:]

    def __repr__(self) -> str:
        return f"<block {self.name!r} of {self.area:.3g} m2, {len(self.polygon)} corners>"


class CutBlocks(Sealed, Sequence[CutBlock]):
    """The blocks of one realization, as a sequence to be looked at."""

    def __init__(self, core: list[_core.Block]) -> None:
        self._blocks = tuple(CutBlock(block) for block in core)

    def __len__(self) -> int:
        return len(self._blocks)

    def __getitem__(self, k: Any) -> Any:
        return self._blocks[k]

    def __setitem__(self, k: Any, block: Any) -> None:
        raise TypeError("blocks that were cut can only be looked at; set blocks of the scenario: scenario.block[0].outer = …")

    def __iter__(self) -> Iterator[CutBlock]:
        return iter(self._blocks)

    @property
    def polygons(self) -> list[np.ndarray]:
        """The outer ring of each block, (n, 2), m."""
        return [block.polygon for block in self]

    @property
    def areas(self) -> np.ndarray:
        """(blocks,), m²."""
        return read_only(np.array([block.area for block in self]))

    @property
    def excavations(self) -> list[str]:
        """Of each block, the first excavation that holds it, or an empty text."""
        return [block.excavations[0] if block.excavations else "" for block in self]

    def to_geodataframe(self) -> Any:
        """A geopandas.GeoDataFrame with columns name, area, excavation and geometry."""
        geopandas = need("geopandas", "maps of blocks")
        shapely = need("shapely.geometry", "maps of blocks")
        return geopandas.GeoDataFrame(
            {
                "name": [block.name for block in self],
                "area": self.areas,
                "excavation": self.excavations,
            },
            geometry=[shapely.Polygon(block.polygon, block.holes) for block in self],
        )

    def plot(self, ax: Any = None, color: str = "excavation") -> Any:
        """Draws the blocks with matplotlib; returns the axes. `color`: "excavation", "area" or any colour."""
        pyplot = need("matplotlib.pyplot", "pictures")
        collections = need("matplotlib.collections", "pictures")
        if ax is None:
            ax = pyplot.subplots(figsize=(6.5, 6.5), layout="constrained")[1]
        patches = collections.PolyCollection(self.polygons, edgecolors="0.35", linewidths=0.4)
        if color == "area":
            patches.set_array(self.areas)
            ax.figure.colorbar(patches, ax=ax, label="area (m²)", shrink=0.8)
        elif color == "excavation":
            patches.set_facecolor(["0.97" if name else "#d9c7a3" for name in self.excavations])
        else:
            patches.set_facecolor(color)
        ax.add_collection(patches)
        ax.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
        ax.autoscale_view()
        return ax
