"""Key blocks without a run: the block of a few joints at an opening, by the areas of polygons and the balance of forces."""

import math

from case_text import FILES, G, NOTE, case, number, point, quantity

DENSITY = 2600.0


def line(*points):
    return "[" + ", ".join(point(p) for p in points) + "]"


def ring_area(ring):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1]))


def sliding_factor(area, dip, friction, cohesion=0.0, length=0.0, k_h=0.0):
    """Of a block on a plane that dips out of a wall, with the inertia force k_h of its weight out of the wall."""
    weight = DENSITY * G * area
    normal = weight * (math.cos(dip) - k_h * math.sin(dip))
    driving = weight * (math.sin(dip) + k_h * math.cos(dip))
    return (normal * math.tan(friction) + cohesion * length) / driving, driving, normal * math.tan(friction) + cohesion * length


def rock(name, title, excavation, friction, stages=""):
    FILES[f"scenarios/{name}.toml"] = (
        NOTE
        + f"""title = "{title}"

[domain]
x = [-10.0, 10.0]
y = [-10.0, 10.0]

[rock]
density = {DENSITY}
young = 1.0e10
poisson = 0.25

[joints]
friction = {friction}
cohesion = 0.0

[[trace_map]]
name = "joints"
lines = [{line((-2.0, 0.0), (0.0, 1.0))}]

[[excavation]]
name = "opening"
shape = "polygon"
outer = {line(*excavation)}
{stages}"""
    )


def blocks_between_joints():
    """Roof blocks, by their joints: label, lines, areas, mode, factor."""
    steep = math.tan(math.radians(60))
    apex = (0.0, 2 * steep)
    a, b = math.tan(math.radians(70)), math.tan(math.radians(40))
    height = 3 / (1 / a + 1 / b)
    skew = (-1.5 + height / a, height)
    lean = 1 / steep
    return [
        ("joints of 60° and 60°, span 4", [[(-2.0, 0.0), apex], [(2.0, 0.0), apex]], ring_area([(-2.0, 0.0), (2.0, 0.0), apex]), "falls", 0.0),
        ("70° and 40°, span 3", [[(-1.5, 0.0), skew], [(1.5, 0.0), skew]], ring_area([(-1.5, 0.0), (1.5, 0.0), skew]), "falls", 0.0),
        ("narrower above", [[(-1.5, 0.0), (-1.0, 1.0), (1.0, 1.0), (1.5, 0.0)]], 2.5, "falls", 0.0),
        ("narrower below", [[(-1.0, 0.0), (-1.5, 1.0), (1.5, 1.0), (1.0, 0.0)]], 2.5, "not removable", None),
        ("between parallel joints of 60°", [[(-1.0, 0.0), (-1.0 + lean, 1.0), (1.0 + lean, 1.0), (1.0, 0.0)]], 2.0, "slides between faces", math.tan(math.radians(30)) / steep),
    ]


def roof_runs():
    text = ""
    for label, lines, area, mode, factor in blocks_between_joints():
        text += f'\n[[run]]\nname = "{label}"\nscenario = "scenarios/roof_blocks.toml"\ncommand = "census"\nset = ["trace_map.joints.lines=[{", ".join(line(*each) for each in lines)}]"]\n'
        text += quantity(f"blocks that are: {mode}", f"summary('totals.modes.{mode}')", expected=1 if mode != "not removable" else 2, tolerance=0)
        if factor is None:
            text += quantity("blocks that move", "summary('totals.moving_blocks')", expected=0, absolute_tolerance=0)
            continue
        text += quantity("area", "summary('blocks.0.area_m2')", "m²", expected=number(area), tolerance=1e-6)
        text += quantity("factor of safety", "summary('blocks.0.factor_of_safety')", expected=number(factor), absolute_tolerance=1e-6)
        text += quantity("blocks that move", "summary('totals.moving_blocks')", expected=1, tolerance=0)
    return text


def wall_runs():
    dip, back = math.radians(40), math.radians(80)
    depth = 3 / (math.tan(back) + math.tan(dip))
    inner = (-depth, depth * math.tan(dip))
    area, length = 1.5 * depth, depth / math.cos(dip)
    text = '\n[[run]]\nname = "on a plane of 40° out of a wall"\nscenario = "scenarios/wall_wedge.toml"\ncommand = "census"\n'
    text += f'set = ["trace_map.joints.lines=[{line((0.0, 0.0), inner)}, {line((0.0, 3.0), inner)}]"]\n'
    text += '[run.points]\nkeys = ["joints.cohesion", "stage.excavated.k_h"]\nlabels = ["φ 30°", "c 5 kPa", "c 5 kPa, k_h 0.2"]\nvalues = [[0.0, 0.0], [5.0e3, 0.0], [5.0e3, 0.2]]\n'
    cases = [sliding_factor(area, dip, math.radians(30), c, length, k_h) for c, k_h in ((0.0, 0.0), (5e3, 0.0), (5e3, 0.2))]
    each = lambda values: "[" + ", ".join(number(v) for v in values) + "]"
    text += quantity("area", "summary('blocks.0.area_m2')", "m²", expected=number(area), tolerance=1e-6)
    text += quantity("factor of safety", "summary('blocks.0.factor_of_safety')", expected_by_point=each(f for f, _, _ in cases), tolerance=1e-6)
    text += quantity("force for a factor of 1.5", "summary('blocks.0.force_n_m')", "N/m", expected_by_point=each(t - r / 1.5 for _, t, r in cases), tolerance=1e-6)
    text += quantity("depth", "summary('blocks.0.depth_m')", "m", expected=number(depth), tolerance=1e-6)
    return text


def successive_run():
    """A column of three blocks over an opening: each is free when the one below it has gone."""
    column = [[(-1.0, 0.0), (-1.0, 3.0), (1.0, 3.0), (1.0, 0.0)], [(-1.0, 1.0), (1.0, 1.0)], [(-1.0, 2.0), (1.0, 2.0)]]
    text = f'\n[[run]]\nname = "three blocks, one above the other"\nscenario = "scenarios/roof_blocks.toml"\ncommand = "census"\nset = ["trace_map.joints.lines=[{", ".join(line(*each) for each in column)}]"]\n'
    text += quantity("layers", "summary('layers')", expected=3, tolerance=0)
    text += quantity("area that moves", "summary('totals.moving_area_m2')", "m²", expected=6, tolerance=1e-6)
    text += quantity("layer of the last", "summary('blocks.2.layer')", expected=3, tolerance=0)
    text += quantity("depth of the last", "summary('blocks.2.depth_m')", "m", expected=3, tolerance=1e-6)
    return text


def key_blocks():
    rock("roof_blocks", "Blocks of a few joints in a roof", [(-4.0, -3.0), (4.0, -3.0), (4.0, 0.0), (-4.0, 0.0)], 30.0)
    stages = """
[time]
step = 0.01

[[stage]]
name = "excavated"
kind = "settle"
excavate = ["opening"]
k_h = 0.0
"""
    rock("wall_wedge", "A wedge in a wall", [(0.0, -2.0), (6.0, -2.0), (6.0, 5.0), (0.0, 5.0)], 30.0, stages)
    about = (
        "The census of key blocks of `keyblock cut --census`: which block a few joints leave at an opening, whether it can move out, and its "
        "factor of safety. Blocks that joints narrow upwards fall; one that is narrower below is held. A wedge on a plane of 40° in a wall slides: F = (N tan φ + c L)/T with "
        "N = W (cos α − k_h sin α) and T = W (sin α + k_h cos α). Between parallel joints, one side presses: F = tan φ / tan 60°. What a block leaves open is judged again."
    )
    case("key_blocks", f'title = "Key blocks without a run"\ncase  = 45\nabout = """{about}"""\n' + roof_runs() + wall_runs() + successive_run())
