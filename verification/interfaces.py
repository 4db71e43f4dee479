"""Case 47, joints of their own between two blocks, as generate.py writes it."""

import math

from case_text import FIXED, G, box, case, number, point, quantity, scenario
from water import PLANES, ROCK, SETTLE, WAYS, WEIGHT, at_limit, table, tangent


def interface(one, other, keys):
    return f'[[interface]]\nbetween = ["{one}", "{other}"]\n{keys}\n\n'


def plane_failures():
    """S2: plane failures with a tension crack. The plane has cohesion and friction, the crack behind it neither: it is a joint that is closed."""
    text = ""
    for k, (height, face, dip, cohesion, friction, behind) in PLANES.items():
        f, p = math.radians(face), math.radians(dip)
        x = height / math.tan(f) + behind
        y, length = x * math.tan(p), x / math.cos(p)
        crack = height - y
        ring = [(0, 0), (x, y), (x, height), (height / math.tan(f), height)]
        area = 0.5 * abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1], strict=True)))
        blocks = [
            ("base", [(0, -10), (x + 30, -10), (x + 30, y), (x, y), (0, 0)], FIXED), ("wall", box(x, y, 30, crack), FIXED), ("slope", ring, ""),
        ]  # fmt: skip
        plane = f"friction = {friction}.0\ncohesion = {cohesion}\nresidual_cohesion = {cohesion}"
        for water, full, dry in (("dry", 0.0, False), ("crack half full", 0.5, False), ("crack full", 1.0, False), ("crack full, plane dry", 1.0, True)):
            head = full * crack
            uplift, thrust = 0.0 if dry else 0.5 * WEIGHT * head * length, 0.5 * WEIGHT * head * head
            normal = 26e3 * area * math.cos(p) - uplift - thrust * math.sin(p)
            factor = (cohesion * length + normal * tangent(friction)) / (26e3 * area * math.sin(p) + thrust * math.cos(p))
            name = f"interface_plane_{k}_{round(2 * full)}{'_dry' if dry else ''}"
            joints = interface("slope", "base", plane + ("\ndry = true" if dry else "")) + interface("wall", "slope", "friction = 0.0\ncohesion = 0.0")
            scenario(
                name, title=f"At the limit: a plane failure with a crack behind it, {water}", rock=ROCK.format(number(26e3 / G)), step=0.005,
                joints="friction = 20.0\ncohesion = 1.0e6", blocks=blocks, extra=joints + (table([(0, 0), (x, y + head)]) if full else ""), stages=SETTLE,
            )  # fmt: skip
            text += at_limit(f"plane failure {k}, {water}, F = {factor:.6f}", name, factor)
    return text


# Weights of the upper and lower block, dip, friction of each on the plane.
PAIRS = [(500e3, 300e3, 30, 25, 40), (800e3, 400e3, 20, 15, 30)]


def pairs():
    """S3b: two blocks on one plane, the upper one with less friction. They hold each other: F = (W1 tan φ1 + W2 tan φ2)/((W1 + W2) tan α)."""
    text = ""
    for k, (upper, lower, dip, slippery, rough) in enumerate(PAIRS):
        a = math.radians(dip)

        def turned(ring, a=a):
            return [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)) for x, y in ring]

        high, weight = 2.0, 25e3
        one, other = upper / (weight * high), lower / (weight * high)
        factor = (upper * tangent(slippery) + lower * tangent(rough)) / ((upper + lower) * tangent(dip))
        scenario(
            f"interface_pair_{k}", title=f"At the limit: two blocks on a plane of {dip}°, each with friction of its own", rock=ROCK.format(number(weight / G)), step=0.005,
            joints="friction = 0.0",
            blocks=[("base", turned(box(-10, -2, one + other + 20, 2)), FIXED), ("lower", turned(box(0, 0, other, high)), ""), ("upper", turned(box(other, 0, one, high)), "")],
            extra=interface("upper", "base", f"friction = {slippery}.0") + interface("lower", "base", f"friction = {rough}.0"), stages=SETTLE,
        )  # fmt: skip
        text += at_limit(f"two blocks on a plane of {dip}°, F = {factor:.6f}", f"interface_pair_{k}", factor)
    return text


# Cohesion and friction at the peak, angle of the joint to the horizontal, cohesion and friction that are left; MPa, degrees.
JOINTS = [(1.0, 30, 60, 0.0, 30), (2.0, 35, 55, 0.0, 25), (0.5, 20, 45, 0.1, 20), (1.0, 40, 70, 0.0, 35)]


def compression():
    """F1: a specimen across a bonded joint, pressed: σ = c/(sin β cos β − cos² β tan φ) (Jaeger), 0.5 % either side."""
    text = ""
    for k, (cohesion, friction, angle, left, residual) in enumerate(JOINTS):
        b = math.radians(angle)
        stress = 1e6 * cohesion / (math.sin(b) * math.cos(b) - math.cos(b) ** 2 * tangent(friction))
        low = 1.0
        rise = math.tan(b)
        top = low + rise + 1.0
        load = f'[[load]]\nblock = "upper"\nfrom = [1.0, {number(top)}]\nto = [0.0, {number(top)}]\ntraction = [0.0, {number(-stress)}]\n\n'
        keys = f"friction = {friction}.0\ncohesion = {number(1e6 * cohesion)}\nresidual_friction = {residual}.0\nresidual_cohesion = {number(1e6 * left)}\nweakening_slip = 0.001"
        scenario(
            f"interface_compression_{k}", title=f"A bonded joint at {angle}°, pressed", rock=ROCK.format(2600.0).replace("poisson = 0.2", "poisson = 0.0"), step=0.005, gravity=(0.0, 0.0), joints="friction = 0.0",
            blocks=[("plate", box(-1, -1, 3, 1), FIXED), ("lower", [(0, 0), (1, 0), (1, low + rise), (0, low)], ""),
                    ("upper", [(0, low), (1, low + rise), (1, top), (0, top)], "")],
            extra=interface("lower", "upper", keys) + interface("plate", "lower", "friction = 80.0") + load, stages=SETTLE,
        )  # fmt: skip
        for side, share, bound in (("stands", 0.995, {"at_most": 0}), ("moves", 1.005, {"at_least": 1})):
            text += f'\n[[run]]\nname = "bonded joint at {angle}° under {stress / 1e6:.5f} MPa: {side}"\nscenario = "scenarios/interface_compression_{k}.toml"\n'
            text += f'set = ["load_factor={share}"]\n{WAYS}'
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **bound)
    return text


def interfaces():
    about = (
        "Joints between two blocks that have properties of their own. Hoek and Bray's plane failures of case 46 with the crack as a closed joint without strength; water in all joints, "
        "or in the crack alone. Two blocks on one plane, each with friction of its own, which hold each other: F = (W1 tan φ1 + W2 tan φ2)/((W1 + W2) tan α). "
        "A bonded joint under compression at an angle (Jaeger 1960): σ = c/(sin β cos β − cos² β tan φ), at 0.5 % from the limit; all others at 0.1 %. At every order and number of contacts. "
        "[joints] has another strength throughout."
    )
    case("interfaces", f'title = "Joints between two blocks"\ncase  = 47\nabout = """{about}"""\n' + plane_failures() + pairs() + compression())
