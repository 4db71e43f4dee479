"""Case 46, water in joints and around blocks, as generate.py writes it."""

import math

from case_text import FIXED, FILES, G, NOTE, box, case, number, point, quantity, scenario

ROCK = 'density = {}\nyoung = 5.0e10\npoisson = 0.2\nstate = "plane-strain"'
SETTLE = '[[stage]]\nname = "settle"\nkind = "settle"\n'
WEIGHT = 1000.0 * G
# Every way of meeting: orders of blocks, contacts per face.
WAYS = 'orders = [1, 2, 3]\nvary = { "solver.face_contacts" = [2, 3, 9] }\n'


def tangent(angle):
    return math.tan(math.radians(angle))


def table(points):
    return "[water]\ntable = [" + ", ".join(point(p) for p in points) + "]\n\n"


def at_limit(name, scenario_name, factor, more=""):
    """0.1 % below its factor of safety a model stands, 0.1 % above it moves."""
    text = ""
    for side, share, bound in (("stands", 0.999, {"at_most": 0}), ("moves", 1.001, {"at_least": 1})):
        text += f'\n[[run]]\nname = "{name}: {side}"\nscenario = "scenarios/{scenario_name}.toml"\nset = ["joints.strength_factor={share * factor:.9f}"{more}]\n{WAYS}'
        text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **bound)
    return text


# Height, angles of face and plane, cohesion, friction, distance of the crack behind the crest (Hoek & Bray 1981).
PLANES = {1: (20, 60, 35, 25e3, 30, 4), 3: (12, 75, 30, 0.0, 35, 3)}


def plane_failures():
    """S2: plane failures with a tension crack, dry, with the crack half full, and full. The crack is a joint, or a gap of 5 cm."""
    text = ""
    for k, (height, face, dip, cohesion, friction, behind) in PLANES.items():
        f, p = math.radians(face), math.radians(dip)
        x = height / math.tan(f) + behind
        y, gap = x * math.tan(p), 0.05 if cohesion > 0 else 0.0
        crack, length = height - y, x / math.cos(p)
        ring = [(0, 0), (x, y), (x, height), (height / math.tan(f), height)]
        area = 0.5 * abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)))
        wall = [(x + gap, height), (x + gap, y), (x, y)] if gap else [(x, height), (x, y)]
        base = [(0, -10), (x + 30, -10), (x + 30, height), *wall, (0, 0)]
        for water, full, push in (("dry", 0.0, 0.0), ("crack half full", 0.5, 0.0), ("crack full", 1.0, 0.0), ("crack full, k_h 0.1", 1.0, 0.1)):
            if push and not gap:
                continue  # the normal force would lie outside of the plane: that slope tips before it slides
            head = full * crack
            uplift, thrust = 0.5 * WEIGHT * head * length, 0.5 * WEIGHT * head * head
            normal = 26e3 * area * (math.cos(p) - push * math.sin(p)) - uplift - thrust * math.sin(p)
            driving = 26e3 * area * (math.sin(p) + push * math.cos(p)) + thrust * math.cos(p)
            factor = (cohesion * length + normal * tangent(friction)) / driving
            name = f"water_plane_{k}_{round(2 * full)}"
            joints = f"friction = {friction}" + (f"\ncohesion = {cohesion}\nresidual_cohesion = {cohesion}" if cohesion else "")
            scenario(
                name, title=f"At the limit: a plane failure with a tension crack, {water.split(chr(44))[0]}", rock=ROCK.format(number(26e3 / G)), step=0.005,
                joints=joints, blocks=[("base", base, FIXED), ("slope", ring, "")], extra=table([(0, 0), (x, y + head)]) if full else "", stages=SETTLE,
            )  # fmt: skip
            text += at_limit(f"plane failure {k}, {water}, F = {factor:.6f}", name, factor, f', "stage.settle.k_h={-push}"' if push else "")
    return text


def dam():
    """S5: a wall with headwater and uplift below it. Beyond its limit it does not come to stand by sliding out of its uplift."""
    width, height, head, friction = 16.0, 20.0, 18.0, 30.0
    weight, uplift, thrust = 2400 * width * height * G, 0.5 * WEIGHT * head * width, 0.5 * WEIGHT * head**2
    factor = tangent(friction) * (weight - uplift) / thrust
    scenario(
        "water_dam", title="At the limit: a dam with uplift", rock=ROCK.format("2400.0"), step=0.005, joints=f"friction = {friction}",
        blocks=[("base", box(-10, -3, 36, 3), FIXED), ("dam", box(0, 0, width, height), "")], extra=table([(0, head), (width, 0)]), stages=SETTLE,
    )  # fmt: skip
    text = at_limit(f"dam with uplift, F = {factor:.6f}", "water_dam", factor)
    text += f'\n[[run]]\nname = "dam, 3 % beyond its limit"\nscenario = "scenarios/water_dam.toml"\nset = ["joints.strength_factor=2.3"]\n{WAYS}'
    text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", at_least=1)
    text += '\n[[run]]\nname = "dam: forces of its water"\nscenario = "scenarios/water_dam.toml"\n' + WAYS
    text += quantity("thrust", "summary('water.forces.1.force_n_m.0')", "N/m", expected=number(thrust), tolerance=1e-4)
    text += quantity("uplift", "summary('water.forces.1.force_n_m.1')", "N/m", expected=number(uplift), tolerance=1e-4)
    text += quantity("largest pressure", "summary('water.largest_pressure_pa')", "Pa", expected=number(WEIGHT * head), tolerance=1e-9)
    return text


def submerged():
    """S6: a block under water on a plane. It weighs less, and its factor of safety is that of the dry block."""
    a = math.radians(30)

    def turned(ring):
        return [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)) for x, y in ring]

    scenario(
        "water_submerged", title="At the limit: a block under water on a plane of 30°", rock=ROCK.format("2600.0"), step=0.005, joints="friction = 35.0",
        blocks=[("base", turned(box(-10, -1, 20, 1)), FIXED), ("block", turned(box(-0.5, 0, 1, 1)), "")], extra="[water]\nhead = 30.0\n\n", stages=SETTLE,
    )  # fmt: skip
    factor = tangent(35) / tangent(30)
    text = at_limit(f"block under water, F = {factor:.6f}", "water_submerged", factor)
    text += '\n[[run]]\nname = "block under water: buoyancy"\nscenario = "scenarios/water_submerged.toml"\n' + WAYS
    return text + quantity("force of the water", "summary('water.forces.1.force_n_m.1')", "N/m", expected=number(WEIGHT), tolerance=1e-5)


# Dip, friction, length, height, density, largest pressure in the base.
BASES = [(25, 40, 4.0, 2.0, 2600.0, 20e3), (30, 45, 5.0, 3.0, 2600.0, 40e3), (15, 35, 2.0, 1.0, 2500.0, 10e3)]


def base_joints():
    """S7: water in the joint below a block, falling from a pressure to nothing downhill. What stood around the block is taken out and drained."""
    text = ""
    for k, (dip, friction, length, height, density, pressure) in enumerate(BASES):
        a = math.radians(dip)

        def turned(ring, a=a):
            return [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)) for x, y in ring]

        weight = density * length * height * G
        factor = (weight * math.cos(a) - 0.5 * pressure * length) * tangent(friction) / (weight * math.sin(a))
        around = {"left": box(-2, 0, 2, height), "right": box(length, 0, 2, height)}
        (low, high) = turned([(0, 0), (length, 0)])
        openings = "".join(
            f'[[excavation]]\nname = "{name}"\nshape = "polygon"\nouter = [{", ".join(point(p) for p in turned(ring))}]\nfilled = false\n\n'
            for name, ring in (*around.items(), ("top", box(-2, height, length + 4, 1)))
        )
        scenario(
            f"water_base_{k}", title=f"At the limit: water in the joint below a block, on a plane of {dip}°", rock=ROCK.format(density), step=0.005,
            joints=f"friction = {friction}",
            blocks=[("base", turned(box(-10, -2, 20 + length, 2)), FIXED), ("block", turned(box(0, 0, length, height)), "")]
            + [(name, turned(ring), "") for name, ring in around.items()] + [("top", turned(box(-2, height, length + 4, 1)), "")],
            extra=table([(low[0], low[1]), (high[0], high[1] + pressure / WEIGHT)]) + openings,
            stages=SETTLE + 'excavate = ["left", "right", "top"]\n',
        )  # fmt: skip
        text += at_limit(f"water in the base joint, plane of {dip}°, F = {factor:.6f}", f"water_base_{k}", factor)
    return text


def rising():
    """A block half as heavy as the water around it rises with g."""
    scenario(
        "water_rising", title="A block lighter than the water around it", rock=ROCK.format("500.0"), step=0.005, joints="friction = 30.0",
        blocks=[("base", box(-2, -1, 5, 1), FIXED), ("block", box(0, 1, 1, 1), "")], histories=[("block", "block", (0.5, 1.5))],
        extra="[water]\nhead = 5.0\n\n", stages='[[stage]]\nname = "rise"\nkind = "rest"\nduration = 0.5\n',
    )  # fmt: skip
    way = 0.5 * G * 0.25
    text = '\n[[run]]\nname = "a block lighter than water"\nscenario = "scenarios/water_rising.toml"\n' + WAYS
    text += quantity("way after 0.5 s", "end('block.uy')", "m", expected=number(way), tolerance=1e-4)
    text += quantity("work of the water, over way and force", f"summary('energy.water')/({number(WEIGHT)}*end('block.uy'))", expected=1, tolerance=1e-5)
    return text + quantity("energy residual", "summary('energy.residual_ratio')", at_most=1e-6)


def falling():
    """The key block of case 24 below a water table: water leaves the joints that open as it falls, and it falls with g."""
    text = FILES["scenarios/key_block.toml"].removeprefix(NOTE)
    text = text.replace("chords = 720", "chords = 720\nfilled = false").replace("duration = 1.5", "duration = 0.2")
    text = text.replace("[time]", '[water]\nhead = 14.0\n\n[[history]]\nname = "block"\npoint = [0.0, 2.9]\n\n[time]')
    FILES["scenarios/water_key_block.toml"] = NOTE + text
    run = '\n[[run]]\nname = "key block under water"\nscenario = "scenarios/water_key_block.toml"\n'
    run += quantity("speed after 0.2 s", "-end('block.vy')", "m/s", expected=number(0.2 * G), tolerance=0.01)
    run += quantity("energy residual", "summary('energy.residual_ratio')", at_most=1e-3)
    return run


def water():
    about = (
        "Water at rest presses on both faces of joints and on outside faces. Hoek and Bray's plane failures with a tension crack: F = (c A + (W cos ψ − U − V sin ψ) tan φ)/(W sin ψ + V cos ψ). "
        "A dam with uplift; a block under water, whose factor is that of the dry block; water in the joint below a block alone. All at 0.1 % from the limit, at every order and number of contacts. "
        "A block lighter than water rises with (ρ_w/ρ − 1) g. A key block falls out of wet rock with g, as water leaves joints that open."
    )
    text = f'title = "Water in joints"\ncase  = 46\nabout = """{about}"""\n'
    case("water", text + plane_failures() + dam() + submerged() + base_joints() + rising() + falling())
