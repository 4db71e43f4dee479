"""What blocks may be coloured by: values, titles, units, and scales that are the same for all moments of a run."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors, record

if TYPE_CHECKING:
    from .frames import Frame
    from .results import Result


@dataclass(frozen=True)
class Scale:
    """From where to where colours go."""

    low: float
    high: float
    logarithmic: bool = False


@dataclass
class Field:
    """One value per block, and how it is shown: on a scale, or as classes."""

    title: str
    values: np.ndarray  #: (nb,); of classes: numbers in `classes`, −1 for none
    quantity: str = ""  #: "length", "stress", "velocity", "density", or "" for numbers without a unit
    scale: Scale | None = None
    color_map: Any = None
    classes: list[tuple[str, str]] = field(default_factory=list)  #: names and colours


# Factors by which values are divided, and their units, from small to large.
_UNITS = {
    "length": [(1e-6, "µm"), (1e-3, "mm"), (1.0, "m")],
    "stress": [(1.0, "Pa"), (1e3, "kPa"), (1e6, "MPa")],
    "velocity": [(1e-3, "mm/s"), (1.0, "m/s")],
    "density": [(1.0, "kg/m³")],
    "force": [(1.0, "N/m"), (1e3, "kN/m"), (1e6, "MN/m")],
}


def unit_for(quantity: str, size: float) -> tuple[float, str]:
    """The factor and the unit in which a value of this size is written: the largest unit that does not exceed it."""
    units = _UNITS.get(quantity, [(1.0, "")])
    return next((u for u in reversed(units) if size >= u[0] * (1.0 - 1e-9)), units[0])


def nice_above(x: float) -> float:
    """Of 1, 2, 5 times a power of ten: the smallest that is not below x > 0."""
    power = 10.0 ** math.floor(math.log10(x))
    return next((m * power for m in (1.0, 2.0, 5.0) if m * power >= x * (1.0 - 1e-9)), 10.0 * power)


# ── values of the blocks of a frame ──


def reference(run: Result) -> int:
    """Index of the frame from which damage counts: the first excavation, or the start of the run."""
    for stage in run.stages:
        if stage["excavate"]:
            rows = np.flatnonzero(run.frames.stage == stage["index"])
            return int(rows[0]) if rows.size else 0
    return 0


def displacement_since(run: Result, frame: Frame, since: int) -> np.ndarray:
    """Of the centroids since frame `since` (−1: the start), against the base where all fixed blocks move alike, (nb, 2), m.

    Before frame `since` it is zero.
    """
    if frame.index < since:
        return np.zeros((len(run.blocks), 2))
    u = frame.block_displacement
    base = base_motion(run, frame)
    if since >= 0:
        u = u - run.frames[since].block_displacement
        base = base - base_motion(run, run.frames[since])
    return u - base


def base_motion(run: Result, frame: Frame) -> np.ndarray:
    """What all fixed blocks have moved by, (2,), m; zero where they move differently or there are none."""
    fixed = frame.displacement[run.blocks.fixed[run.blocks.outlines.vertex_block]]
    if len(fixed) == 0 or np.ptp(fixed, axis=0).max() > 1e-6:
        return np.zeros(2)
    return fixed[0].astype(float)


def _slip(run: Result, frame: Frame) -> np.ndarray:
    contacts = run.contact_snapshots.near(frame)
    return np.full(len(run.blocks), np.nan) if contacts is None else contacts.slip_of_blocks


_Values = Callable[["Result", "Frame"], np.ndarray]
_STRESS: dict[str, tuple[str, _Values]] = {
    "mean": ("Mean stress", lambda run, f: f.stress[:, :2].mean(axis=1)),
    "major": ("Most compressive principal stress", lambda run, f: f.principal[0][:, 1]),
    "minor": ("Least compressive principal stress", lambda run, f: f.principal[0][:, 0]),
    "shear": ("Largest shear stress", lambda run, f: 0.5 * (f.principal[0][:, 0] - f.principal[0][:, 1])),
    "sxx": ("Stress σxx", lambda run, f: f.stress[:, 0]),
    "syy": ("Stress σyy", lambda run, f: f.stress[:, 1]),
    "sxy": ("Stress σxy", lambda run, f: f.stress[:, 2]),
}
_SIZES: dict[str, tuple[str, str, _Values]] = {
    "velocity": ("Velocity of the blocks", "velocity", lambda run, f: np.hypot(*f.velocity.T)),
    "slip": ("Largest slip of the joints of each block", "length", _slip),
}
_ALIASES = {"stress": "major", "sigma1": "major", "none": "plain", "materials": "material"}

#: What `color` may be.
NAMES = ["displacement", *_SIZES, "stress", *_STRESS, "density", "material", "excavation", "status", "order", "plain"]


def block_field(run: Result, frame: Frame, color: Any, since: int) -> Field:
    """The values of all blocks and how to show them. `color`: one of `NAMES`, or an array with a number per block.

    Throws KeyError for a name that is not known, ValueError for an array of another length.
    """
    if not isinstance(color, str):
        return _own(run, np.asarray(color, dtype=float))
    name = _ALIASES.get(color, color)
    if name in _CLASSES:
        return _CLASSES[name](run, frame)
    if name == "displacement":
        values = np.hypot(*displacement_since(run, frame, since).T)
        return Field("Displacement of the blocks", values, "length", None, colors.color_map("magma"))
    if name in _SIZES:
        title, quantity, values_of = _SIZES[name]
        return Field(title, values_of(run, frame), quantity, None, colors.color_map("magma"))
    if name in _STRESS:
        title, values_of = _STRESS[name]
        # Dark is the most compressed rock; of the shear stress, the largest.
        return Field(title, values_of(run, frame), "stress", None, colors.color_map("mako", name != "shear"))
    if name == "density":
        return Field("Density", run.blocks.density, "density", None, colors.color_map("mako"))
    raise KeyError(f"blocks cannot be coloured by {color!r}{record.did_you_mean(color, NAMES)}")


def _own(run: Result, values: np.ndarray) -> Field:
    if values.shape != (len(run.blocks),):
        raise ValueError(f"found an array of shape {values.shape} as color; expected a number for each of {len(run.blocks)} blocks")
    return Field("", values, "", None, colors.color_map("viridis"))


def _plain(run: Result, frame: Frame) -> Field:
    return Field("", np.zeros(len(run.blocks), dtype=int), classes=[("", colors.ROCK)])


def _status(run: Result, frame: Frame) -> Field:
    names = ["in place", "loosened", "fallen"]
    return Field("Status", frame.status.astype(int), classes=list(zip(names, colors.STATUS)))


def _order(run: Result, frame: Frame) -> Field:
    orders = sorted({int(order) for order in frame.order})
    shades = [colors.ROCK if order == 1 else colors.PALETTE[(order - 2) % len(colors.PALETTE)] for order in orders]
    return Field("Order", np.searchsorted(orders, frame.order), classes=list(zip([f"order {o}" for o in orders], shades)))


def _material(run: Result, frame: Frame) -> Field:
    names = []
    for density, young, poisson in run.blocks.materials:
        elastic = "" if math.isnan(young) else f", E = {young / 1e9:.3g} GPa, ν = {poisson:.3g}"
        names.append(f"ρ = {density:.4g} kg/m³{elastic}")
    shades = [_pale(colors.PALETTE[k % len(colors.PALETTE)]) for k in range(len(names))]
    return Field("Material", run.blocks.material, classes=list(zip(names, shades)))


def _excavation(run: Result, frame: Frame) -> Field:
    names = list(run.blocks.record.excavation_names)
    shades = [_pale(colors.PALETTE[k % len(colors.PALETTE)]) for k in range(len(names))]
    return Field("Excavations", run.blocks.excavation + 1, classes=[("rock that stays", colors.ROCK), *zip(names, shades)])


def _pale(color: str) -> str:
    """Mixed with white, for areas."""
    return "#" + "".join(f"{(int(color[i : i + 2], 16) + 255) // 2:02x}" for i in (1, 3, 5))


_CLASSES: dict[str, Callable[[Result, Frame], Field]] = {
    "plain": _plain,
    "status": _status,
    "order": _order,
    "material": _material,
    "excavation": _excavation,
}

# ── scales ──


def with_scale(run: Result, frame: Frame, shown: Field, color: Any, since: int) -> Field:
    """The field with its scale, by the values at the ends of all stages, so that pictures of a run can be compared."""
    if shown.classes:
        return shown
    if isinstance(color, str):
        rows = typical_frames(run, since, shown.quantity) or [frame.index]
        samples = [block_field(run, run.frames[k], color, since).values[_counted(run, run.frames[k])] for k in rows]
        values = np.concatenate(samples)
    else:
        values = shown.values[_counted(run, frame)]
    values = np.sort(values[np.isfinite(values)])
    if shown.quantity in ("length", "velocity"):
        return replace(shown, scale=_scale_from_zero(values))
    signed = isinstance(color, str) and _ALIASES.get(color, color) != "shear"
    return replace(shown, scale=_scale_of_stress(values, signed) if shown.quantity == "stress" else _scale_between(values))


def typical_frames(run: Result, since: int, quantity: str) -> list[int]:
    """Frames whose values set a scale. At the ends of stages nothing moves any more: velocities need frames in between."""
    ends = stage_ends(run, since)
    return ends if quantity != "velocity" else [*ends, *np.linspace(0, len(run.frames) - 1, 30).astype(int).tolist()]


def _counted(run: Result, frame: Frame) -> np.ndarray:
    return ~run.blocks.fixed & frame.is_there


def stage_ends(run: Result, since: int = -1) -> list[int]:
    """The last frame of each stage, from frame `since` on."""
    stage = run.frames.stage
    ends = [k for k in range(len(stage)) if k + 1 == len(stage) or stage[k + 1] != stage[k]]
    return [k for k in ends if k >= since]


def _percentile(sorted_values: np.ndarray, share: float) -> float:
    return float(sorted_values[round(share * (len(sorted_values) - 1))]) if len(sorted_values) else 0.0


def _scale_from_zero(values: np.ndarray) -> Scale:
    """A few fallen blocks move metres, the rest millimetres: then only a logarithmic scale shows both."""
    values = values[values > 0.0]
    largest = _percentile(values, 1.0)
    if not largest > 0.0:
        return Scale(0.0, 1e-3)
    high = nice_above(largest)
    if largest < 30.0 * _percentile(values, 0.5):
        return Scale(0.0, high)
    decades = min(5, max(2, math.ceil(math.log10(high / _percentile(values, 0.1)))))
    return Scale(high / 10.0**decades, high, True)


def _scale_of_stress(values: np.ndarray, signed: bool) -> Scale:
    """From the 2nd to the 98th percentile, rounded outwards."""
    low, high = _percentile(values, 0.02), _percentile(values, 0.98)
    if not signed:
        return Scale(0.0, nice_above(high) if high > 0.0 else 1.0)
    least = -nice_above(-low) if low < 0.0 else 0.0
    most = nice_above(high) if high > 0.0 and high > -0.02 * least else 0.0
    return Scale(least, most) if least < most else Scale(-1.0, 0.0)


def _scale_between(values: np.ndarray) -> Scale:
    low, high = _percentile(values, 0.0), _percentile(values, 1.0)
    return Scale(low, high) if low < high else Scale(low - 0.5, low + 0.5)
