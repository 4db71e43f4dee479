#!/usr/bin/env python3
"""Writes the scenarios and cases that repeat themselves: rows of blocks, charts, tables of motion.

Run it in this folder after a change; what it writes is kept beside it, and a test says when the two differ.
"""

import argparse
import math
from pathlib import Path

from arches import arches
from boundaries import boundaries
from dampings import dampings
from bridges import bridges
from case_text import FILES, FIXED, NOTE, STIFF_ROCK, G, box, case, largest, number, point, quantity, scenario
from inclines import inclines
from interfaces import interfaces
from joint_pressure import joint_pressure
from key_blocks import key_blocks
from limits import limits
from water import water
from weakening import weakening


# ── 20: a column and a stack ─────────────────────────────────────────────────────────────────────────────────────────

def column():
    rock = 'density = 2600.0\nyoung = 1.0e9\npoisson = 0.2\nstate = "plane-stress"'
    scenario(
        "column", title="Five blocks on one another", rock=rock, joints="friction = 30.0", step=0.05,
        blocks=[("base", box(-1, -1, 3, 1), FIXED)] + [(f"b{k}", box(0, k - 1, 1, 1), "") for k in range(1, 6)],
        stages='[[stage]]\nname = "settle"\nkind = "settle"\ntolerance = 1.0e-9\nmax_steps = 5000\n',
    )
    names = [f"b{row}{column}" for row in range(3) for column in range(3)]
    scenario(
        "stack", title="Nine blocks in three rows, set down at once", rock=rock, joints="friction = 35.0", step=0.005,
        blocks=[("base", box(-1, -1, 6, 1), FIXED)] + [(n, box(int(n[2]), 0.5 * int(n[1]), 1, 0.5), "") for n in names],
        histories=[(n, n, (int(n[2]) + 0.5, 0.5 * int(n[1]) + 0.25)) for n in names],
        stages='[[stage]]\nname = "stand"\nkind = "rest"\nduration = 1.0\n',
    )
    scenario(
        "soft_joints", title="Five blocks on soft joints, pressed together", gravity=(0.0, 0.0), step=0.05,
        rock='density = 2600.0\nyoung = 1.0e9\npoisson = 0.0\nstate = "plane-stress"',
        joints="friction = 30.0\nnormal_stiffness = 1.0e9",
        blocks=[("base", box(0, -1, 1, 1), FIXED)] + [(f"b{k}", box(0, k - 1, 1, 1), "") for k in range(1, 6)],
        histories=[("top", "b5", (0.5, 5.0)), ("aside", "b3", (0.9, 2.2))],
        extra='[[load]]\nblock = "b5"\nfrom = [1.0, 5.0]\nto = [0.0, 5.0]\ntraction = [0.0, -1000.0]\n\n',
        stages='[[stage]]\nname = "settle"\nkind = "settle"\ntolerance = 1.0e-9\nmax_steps = 5000\n',
    )
    scenario(
        "bond_in_tension", title="A block that is pulled off its base", gravity=(0.0, 0.0), step=0.005,
        rock='density = 2600.0\nyoung = 1.0e9\npoisson = 0.0\nstate = "plane-stress"',
        joints="friction = 30.0\ncohesion = 1.0e6\ntension = 5.0e4",
        blocks=[("base", box(0, -1, 1, 1), FIXED), ("block", box(0, 0, 1, 1), "")],
        histories=[("block", "block", (0.5, 0.5))],
        extra='''[[load]]
block = "block"
from = [1.0, 1.0]
to = [0.0, 1.0]
traction = [0.0, 1000.0]
time = [[0.0, 0.0], [60.0, 60.0]]

''',
        stages='[[stage]]\nname = "pull"\nkind = "rest"\nduration = 55.0\n',
    )
    scenario(
        "joint_in_bending", title="A stiff block on a soft joint, pressed more at one end", gravity=(0.0, 0.0), step=0.05,
        rock='density = 2600.0\nyoung = 1.0e13\npoisson = 0.0\nstate = "plane-stress"',
        joints="friction = 30.0\nnormal_stiffness = 1.0e9",
        blocks=[("base", box(-1, -1, 3, 1), FIXED), ("block", box(0, 0, 1, 1), "")],
        histories=[("left", "block", (0.0, 0.0)), ("right", "block", (1.0, 0.0))],
        extra="""[[load]]
block = "block"
from = [0.0, 1.0]
to = [1.0, 1.0]
traction = [0.0, -500.0]
traction_end = [0.0, -1500.0]

""",
        stages='[[stage]]\nname = "settle"\nkind = "settle"\ntolerance = 1.0e-9\nmax_steps = 5000\n',
    )
    text = '''title = "Column and stack"
case  = 20
about = """Five blocks of 1 m on one another, settled: the contacts under each carry the weight above. Five on joints as soft as the blocks, pressed together by 1 kPa: blocks and joints get shorter by as much, and the stress is the same everywhere, with any order. A block that is pulled off its base: the bond breaks at its strength times its length. A stiff block on a soft joint of width b, pressed more at one end: it turns by M/(kn b³/12). Nine blocks in three rows, set down at once, keep their places for 1 s of dynamics with any time step."""

[[run]]
name = "column"
scenario = "scenarios/column.toml"
orders = [1, 2, 3]
'''
    for k in range(1, 6):
        below = f"b{k - 1}" if k > 1 else "base"
        text += quantity(f"force under block {k}, from below", f"normal_force('{below}', 'b{k}')", "N/m", expected=f"{6 - k}*2600*9.81", tolerance=1e-6)
    text += '''
[[run]]
name = "soft joints"
scenario = "scenarios/soft_joints.toml"
orders = [1, 2, 3, 4, 6]
'''
    text += quantity("displacement of the top", "end('top.uy')", "m", expected="-1e3*(5/1e9 + 5/1e9)", tolerance=1e-5)
    text += quantity("stress aside of the middle", "end('aside.syy')", "Pa", expected="-1e3", tolerance=1e-5)
    text += '''
[[run]]
name = "bond in tension"
scenario = "scenarios/bond_in_tension.toml"
orders = [1, 2, 3, 4, 6]
'''
    text += quantity("peak of the pull", "1e3*crossing('block.vy', 5e-4)", "N/m", expected="5e4", tolerance=1e-3)
    text += quantity("when it breaks", "summary('breaks.0.first_s')", "s", expected="50", tolerance=2e-4)
    text += quantity("joint that breaks", "summary('breaks.0.length_m')", "m", expected="1", tolerance=1e-9)
    turn = "end('left.uy') - end('right.uy')"
    text += '''
[[run]]
name = "joint in bending"
scenario = "scenarios/joint_in_bending.toml"
orders = [1, 2, 3]
'''
    text += quantity("turn of the block", turn, "rad", expected="(1e3/12)/(1e9/12)", tolerance=1e-3)
    text += '''
[[run]]
name = "stack"
scenario = "scenarios/stack.toml"
vary = { "time.step" = [0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001] }
'''
    text += quantity("largest displacement of a block in 1 s", largest([f"{n}.{u}" for n in names for u in ("ux", "uy")]), "m", at_most=1e-4)
    case("column", text)


# ── 21: direct shear ─────────────────────────────────────────────────────────────────────────────────────────────────

def direct_shear():
    rate, pressure, cohesion = 1e3, 50e3, 60e3
    for name, base in (("", [("base", box(-1, -0.5, 3, 0.5), FIXED)]),
                       ("_divided", [("base left", box(-1, -0.5, 1.4, 0.5), FIXED), ("base right", box(0.4, -0.5, 1.6, 0.5), FIXED)])):
        scenario(
            f"direct_shear{name}", title="Direct shear of a joint of 1 m", rock=STIFF_ROCK.replace("5.0e10", "1.0e12"),
            joints=f"friction = 30.0\ncohesion = {cohesion}\nnormal_stiffness = 1.0e9\nshear_stiffness = 4.0e8", step=0.005,
            blocks=base + [("block", box(0, 0, 1, 0.25), "")],
            histories=[("block", "block", (0.5, 0.125))],
            extra=f'''[[load]]
block = "block"
from = [1.0, 0.25]
to = [0.0, 0.25]
traction = [0.0, {-pressure}]

[[load]]           # along the joint, so that it does not tilt the block
block = "block"
point = [0.5, 0.0]
force = [{rate}, 0.0]
time = [[0.0, 0.0], [100.0, 100.0]]

''',
            stages='[[stage]]\nname = "settle"\nkind = "settle"\n\n[[stage]]\nname = "shear"\nkind = "rest"\nduration = 100.0\n',
        )
    text = '''title = "Direct shear of a joint"
case  = 21
about = """A block on a joint of 1 m under a pressure of 50 kPa and its weight is pushed along it by a force that grows by 1 kN/m per second, until it leaves: at c A + N tan φ, also where it is pulled off the joint by 40 kPa and N is negative. The joint is much softer than the rock (0.4 GPa/m in shear), so that shear is even along it; a stiffer one fails from the ends inwards. Cohesion belongs to the joint once, whether it is one contact edge or divided among two blocks below."""
'''
    for name, kind in (("", "one base"), ("_divided", "divided base")):
        text += f'''
[[run]]
name = "{kind}"
scenario = "scenarios/direct_shear{name}.toml"
[run.points]
keys = ["joints.cohesion", "joints.friction", "joints.tension", "load.0.traction"]
labels = ["c 60 kPa, φ 30°", "c 0, φ 30°", "c 60 kPa, φ 0°", "c 60 kPa, φ 30°, pulled"]
values = [[60.0e3, 30.0, 0.0, [0.0, -50.0e3]], [0.0, 30.0, 0.0, [0.0, -50.0e3]], [60.0e3, 0.0, 0.0, [0.0, -50.0e3]], [60.0e3, 30.0, 80.0e3, [0.0, 40.0e3]]]
'''
        text += quantity("peak of the shear force", "1e3*crossing('block.vx', 5e-4)", "N/m",
                         expected="set('joints.cohesion')*1 + (2600*0.25*9.81 - set('load.0.traction.1'))*tan(rad(set('joints.friction')))", tolerance=1e-3)
    case("direct_shear", text)


# ── 10: two bars in collision ────────────────────────────────────────────────────────────────────────────────────────

def bars():
    count, h, gap, speed = 40, 0.05, 5e-4, 1.0
    blocks = []
    for side, x, v in (("l", 0.0, speed), ("r", count * h + gap, 0.0)):
        for k in range(count):
            blocks.append((f"{side}{k}", box(x + k * h, 0.0, h, h), f"velocity = [{v}, 0.0]\n"))
    middle = lambda name: (sum(p[0] for p in dict((b[0], b[1]) for b in blocks)[name]) / 4, h / 2)
    names = [b[0] for b in blocks]
    scenario(
        "bars", title="A bar meets an equal one at rest", gravity=(0.0, 0.0),
        rock='density = 2500.0\nyoung = 1.0e10\npoisson = 0.0\nstate = "plane-stress"',
        joints="friction = 0.0\ncohesion = 1.0e12\ntension = 1.0e12\nnormal_stiffness = 2.0e13\nshear_stiffness = 2.0e13", step=1e-6,
        blocks=blocks, histories=[(n, n, middle(n)) for n in names],
        stages='[[stage]]\nname = "collision"\nkind = "rest"\nduration = 0.0035\n',
        solver="rock_damping = 0.0\ncontact_damping = 0.0\ntolerance = 1.0e-8",
    )
    mean = lambda side: "(" + " + ".join(f"end('{side}{k}.vx')" for k in range(count)) + f")/{count}"
    c = math.sqrt(1e10 / 2500)
    text = f'''title = "Two bars in collision"
case  = 10
about = """A bar of 2 m moves at v = 1 m/s against an equal one at rest; ν = 0, so that this is the one-dimensional problem of St. Venant. Stress ρcv/2 runs away from the impact both ways, is reflected at the free ends, and when it is back, after 2L/c, the bars part and have exchanged their velocities. Each bar is {count} blocks that are bonded to one another by joints 100 times as stiff as they are."""

[[run]]
name = "bars"
scenario = "scenarios/bars.toml"
'''
    text += quantity("mean velocity of the bar that was hit", mean("r"), "m/s", expected=1.0, tolerance=0.02)
    text += quantity("mean velocity of the other", mean("l"), "m/s", expected=0.0, absolute_tolerance=0.02)
    text += quantity("momentum, of that at the start", f"{mean('r')} + {mean('l')}", expected=1.0, tolerance=1e-12)
    x = 4.5 * h
    text += quantity(f"time between the wave from the impact and the reflected one, {x:g} m from it", "crossing('r4.vx', 0.75) - crossing('r4.vx', 0.25)", "s", expected=f"2*(2 - {x:g})/sqrt(1e10/2500)", tolerance=0.02)
    mid = f"l{count // 2}.sxx"
    arrival = (gap / speed) + (count // 2 * h) / c
    text += quantity("stress in the middle, between the waves", f"at('{mid}', {arrival + 0.5e-3:.6f})", "Pa", expected="-0.5*2500*sqrt(1e10/2500)", tolerance=0.1)
    text += quantity("energy that is not accounted for, over the largest term", "summary('energy.residual_ratio')", at_most=1e-3)
    case("bars", text)


# ── 11: toppling or sliding ──────────────────────────────────────────────────────────────────────────────────────────

def mode(alpha, delta, phi):
    """Goodman & Bray 1976, with the moments of inertia of Sagaseta 1986: what a block on an incline does, in degrees."""
    a, d, p = (math.radians(x) for x in (alpha, delta, phi))
    if alpha <= phi and alpha <= delta:
        return "stable"
    if alpha > phi and alpha <= delta and phi <= delta:
        return "slides"
    if alpha <= delta:
        return "slides"
    if math.tan(p) >= (math.sin(a) + 3 * math.sin(d) * math.cos(a - d)) / (math.cos(a) + 3 * math.cos(d) * math.cos(a - d)):
        return "topples"
    if phi < delta:
        return "slides"
    return "slides and topples"


def clear_mode(alpha, delta, phi, margin=0.25):
    """The mode, if it is the same everywhere within the margin; else None."""
    modes = {mode(alpha + i * margin, delta + j * margin, phi) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    return modes.pop() if len(modes) == 1 else None


def chart():
    scenario(
        "toppling", title="A block on an incline", rock=STIFF_ROCK, joints="friction = 30.0", step=0.001,
        blocks=[("incline", box(-3, -1, 8, 1), FIXED), ("block", box(0, 0, 0.5, 1), "")],
        histories=[("toe", "block", (0.5, 0)), ("top", "block", (0.5, 1))],
        stages='[[stage]]\nname = "go"\nkind = "rest"\nduration = 0.05\n',
    )
    points = {"stable": [], "slides": [], "topples": [], "slides and topples": []}
    wanted = [(a, d, p) for p in (15, 25, 35, 45) for a in range(4, 65, 6) for d in range(3, 60, 7)]
    # Close to the boundaries, on both sides.
    for p in (20, 30):
        wanted += [(p + s * 0.3, d, p) for s in (-1, 1) for d in (p + 10, p + 20)]
        wanted += [(d + s * 0.3, d, p) for s in (-1, 1) for d in (p - 8, p - 15)]
        for d in range(8, p - 1, 4):
            alphas = [a / 100 for a in range(100 * d, 8500)]
            edge = [a for a, b in zip(alphas, alphas[1:]) if mode(a, d, p) != mode(b, d, p) and a > d + 1]
            wanted += [(a + s * 0.5, d, p) for a in edge for s in (-1, 1)]
    for a, d, p in wanted:
        what = clear_mode(a, d, p)
        if what:
            points[what].append((a, d, p))
    text = '''title = "Toppling or sliding"
case  = 11
about = """A block on an incline of α, base over height tan δ, friction angle φ: it stays while α < φ and α < δ, slides, topples about its toe, or both (Sagaseta 1986): it topples without sliding when α > δ and tan φ ≥ (sin α + 3 sin δ cos(α − δ))/(cos α + 3 cos δ cos(α − δ)). Points of the chart at least 0.25° from a boundary, after 0.05 s from rest."""
'''
    expectations = {"stable": (False, False), "slides": (True, False), "topples": (False, True), "slides and topples": (True, True)}
    for what, (slides, topples) in expectations.items():
        text += f'\n[[run]]\nname = "{what}"\nscenario = "scenarios/toppling.toml"\n[run.points]\n'
        text += 'keys = ["gravity", "joints.friction", "block.block.outer", "history.toe.point", "history.top.point"]\nlabels = [\n'
        text += "".join(f'  "α {a:g}°, δ {d:g}°, φ {p:g}°",\n' for a, d, p in points[what]) + "]\nvalues = [\n"
        for a, d, p in points[what]:
            r, b = math.radians(a), math.tan(math.radians(d))
            ring = ", ".join(point(q) for q in box(0, 0, b, 1))
            text += f"  [{point((G * math.sin(r), -G * math.cos(r)))}, {float(p)}, [{ring}], {point((b, 0))}, {point((b, 1))}],\n"
        text += "]\n"
        text += quantity("way of the toe", "abs(end('toe.ux'))", "m", **({"at_least": 3e-5} if slides else {"at_most": 1e-5}))
        text += quantity("turn", "abs(end('top.ux') - end('toe.ux'))", "rad", **({"at_least": 3e-5} if topples else {"at_most": 1e-5}))
    case("toppling", text)


# ── 6: a block on an oscillating base ────────────────────────────────────────────────────────────────────────────────

def oscillating_base():
    amplitude, omega, end, every = 0.5, 2 * math.pi, 5.0, 0.001
    times = [k * every for k in range(round(end / every) + 1)]
    common = dict(rock=STIFF_ROCK, joints=f"friction = {math.degrees(math.atan(0.3))!r}      # tan φ = 0.3", step=every,
                  histories=[("block", "block", (0.5, 0.25))], solver="rock_damping = 0.0\ncontact_damping = 0.0")
    block = ("block", box(0, 0, 1, 0.5), "")
    settle = '[[stage]]\nname = "settle"\nkind = "settle"\n\n'
    rows = ", ".join(f"[{t:g}, {amplitude * (1 - math.cos(omega * t)):.10g}]" for t in times)
    scenario("base_displacement", title="A block on a base that is moved", blocks=[("base", box(-4, -1, 9, 1), FIXED + f"motion = {{ x = [{rows}] }}\n"), block],
             stages=settle + '[[stage]]\nname = "shake"\nkind = "rest"\nduration = 5.0\n', **common)
    rows = ", ".join(f"[{t:g}, {amplitude * omega**2 * math.cos(omega * t):.10g}]" for t in times)
    scenario("base_acceleration", title="A block on a base that is shaken", blocks=[("base", box(-4, -1, 9, 1), FIXED), block],
             extra=f'[[motion]]\nname = "cosine"\nx = [{rows}]\n\n',
             stages=settle + '[[stage]]\nname = "shake"\nkind = "shake"\nmotion = "cosine"\n', **common)
    text = '''title = "Block on an oscillating base"
case  = 6
about = """A base moves by D (1 − cos ωt), D = 0.5 m, 1 Hz; the block on it, μ = 0.3, is dragged along and never sticks for long. Its displacement in space after 1, 2 and 5 s, once with the base moved, once in the frame of the base with its acceleration as ground motion: to this the displacement of the base is added."""
'''
    for name, run, add in (("base_displacement", "base displacement", ""), ("base_acceleration", "ground acceleration", " + 0.5*(1 - cos(2*pi*{t}))")):
        text += f'\n[[run]]\nname = "{run}"\nscenario = "scenarios/{name}.toml"\nvary = {{ "time.step" = [0.001, 0.0005] }}\n'
        for t, expected in ((1, 0.52769), (2, 0.81151), (5, 1.09120)):
            text += quantity(f"displacement after {t} s", f"at('block.ux', {t})" + add.format(t=t), "m", expected=expected, tolerance=5e-3)
    text += quantity("difference of the two after 5 s", "row('ground acceleration', 'displacement after 5 s') - row('base displacement', 'displacement after 5 s')", "m", expected=0, absolute_tolerance=1e-3)
    case("oscillating_base", text)


# ── 9: the rocking block ─────────────────────────────────────────────────────────────────────────────────────────────

def rocking():
    tilt = math.degrees(math.atan2(0.2, 0.6)) / 2
    h0 = 0.4 * math.sin(math.radians(tilt))
    a = math.radians(-tilt)
    corner = (0.4 + (-0.4) * math.cos(a), (-0.4) * math.sin(a))
    scenario(
        "rocking", title="A block set free on one corner", rock=STIFF_ROCK, joints="friction = 60.0", step=0.001,
        blocks=[("floor", box(-1, -1, 3, 1), FIXED), ("block", box(0, 0, 0.4, 1.2), f"rotation = {-tilt!r}\nrotation_center = [0.4, 0.0]\n")],
        histories=[("corner", "block", corner), ("pivot", "block", (0.4, 0.0))],
        stages='[[stage]]\nname = "rock"\nkind = "rest"\nduration = 0.6\n',
        solver="rock_damping = 0.0\ncontact_damping = 0.0",
    )
    text = f'''title = "Rocking block"
case  = 9
about = """A block of half-sizes 0.2 × 0.6 m (Housner 1963), set free on one corner, turned by half its slenderness angle: the other corner meets the floor after 0.387295 s, with 0.945267 rad/s. The moment is that at which 99.9 % of its way is done, as the last of it ends in contact."""

[[run]]
name = "release"
scenario = "scenarios/rocking.toml"
vary = {{ "time.step" = [0.001, 0.0005, 0.0002] }}
'''
    text += quantity("time of the first impact", f"crossing('corner.uy', {-0.999 * h0!r})", "s", expected=0.387295, tolerance=2e-3)
    text += quantity("angular velocity at the impact", "-min('corner.vy')/0.4", "rad/s", expected=0.945267, tolerance=5e-3)
    text += quantity("way of the other corner until then", "abs(at('pivot.ux', 0.38))", "m", at_most=1e-4)
    case("rocking", text)


# ── 24: the key block of two joints ──────────────────────────────────────────────────────────────────────────────────

def key_block():
    radius, left, right = 2.75, math.radians(53.092), math.radians(69.456)
    gamma = math.pi - left - right
    shares = (0.5, 0.7, 0.9, 0.99)
    for share in shares:
        d = share * radius
        # Feet of the perpendiculars from the centre; the lines meet above, at the same distance from both.
        feet = [(-d * math.sin(left), d * math.cos(left)), (d * math.sin(right), d * math.cos(right))]
        along = [(math.cos(left), math.sin(left)), (-math.cos(right), math.sin(right))]
        to_apex = d / math.tan(gamma / 2)
        rows = "trace,x,y\n"
        for k in range(2):
            for t in (0.0, to_apex + 0.3):
                rows += f"{k + 1},{number(feet[k][0] + t * along[k][0])},{number(feet[k][1] + t * along[k][1])}\n"
        FILES[f"traces/key_block_{share}.csv"] = rows
    FILES["scenarios/key_block.toml"] = NOTE + """title = "A block of two joints in the roof of a tunnel"

[domain]
x = [-10.0, 10.0]
y = [-10.0, 14.0]

[rock]
density = 2270.0
young = 3.0e9
poisson = 0.21
state = "plane-stress"

[joints]
friction = 39.0

[[trace_map]]
name = "joints"
file = "../traces/key_block_0.9.csv"

[[excavation]]
name = "tunnel"
shape = "circle"
center = [0.0, 0.0]
diameter = 5.5
chords = 720

[cutting]
cluster = 0.001
sliver_thickness = 0.001

[time]
step = 0.002

[[stage]]
name = "excavated"
kind = "settle"
excavate = ["tunnel"]

[[stage]]
name = "fall"
kind = "rest"
duration = 1.5
"""
    text = '''title = "Largest key block of two joints"
case  = 24
about = """Two joints in the roof of a circular tunnel of radius R, γ between them, both at distance d from its centre. The block between them has the area d (d cot(γ/2) − √(R² − d²)) − R² ((π − γ)/2 − acos(d/R)); the largest, of tangents, R² (cot(γ/2) − (π − γ)/2), is 5.71 m² with R = 2.75 m and the γ = 57.452° of the sets 79/270 and 81/230 in a section of azimuth 165°. The rock is cut by the joints and excavated; the block, and nothing else, falls."""

[[run]]
name = "roof"
scenario = "scenarios/key_block.toml"
[run.points]
keys = ["trace_map.joints.file"]
labels = [''' + ", ".join(f'"d = {share} R"' for share in shares) + "]\nvalues = [" + ", ".join(f'["../traces/key_block_{share}.csv"]' for share in shares) + "]\n"
    areas = []
    for share in shares:
        d = share * radius
        areas.append(d * (d / math.tan(gamma / 2) - math.sqrt(radius**2 - d**2)) - radius**2 * ((math.pi - gamma) / 2 - math.acos(share)))
    text += quantity("fallen area", "summary('stages.1.damage.fallen_area_m2')", "m²", expected_by_point="[" + ", ".join(f"{a:.6f}" for a in areas) + "]", tolerance=2e-3)
    text += quantity("fallen blocks", "summary('stages.1.damage.fallen_blocks')", expected=1, tolerance=0)
    text += quantity("fallen area, of the largest possible", "summary('stages.1.damage.fallen_area_m2')/(2.75^2*(1/tan(rad(57.452/2)) - rad(180 - 57.452)/2))", at_most=1)
    case("key_block", text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; say which files differ")
    check = parser.parse_args().check
    for write in (column, direct_shear, bars, chart, arches, inclines, oscillating_base, rocking, key_block, limits,
                  boundaries, dampings, joint_pressure, weakening, key_blocks, water, interfaces, bridges):
        write()
    here = Path(__file__).resolve().parent
    stale = [name for name, text in FILES.items() if not (here / name).is_file() or (here / name).read_text() != text]
    for name in stale:
        print(f"{name} differs" if check else name)
        if not check:
            (here / name).parent.mkdir(exist_ok=True)
            (here / name).write_text(FILES[name])
    return 1 if check and stale else 0


if __name__ == "__main__":
    raise SystemExit(main())
