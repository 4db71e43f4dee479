"""What stands around the section: axes or a scale bar, colour bars, legends and keys."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors, fields, figures, section

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .plot import Picture

_BAR_WIDTH = 0.035  # of the width of the axes


def draw_axes(ax: Axes, picture: Picture) -> None:
    """Axes in metres, or a scale bar in their place."""
    if not picture.options.axes:
        ax.set_axis_off()
        _draw_scale_bar(ax, picture)
        return
    ax.ticklabel_format(useOffset=False, style="plain")
    ax.set_xlabel("x in m")
    ax.set_ylabel("y in m")


def _draw_scale_bar(ax: Axes, picture: Picture) -> None:
    left, right, bottom, top = picture.window
    length = fields.nice_above(0.1 * (right - left))
    x, y = left + 0.02 * (right - left), bottom - 0.03 * max(right - left, top - bottom)
    ax.plot([x, x + length], [y, y], color="black", linewidth=2.0, solid_capstyle="butt", clip_on=False)
    ax.text(x + length + 0.01 * (right - left), y, f"{length:g} m", va="center", ha="left")
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)


def draw_bars(ax: Axes, picture: Picture) -> None:
    """Colour bars beside the axes: of the blocks, of the joints, or one above the other."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm

    bars: list[tuple[str, str, fields.Scale, Any, str]] = []
    field, joint_scale = picture.field, picture.joint_scale
    if field.scale:
        bars.append((field.title, field.quantity, field.scale, field.color_map, _extend(picture)))
    if joint_scale:
        title = "Slip of the joints" if picture.options.joints == "slip" else "Opening of the joints"
        bars.append((title, "length", joint_scale, colors.color_map("viridis"), "neither"))
    share = 1.0 / max(len(bars), 1)
    for k, (title, quantity, scale, shades, extend) in enumerate(bars):
        # On a scale of decades each mark has its own unit.
        factor, unit = (1.0, "") if scale.logarithmic else fields.unit_for(quantity, max(abs(scale.low), abs(scale.high)))
        low, high = scale.low / factor, scale.high / factor
        bottom = 1.0 - (k + 1) * share + (0.04 if len(bars) > 1 else 0.0)
        inset = ax.inset_axes([1.03, bottom, _BAR_WIDTH, share - (0.08 if len(bars) > 1 else 0.0)])
        norm = (LogNorm if scale.logarithmic else _linear())(low, high)
        bar = ax.figure.colorbar(ScalarMappable(norm, shades), cax=inset, extend=extend, extendfrac=0.03)
        if scale.logarithmic:
            decades = 10.0 ** np.arange(np.ceil(np.log10(low) - 1e-9), np.log10(high) + 1e-9)
            bar.set_ticks(sorted({low, *decades, high}) if len(decades) < 3 else decades)
            bar.minorticks_off()
            bar.ax.set_yticklabels([with_unit(tick, quantity) for tick in bar.get_ticks()])
        label = f"{title} in {unit}" if title and unit else title or unit
        bar.set_label(textwrap.fill(label, 24) if len(bars) > 1 else label)
        bar.outline.set_linewidth(0.6)


def _linear() -> Any:
    from matplotlib.colors import Normalize

    return Normalize


def _extend(picture: Picture) -> str:
    """Whether there are values beyond the ends of the bar."""
    scale = picture.field.scale
    values = picture.field.values[picture.look.shown]
    values = values[np.isfinite(values)]
    assert scale is not None
    below = bool((values < scale.low - 1e-9 * abs(scale.low)).any()) and not (scale.logarithmic or scale.low == 0.0)
    above = bool((values > scale.high + 1e-9 * abs(scale.high)).any())
    return "both" if below and above else "min" if below else "max" if above else "neither"


def draw_legend(ax: Axes, picture: Picture) -> None:
    """Classes of blocks and joints, and what widths and lengths stand for, below the axes."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[Any] = []
    options, field = picture.options, picture.field
    for name, color in field.classes:
        if name:
            entries.append(Patch(facecolor=color, edgecolor=colors.JOINT, linewidth=0.4, label=name))
    if options.joints == "state":
        names = ["open joint", "sliding joint", "locked joint"]
        entries += [Line2D([], [], color=c, linewidth=1.4 * w, label=n) for n, (c, w) in zip(names, colors.STATE)]
    entries += [Line2D([], [], color=color, linewidth=1.4, label=name) for name, color in picture.used_sets]
    if options.forces:
        typical = picture.typical("force")
        force = nice(typical)
        label = f"force between blocks: {with_unit(force, 'force')}"
        entries.append(Line2D([], [], color=colors.FORCE, linewidth=section.FORCE_WIDTH * force / typical, label=label))
    if options.elements and len(picture.frame.elements):
        entries += element_entries(picture)
    if options.thrust:
        entries.append(Line2D([], [], color=colors.THRUST, linewidth=1.4, marker="o", markersize=4, label="line of thrust; dots are hinges"))
    if options.outline:
        entries.append(Line2D([], [], color=colors.BEFORE, linewidth=0.6, label="as the blocks were"))
    if options.stress:
        entries.append(Line2D([], [], color=colors.COMPRESSION, linewidth=0.8, label="compression"))
        entries.append(Line2D([], [], color=colors.TENSION, linewidth=0.8, label="tension"))
    if options.arrows:
        longest = section.LONGEST_ARROW * picture.typical("arrow")
        label = f"{options.arrows}, cut at {with_unit(float(f'{longest:.2g}'), _quantity(picture))}"
        entries.append(Line2D([], [], color=colors.ARROW, marker=">", markersize=3, linewidth=0.8, label=label))
    if not entries:
        return
    longest = max(len(entry.get_label()) for entry in entries)
    columns = max(1, min(len(entries), 72 // (longest + 6)))
    figures.legend_below(ax, entries, columns=columns, gap=32.0 if options.axes else 18.0)
    _draw_length_key(ax, picture)


def element_entries(picture: Picture) -> list[Any]:
    """The force of elements over their limit, or over the largest of those without one."""
    from matplotlib.lines import Line2D

    shades = colors.color_map("viridis")
    labels = {1.0: "element at its limit", 0.5: "at half of it"}
    if picture.free_forces:
        largest = ", ".join(f"{kind} {with_unit(float(f'{force:.2g}'), 'force')}" for kind, force in picture.free_forces.items())
        labels[1.0] = f"element at its limit, or {largest}"
    return [Line2D([], [], color=shades(share), linewidth=1.0 + 2.2 * share, label=label) for share, label in labels.items()]


def _quantity(picture: Picture) -> str:
    """Of the arrows."""
    return "velocity" if picture.options.arrows == "velocity" else "length"


def _draw_length_key(ax: Axes, picture: Picture) -> None:
    """Bars of crosses and arrows of a round size, in a corner of the section."""
    from matplotlib.patches import Rectangle

    options, look = picture.options, picture.look
    keys = []
    if options.stress:
        keys.append((picture.typical("stress"), section.CROSS_LENGTH, colors.COMPRESSION, "stress"))
    if options.arrows:
        keys.append((picture.typical("arrow"), section.ARROW_LENGTH, colors.ARROW, _quantity(picture)))
    left, right, bottom, top = picture.window
    for k, (typical, sides, color, quantity) in enumerate(keys):
        value = nice(typical)
        length, text = sides * look.block_size * value / typical, with_unit(value, quantity)
        x, y = right - 0.02 * (right - left) - length, top - (0.03 + 0.05 * k) * (top - bottom)
        label = ax.text(x - 0.01 * (right - left), y, text, ha="right", va="center", color=color, zorder=10)
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0})
        pad = 0.008 * (right - left)
        ax.add_patch(Rectangle((x - pad, y - pad), length + 2 * pad, 2 * pad, facecolor="white", edgecolor="none", alpha=0.85, zorder=9))
        ax.plot([x, x + length], [y, y], color=color, linewidth=1.2, solid_capstyle="butt", zorder=10)
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)


def nice(typical: float) -> float:
    """A round number for a key, between 0.6 and 1.5 times the typical size."""
    return fields.nice_above(0.6 * typical)


def with_unit(value: float, quantity: str) -> str:
    factor, unit = fields.unit_for(quantity, value)
    return f"{value / factor:g} {unit}"
