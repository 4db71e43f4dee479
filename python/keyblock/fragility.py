"""Fragility curves of a study: the probability that damage exceeds a level, over the intensity of the shaking."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _optional, colors, figures, record

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Estimate:
    """A value and its confidence interval; NaN where it is not known."""

    value: float
    low: float
    high: float

    @staticmethod
    def of(found: record.Record) -> Estimate:
        return Estimate(*(math.nan if found[name] is None else float(found[name]) for name in ("value", "low", "high")))

    def __repr__(self) -> str:
        return f"{self.value:.4g} ({self.low:.4g} to {self.high:.4g})"


@dataclass(frozen=True)
class Fragility:
    """One curve, P(x) = Φ(ln(x/θ)/β), or the points alone where there is none to fit."""

    level: str
    measure: str
    threshold: float  #: in the unit of the measure
    intensity: str  #: name: pga_m_s2, pgv_m_s or arias_m_s
    intensity_title: str
    unit: str  #: of the intensity
    values: dict[str, str]  #: of the axes that are not of shaking
    status: str  #: "fitted", or why there is no curve, as a word
    why: str  #: in words; empty where there is a curve
    theta: Estimate  #: the median, in the unit of the intensity
    beta: Estimate  #: the logarithmic standard deviation
    realizations: int
    records: int  #: ground motions; with one of them intervals are for this record only
    which_records: str  #: of which records the intervals tell; empty without a curve
    sigma: dict[str, Estimate]  #: what of β is of the `rock`, of the `record` and of the `rest`; NaN where it is not known
    not_monotone: int  #: pairs of rock mass and record that exceed the level at an intensity and not at a stronger one
    points: dict[str, np.ndarray] = field(repr=False)  #: intensity, n, exceeded, realizations, probability, low, high
    curve: dict[str, np.ndarray] = field(repr=False)  #: intensity, probability, low, high; empty without a curve

    @staticmethod
    def of(found: record.Record, level: record.Record, intensity: record.Record, axes: list[str]) -> Fragility:
        return Fragility(
            level=level["name"],
            measure=level["measure"],
            threshold=float(level["threshold"]),
            intensity=intensity["name"],
            intensity_title=intensity["title"],
            unit=intensity["unit"],
            values={key: value for key, value in zip(axes, found["values"]) if value is not None},
            status=found["status"],
            why=found["why"] or "",
            theta=Estimate.of(found["theta"]),
            beta=Estimate.of(found["beta"]),
            realizations=found["realizations"],
            records=found["records"],
            which_records=found["which_records"] or "",
            sigma={name: Estimate.of(part) for name, part in found["sigma"].items()},
            not_monotone=found["not_monotone"],
            points={name: np.asarray(column, dtype=float) for name, column in found["points"].items()},
            curve={name: np.asarray(column, dtype=float) for name, column in found["curve"].items()},
        )

    @property
    def is_fitted(self) -> bool:
        return self.status == "fitted"

    def probability(self, intensity: float) -> float:
        """P at an intensity, in its unit. Throws ValueError where there is no curve, with the reason."""
        if not self.is_fitted:
            raise ValueError(f"there is no fragility curve of level {self.level!r} over {self.intensity}: {self.why}")
        if intensity <= 0.0:
            return 0.0
        return 0.5 * math.erfc(-math.log(intensity / self.theta.value) / self.beta.value / math.sqrt(2.0))

    def table(self) -> Any:
        """The points, as pandas.DataFrame."""
        return _optional.need("pandas", "a table of points").DataFrame(self.points)

    @property
    def label(self) -> str:
        return ", ".join(f"{key} = {value}" for key, value in self.values.items()) or f"level {self.level}"

    def plot(self, ax: Axes | None = None, *, color: str | None = None, save: str | Path | None = None) -> Axes:
        """Curve with its band, and points with their intervals. Several curves go into the same axes."""
        with figures.chart(ax, save) as axes:
            self._draw(axes, color)
        return axes

    def _draw(self, ax: Axes, color: str | None) -> None:
        shade = color or colors.PALETTE[len(ax.containers) % len(colors.PALETTE)]
        p, c = self.points, self.curve
        bars = np.abs(np.vstack([p["probability"] - p["low"], p["high"] - p["probability"]]))
        ax.errorbar(p["intensity"], p["probability"], bars, fmt="o", color=shade, markersize=3, linewidth=0.8, capsize=1.5, zorder=3)
        if c["intensity"].size:
            ax.fill_between(c["intensity"], c["low"], c["high"], color=shade, alpha=0.15, linewidth=0)
            text = f"{self.label}: θ = {self.theta.value:.3g} {self.unit}, β = {self.beta.value:.2g}"
            ax.plot(c["intensity"], c["probability"], color=shade, linewidth=1.2, label=text)
        else:
            ax.plot([], [], color=shade, marker="o", markersize=3, linewidth=0, label=f"{self.label}: no curve, as {self.why}")
        ax.set_xlabel(f"{self.intensity_title} in {self.unit}")
        ax.set_ylabel(f"P(more than level {self.level})")
        ax.set_ylim(-0.02, 1.02)
        ax.set_xlim(left=0.0)
        figures.legend_below(ax)
