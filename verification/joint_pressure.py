"""Case 41, joints of given stiffness, as generate.py writes it."""

import math

from case_text import FIXED, G, box, case, number, point, quantity, scenario

RIGID = 'density = 2500.0\nyoung = 1.0e13\npoisson = 0.0\nstate = "plane-strain"'
SETTLE = '[[stage]]\nname = "settle"\nkind = "settle"\n'
EXACT = SETTLE + "tolerance = 1.0e-8\nmax_steps = 5000\n"
# Tilt at which a pier of eight rigid blocks falls (pier_limit, below), degrees, by Pa/m of its joints.
PIERS = {5e7: 8.049, 1e8: 9.483, 2e8: 10.555, 1e9: 12.129}


def pier_limit(stiffness, count=8, height=0.5, width=1.0, density=2500.0, shear=0.4):
    """Degrees: rigid blocks on continuous joints that bear no tension, each turned by the triangle or trapezium of its pressure, and shifted along it by
    what its closed part gives way in shear, at `shear` times the stiffness; weights where both have brought them. Without the shear the limits are
    8.122, 9.528, 10.582 and 12.136. Independent of the program; takes seconds."""
    weight = density * G * height * width

    def stands(angle):
        down = (math.sin(angle), -math.cos(angle))
        turns, shifts = [0.0] * count, [0.0] * count
        for _ in range(40000):
            sums, joints, centres, x, y, total = [], [], [], 0.0, 0.0, 0.0
            for turn, shift in zip(turns, shifts):
                x, y = x + shift * math.cos(total), y - shift * math.sin(total)
                total += turn
                sums.append(total)
                up = (math.sin(total), math.cos(total))
                joints.append((x, y))
                centres.append((x + up[0] * height / 2, y + up[1] * height / 2))
                x, y = x + up[0] * height, y + up[1] * height
            largest = 0.0
            for j in range(count):
                below = sums[j - 1] if j else 0.0
                above = weight * (count - j)
                pressed = -above * (down[0] * math.sin(below) + down[1] * math.cos(below))
                along = above * (down[0] * math.cos(below) - down[1] * math.sin(below))
                moment = sum(weight * ((c[0] - joints[j][0]) * down[1] - (c[1] - joints[j][1]) * down[0]) for c in centres[j:])
                turn = rotation(-moment / pressed, pressed, stiffness, width)
                if turn is None:
                    return False
                shift = along / (shear * stiffness * closed_length(-moment / pressed, width)) if shear else 0.0
                largest = max(largest, abs(turn - turns[j]), abs(shift - shifts[j]))
                turns[j] += 0.3 * (turn - turns[j])
                shifts[j] += 0.3 * (shift - shifts[j])
            if largest < 1e-10:
                return True
        return False

    low, high = 0.0, math.degrees(math.atan(width / (count * height)))
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stands(math.radians(middle)) else (low, middle)
    return low


def closed_length(eccentricity, width):
    return min(width, 3 * (width / 2 - abs(eccentricity)))


def rotation(eccentricity, force, stiffness, width):
    """Of rigid faces, by the pressure between them; None: the force is beyond the end."""
    e = abs(eccentricity)
    if e >= width / 2:
        return None
    closed = closed_length(e, width)
    turn = 12 * force * e / (stiffness * width**3) if e <= width / 6 else 2 * force / (stiffness * closed**2)
    return math.copysign(turn, eccentricity)


def leaning(share, force, stiffness):
    """Turn and largest closure of a block of 1 m, with the force at its top: as the block turns, the force moves away from its middle."""
    turn = 0.0
    for _ in range(200):
        turn = rotation(share + turn, force, stiffness, 1.0)
    middle = force / stiffness
    e = share + turn
    return turn, middle * (1 + 6 * e) if e <= 1 / 6 else turn * 3 * (0.5 - e)


def eccentric():
    scenario(
        "eccentric_joint", title="A rigid block on a soft joint, with a load beside its middle", gravity=(0.0, 0.0), step=0.05, rock=RIGID,
        joints="friction = 30.0\nnormal_stiffness = 1.0e8",
        blocks=[("base", box(-1, -1, 3, 1), FIXED), ("block", box(0, 0, 1, 1), "")],
        histories=[("left", "block", (0.0, 0.0)), ("right", "block", (1.0, 0.0))],
        extra='[[load]]\nblock = "block"\nfrom = [0.0, 1.0]\nto = [1.0, 1.0]\ntraction = [0.0, -500.0]\ntraction_end = [0.0, -1500.0]\n\n',
        stages=EXACT,
    )
    shares = (1 / 12, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45)
    text = ""
    for what, more in (
        ("", "orders = [1, 2, 3]\n"),
        (", more contacts", 'vary = { "solver.face_contacts" = [3, 5, 9] }\n'),
        (", every solver", 'vary = { "solver.linear" = ["block", "direct", "iterative"] }\n'),
    ):
        text += f'\n[[run]]\nname = "eccentric load{what}"\nscenario = "scenarios/eccentric_joint.toml"\n{more}[run.points]\n'
        text += 'keys = ["load.0.traction", "load.0.traction_end"]\nlabels = [' + ", ".join(f'"e {e:.4g} b"' for e in shares) + "]\n"
        text += "values = [" + ", ".join(f"[{point((0, -1e3 * (1 - 6 * e)))}, {point((0, -1e3 * (1 + 6 * e)))}]" for e in shares) + "]\n"
        turns, closed = zip(*(leaning(e, 1e3, 1e8) for e in shares))
        text += quantity("turn of the block", "end('left.uy') - end('right.uy')", "rad", expected_by_point=f"[{', '.join(f'{t:.9e}' for t in turns)}]", tolerance=1e-3)
        text += quantity("closure at the end that is pressed", "-end('right.uy')", "m", expected_by_point=f"[{', '.join(f'{c:.9e}' for c in closed)}]", tolerance=1e-3)
    return text


def cracks():
    scenario(
        "bond_in_bending", title="A rigid block on a bonded joint, bent until it breaks", gravity=(0.0, 0.0), step=0.005, rock=RIGID,
        joints="friction = 30.0\ncohesion = 1.0e6\ntension = 6.0e4\nnormal_stiffness = 1.0e9",
        blocks=[("base", box(-1, -1, 3, 1), FIXED), ("block", box(0, 0, 1, 1), "")],
        histories=[("left", "block", (0.0, 0.0))],
        extra='[[load]]\nblock = "block"\nfrom = [0.0, 1.0]\nto = [1.0, 1.0]\ntraction = [0.0, 6000.0]\ntraction_end = [0.0, -6000.0]\ntime = [[0.0, 0.0], [20.0, 20.0]]\n\n',
        stages='[[stage]]\nname = "bend"\nkind = "rest"\nduration = 15.0\n',
    )
    text = '\n[[run]]\nname = "bond in bending"\nscenario = "scenarios/bond_in_bending.toml"\norders = [1]\n'
    return text + quantity("moment at which it breaks", "1e3*crossing('left.vy', 5e-4)", "N m/m", expected="6e4/6", tolerance=2e-3)


def piers():
    scenario(
        "soft_pier", title="A pier of eight blocks on soft joints", step=0.002, rock='density = 2500.0\nyoung = 5.0e9\npoisson = 0.2\nstate = "plane-strain"',
        joints="friction = 35.0\nnormal_stiffness = 1.0e8",
        blocks=[("floor", box(-3, -1, 7, 1), FIXED)] + [(f"b{k}", box(0, 0.5 * k, 1, 0.5), "") for k in range(8)], stages=SETTLE,
    )
    text = ""
    for what, share, moving in (("stands", 0.995, {"at_most": 0}), ("falls", 1.005, {"at_least": 1})):
        text += f'\n[[run]]\nname = "a pier on soft joints: {what}"\nscenario = "scenarios/soft_pier.toml"\n[run.points]\nkeys = ["joints.normal_stiffness", "gravity"]\n'
        tilts = {k: math.radians(share * limit) for k, limit in PIERS.items()}
        text += "labels = [" + ", ".join(f'"{k:.0e} Pa/m, {share} of {limit}°"' for k, limit in PIERS.items()) + "]\n"
        text += "values = [" + ", ".join(f"[{number(k)}, {point((G * math.sin(a), -G * math.cos(a)))}]" for k, a in tilts.items()) + "]\n"
        text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
        text += quantity("out of balance, of the others", "summary('stages.0.equilibrium.worst_residual_ratio')", at_most=1e-4)
    return text


def tilted_block(degrees, stiffness, level, size=10.0, weight=2e6):
    """Closure of the toe and turn of a rigid square block on a tilted plane, the joint closed over the part c at the toe: c²/2 k tan(turn) is the load across,
    which acts at c/3, and the weight where the turn has brought it. The shear acts at a share `level` of the way from the tip back to the plane.
    None: there is no equilibrium."""
    across, along = weight * math.cos(math.radians(degrees)), weight * math.sin(math.radians(degrees))

    def moment(turn):
        closed = math.sqrt(2 * across / (stiffness * math.tan(turn)))
        right = (math.sin(turn) - math.cos(turn)) * size / 2
        up = (math.sin(turn) + math.cos(turn)) * size / 2 - level * closed * math.tan(turn)
        return -right * across - up * along - closed / 3 * across

    # It restores above the smallest turn at which it is zero; the whole face closes below the first.
    first = math.atan(2 * across / (stiffness * size**2))
    turns = [first * 1.001**k for k in range(8000) if first * 1.001**k < 0.3]
    beyond = next((k for k, turn in enumerate(turns) if moment(turn) > 0), None)
    if beyond is None:
        return None
    low, high = turns[beyond - 1], turns[beyond]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if moment(middle) < 0 else (low, middle)
    return math.sqrt(2 * across * math.tan(low) / stiffness), low


def tilted():
    """Where the shear acts, at the tip or at the plane, is the width of what is known by hand."""
    scenario(
        "tilted_block", title="A square block on a tilted plane, on a soft joint", gravity=(5.0, -8.660254037844386), step=0.005,
        rock='density = 2000.0\nyoung = 1.0e11\npoisson = 0.2\nstate = "plane-strain"', joints="friction = 60.0\nnormal_stiffness = 1.0e7\nshear_stiffness = 1.0e7",
        blocks=[("floor", box(-30, -10, 70, 10), FIXED), ("block", box(0, 0, 10, 10), "")],
        histories=[("toe", "block", (10.0, 0.0)), ("heel", "block", (0.0, 0.0))], stages=SETTLE,
    )
    text, keys = "", '"gravity", "joints.normal_stiffness", "joints.shear_stiffness"'
    stands = [(30, 1e7), (30, 1e8), (30, 1e9), (40, 1e9)]

    def points(cases, orders):
        labels = ", ".join(f'"{a}°, {k:.0e} Pa/m"' for a, k in cases)
        values = ", ".join(f"[{point((10 * math.sin(math.radians(a)), -10 * math.cos(math.radians(a))))}, {number(k)}, {number(k)}]" for a, k in cases)
        return f'scenario = "scenarios/tilted_block.toml"\norders = {orders}\n[run.points]\nkeys = [{keys}]\nlabels = [{labels}]\nvalues = [{values}]\n'

    ends = [[tilted_block(a, k, level) for level in (0.0, 1.0)] for a, k in stands]
    text += '\n[[run]]\nname = "a block on a tilted plane"\n' + points(stands, [1, 2, 3])
    for what, place, value, unit in (("closure at the toe", 0, "-end('toe.uy')", "m"), ("turn of the block", 1, "atan2(end('heel.uy') - end('toe.uy'), 10)", "rad")):
        middle = [0.5 * (one[0][place] + one[1][place]) for one in ends]
        width = max(abs(one[0][place] - one[1][place]) / (2 * m) for one, m in zip(ends, middle))
        text += quantity(what, value, unit, expected_by_point=f"[{', '.join(f'{m:.9e}' for m in middle)}]", tolerance=round(width + 1e-3, 4))
    text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", at_most=0)
    assert tilted_block(40, 3.4e7, 0.0) is None and tilted_block(40, 3.4e7, 1.0) is None and None not in (tilted_block(40, 4.1e7, 0.0), tilted_block(40, 4.1e7, 1.0))
    for what, cases, moving in (("stands", [(40, 4.1e7)], {"at_most": 0}), ("tips", [(40, 1e7), (40, 3.4e7)], {"at_least": 1})):
        text += f'\n[[run]]\nname = "a block on a tilted plane {what}"\n' + points(cases, [1, 3])
        text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
    return text


def prestressed():
    scenario(
        "prestressed_joint", title="Joints that stress has closed, and a wall that moves away", gravity=(0.0, 0.0), step=0.001,
        rock='density = 2500.0\nyoung = 1.0e10\npoisson = 0.0\nstate = "plane-strain"', joints="friction = 60.0\nnormal_stiffness = 1.0e8",
        blocks=[
            ("left", box(-1, -0.5, 1, 2), FIXED), ("block", box(0, 0, 1, 1), ""),
            ("right", box(1, -0.5, 1, 2), FIXED + "motion = { x = [[0.0, 0.0], [1.0, 0.004], [3.0, 0.004]] }\n"),
        ],
        histories=[("middle", "block", (0.5, 0.5))], extra="[in_situ]\nsxx = -1.0e6\nsyy = 0.0\n\n", stages='[[stage]]\nname = "relax"\nkind = "rest"\nduration = 2.0\n',
    )
    ways = (0.0028, 0.0032, 0.004, 0.008, 0.016)
    text = '\n[[run]]\nname = "a joint that stress has closed relaxes"\nscenario = "scenarios/prestressed_joint.toml"\norders = [1, 2, 3]\n[run.points]\nkeys = ["block.right.motion.x"]\n'
    text += "labels = [" + ", ".join(f'"wall {1e3 * w:g} mm away"' for w in ways) + "]\n"
    text += "values = [" + ", ".join(f"[[[0.0, 0.0], [1.0, {w}], [3.0, {w}]]]" for w in ways) + "]\n"
    # Two joints and the rock between them, in a row: 1 MPa less w over their compliances.
    expected = ", ".join(f"{-1e6 + w / (2 / 1e8 + 1 / 1e10):.6e}" for w in ways)
    return text + quantity("stress of the block", "end('middle.sxx')", "Pa", expected_by_point=f"[{expected}]", tolerance=5e-3)


def corners():
    text = ""
    for name, angle, slender in (("25", 25.0, 1 / 30), ("40", 40.0, 0.2)):
        s, c, length = math.sin(math.radians(angle)), math.cos(math.radians(angle)), 6.0
        thick = slender * length
        foot, head = (-length * s, 0.0), (0.0, length * c)
        left = [foot, head, (head[0] - thick * c, head[1] + thick * s), (foot[0] - thick * c, foot[1] + thick * s)]
        right = [(-x, y) for x, y in reversed(left)]
        tangent = 0.5 * (s / c - slender)
        scenario(
            f"corner_to_corner_{name}", title=f"Two blocks that lean on each other by their corners, {name} degrees from upright",
            rock='density = 2600.0\nyoung = 5.0e10\npoisson = 0.2\nstate = "plane-stress"', joints="friction = 30.0", step=0.002,
            blocks=[("floor", box(-8, -1, 16, 1), FIXED), ("left", left, ""), ("right", right, "")], stages=SETTLE,
        )
        for what, share, moving in (("stands", 1.01, {"at_most": 0}), ("slides", 0.99, {"at_least": 1})):
            text += f'\n[[run]]\nname = "corner to corner, {name}°: {what}"\nscenario = "scenarios/corner_to_corner_{name}.toml"\nset = ["joints.friction={math.degrees(math.atan(share * tangent)):.9f}"]\n'
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
    return text


def sliding():
    tilt, width, height = 25.0, 0.8, 1.0
    s, c = math.sin(math.radians(tilt)), math.cos(math.radians(tilt))
    scenario(
        "sliding_on_open_heel", title="A block on a tilted base, whose joint is open at the heel", gravity=(G * s, -G * c), rock=RIGID,
        joints="friction = 30.0\nnormal_stiffness = 1.0e9", step=0.002, blocks=[("base", box(-1, -1, 4, 1), FIXED), ("block", box(0, 0, width, height), "")],
        stages=SETTLE,
    )
    # It would tip at tan(tilt) = width/height; from a third of that on the heel is open.
    assert width / height / 3 < s / c < width / height
    text = ""
    for what, share, moving in (("stands", 1.005, {"at_most": 0}), ("slides", 0.995, {"at_least": 1})):
        for kind, ways in (
            ("", 'orders = [1, 2]\nvary = { "solver.face_contacts" = [2, 3, 5], "joints.normal_stiffness" = [1.0e9, 1.0e10] }\n'),
            (", order 3", 'orders = [3]\nvary = { "joints.normal_stiffness" = [1.0e9, 1.0e10] }\n'),
        ):
            text += f'\n[[run]]\nname = "sliding on an open heel{kind}: {what}"\nscenario = "scenarios/sliding_on_open_heel.toml"\n'
            text += f'set = ["joints.friction={math.degrees(math.atan(share * s / c)):.9f}"]\n{ways}'
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **moving)
    return text


def joint_pressure():
    text = '''title = "Pressure along joints"
case  = 41
about = """Joints of given stiffness k, at default settings. A rigid block of width b with a load e beside its middle: the pressure is a trapezium up to e = b/6, then a triangle of length 3 (b/2 − e), whatever the order and the number of contacts. A bond of strength t that is bent breaks at t b²/6. A pier of eight blocks on such joints falls at a tilt that an independent computation of rigid blocks gives (verification/joint_pressure.py), 0.5 % either side. A square block on a tilted plane leans over until the pressure of its joint bears it, or tips. A joint that in-situ stress has closed by 10 mm and a wall that moves away relaxes by what two joints and the rock between them give in a row. Two blocks that lean on each other corner to corner, θ from upright: the force between them is level, and their feet need a friction of ½ (tan θ − thickness/length), 1 % either side. A block on a tilted base whose joint is open at the heel slides at the friction of the tilt, 0.5 % either side."""
'''
    case("joint_pressure", text + eccentric() + cracks() + piers() + tilted() + prestressed() + corners() + sliding())
