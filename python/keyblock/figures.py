"""Figures of the size and quality that a publication asks for, whatever is drawn in them."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

from . import _optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MILLIMETRE = 1.0 / 25.4  # inch
_FONT = 8.0  # pt
_RATIO = 0.62  # height over width of axes that are no section

# Figures that were made here, which are given their shape anew when more is drawn into them; and their widths, mm.
_OWN: WeakKeyDictionary[Any, float] = WeakKeyDictionary()


def check() -> None:
    """Throws MissingPackageError without matplotlib."""
    _optional.need("matplotlib", "a picture")


@contextmanager
def chart(ax: Axes | None, save: str | Path | None, *, width: float = 120.0, dpi: float = 300.0) -> Iterator[Axes]:
    """Axes to draw in: those given, or new ones `width` mm wide. Afterwards the figure is fitted and saved.

    Throws MissingPackageError without matplotlib, ValueError where the format of `save` is not known.
    """
    matplotlib = _optional.need("matplotlib", "a picture")
    own = ax is None or ax.figure in _OWN
    with matplotlib.rc_context(style() if own else {}):
        axes = new_axes(width, shown=save is None) if ax is None else ax
        yield axes
        if own:
            fit(axes, _OWN.setdefault(axes.figure, width))
    if save is not None:
        save_figure(axes.figure, save, dpi)


def new_axes(width: float, *, shown: bool) -> Axes:
    """Axes in a new figure `width` mm wide, which `fit` brings into its final shape; one of pyplot where it is to be shown."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    size = (width * _MILLIMETRE, width * _RATIO * _MILLIMETRE)
    if shown:
        import matplotlib.pyplot as pyplot

        return pyplot.subplots(figsize=size)[1]
    figure = Figure(figsize=size)
    FigureCanvasAgg(figure)
    return figure.subplots()


def fit(ax: Axes, width: float) -> None:
    """Gives a figure of one picture the height it needs, and the axes all room that labels, bars and legends leave."""
    figure: Any = ax.figure
    left, right, bottom, top = ax.get_xlim() + ax.get_ylim()
    ratio = (top - bottom) / (right - left) if ax.get_aspect() != "auto" else _RATIO
    for _ in range(2):  # a legend is wider than the axes may be: then margins change once
        ax.apply_aspect()
        around = figure.get_tightbbox()
        box = ax.get_window_extent().transformed(figure.dpi_scale_trans.inverted())
        margins = [box.x0 - around.x0, around.x1 - box.x1, box.y0 - around.y0, around.y1 - box.y1]
        before, after, below, above = (max(m, 0.0) + _MILLIMETRE for m in margins)
        across = max(width * _MILLIMETRE - before - after, 0.2 * width * _MILLIMETRE)
        high = across * ratio
        total = before + across + after, below + high + above
        figure.set_size_inches(*total)
        ax.set_position((before / total[0], below / total[1], across / total[0], high / total[1]))


def style() -> dict[str, Any]:
    """Settings of matplotlib for new figures."""
    return {
        "font.size": _FONT,
        "axes.titlesize": _FONT,
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "hatch.linewidth": 0.5,
        "pdf.fonttype": 42,
        "ps.fonttype": 42,
    }


def save_figure(figure: Any, path: str | Path, dpi: float = 300.0) -> None:
    """Writes a figure; fonts stay text in PDF. Throws ValueError for a format that matplotlib cannot write."""
    import matplotlib

    path = Path(path)
    known = figure.canvas.get_supported_filetypes()
    if path.suffix[1:].lower() not in known:
        others = ", ".join(sorted(known))
        raise ValueError(f"{path}: found the ending {path.suffix!r}; expected pdf, svg, png, or another of {others}")
    with matplotlib.rc_context(style()):
        figure.savefig(path, dpi=dpi, bbox_inches="tight", pad_inches=0.03)


def legend_below(ax: Axes, handles: list[Any] | None = None, *, columns: int = 1, gap: float = 32.0) -> None:
    """A legend `gap` pt below the axes, however high they are."""
    from matplotlib.transforms import ScaledTranslation

    below = ax.transAxes + ScaledTranslation(0.0, -gap / 72.0, ax.figure.dpi_scale_trans)
    where = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0), "bbox_transform": below, "borderaxespad": 0.0}
    if handles is None:
        handles = ax.get_legend_handles_labels()[0]
    labels = [textwrap.fill(handle.get_label(), 64) for handle in handles]
    ax.legend(handles, labels, ncol=columns, frameon=False, **where)


_SUFFIXES = {"_m2": "m²", "_n_m": "N/m", "_pa": "Pa", "_m_s2": "m/s²", "_m_s": "m/s", "_deg": "°", "_m": "m"}


def measure_label(name: str) -> str:
    """What a measure is called beside an axis: "fallen_area_m2" is "fallen area in m²"."""
    for suffix, unit in _SUFFIXES.items():
        if name.endswith(suffix):
            return f"{name[: -len(suffix)].replace('_', ' ')} in {unit}"
    return name.replace("_", " ")
