"""Case 30, structures at their limit, as generate.py writes it."""

import math

from case_text import FILES, FIXED, NOTE, G, STIFF_ROCK, box, case, number, point, quantity, scenario

SETTLE = '[[stage]]\nname = "settle"\nkind = "settle"\n'
# Columns on steps (Goodman & Bray 1976): dip of the base, width, heights from the toe, tan φ at the limit.
COLUMNS = {
    "seven columns": (25, 2, (2, 4, 6, 8, 10, 8, 6), 0.918696),
    "nine columns": (30, 1, (1, 2, 3, 4, 5, 6, 5, 4, 3), 0.971794),
    "six columns": (30, 2, (2.5, 3, 3.2, 5, 6, 5), 0.736190),
}


def degrees(tangent):
    return math.degrees(math.atan(tangent))


def tilted(angle):
    return (-G * math.sin(math.radians(angle)), -G * math.cos(math.radians(angle)))


def columns(angle, width, heights):
    step, n = 0.1 * width, len(heights)
    base = [(-3 * width, -3), ((n + 1) * width, -3), ((n + 1) * width, (n - 1) * step)]
    for i in range(n - 2, -1, -1):
        base += [((i + 1) * width, (i + 1) * step), ((i + 1) * width, i * step)]
    base += [(0, 0), (-3 * width, 0)]
    return [("base", base, FIXED)] + [(f"c{i}", box(i * width, i * step, width, h), "") for i, h in enumerate(heights)]


def slab(length=4.0, thickness=0.4, angle=65.0):
    """A slab that leans against a wall, and tan φ at which it slides: Coulomb's law at foot and head, moments about the foot."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    head = (-length * c, length * s)
    ring = [(0, 0), (thickness * s, thickness * c), (thickness * s + head[0], thickness * c + head[1]), head]
    centre = sum(x for x, _ in ring) / 4
    # Foot: N, μN. Head: μN, μ²N, so that N = W/(1 + μ²); moments: −x_c (1 + μ²) = μ y_h − μ² x_h.
    low, high = 0.0, 1.0
    for _ in range(80):
        mu = 0.5 * (low + high)
        low, high = (mu, high) if -centre * (1 + mu * mu) > mu * head[1] - mu * mu * head[0] else (low, mu)
    return [("floor", box(-4, -1, 8, 1), FIXED), ("wall", box(head[0] - 1, 0, 1, 6), FIXED), ("slab", ring, "")], low


def dam(height=20.0, width=16.0, water=18.0, density=2400.0):
    """A wall with water on one side and uplift under it, and tan φ of its base at which it slides."""
    unit = 9810.0
    loads = (
        f'[[load]]\nblock = "dam"\nfrom = [0.0, 0.0]\nto = [0.0, {number(water)}]\ntraction = [{number(unit * water)}, 0.0]\ntraction_end = [0.0, 0.0]\n\n'
        f'[[load]]\nblock = "dam"\nfrom = [0.0, 0.0]\nto = [{number(width)}, 0.0]\ntraction = [0.0, {number(unit * water)}]\ntraction_end = [0.0, 0.0]\n\n'
    )
    thrust, uplift, weight = unit * water * water / 2, unit * water * width / 2, density * G * height * width
    return [("base", box(-10, -3, width + 20, 3), FIXED), ("dam", box(0, 0, width, height), "")], loads, thrust / (weight - uplift)


SLOPE = """title = "At the limit: a rock slope with a plane that dips 30° out of it"
accept_warnings = ["order-1"]

[domain]
x = [0.0, 70.0]
y = [0.0, 40.0]
boundary = "frame"

[rock]
density = 2600.0
young = 10.0e9
poisson = 0.25
state = "plane-strain"

[joints]
friction = 40.0

[[trace_map]]
name = "bedding"
points = [[20.0, 11.33333], [50.0, 28.65384]]

[[trace_map]]
name = "tension crack"
points = [[50.0, 28.65384], [50.0, 40.0]]

[[excavation]]
name = "cut"
shape = "polygon"
outer = [[0.0, 10.0], [20.0, 10.0], [37.3205, 40.0], [0.0, 40.0]]

[time]
step = 0.005

[[stage]]
name = "excavated"
kind = "settle"
excavate = ["cut"]
"""
SLIDING_AREA = 341.155  # m², above the plane and before the crack
SHEAR = 1.2  # of a rectangle: by how much more it shears than its mean stress says


def slope_sides():
    """Sets that stand and move, 0.5 % from each limit of a block on a plane of 30° with φ 40°: tan φ/tan α; tan(φ − α) of the weight."""
    safety, seismic = math.tan(math.radians(40)) / math.tan(math.radians(30)), math.tan(math.radians(10))
    k_h = -0.1
    k_v = 1 - abs(k_h) / seismic
    return {
        "a slope, by its strength": [[f"joints.strength_factor={safety * f:.9f}"] for f in (0.995, 1.005)],
        "a slope, by k_h": [[f"stage.excavated.k_h={-seismic * f:.9f}"] for f in (0.995, 1.005)],
        "a slope, by k_v": [[f"stage.excavated.k_h={k_h}", f"stage.excavated.k_v={k_v * f:.9f}"] for f in (0.995, 1.005)],
    }


def retaining_wall(height=3.0, width=1.2, weight=22e3, pressure=5.4e3):
    """Three courses under earth pressure that grows with depth, and the factor on it at which they overturn about the toe."""
    loads, blocks = "", [("ground", box(-2, -0.5, 6, 0.5), FIXED)]
    for k in range(3):
        blocks.append((f"c{k}", box(0, k, width, 1), ""))
        low, high = (pressure * (height - y) for y in (k, k + 1))
        loads += (
            f'[[load]]\nblock = "c{k}"\nfrom = [{width}, {k}.0]\nto = [{width}, {k + 1}.0]\n'
            f"traction = [{number(-low)}, 0.0]\ntraction_end = [{number(-high)}, 0.0]\n\n"
        )
    thrust = pressure * height**2 / 2
    return blocks, loads, weight * width * height * (width / 2) / (thrust * height / 3)


def straight_column(slenderness, young=1e9):
    """A column of height 1 that is pressed along its axis, clamped at one end, and the load at which it buckles (with shear)."""
    length = slenderness
    euler = math.pi**2 * young / 12 / (4 * length**2)
    critical = euler / (1 + SHEAR * euler / (young / 2))
    loads = (
        f'[[support]]\nblock = "column"\nfrom = [0.0, -0.5]\nto = [0.0, 0.5]\nstiffness = 1.0e13\n\n'
        f'[[load]]\nblock = "column"\nfrom = [{number(length)}, -0.5]\nto = [{number(length)}, 0.5]\ntraction = [{number(-critical)}, 0.0]\n\n'
    )
    return [("column", box(0, -0.5, length, 1), "")], loads


def stack_stiffness(count):
    """Of the joints of a stack, against turning, over weight × height of a block: the least with which it stands upright.

    Block i turns by θ_i: ½ k Σ (θ_i − θ_{i−1})² − ½ W h Σ (½ + number above) θ_i² ≥ 0."""

    def stands(k):
        pivot = 0.0
        for i in range(count):
            diagonal = (2 * k if i + 1 < count else k) - (0.5 + count - 1 - i)
            pivot = diagonal - (k * k / pivot if i else 0.0)
            if pivot <= 0:
                return False
        return True

    low, high = 0.0, 100.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands(middle) else (middle, high)
    return high


def limits():
    text = '''title = "Limits of equilibrium"
case  = 30
about = """Static stages at default settings, on both sides of known limits, 0.5 % from them. A block on an incline: tan φ = tan α. A slab that leans against a wall with friction at foot and head: equilibrium of forces and moments. A dam with water and uplift: thrust over weight less uplift. Columns that topple over steps: Goodman & Bray (1976). A semicircular arch of 25 voussoirs, thickness over mean radius 0.15, φ 37°, under lateral acceleration: 1.443 m/s² by limit analysis of rigid blocks (linear programme, no tension). A cantilever column at 0.85 of Euler's load with a lateral force at its tip: beam-column theory. A rock slope with a plane that dips out of it: tan φ/tan α, and the seismic coefficients tan(φ − α) (1 − k_v); what a static stage names counts as loosened. A dry retaining wall: moments about its toe. Straight columns 1 % either side of their buckling load, with shear, and pillars on soft joints, one with kn b³/12 = W h/2, and three on one another: beyond it they are in equilibrium that is not stable."""
'''

    def sides(name, file, stands, moves):
        nonlocal text
        for what, value in (("stands", stands), ("moves", moves)):
            text += f'\n[[run]]\nname = "{name}: {what}"\nscenario = "scenarios/{file}.toml"\nset = ["{value}"]\n'
            moving = {"at_most": 0} if what == "stands" else {"at_least": 1}
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
            text += quantity("out of balance, of the others", "summary('stages.0.equilibrium.worst_residual_ratio')", at_most=1e-4)

    def with_friction(name, file, tangent, blocks, gravity=(0.0, -G), extra="", rock=STIFF_ROCK):
        scenario(file, title=f"At the limit: {name}", gravity=gravity, rock=rock, joints=f"friction = {degrees(tangent):.9f}", step=0.005, blocks=blocks, extra=extra, stages=SETTLE)
        sides(name, file, *(f"joints.friction={degrees(tangent * f):.9f}" for f in (1.005, 0.995)))

    with_friction("a block on an incline of 30°", "limit_incline", math.tan(math.radians(30)), [("base", box(-5, -1, 10, 1), FIXED), ("block", box(-0.5, 0, 1, 1), "")], gravity=tilted(30))
    blocks, tangent = slab()
    with_friction("a leaning slab", "limit_slab", tangent, blocks)
    blocks, loads, tangent = dam()
    with_friction("a dam on its base", "limit_dam", tangent, blocks, extra=loads, rock=STIFF_ROCK.replace("2600", "2400"))
    for name, (angle, width, heights, tangent) in COLUMNS.items():
        with_friction(f"{name} that topple", f"limit_{name.replace(' ', '_')}", tangent, columns(angle, width, heights), gravity=tilted(angle))

    radius, inner, outer, arcs, count = 10.0, 9.25, 10.75, 4, 25
    blocks = [("left", box(-outer - 1, -1, outer - inner + 2, 1), FIXED), ("right", box(inner - 1, -1, outer - inner + 2, 1), FIXED)]
    for k in range(count):
        angles = [math.pi * (k + j / arcs) / count for j in range(arcs + 1)]
        ring = [(outer * math.cos(t), outer * math.sin(t)) for t in angles] + [(inner * math.cos(t), inner * math.sin(t)) for t in reversed(angles)]
        blocks.append((f"v{k}", [(round(x, 12), abs(round(y, 12))) for x, y in ring], ""))
    scenario("limit_arch", title="At the limit: an arch under lateral acceleration", gravity=(1.443, -G), rock=STIFF_ROCK, joints="friction = 37.0", step=0.005, blocks=blocks, stages=SETTLE)
    sides("an arch under lateral acceleration", "limit_arch", *(f"gravity={point((1.443 * f, -G))}" for f in (0.995, 1.005)))

    length, young, lateral = 60.0, 2e9, 10.0
    thrust = 0.85 * math.pi**2 * young / 12 / (4 * length**2)
    scenario(
        "limit_column", title="A column at 0.85 of its critical load", gravity=(0.0, 0.0), step=1.0,
        rock=f'density = 2400.0\nyoung = {young}\npoisson = 0.0\nstate = "plane-stress"\norder = 6', joints="friction = 30.0",
        blocks=[("column", box(0, -0.5, length, 1), "")], histories=[("tip", "column", (length, 0.0))],
        extra=f'[[support]]\nblock = "column"\nfrom = [0.0, -0.5]\nto = [0.0, 0.5]\nstiffness = 2.0e13\n\n[[load]]\nblock = "column"\nfrom = [{length}, -0.5]\nto = [{length}, 0.5]\ntraction = [{number(-thrust)}, {lateral}]\n\n',
        stages=SETTLE,
    )
    k = math.sqrt(thrust * 12 / young)
    text += '\n[[run]]\nname = "a column at 0.85 of its critical load"\nscenario = "scenarios/limit_column.toml"\n'
    text += quantity("deflection of the tip", "end('tip.uy')", "m", expected=number(lateral / (thrust * k) * (math.tan(k * length) - k * length)), tolerance=5e-3)

    FILES["scenarios/limit_slope.toml"] = NOTE + SLOPE
    for name, sides_of in slope_sides().items():
        for what, sets in zip(("stands", "slides"), sides_of, strict=True):
            text += f'\n[[run]]\nname = "{name}: {what}"\nscenario = "scenarios/limit_slope.toml"\nset = [{", ".join(chr(34) + s + chr(34) for s in sets)}]\n'
            moving = {"at_most": 0} if what == "stands" else {"at_least": 1}
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
            loose = {"at_most": 0} if what == "stands" else {"expected": SLIDING_AREA, "tolerance": 1e-3}
            text += quantity("loosened area", "summary('stages.0.damage.loosened_area_m2')", "m²", **loose)

    blocks, loads, factor = retaining_wall()
    rock = f'density = {22e3 / G:.9f}\nyoung = 5.0e9\npoisson = 0.2\nstate = "plane-strain"'
    scenario("limit_wall", title="At the limit: a dry wall that holds back earth", rock=rock, joints="friction = 35.0", step=0.002, blocks=blocks, extra=loads, stages=SETTLE)
    sides("a retaining wall overturns", "limit_wall", *(f"load_factor={factor * f:.9f}" for f in (0.995, 1.005)))

    def stability(name, file, stable, unstable):
        nonlocal text
        for what, value in (("stable", stable), ("not stable", unstable)):
            text += f'\n[[run]]\nname = "{name}: {what}"\nscenario = "scenarios/{file}.toml"\nset = ["{value}"]\n'
            text += quantity("in equilibrium", "summary('stages.0.equilibrium.moving_blocks')", at_most=0)
            bound = {"at_most": 0} if what == "stable" else {"at_least": 1}
            text += quantity("blocks that are not stable", "summary('stages.0.equilibrium.unstable_blocks')", **bound)

    for slenderness in (10.0, 20.0, 40.0):
        blocks, loads = straight_column(slenderness)
        file = f"limit_straight_column_{slenderness:.0f}"
        scenario(
            file, title=f"A straight column, length over height {slenderness:.0f}, at its buckling load", gravity=(0.0, 0.0), step=1.0,
            rock='density = 2500.0\nyoung = 1.0e9\npoisson = 0.0\nstate = "plane-stress"\norder = 6', joints="friction = 30.0",
            blocks=blocks, extra=loads, stages=SETTLE,
        )
        stability(f"a straight column, L/h {slenderness:.0f}", file, "load_factor=0.99", "load_factor=1.01")

    width, height, density = 1.0, 10.0, 2600.0
    stiffness = 6 * density * G * width * height**2 / width**3  # kn b³/12 = W h/2
    scenario(
        "limit_pillar", title="A pillar that stands upright on a soft joint", rock=STIFF_ROCK, joints=f"friction = 30.0\nnormal_stiffness = {stiffness:.6f}", step=0.01,
        blocks=[("ground", box(-3, -1, 7, 1), FIXED), ("pillar", box(0, 0, width, height), "")], stages=SETTLE,
    )
    stability("a pillar on a soft joint", "limit_pillar", *(f"joints.normal_stiffness={stiffness * f:.3f}" for f in (1.02, 0.98)))

    count, height = 3, 5.0
    stiffness = 12 * stack_stiffness(count) * density * G * width * height**2 / width**3
    scenario(
        "limit_stack", title="Three pillars on one another, on soft joints", rock=STIFF_ROCK, joints=f"friction = 60.0\nnormal_stiffness = {stiffness:.6f}\nshear_stiffness = 1.0e9",
        step=0.01, blocks=[("ground", box(-3, -1, 7, 1), FIXED)] + [(f"p{k}", box(0, k * height, width, height), "") for k in range(count)], stages=SETTLE,
    )
    stability("three pillars on one another", "limit_stack", *(f"joints.normal_stiffness={stiffness * f:.3f}" for f in (1.02, 0.98)))
    case("limits", text)
