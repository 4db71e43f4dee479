"""The section in matplotlib's axes: blocks, joints, forces, stresses, arrows, each drawn by a function of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import colors, fields
from .blocks import DOMAIN, JOINT_SET, TRACE_MAP
from .elements import Elements

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from .blocks import Blocks
    from .contacts import Contacts
    from .frames import Frame
    from .results import Result
    from .rings import Rings

JOINTS = ["state", "slip", "opening", "set"]


def outline_paths(rings: Rings, at: np.ndarray, which: np.ndarray) -> list[Any]:
    """A matplotlib path with holes for each of the blocks `which` (indices); `at` (nv, 2) are the positions of all vertices."""
    from matplotlib.path import Path

    begin, end = rings.ranges.T
    size = end - begin + 1  # of a ring with its first vertex again
    stop = np.cumsum(size)
    within = np.arange(int(stop[-1]) if len(stop) else 0) - np.repeat(stop - size, size)
    length = np.repeat(end - begin, size)
    vertex = np.repeat(begin, size) + np.where(within == length, 0, within)
    codes = np.full(len(vertex), Path.LINETO, dtype=Path.code_type)
    codes[within == 0] = Path.MOVETO
    codes[within == length] = Path.CLOSEPOLY
    corners = at[vertex]
    # Rings of a block stand one after the other.
    first_ring = np.searchsorted(rings.ring_block, np.arange(rings.blocks + 1))
    limits = np.concatenate([[0], stop])[first_ring]
    return [Path(corners[limits[b] : limits[b + 1]], codes[limits[b] : limits[b + 1]]) for b in which]


@dataclass
class Look:
    """Where things are drawn at one moment."""

    run: Result
    frame: Frame
    at: np.ndarray  #: (nv, 2), m: positions of the vertices as drawn
    centroid: np.ndarray  #: (nb, 2), m: of the blocks as drawn
    elements: np.ndarray  #: (n, 2, 2), m: ends of the elements as drawn
    block_size: float  #: m: side of a mean block
    points_per_metre: float

    @staticmethod
    def of(run: Result, frame: Frame, since: int, exaggeration: float, points_per_metre: float) -> Look:
        blocks, local, ends = run.blocks, frame.local, frame.elements.local
        if exaggeration != 1.0:
            before = blocks.local if since < 0 else run.frames[since].local
            local = before + exaggeration * (local - before)
            ends_before = Elements(run._file, blocks, None if since < 0 else since).local
            ends = ends_before + exaggeration * (ends - ends_before)
        moving = ~blocks.fixed
        size = float(np.sqrt(blocks.area[moving].mean())) if moving.any() else 1.0
        centroid = blocks.outlines.centroids(local) + blocks.origin
        return Look(run, frame, local + blocks.origin, centroid, ends + blocks.origin, size, points_per_metre)

    @property
    def shown(self) -> np.ndarray:
        """Whether blocks are drawn in colour: they are neither fixed nor excavated, (nb,)."""
        return ~self.run.blocks.fixed & self.frame.is_there

    def edge_width(self) -> float:
        """Of the edges of the blocks, pt: thin where blocks are small."""
        return 0.26 + 0.34 * min(1.0, self.block_size * self.points_per_metre / 18.0)


# ── what is to be seen ──


def extent(run: Result) -> tuple[float, float, float, float]:
    """Left, right, bottom, top: the rock, a margin of the frame, and blocks that lie elsewhere when a stage ends.

    Blocks that have gone so far away that all else would hardly be seen are left out.
    """
    blocks = run.blocks
    has_domain = bool((blocks.edge_kind == DOMAIN).any())
    counts = ~blocks.fixed if has_domain else np.ones(len(blocks), dtype=bool)
    if not counts.any():
        return -1.0, 1.0, -1.0, 1.0
    rock = blocks.local[counts[blocks.outlines.vertex_block]]
    low, high = rock.min(axis=0), rock.max(axis=0)
    margin = 0.03 * float((high - low).max())
    low, high = low - margin, high + margin
    first_low, first_high = low, high
    allowed = 2.0 * float((high - low).max())
    for k in fields.stage_ends(run):
        frame = run.frames[k]
        lows, highs = _boxes(blocks, frame.local)
        for b in np.flatnonzero(~blocks.fixed & frame.is_there):
            both_low, both_high = np.minimum(first_low, lows[b] - margin), np.maximum(first_high, highs[b] + margin)
            if (both_high - both_low).max() <= max(allowed, 30.0 * (highs[b] - lows[b] + 2.0 * margin).max()):
                low, high = np.minimum(low, both_low), np.maximum(high, both_high)
    low, high = low + blocks.origin, high + blocks.origin
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _boxes(blocks: Blocks, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner of each block, (nb, 2)."""
    low, high = np.full((len(blocks), 2), np.inf), np.full((len(blocks), 2), -np.inf)
    np.minimum.at(low, blocks.outlines.vertex_block, local)
    np.maximum.at(high, blocks.outlines.vertex_block, local)
    return low, high


# ── blocks ──


def draw_fixed(ax: Axes, look: Look) -> list[Artist]:
    """Fixed blocks, hatched."""
    from matplotlib.collections import PathCollection

    which = np.flatnonzero(look.run.blocks.fixed & look.frame.is_there)
    paths = outline_paths(look.run.blocks.outlines, look.at, which)
    hatched = PathCollection(paths, facecolors=colors.FIXED, edgecolors=colors.FIXED_HATCH, hatch="////", linewidths=0.0, zorder=1)
    return [ax.add_collection(hatched, autolim=False)]


def draw_blocks(ax: Axes, look: Look, field: fields.Field, norm: Any, faint: bool) -> list[Artist]:
    """Blocks in the colours of a field; edges are fainter where joints are drawn over them."""
    from matplotlib.collections import PathCollection
    from matplotlib.colors import ListedColormap, to_rgba

    which = np.flatnonzero(look.shown)
    values = field.values[which]
    edge = to_rgba(colors.JOINT, 0.35 if faint else 0.75)
    paths = outline_paths(look.run.blocks.outlines, look.at, which)
    drawn = PathCollection(paths, linewidths=look.edge_width(), joinstyle="round", zorder=2)
    if field.classes:
        shades = ListedColormap([color for _, color in field.classes])
        shades.set_under(colors.ROCK)
        drawn.set_facecolors(shades(values.astype(int)))
    else:
        low = field.scale.low if field.scale else 0.0
        drawn.set_facecolors(field.color_map(norm(np.maximum(np.nan_to_num(values, nan=low), low) if norm_is_log(field) else values)))
    drawn.set_edgecolor(edge)
    return [ax.add_collection(drawn, autolim=False)]


def norm_is_log(field: fields.Field) -> bool:
    return field.scale is not None and field.scale.logarithmic


def draw_outlines(ax: Axes, run: Result) -> list[Artist]:
    """Outlines of excavations as they were planned, dashed."""
    from matplotlib.collections import LineCollection

    rings = [np.vstack([o, o[:1]]) for o in run.blocks.excavation_outlines.values() if len(o)]
    lines = LineCollection(rings, colors=colors.OUTLINE, linewidths=1.0, linestyles=[(0, (5, 3))], zorder=4)
    return [ax.add_collection(lines, autolim=False)]


def draw_numbers(ax: Axes, look: Look) -> list[Artist]:
    """The name of each block, or its index, at its centroid."""
    from matplotlib.patheffects import withStroke

    names = look.run.blocks.names
    halo = [withStroke(linewidth=1.2, foreground="white")]
    style = {"ha": "center", "va": "center", "fontsize": 5, "clip_on": True, "zorder": 8, "path_effects": halo}
    return [ax.text(*look.centroid[b], names[b] or str(b), **style) for b in np.flatnonzero(look.shown)]


# ── joints ──


def draw_sets(ax: Axes, look: Look) -> tuple[list[Artist], list[tuple[str, str]]]:
    """Edges of the blocks by joint set and trace map; with the names and colours of those."""
    from matplotlib.collections import LineCollection

    blocks = look.run.blocks
    sets, maps = blocks.record.joint_set_names, blocks.record.trace_map_names
    names = [*sets, *maps]
    shades = [colors.PALETTE[k % len(colors.PALETTE)] for k in range(len(names))]
    place = np.where(blocks.edge_kind == TRACE_MAP, len(sets), 0) + blocks.edge_index
    is_joint = ((blocks.edge_kind == JOINT_SET) | (blocks.edge_kind == TRACE_MAP)) & look.shown[blocks.outlines.vertex_block]
    edges = np.flatnonzero(is_joint)
    segments = np.stack([look.at[edges], look.at[blocks.outlines.next_vertex[edges]]], axis=1)
    lines = LineCollection(segments, colors=[shades[k] for k in place[edges]], linewidths=0.9, capstyle="round", zorder=5)
    used = [(names[k], shades[k]) for k in sorted(set(place[edges].tolist()))]
    return [ax.add_collection(lines, autolim=False)], used


def pieces(look: Look, contacts: Contacts) -> tuple[np.ndarray, np.ndarray]:
    """Stretches of joint to be drawn, (n, 2, 2), and their rows in `contacts`. Those along the edge of the domain are no joints."""
    local = look.run.frames[look.run.frames.moments.nearest_to(contacts.time, contacts.step)].local
    rows = np.flatnonzero((contacts.edge_kind != DOMAIN) & (contacts.length > 0.0))
    return contacts.stretches(local)[rows], rows


def draw_states(ax: Axes, look: Look, contacts: Contacts) -> list[Artist]:
    """Joints by contact state, sliding ones on top."""
    from matplotlib.collections import LineCollection

    segments, rows = pieces(look, contacts)
    artists: list[Artist] = []
    for state in (2, 0, 1):
        color, width = colors.STATE[state]
        of_state = segments[contacts.state[rows] == state]
        lines = LineCollection(of_state, colors=color, linewidths=width, capstyle="round", zorder=5 + 0.1 * width)
        artists.append(ax.add_collection(lines, autolim=False))
    return artists


def draw_sizes(ax: Axes, look: Look, contacts: Contacts, which: str, scale: fields.Scale) -> list[Artist]:
    """Joints that have slipped or opened, the wider and darker the more."""
    from matplotlib.collections import LineCollection

    segments, rows = pieces(look, contacts)
    values = contacts.slip[rows] if which == "slip" else contacts.gap[rows]
    place = np.clip(np.log(np.maximum(values, scale.low) / scale.low) / np.log(scale.high / scale.low), 0.0, 1.0)
    kept = np.flatnonzero(values > scale.low)
    kept = kept[np.argsort(place[kept])]
    shades = colors.color_map("viridis")(place[kept])
    lines = LineCollection(segments[kept], colors=shades, linewidths=0.9 + 2.2 * place[kept], capstyle="round", zorder=5)
    return [ax.add_collection(lines, autolim=False)]


def size_scale(run: Result, which: str) -> fields.Scale:
    """Three decades up to the largest slip or opening that was kept, m."""
    ends = [run.contact_snapshots.near(run.frames[k]) for k in fields.stage_ends(run)]
    values = [c.slip if which == "slip" else c.gap for c in ends if c is not None]
    largest = max((float(v.max(initial=0.0)) for v in values), default=0.0)
    high = fields.nice_above(max(largest, 1e-5))
    return fields.Scale(high / 1e3, high, True)


# ── forces, stresses, arrows ──


def pair_forces(look: Look, contacts: Contacts) -> tuple[np.ndarray, np.ndarray]:
    """Paths of the normal forces between pairs of blocks, centroid – contact – centroid, (n, 3, 2), and their sums, (n,), N/m.

    A force on a fixed block ends where it touches.
    """
    pressed = np.flatnonzero(contacts.normal_force > 0.0)
    a, b, force = contacts.block_a[pressed], contacts.block_b[pressed], contacts.normal_force[pressed]
    pairs, which = np.unique(np.sort(np.column_stack([a, b]), axis=1), axis=0, return_inverse=True)
    which = which.ravel()
    total = np.bincount(which, force, len(pairs))
    middle = np.column_stack([np.bincount(which, force * x, len(pairs)) for x in contacts.position[pressed].T]) / total[:, None]
    ends = look.centroid[pairs]
    ends = np.where(look.run.blocks.fixed[pairs][:, :, None], middle[:, None, :], ends)
    return np.stack([ends[:, 0], middle, ends[:, 1]], axis=1), total


def draw_before(ax: Axes, look: Look) -> list[Artist]:
    """Blocks as they were before anything moved."""
    from matplotlib.collections import PathCollection

    blocks = look.run.blocks
    paths = outline_paths(blocks.outlines, blocks.local + blocks.origin, np.flatnonzero(look.shown))
    drawn = PathCollection(paths, facecolors="none", edgecolors=colors.BEFORE, linewidths=0.4, zorder=3)
    return [ax.add_collection(drawn, autolim=False)]


def eccentricities(contacts: Contacts) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of all pairs of blocks that press on each other: the pairs, (n, 2); where the resultant of the normal forces goes through the
    joint, (n, 2); how far that is from the middle of the joint over half its length, ±1 at its ends; and its size, N/m."""
    pairs, which = np.unique(np.sort(np.column_stack([contacts.block_a, contacts.block_b]), axis=1), axis=0, return_inverse=True)
    which = which.ravel()
    force = np.maximum(contacts.normal_force, 0.0)
    total = np.bincount(which, force, len(pairs))
    pressed = total > 0.0
    middle = np.column_stack([np.bincount(which, force * x, len(pairs)) for x in contacts.position.T]) / np.where(pressed, total, 1.0)[:, None]
    first = np.unique(which, return_index=True)[1]
    along = np.column_stack([-contacts.normal[first, 1], contacts.normal[first, 0]])
    place = np.einsum("ij,ij->i", contacts.position, along[which])
    low, high = np.full(len(pairs), np.inf), np.full(len(pairs), -np.inf)
    np.minimum.at(low, which, place)
    np.maximum.at(high, which, place)
    half = 0.5 * (high - low)
    off = np.einsum("ij,ij->i", middle, along) - 0.5 * (low + high)
    found = np.divide(off, half, out=np.zeros(len(pairs)), where=half > 0.0)
    return pairs[pressed], middle[pressed], found[pressed], total[pressed]


#: A joint whose resultant is so far out turns about one of its ends.
HINGE = 0.9


def draw_thrust(ax: Axes, look: Look, contacts: Contacts, typical: float) -> list[Artist]:
    """The line of thrust, through each block that is pressed by two others, and its hinges."""
    from matplotlib.collections import LineCollection

    pairs, middle, eccentricity, total = eccentricities(contacts)
    of_block: dict[int, list[int]] = {}
    for k, pair in enumerate(pairs.tolist()):
        for b in pair:
            of_block.setdefault(b, []).append(k)
    fixed = look.run.blocks.fixed
    ends = [k for b, k in of_block.items() if not fixed[b] and len(k) == 2 and total[k].max() >= 0.01 * typical]
    lines = LineCollection(middle[np.array(ends, dtype=int).reshape(-1, 2)], colors=colors.THRUST, linewidths=1.4, capstyle="round", zorder=7)
    hinges = middle[(np.abs(eccentricity) > HINGE) & (total >= 0.01 * typical)]
    dots = ax.scatter(*hinges.T, s=22.0, c=colors.THRUST, edgecolors="white", linewidths=0.6, zorder=7.1)
    return [ax.add_collection(lines, autolim=False), dots]


#: Width of the line of a typical force, pt.
FORCE_WIDTH = 2.0


def draw_forces(ax: Axes, look: Look, contacts: Contacts, typical: float) -> list[Artist]:
    """Force chains: lines as wide as the force; those of the size `typical` (N/m) have the width FORCE_WIDTH."""
    from matplotlib.collections import LineCollection

    chains, total = pair_forces(look, contacts)
    kept = total > 0.01 * typical
    widths = np.minimum(FORCE_WIDTH * total[kept] / typical, 2.0 * FORCE_WIDTH)
    lines = LineCollection(chains[kept], colors=colors.FORCE, linewidths=widths, alpha=0.85, capstyle="round", zorder=6)
    return [ax.add_collection(lines, autolim=False)]


def element_shares(look: Look, largest: dict[str, float]) -> np.ndarray:
    """Size of the force of each element over its limit, (n,); without one, over the largest of its kind in the run, N/m."""
    elements = look.frame.elements
    whole = np.where(np.isfinite(elements.limit), elements.limit, [largest.get(kind, 0.0) for kind in elements.kinds])
    return np.clip(np.abs(elements.force) / np.maximum(whole, 1e-30), 0.0, 1.0)


def largest_free_forces(run: Result) -> dict[str, float]:
    """By kind of element: the largest force in the run of those without a limit, N/m."""
    largest: dict[str, float] = {}
    for k in fields.stage_ends(run):
        elements = run.frames[k].elements
        for kind, force, limit in zip(elements.kinds, elements.force, elements.limit):
            if not np.isfinite(limit):
                largest[kind] = max(largest.get(kind, 0.0), abs(float(force)))
    return largest


def draw_elements(ax: Axes, look: Look, largest: dict[str, float]) -> list[Artist]:
    """Springs, supports and other elements that are there: lines, the wider and darker the more of its limit each carries."""
    from matplotlib.collections import LineCollection

    kept = np.flatnonzero(look.frame.elements.present)
    share = element_shares(look, largest)[kept]
    segments, shades = look.elements[kept], colors.color_map("viridis")(share)
    halo = LineCollection(segments, colors="white", linewidths=2.0 + 2.2 * share, capstyle="round", zorder=6.5)
    lines = LineCollection(segments, colors=shades, linewidths=1.0 + 2.2 * share, capstyle="round", zorder=6.6)
    ends = ax.scatter(*segments.reshape(-1, 2).T, s=6.0, c=np.repeat(shades, 2, axis=0), linewidths=0.0, zorder=6.6)
    return [ax.add_collection(halo, autolim=False), ax.add_collection(lines, autolim=False), ends]


#: Length of a bar of a cross, and of an arrow, whose value is the typical one, in sides of a mean block.
CROSS_LENGTH, ARROW_LENGTH = 1.2, 2.0
#: Longer arrows are cut to so many typical ones.
LONGEST_ARROW = 3.0


def draw_crosses(ax: Axes, look: Look, typical: float) -> list[Any]:
    """Principal stresses at the centroids; bars of the stress `typical` (Pa) have the length CROSS_LENGTH."""
    which = np.flatnonzero(look.shown)
    values, angle = look.frame.principal
    at = np.vstack([look.centroid[which]] * 2)
    size = np.concatenate([values[which, 0], values[which, 1]])
    turned = np.concatenate([angle[which], angle[which] + 0.5 * np.pi])
    lines = []
    for color, chosen in ((colors.COMPRESSION, size < 0.0), (colors.TENSION, size > 0.0)):
        length = np.abs(size[chosen]) * CROSS_LENGTH * look.block_size / typical
        u, v = length * np.cos(turned[chosen]), length * np.sin(turned[chosen])
        lines.append(_lines_of(ax, at[chosen], u, v, color, head=False, zorder=7))
    return lines


def draw_arrows(ax: Axes, look: Look, vectors: np.ndarray, typical: float) -> Any:
    """A vector per block at its centroid; those of the size `typical` have the length ARROW_LENGTH."""
    which = np.flatnonzero(look.shown & np.isfinite(vectors).all(axis=1))
    scaled = vectors[which] / typical
    size = np.hypot(*scaled.T)
    scaled *= ARROW_LENGTH * look.block_size * (np.minimum(size, LONGEST_ARROW) / np.maximum(size, 1e-30))[:, None]
    kept = size > 0.125
    u, v = scaled[kept].T
    return _lines_of(ax, look.centroid[which][kept], u, v, colors.ARROW, head=True, zorder=7)


def _lines_of(ax: Axes, at: np.ndarray, u: np.ndarray, v: np.ndarray, color: str, *, head: bool, zorder: float) -> Any:
    """Arrows, or lines without heads that have their middle in `at`; `u`, `v` in m."""
    heads = (4.0, 5.0, 4.5) if head else (0.0, 0.0, 0.0)
    shape: dict[str, Any] = dict(zip(("headwidth", "headlength", "headaxislength"), heads))
    shape |= {"units": "inches", "width": 0.015, "edgecolors": "white", "linewidths": 0.25, "minlength": 0.0}
    pivot = "tail" if head else "middle"
    return ax.quiver(*at.T, u, v, color=color, angles="xy", scale_units="xy", scale=1.0, pivot=pivot, zorder=zorder, **shape)
