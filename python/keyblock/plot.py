"""Pictures of a section, of the quality that a publication asks for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _optional, colors, fields, record, section
from .frames import When

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from .contacts import Contacts
    from .frames import Frame
    from .results import Result

_MILLIMETRE = 1.0 / 25.4  # inch
_FONT = 8.0  # pt

ARROWS = ["velocity", "displacement"]


def plot(run: Result, time: When = None, color: Any = "displacement", *, ax: Axes | None = None, save: str | Path | None = None,
         width: float = 140.0, dpi: float = 300.0, **options: Any) -> Axes:  # fmt: skip
    """Draws the section at a moment and returns matplotlib's axes.

    time: s, the name of a stage (its end), or None (the last frame).
    color: of the blocks. displacement, velocity, slip, stress, mean, major, minor, shear, sxx, syy, sxy, density, material,
        excavation, status, order, plain; or an array with a number per block.
    ax: where to draw; a new figure by default. save: a file to write, its format by its name (pdf, svg, png).
    width: of a new figure, mm. dpi: of PNG. All other options: see `Options`.
    """
    _optional.need("matplotlib", "a picture")
    picture = Picture(run, run.frames.at(time), Options.of(color, options))
    if ax is None:
        import matplotlib

        with matplotlib.rc_context(style()):
            ax = new_axes(picture.window, width, picture.has_bar, shown=save is None)
            picture.draw(ax)
    else:
        picture.draw(ax)
    if save is not None:
        save_figure(ax.figure, save, dpi)
    return ax


@dataclass
class Options:
    """What is drawn, beside the moment and the colour of the blocks."""

    color: Any = "displacement"
    joints: str | None = None  #: "state", "slip", "opening" or "set"
    forces: bool = False  #: force chains: lines between blocks, as wide as the force
    stress: bool = False  #: crosses of the principal stresses
    arrows: str | None = None  #: "velocity" or "displacement"
    numbers: bool = False  #: names of the blocks, or their numbers
    since: When | int = "reference"  #: displacements count from here: a moment, "start" or "reference" (first excavation)
    exaggeration: float = 1.0  #: factor on displacements since then, as drawn
    window: tuple[float, float, float, float] | None = None  #: left, right, bottom, top, m; the rock by default
    axes: bool = True  #: axes in m; else a scale bar
    legend: bool = True  #: colour bars and legends
    title: str | None = None  #: stage and time by default; "" for none
    label: str | None = None  #: title of the colour bar
    cmap: Any = None  #: colour map, of matplotlib
    vmin: float | None = None  #: ends of the colour scale, in SI units
    vmax: float | None = None
    log: bool | None = None  #: whether the scale is logarithmic

    @staticmethod
    def of(color: Any, options: dict[str, Any]) -> Options:
        """Throws TypeError for an option, ValueError for a word that is not known."""
        known = Options.__dataclass_fields__
        for name in options:
            if name not in known:
                raise TypeError(f"no option {name!r}{record.did_you_mean(name, known)}")
        found = Options(color=color, **options)
        for name, value, words in (("joints", found.joints, section.JOINTS), ("arrows", found.arrows, ARROWS)):
            if value is not None and value not in words:
                raise ValueError(f"{name} = {value!r}; expected {', '.join(map(repr, words))}")
        return found


class Picture:
    """One section in axes, which can be taken on to another moment."""

    def __init__(self, run: Result, frame: Frame, options: Options) -> None:
        self.run = run
        self.options = options
        self.since = self._since_frame(frame)
        self.frame = frame
        self.window = options.window or section.extent(run)
        self.field = self._scaled(fields.block_field(run, frame, options.color, self.since))
        self.joint_scale = section.size_scale(run, options.joints) if options.joints in ("slip", "opening") else None
        self._ax: Any = None
        self._moving: list[Artist] = []
        self._references: dict[str, float] = {}

    def _since_frame(self, frame: Frame) -> int:
        """Index of the frame from which displacements count; −1: the start."""
        since = self.options.since
        if since == "start":
            return -1
        index = self.run.reference if since == "reference" else since if isinstance(since, int) else self.run.frames.at(since).index
        # Before the reference, what has moved since the start is shown.
        return index if frame.index >= index else -1

    def _scaled(self, field: fields.Field) -> fields.Field:
        o = self.options
        field = fields.with_scale(self.run, self.frame, field, o.color, self.since)
        if field.scale:
            low = field.scale.low if o.vmin is None else o.vmin
            high = field.scale.high if o.vmax is None else o.vmax
            logarithmic = field.scale.logarithmic if o.log is None else o.log
            if logarithmic and low <= 0.0:
                low = high / 1e3
            if not low < high:
                raise ValueError(f"found a colour scale from {low:g} to {high:g}; expected vmin below vmax")
            field.scale = fields.Scale(low, high, logarithmic)
        if o.cmap is not None:
            field.color_map = colors.color_map(o.cmap) if isinstance(o.cmap, str) else o.cmap
        if o.label is not None:
            field.title = o.label
        return field

    @property
    def has_bar(self) -> bool:
        return self.options.legend and (self.field.scale is not None or self.joint_scale is not None)

    @property
    def norm(self) -> Any:
        from matplotlib.colors import LogNorm, Normalize

        scale = self.field.scale or fields.Scale(0.0, 1.0)
        return (LogNorm if scale.logarithmic else Normalize)(scale.low, scale.high, clip=False)

    # ── drawing ──

    def draw(self, ax: Axes) -> None:
        """Everything, into axes of which nothing is known but their size."""
        from . import legends

        self._ax = ax
        left, right, bottom, top = self.window
        ax.set_xlim(left, right)
        ax.set_ylim(bottom, top)
        ax.set_aspect("equal", adjustable="box")
        ax.set_facecolor("white")
        section.draw_outlines(ax, self.run)
        self._draw_moment()
        legends.draw_axes(ax, self)
        if self.options.legend:
            legends.draw_bars(ax, self)
            legends.draw_legend(ax, self)

    def move_to(self, frame: Frame) -> None:
        """The same picture of another moment; scales and legends stay."""
        for artist in self._moving:
            artist.remove()
        self.frame = frame
        fresh = fields.block_field(self.run, frame, self.options.color, self.since if frame.index >= self.since else -1)
        self.field.values = fresh.values
        self._draw_moment()

    def _draw_moment(self) -> None:
        ax, o = self._ax, self.options
        look = section.Look.of(self.run, self.frame, self.since, o.exaggeration, self._points_per_metre())
        self.look = look
        contacts = self.run.contacts_of(self.frame) if o.joints in ("state", "slip", "opening") or o.forces else None
        drawn = section.draw_fixed(ax, look)
        drawn += section.draw_blocks(ax, look, self.field, self.norm, faint=o.joints in ("state", "slip", "opening"))
        drawn += self._draw_joints(ax, look, contacts)
        if o.forces and contacts is not None:
            drawn += section.draw_forces(ax, look, contacts, self.reference_force(contacts))
        if o.stress:
            drawn += section.draw_crosses(ax, look, self.reference_stress())
        if o.arrows:
            drawn.append(section.draw_arrows(ax, look, self._vectors(self.frame), self.reference_arrow()))
        if o.numbers:
            drawn += section.draw_numbers(ax, look)
        ax.set_title(self.title(contacts), loc="left")
        self._moving = drawn

    def _draw_joints(self, ax: Axes, look: section.Look, contacts: Contacts | None) -> list[Artist]:
        joints = self.options.joints
        self.used_sets: list[tuple[str, str]] = []
        if joints == "set":
            artists, self.used_sets = section.draw_sets(ax, look)
            return artists
        if joints is None or contacts is None:
            return []
        if joints == "state":
            return section.draw_states(ax, look, contacts)
        assert self.joint_scale is not None
        return section.draw_sizes(ax, look, contacts, joints, self.joint_scale)

    def _points_per_metre(self) -> float:
        box = self._ax.get_window_extent()
        left, right, bottom, top = self.window
        return 72.0 / self._ax.figure.dpi * min(box.width / (right - left), box.height / (top - bottom))

    def title(self, contacts: Contacts | None) -> str:
        if self.options.title is not None:
            return self.options.title
        title = f"{self.frame.stage}, t = {self.frame.time:.2f} s"
        if contacts is not None and abs(contacts.time - self.frame.time) > 5e-3:
            title += f" (contacts of {contacts.time:.2f} s)"
        return title

    # ── lengths of arrows and crosses, widths of chains: those of the whole run, so that pictures can be compared ──

    def _reference(self, name: str, sizes: Any) -> float:
        """A round number near the 95th percentile of sizes at the typical moments of the run."""
        if name not in self._references:
            found = np.concatenate([np.zeros(0), *sizes()])
            found = found[np.isfinite(found) & (found > 0.0)]
            self._references[name] = fields.nice_above(0.7 * float(np.quantile(found, 0.95))) if found.size else 1.0
        return self._references[name]

    def _typical(self, between: bool) -> list[Frame]:
        rows = fields._typical_frames(self.run, -1, "velocity" if between else "")
        return [self.run.frames[k] for k in sorted({*rows, self.frame.index})]

    def reference_force(self, contacts: Contacts) -> float:
        return self._reference("force", lambda: [section.pair_forces(self.look, contacts)[1]])

    def reference_stress(self) -> float:
        moving = ~self.run.blocks.fixed
        return self._reference("stress", lambda: [np.abs(f.principal[0][moving]).ravel() for f in self._typical(False)])

    def reference_arrow(self) -> float:
        moving = ~self.run.blocks.fixed
        between = self.options.arrows == "velocity"
        return self._reference("arrow", lambda: [np.hypot(*self._vectors(f)[moving].T) for f in self._typical(between)])

    def _vectors(self, frame: Frame) -> np.ndarray:
        if self.options.arrows == "velocity":
            return frame.velocity
        return fields.displacement_since(self.run, frame, self.since if frame.index >= self.since else -1)


# ── figures ──


def new_axes(window: tuple[float, float, float, float], width: float, has_bar: bool, *, shown: bool) -> Axes:
    """Axes in a new figure `width` mm wide that leaves no room empty; one of pyplot where it is to be shown."""
    from matplotlib.figure import Figure

    left, right, bottom, top = window
    beside = 32.0 if has_bar else 14.0  # mm, of labels and colour bar
    inner = max(width - beside, 20.0)
    height = min(max(inner * (top - bottom) / (right - left), 0.25 * width), 1.6 * width) + 18.0
    size = (width * _MILLIMETRE, height * _MILLIMETRE)
    if shown:
        import matplotlib.pyplot as pyplot

        return pyplot.subplots(figsize=size, layout="constrained")[1]
    return Figure(figsize=size, layout="constrained").subplots()


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
        raise ValueError(f"{path}: found the ending {path.suffix!r}; expected pdf, svg, png, or another of {', '.join(sorted(known))}")
    with matplotlib.rc_context(style()):
        figure.savefig(path, dpi=dpi, bbox_inches="tight", pad_inches=0.03, metadata={"Creator": "keyblock"} if path.suffix == ".pdf" else None)
