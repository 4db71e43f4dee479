"""Writes the drawings of this folder by ezdxf (Debian: python3-ezdxf), and what ezdxf itself makes of their curves.

    /usr/bin/python3 make.py FOLDER
"""
import json
import math
import sys
from pathlib import Path

import ezdxf
from ezdxf import disassemble, path, units

FOLDER = Path(sys.argv[1])


def flattened(entity):
    """Points on the curve itself where ezdxf can; Bezier curves come as near to an arc as 3e-4 of its radius."""
    if hasattr(entity, "flattening"):
        return entity.flattening(0.05)
    return path.make_path(entity).flattening(0.05)


def entities():
    """Every kind of line, blocks within blocks, and what is no line."""
    drawing = ezdxf.new("R2000")
    drawing.units = units.MM
    for layer in ("FACE", "Arcs", "SPLINES", "STONES", "NOTES"):
        drawing.layers.add(layer)
    space = drawing.modelspace()
    space.add_line((0, 0), (3000, 1000), dxfattribs={"layer": "FACE"})
    space.add_lwpolyline([(0, 0, 0), (1000, 0, 0.5), (1000, 1000, -0.2), (0, 1000, 0)], format="xyb", close=True, dxfattribs={"layer": "FACE"})
    space.add_polyline2d([(5000, 0, 1.0), (6000, 0, 0.0), (6500, 500, 0.0)], format="xyb", dxfattribs={"layer": "FACE"})
    space.add_polyline3d([(0, 2000, 5), (500, 2500, 7), (900, 2400, 9)], dxfattribs={"layer": "FACE"})
    space.add_arc((2000, 2000), 500, 300, 40, True, dxfattribs={"layer": "Arcs"})
    space.add_circle((4000, 2000), 400, dxfattribs={"layer": "Arcs"})
    space.add_ellipse((6000, 2000), (600, 300), 0.4, 0.5, 4.0, dxfattribs={"layer": "Arcs"})
    mirrored = space.add_arc((2000, 4000), 300, 10, 100, True, dxfattribs={"layer": "Arcs"})
    mirrored.dxf.extrusion = (0, 0, -1)
    below = space.add_ellipse((8000, 2000), (0, 500), 0.5, 1.0, 3.0, dxfattribs={"layer": "Arcs"})
    below.dxf.extrusion = (0, 0, -1)
    space.add_open_spline([(0, 5000), (500, 5800), (1200, 5200), (1800, 5900), (2500, 5400)], 3, dxfattribs={"layer": "SPLINES"})
    space.add_rational_spline([(3000, 5000), (3500, 5800), (4200, 5200), (4800, 5900)], [1, 2, 3, 1], 3, dxfattribs={"layer": "SPLINES"})
    space.add_spline([(0, 7000), (500, 7500), (900, 7100)], dxfattribs={"layer": "SPLINES"})
    stone = drawing.blocks.new("STONE", base_point=(10, 20))
    stone.add_lwpolyline([(10, 20), (210, 20), (210, 120), (10, 120)], close=True)
    stone.add_arc((110, 70), 30, 0, 90)
    course = drawing.blocks.new("COURSE")
    course.add_blockref("STONE", (0, 0))
    course.add_blockref("STONE", (300, 0), dxfattribs={"rotation": 20, "layer": "FACE"})
    space.add_blockref("COURSE", (1000, 8000), dxfattribs={"layer": "STONES", "xscale": 2, "yscale": -2, "rotation": 30})
    space.add_blockref("STONE", (4000, 8000), dxfattribs={"layer": "STONES", "column_count": 3, "row_count": 2, "column_spacing": 250, "row_spacing": 150})
    space.add_blockref("STONE", (7000, 8000), dxfattribs={"layer": "STONES", "xscale": 3, "yscale": -1.5, "rotation": -40})
    for k in range(3):
        space.add_text(f"note {k}", dxfattribs={"layer": "NOTES"})
    space.add_point((1, 1), dxfattribs={"layer": "FACE"})
    drawing.saveas(FOLDER / "entities.dxf")
    lines = []
    for entity in disassemble.recursive_decompose(space):
        if entity.dxftype() in ("TEXT", "POINT") or (entity.dxftype() == "SPLINE" and not entity.control_points):
            continue
        lines.append({"entity": entity.dxftype(), "layer": entity.dxf.layer, "vertices": [[round(v.x, 6), round(v.y, 6)] for v in flattened(entity)]})
    (FOLDER / "entities.json").write_text(json.dumps({"lines": lines}) + "\n")


def wall():
    """A wall of 300 stones in running bond over a ground, in millimetres."""
    drawing = ezdxf.new("R2000")
    drawing.units = units.MM
    for layer in ("STONES", "GROUND", "TEXT"):
        drawing.layers.add(layer)
    space = drawing.modelspace()
    length, height, courses = 500, 200, 29
    for course in range(courses):
        cuts = [0, *range(250 if course % 2 else 500, 5000, length), 5000]
        for left, right in zip(cuts, cuts[1:]):
            space.add_lwpolyline([(left, course * height), (right, course * height), (right, (course + 1) * height), (left, (course + 1) * height)],
                                 close=True, dxfattribs={"layer": "STONES"})
    space.add_lwpolyline([(-1000, -500), (6000, -500), (6000, 0), (-1000, 0)], close=True, dxfattribs={"layer": "GROUND"})
    space.add_text("wall", dxfattribs={"layer": "TEXT"})
    drawing.saveas(FOLDER / "wall.dxf")


def arch():
    """An arch of 15 voussoirs with round faces on two abutments, in metres: span 4 m, rise 2 m, 0.5 m thick."""
    drawing = ezdxf.new("R2000")
    drawing.units = units.M
    for layer in ("VOUSSOIRS", "ABUTMENTS"):
        drawing.layers.add(layer)
    space = drawing.modelspace()
    inner, outer, count = 2.0, 2.5, 15
    bulge = math.tan(math.pi / count / 4)
    at = lambda r, k: (r * math.cos(math.pi * k / count), r * math.sin(math.pi * k / count))
    for k in range(count):
        space.add_lwpolyline([(*at(outer, k), bulge), (*at(outer, k + 1), 0), (*at(inner, k + 1), -bulge), (*at(inner, k), 0)], format="xyb", close=True,
                             dxfattribs={"layer": "VOUSSOIRS"})
    for side in (-1, 1):
        x = sorted((1.8 * side, 2.7 * side))
        space.add_lwpolyline([(x[0], -0.6), (x[1], -0.6), (x[1], 0), (x[0], 0)], close=True, dxfattribs={"layer": "ABUTMENTS"})
    drawing.saveas(FOLDER / "arch.dxf")


entities()
wall()
arch()
