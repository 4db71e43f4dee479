"""Pictures of a section, of the quality that a publication asks for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors, fields, figures, record, section
from .frames import FALLEN, When

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from .contacts import Contacts
    from .frames import Frame
    from .results import Result

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
    figures.check()
    picture = Picture(run, run.frames.at(time), Options.of(color, options))
    with figures.chart(ax, save, width=width, dpi=dpi) as axes:
        picture.draw(axes)
    return axes


@dataclass
class Options:
    """What is drawn, beside the moment and the colour of the blocks."""

    color: Any = "displacement"
    joints: str | None = None  #: "state", "slip", "opening" or "set"
    elements: bool = True  #: springs, supports and other elements: lines, the wider and darker the more of its limit each carries
    forces: bool = False  #: force chains: lines between blocks, as wide as the force
    stress: bool = False  #: crosses of the principal stresses
    thrust: bool = False  #: the line of thrust of arches and columns, and hinges
    outline: bool = False  #: the blocks as they were, over those as they are
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

    def __init__(self, run: Result, frame: Frame, options: Options, *, film: bool = False) -> None:
        self.run = run
        self.film = film
        self.options = options
        self.since = self._since_frame(frame)
        self.frame = frame
        self.window = options.window or section.extent(run)
        self.field = self._scaled(fields.block_field(run, frame, options.color, self.since))
        self.joint_scale = section.size_scale(run, options.joints) if options.joints in ("slip", "opening") else None
        self.free_forces = section.largest_free_forces(run) if options.elements else {}
        self._ax: Any = None
        self._moving: list[Artist] = []
        self._typical: dict[str, float] = {}

    def _since_frame(self, frame: Frame) -> int:
        """Index of the frame from which displacements count; −1: the start."""
        since = self.options.since
        if since == "start":
            return -1
        index = fields.reference(self.run) if since == "reference" else since if isinstance(since, int) else self.run.frames.at(since).index
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
        self.field.values = fields.block_field(self.run, frame, self.options.color, self.since).values
        self._draw_moment()

    def _draw_moment(self) -> None:
        ax, o = self._ax, self.options
        look = section.Look.of(self.run, self.frame, self.since, o.exaggeration, self._points_per_metre())
        self.look = look
        contacts = self.run.contact_snapshots.near(self.frame) if o.joints in ("state", "slip", "opening") or o.forces or o.thrust else None
        drawn = section.draw_fixed(ax, look)
        drawn += section.draw_blocks(ax, look, self.field, self.norm, faint=o.joints in ("state", "slip", "opening"))
        drawn += self._draw_joints(ax, look, contacts)
        if o.outline:
            drawn += section.draw_before(ax, look)
        if o.forces and contacts is not None:
            drawn += section.draw_forces(ax, look, contacts, self.typical("force"))
        if o.elements and len(self.frame.elements):
            drawn += section.draw_elements(ax, look, self.free_forces)
        if o.stress:
            drawn += section.draw_crosses(ax, look, self.typical("stress"))
        if o.arrows:
            drawn.append(section.draw_arrows(ax, look, self._vectors(self.frame), self.typical("arrow")))
        if o.thrust and contacts is not None:
            drawn += section.draw_thrust(ax, look, contacts, self.typical("force"))
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

    # ── typical sizes, on which lengths of arrows and crosses and widths of chains are based ──

    def typical(self, what: str) -> float:
        """Of what is drawn ("force", "stress" or "arrow"): the 95th percentile in this frame, of a film in the frame that has the most."""
        if what not in self._typical:
            rows = fields.typical_frames(self.run, -1, "velocity" if what == "arrow" else "") if self.film else []
            frames = [self.run.frames[k] for k in sorted({*rows, self.frame.index})]
            found = (self._sizes(what, frame) for frame in frames)
            self._typical[what] = max((float(np.quantile(s, 0.95)) for s in found if s.size), default=1.0)
        return self._typical[what]

    def _sizes(self, what: str, frame: Frame) -> np.ndarray:
        blocks = ~self.run.blocks.fixed & frame.is_there
        if what == "stress":
            sizes = np.abs(frame.principal[0][blocks]).ravel()
        elif what == "arrow":
            sizes = np.hypot(*self._vectors(frame)[blocks & (frame.status != FALLEN)].T)
        else:
            contacts = self.run.contact_snapshots.near(frame)
            sizes = np.zeros(0) if contacts is None else section.pair_forces(self.look, contacts)[1]
        return sizes[np.isfinite(sizes) & (sizes > 0.0)]

    def _vectors(self, frame: Frame) -> np.ndarray:
        if self.options.arrows == "velocity":
            return frame.velocity
        return fields.displacement_since(self.run, frame, self.since)
