"""Case 44, joints whose strength falls with slip, as generate.py writes it."""

import math

from case_text import FIXED, G, box, case, number, point, quantity, scenario

ROCK = 'density = 2600.0\nyoung = 5.0e10\npoisson = 0.2\nstate = "plane-strain"'
SETTLE = '[[stage]]\nname = "settle"\nkind = "settle"\n'
# Peak and residual friction, degrees, slip of weakening, m, dip, degrees.
FALLS = [(30, 29.5, 25, 0.02), (35, 34, 20, 0.05), (25, 24, 15, 0.1), (40, 38, 30, 0.01)]


def tilted(angle):
    return (-G * math.sin(math.radians(angle)), -G * math.cos(math.radians(angle)))


def tangent(angle):
    return math.tan(math.radians(angle))


def way(dip, peak, residual, slip, time=1.0):
    """m, and J/kg of friction: x'' = A + B x until x is the slip of weakening, then a constant acceleration."""
    s, c = G * math.sin(math.radians(dip)), G * math.cos(math.radians(dip))
    a, b = s - c * tangent(peak), c * (tangent(peak) - tangent(residual)) / slip
    rate = math.sqrt(b)
    if a / b * (math.cosh(rate * time) - 1) < slip:
        x = a / b * (math.cosh(rate * time) - 1)
        return x, c * (tangent(peak) * x - 0.5 * (tangent(peak) - tangent(residual)) / slip * x * x)
    until = math.acosh(1 + slip * b / a) / rate
    speed = a / rate * math.sinh(rate * until)
    x = slip + speed * (time - until) + 0.5 * (s - c * tangent(residual)) * (time - until) ** 2
    return x, c * (0.5 * (tangent(peak) + tangent(residual)) * slip + tangent(residual) * (x - slip))


def strength_gone(dip, peak, residual, slip):
    """s: x has come to the slip of weakening."""
    s, c = G * math.sin(math.radians(dip)), G * math.cos(math.radians(dip))
    a, b = s - c * tangent(peak), c * (tangent(peak) - tangent(residual)) / slip
    return math.acosh(1 + slip * b / a) / math.sqrt(b)


def sliding(name, title, base, joints="friction = 30.0\nresidual_friction = 25.0\nweakening_slip = 0.02", width=4.0, height=0.4):
    """A block on an incline as gravity that is turned, held by a load that ends with the first stage."""
    load = (
        f'[[load]]\nblock = "block"\npoint = {point((width / 2, height / 2))}\nforce = [0.0, 0.0]\n'
        "time = [[0.0, 1.0], [1.0e-9, 0.0], [100.0, 0.0]]\n\n"
    )
    scenario(
        name, title=title, gravity=(0.0, -G), rock=ROCK, joints=joints, step=0.005, blocks=[*base, ("block", box(0, 0, width, height), "")],
        histories=[("block", "block", (width / 2, height / 2))], extra=load,
        stages=SETTLE + '\n[[stage]]\nname = "slide"\nkind = "rest"\nduration = 1.0\n',
    )


def slides(scenario_name, name, sets, width=4.0, height=0.4, tolerance=1e-3, orders=None, more=()):
    mass = 2600.0 * width * height
    values = [
        f"[{point(tilted(dip))}, {peak}, {residual}, {slip}, {point((mass * G * math.sin(math.radians(dip)), 0.0))}]"
        for dip, peak, residual, slip in sets
    ]
    labels = ", ".join(f'"{dip}°, φ {peak}° → {residual}° over {slip} m"' for dip, peak, residual, slip in sets)
    expected = [way(*one) for one in sets]
    text = f'\n[[run]]\nname = "{name}"\nscenario = "scenarios/{scenario_name}.toml"\n'
    if more:
        text += f"set = {list(more)}\n".replace("'", '"')
    if orders:
        text += f"orders = {orders}\n"
    text += 'points.keys = ["gravity", "joints.friction", "joints.residual_friction", "joints.weakening_slip", "load.0.force"]\n'
    text += f"points.values = [{', '.join(values)}]\npoints.labels = [{labels}]\n"
    if orders:
        text += quantity("way after 1 s", "-(end('block.ux') - after('settle', 'block.ux'))", "m", expected=number(expected[0][0]), tolerance=tolerance)
        return text
    text += quantity("way after 1 s", "-(end('block.ux') - after('settle', 'block.ux'))", "m",
                     expected_by_point=str([round(x, 6) for x, _ in expected]), tolerance=tolerance)  # fmt: skip
    text += quantity("work of friction, over the mass", f"summary('energy.friction')/{number(mass)}", "J/kg",
                     expected_by_point=str([round(w, 6) for _, w in expected]), tolerance=tolerance)  # fmt: skip
    if max(strength_gone(*one) for one in sets) > 1.0:
        return text
    # Events have the time of the end of their step.
    text += quantity("all strength that slip takes is gone", "summary('breaks.0.last_s')", "s",
                     expected_by_point=str([round(strength_gone(*one), 6) for one in sets]), tolerance=0.02)  # fmt: skip
    return text + quantity("joint that lost it", "summary('breaks.0.length_m')", "m", expected=number(width), tolerance=1e-6)


def hop():
    """A block that hops without slip keeps its peak strength; it is then pushed by 0.9 of it, which is more than the residual."""
    weight = 2600.0 * 4 * 0.4 * G
    loads = (
        f'[[load]]\nblock = "block"\npoint = [2.0, 0.2]\nforce = [0.0, {number(3 * weight)}]\n'
        "time = [[0.0, 0.0], [0.1, 0.0], [0.10005, 1.0], [0.1101, 1.0], [0.1102, 0.0], [10.0, 0.0]]\n\n"
        f'[[load]]\nblock = "block"\npoint = [2.0, 0.0]\nforce = [{number(0.9 * tangent(35) * weight)}, 0.0]\n'
        "time = [[0.0, 0.0], [0.8, 0.0], [1.0, 1.0], [10.0, 1.0]]\n\n"
    )
    scenario(
        "weakening_hop", title="A block that hops, and is pushed by 0.9 of its peak strength", rock=ROCK, step=0.001,
        joints="friction = 35.0\nresidual_friction = 25.0\nweakening_slip = 0.01",
        blocks=[("base", box(-12, -1, 24, 1), FIXED), ("block", box(0, 0, 4, 0.4), "")], histories=[("block", "block", (2, 0.2))],
        extra=loads, stages=SETTLE + '\n[[stage]]\nname = "hop"\nkind = "rest"\nduration = 2.0\n',
    )
    text = '\n[[run]]\nname = "a block that hops"\nscenario = "scenarios/weakening_hop.toml"\n'
    text += quantity("height of the hop", "max('block.uy')", "m", at_least=0.002)
    return text + quantity("slip at the end", "abs(end('block.ux'))", "m", at_most=1e-4)


def shear():
    """Direct shear through a spring of stiffness K, driven at a steady rate: peak cohesion and friction, then what is left."""
    sets = [(0.5e6, 40, 0.0, 30, 0.002, 1e6, 2e9, 1e9, 1.33910e6, 0.57735e6), (0.2e6, 35, 0.05e6, 28, 0.005, 0.4e6, 1e9, 0.5e9, 0.48008e6, 0.26268e6)]
    time, weight = 20.0, 2600.0 * 0.25 * G
    ends = (2.866025e-3, 5.788051e-3)
    text = ""
    for k, ((cohesion, friction, left, residual, slip, normal, ks, spring, peak, after), travel) in enumerate(zip(sets, ends, strict=True)):
        driven = 1.3 * travel
        extra = (
            f'[[support]]\nblock = "block"\npoints = [[1.0, 0.0]]\ndirections = ["x"]\nstiffness = {spring}\n'
            f"motion = {{ x = [[0.0, 0.0], [{time}, {driven}]] }}\n\n"
            f'[[load]]\nblock = "block"\nfrom = [1.0, 0.25]\nto = [0.0, 0.25]\ntraction = [0.0, {number(weight - normal)}]\n\n'
        )
        scenario(
            f"weakening_shear_{k}", title="Direct shear of a joint that weakens", step=0.005,
            rock='density = 2600.0\nyoung = 1.0e12\npoisson = 0.2\nstate = "plane-strain"',
            joints=f"friction = {friction}\ncohesion = {cohesion}\nresidual_friction = {residual}\nresidual_cohesion = {left}\n"
            f"weakening_slip = {slip}\nnormal_stiffness = {2.5 * ks}\nshear_stiffness = {ks}",
            blocks=[("base", box(-1, -0.5, 3, 0.5), FIXED), ("block", box(0, 0, 1, 0.25), "")], histories=[("block", "block", (1, 0))],
            extra=extra, stages=SETTLE + f'\n[[stage]]\nname = "shear"\nkind = "rest"\nduration = {time}\n',
        )  # fmt: skip
        text += f'\n[[run]]\nname = "direct shear, c {cohesion / 1e6:g} MPa, φ {friction}°"\nscenario = "scenarios/weakening_shear_{k}.toml"\n'
        text += quantity("residual stress", f"{spring}*({driven} - end('block.ux'))", "Pa", expected=number(after), tolerance=1e-3)
        text += quantity("stress where the peak is passed", f"{spring}*({driven}*crossing('block.ux', {number(peak / ks * 1.02)})/{time} - {number(peak / ks * 1.02)})", "Pa",
                         at_most=number(1.002 * peak))  # fmt: skip
    return text


def plane_failures():
    """Ideal plasticity: F = (c A + W cos α tan φ)/(W sin α), whatever the number of contacts and the order of the block."""
    blocks = [(35, 30, 5e3, 2.0, 0.98), (40, 32, 20e3, 3.0, 2.3526)]
    text = ""
    for k, (dip, friction, cohesion, length, height) in enumerate(blocks):
        a, weight = math.radians(dip), 2600.0 * length * height * G
        factor = (cohesion * length + weight * math.cos(a) * tangent(friction)) / (weight * math.sin(a))
        scenario(
            f"cohesive_slide_{k}", title=f"At the limit: a block with cohesion on a plane of {dip}°", gravity=tilted(dip), rock=ROCK, step=0.005,
            joints=f"friction = {friction}\ncohesion = {cohesion}\nresidual_cohesion = {cohesion}",
            blocks=[("base", box(-10, -1, 20, 1), FIXED), ("block", box(-length / 2, 0, length, height), "")], stages=SETTLE,
        )
        for side, share, bound in (("stands", 0.998, "at_most"), ("moves", 1.002, "at_least")):
            text += (
                f'\n[[run]]\nname = "plane of {dip}°, c {cohesion / 1e3:g} kPa: {side}"\nscenario = "scenarios/cohesive_slide_{k}.toml"\n'
                f'set = ["joints.strength_factor={share * factor:.9f}"]\norders = [1, 2, 3]\nvary = {{ "solver.face_contacts" = [2, 3, 9] }}\n'
            )
            text += quantity("blocks that move", "summary('stages.0.equilibrium.moving_blocks')", **{bound: 0 if side == "stands" else 1})
    return text


def weakening():
    floor = [("base", box(-12, -1, 20, 1), FIXED)]
    pieces = [("base0", box(-12, -1, 12 - 0.9, 1), FIXED)]
    pieces += [(f"base{k + 1}", box(-0.9 + 0.13 * k, -1, 0.13, 1), FIXED) for k in range(12)] + [("base13", box(0.66, -1, 6, 1), FIXED)]
    sliding("weakening_slide", "A block on an incline that weakens", floor)
    sliding("weakening_short", "A short block on an incline with joints that weakens", pieces, width=0.4, height=0.05)
    text = 'title = "Joints whose strength falls with slip"\ncase  = 44\nabout = """A block on an incline is let go. Its friction falls in a straight line with slip: x\'\' = g sin α − g cos α (μ_p − (μ_p − μ_r) x/d_c), in closed form. A short block does so over joints in its base. A block that hops without slip keeps its peak strength. Direct shear through a spring: what is left of the strength of a joint with cohesion. Blocks with cohesion on planes, at 0.2 % from limit equilibrium, with residual cohesion equal to cohesion: the factor of safety is (c A + W cos α tan φ)/(W sin α) for any number of contacts and any order."""\n'
    text += slides("weakening_slide", "weakening by slip", FALLS)
    text += slides("weakening_slide", "weakening by slip, orders", FALLS[:1], orders=[1, 2, 3])
    text += slides("weakening_slide", "weakening by slip, soft joints", FALLS, more=["joints.normal_stiffness=1e10"])
    text += slides("weakening_slide", "weakening by slip, generalized-alpha", FALLS, more=["solver.integrator=generalized-alpha"], tolerance=2e-3)
    text += slides("weakening_short", "short block over short joints", [(25, 24, 15, 0.3)], width=0.4, height=0.05)
    case("weakening", text + hop() + shear() + plane_failures())
