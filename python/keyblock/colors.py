"""Colours of pictures, the same as those of the report: maps whose lightness grows evenly, and a palette for classes."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

# Anchors of the maps, from light (little) to dark (much).
_MAGMA = "f4efdf fecf92 fe9f6d f7705c de4968 b73779 8c2981 641a80 3b0f70 150e38"
_MAKO = "def5e5 8bdab2 40b7ad 348fa7 37659e 413d7b 2e1e3b"
_VIRIDIS = "7ad151 44bf70 22a884 21918c 2a788e 355f8d 414487 482475 440154"

_MAPS = {"magma": _MAGMA, "mako": _MAKO, "viridis": _VIRIDIS}

#: For classes, told apart with defective colour vision, too (Okabe & Ito 2008).
PALETTE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A5C00", "#B8A900"]

ROCK = "#e4e1d8"
JOINT = "#33373b"
FIXED = "#d3d5d7"
FIXED_HATCH = "#b0b4b8"
OUTLINE = "#c2185b"
COMPRESSION = "#0b3c8c"
TENSION = "#d55e00"
FORCE = "#1d1f22"
ARROW = "#a0187a"
THRUST = "#c2185b"
BEFORE = "#0072b2"

STATUS = [ROCK, "#e69f00", "#d55e00"]
#: Colour and line width (pt) by contact state: open, sliding, locked.
STATE = [("#56b4e9", 1.1), ("#d55e00", 1.9), (JOINT, 0.9)]


@lru_cache(maxsize=None)
def color_map(name: str, reversed_: bool = False) -> Colormap:
    """A map of this module by its name, else one of matplotlib."""
    import matplotlib
    from matplotlib.colors import LinearSegmentedColormap

    if name not in _MAPS:
        return matplotlib.colormaps[name]
    anchors = [f"#{anchor}" for anchor in _MAPS[name].split()]
    return LinearSegmentedColormap.from_list(f"keyblock_{name}", anchors[::-1] if reversed_ else anchors, N=256)
