"""Maps of a study: in what share of the realizations the rock of each cell falls."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors, figures, record

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes


@dataclass(frozen=True)
class FrequencyMap:
    """A raster of square cells; row 0 is the lowest. Shares are NaN where the rock is excavated in all realizations."""

    values: dict[str, Any]  #: of the axes
    n: int  #: realizations
    corner: tuple[float, float]  #: lower left, m
    cell: float  #: m
    fallen: np.ndarray = field(repr=False)  #: (rows, columns), 0 to 1
    fallen_or_loosened: np.ndarray = field(repr=False)  #: (rows, columns), 0 to 1
    outlines: list[np.ndarray] = field(repr=False)  #: of the excavations, (n, 2), m

    @staticmethod
    def of(found: record.Record, grid: record.Record, outlines: list[Any], values: dict[str, Any]) -> FrequencyMap:
        shape = grid["rows"], grid["columns"]

        def share(counts: list[int]) -> np.ndarray:
            cells = np.asarray(counts, dtype=float).reshape(shape)
            return np.where(cells < 0.0, np.nan, cells / max(found["n"], 1))

        return FrequencyMap(
            values=values,
            n=found["n"],
            corner=(float(grid["corner"][0]), float(grid["corner"][1])),
            cell=float(grid["cell_m"]),
            fallen=share(found["fallen"]),
            fallen_or_loosened=share(found["fallen_or_loosened"]),
            outlines=[np.asarray(outline, dtype=float).reshape(-1, 2) for outline in outlines],
        )

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top, m."""
        rows, columns = self.fallen.shape
        x, y = self.corner
        return x, x + columns * self.cell, y, y + rows * self.cell

    @property
    def fallen_area(self) -> float:
        """Area that falls in the mean over the realizations, m²."""
        return float(np.nansum(self.fallen)) * self.cell**2

    def plot(self, ax: Axes | None = None, *, loosened: bool = False, save: str | Path | None = None) -> Axes:
        """Shares in per cent, with the outlines of the openings. `loosened`: of what has fallen or loosened."""
        with figures.chart(ax, save) as axes:
            self._draw(axes, loosened)
        return axes

    def _draw(self, ax: Axes, loosened: bool) -> None:
        shares = self.fallen_or_loosened if loosened else self.fallen
        shades = colors.color_map("magma").copy()
        shades.set_bad("white")
        image = ax.imshow(100.0 * shares, origin="lower", extent=self.extent, cmap=shades, vmin=0.0, vmax=100.0, interpolation="nearest")
        for outline in self.outlines:
            ax.plot(*np.vstack([outline, outline[:1]]).T, color=colors.OUTLINE, linewidth=1.0, linestyle=(0, (5, 3)))
        ax.set_xlim(self.extent[:2])
        ax.set_ylim(self.extent[2:])
        ax.ticklabel_format(useOffset=False, style="plain")
        ax.set_xlabel("x in m")
        ax.set_ylabel("y in m")
        ax.set_title(", ".join(f"{key} = {value}" for key, value in self.values.items()), loc="left")
        bar = ax.figure.colorbar(image, cax=ax.inset_axes([1.03, 0.0, 0.035, 1.0]))
        bar.set_label(f"{'Fallen or loosened' if loosened else 'Fallen'} in % of {self.n} realizations")
