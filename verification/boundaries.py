"""Case 34, seismic boundaries, as generate.py writes it."""

import math

from case_text import FILES, NOTE, box, case, number, point, quantity
from oblique_waves import oblique_waves

STRONG = "friction = 45.0\ncohesion = 1.0e12\ntension = 1.0e12\nnormal_stiffness = 1.0e13\nshear_stiffness = 1.0e13"
UNDAMPED = "[solver]\nrock_damping = 0.0\ncontact_damping = 0.0\n"
MIDDLE, FREQUENCY, PEAK = 0.5, 4.0, 3.0  # of a Ricker wavelet, s, Hz, m/s²
# Of columns: height, density, speed of waves; density and speed below.
COLUMNS = {"uniform": (40, 2400, 800, 2400, 800), "soft layer": (20, 2000, 250, 2500, 1500), "weak rock": (60, 2300, 600, 2600, 1800)}


def wavelet(t):
    q = (math.pi * FREQUENCY * (t - MIDDLE)) ** 2
    return PEAK * (1 - 2 * q) * math.exp(-q)


def velocity(t):
    """Its integral."""
    return PEAK * (t - MIDDLE) * math.exp(-((math.pi * FREQUENCY * (t - MIDDLE)) ** 2))


def displacement(t):
    """Its integral in turn."""
    return -PEAK / (2 * (math.pi * FREQUENCY) ** 2) * math.exp(-((math.pi * FREQUENCY * (t - MIDDLE)) ** 2))


def surface(t, height, density, speed, below, speed_below, of_outcrop=velocity):
    """Velocity of the top of a layer on a half-space, whose outcrop moves with velocity(t): a wave enters the layer, is doubled at the top
    and comes back from the half-space again and again. below = inf: it rests on a rigid base that moves so."""
    ratio = 0.0 if below == math.inf else density * speed / (below * speed_below)
    enters, back = 2 / (1 + ratio), (ratio - 1) / (ratio + 1)
    return sum(enters * back**k * of_outcrop(t - (2 * k + 1) * height / speed) for k in range(200))


def motion(axis, step=0.002, last=1.3):
    rows = ", ".join(f"[{number(i * step)}, {wavelet(i * step):.8g}]" for i in range(round(last / step) + 1))
    return f'[[motion]]\nname = "wavelet"\n{axis} = [{rows}]\n'


SHAKE = '\n[[stage]]\nname = "shake"\nkind = "shake"\nmotion = "wavelet"\nduration = 1.2\n'


def column(name, axis, height, density, speed, boundary, tail, step=0.001):
    """Blocks of 1 m on one another. A bar of plane stress without Poisson's ratio has one speed for each kind of wave."""
    young = density * speed**2 * (2 if axis == "x" else 1)
    text = NOTE + f'title = "A column, {name}"\ngravity = [0.0, 0.0]\n\n[rock]\ndensity = {number(density)}\nyoung = {number(young)}\n'
    text += f'poisson = 0.0\nstate = "plane-stress"\n\n[joints]\n{STRONG}\n\n[time]\nstep = {step}\n\n[boundary]\n{boundary}\n\n{UNDAMPED}'
    for k in range(height):
        text += f'\n[[block]]\nname = "b{k}"\nouter = [{", ".join(point(p) for p in box(0, k, 1, 1))}]\n'
    for history, y in (("top", height), ("middle", height / 2), ("bottom", 0)):
        text += f'\n[[history]]\nname = "{history}"\nblock = "b{min(int(y), height - 1)}"\npoint = [0.5, {number(y)}]\n'
    FILES[f"scenarios/column_{name.replace(' ', '_')}.toml"] = text + "\n" + tail


def layer():
    """40 m wide, 20 m high, of bonded blocks of 2 m; its sides are set by the case."""
    width, height, size = 40, 20, 2
    lines = [((0, y), (width, y)) for y in range(size, height, size)] + [((x, 0), (x, height)) for x in range(size, width, size)]
    FILES["scenarios/bonded_layer.csv"] = "trace,x,y\n" + "".join(
        f"{k},{p[0]},{p[1]}\n" for k, line in enumerate(lines) for p in line
    )
    shear, poisson = 2400 * 800**2, 0.25
    for axis in "xy":
        text = NOTE + f'title = "A bonded layer, shaken along {axis}"\ngravity = [0.0, 0.0]\n\n[domain]\nx = [0.0, 40.0]\ny = [0.0, 20.0]\n\n'
        text += f'[rock]\ndensity = 2400.0\nyoung = {number(2 * shear * (1 + poisson))}\npoisson = {poisson}\nstate = "plane-strain"\n\n'
        text += f'[joints]\n{STRONG}\n\n[[trace_map]]\nname = "grid"\nfile = "bonded_layer.csv"\n\n[time]\nstep = 0.001\n\n[boundary]\nsides = "free-field"\n\n{UNDAMPED}\n'
        for history, x in (("left", 0.5), ("middle", 20.5), ("right", 39.5)):
            text += f'[[history]]\nname = "{history}"\npoint = [{x}, 19.9]\n\n'
        text += '[[history]]\nname = "beside"\ncolumn = "left"\ny = 19.9\n\n'
        FILES[f"scenarios/bonded_layer_{axis}.toml"] = text + motion(axis) + SHAKE


def resting_layer():
    text = FILES["scenarios/bonded_layer_x.toml"]
    text = text[: text.index("[[motion]]")].replace("gravity = [0.0, 0.0]", "gravity = [0.0, -9.81]").replace("shaken along x", "at rest")
    stages = [("settle", "settle", ""), ("rest", "rest", "duration = 5.0\n"), ("settle again", "settle", ""), ("rest again", "rest", "duration = 1.0\n")]
    for name, kind, more in stages:
        tolerance = "tolerance = 1.0e-9\n" if kind == "settle" else ""
        text += f'[[stage]]\nname = "{name}"\nkind = "{kind}"\n{more}{tolerance}\n'
    FILES["scenarios/resting_layer.toml"] = text


def struck_bar():
    """A pulse is pushed into the top; what comes back from the base passes the middle again."""
    rows = [(0.04 * k / 40, math.sin(math.pi * k / 40) ** 2) for k in range(41)]
    time = ", ".join(f"[{number(t)}, {number(f)}]" for t, f in rows)
    pulse = f'[[load]]\nblock = "b39"\nfrom = [1.0, 40.0]\nto = [0.0, 40.0]\ntraction = [0.0, {number(-2400 * 800 * 0.1)}]\ntime = [{time}]\n'
    stage = '\n[[stage]]\nname = "strike"\nkind = "rest"\nduration = 0.12\n'
    boundary = 'sides = "roller"\ndensity = 2400.0\nvs = 300.0\nvp = 800.0'
    column("struck", "y", 40, 2400, 800, boundary, pulse + stage, step=0.0005)  # the pulse is one of 25 Hz


def boundaries():
    text = '''title = "Seismic boundaries"
case  = 34
about = """Columns of bonded blocks on a half-space, under a wavelet of 4 Hz that its outcrop makes. A wave enters the column, is doubled
at the top and comes back from the half-space again and again: the velocity of the top is the sum of these. On a rigid base nothing goes
out. A pulse that goes down in a bar comes back by (1 - f)/(1 + f), with f the impedance below over the bar's. A layer with the free field at
its sides moves as one column; with rock at rest at its sides it does not. Rock at rest stays at rest when dynamic steps follow static ones. Waves that come at an angle are taken
up less: a wave train and its mirror image go down in a strip between mirrors, and what is left in it comes back from the base."""
'''
    def balance(most):  # elasticity is linear up to the strain itself
        return quantity("energy that is not accounted for, over the largest term", "summary('energy.residual_ratio')", at_most=most)

    residual = balance(1e-6)
    for name, (height, density, speed, below, speed_below) in COLUMNS.items():
        for axis, kind in (("x", "shear"), ("y", "pressure")):
            scenario = f"{name} {kind}"
            half_space = f"density = {number(below)}\nvs = {number(speed_below if axis == 'x' else speed_below / 2)}\n"
            half_space += f"vp = {number(speed_below if axis == 'y' else 2 * speed_below)}"
            sides = "free-field" if axis == "x" else "roller"
            absolute = f'\n[[history]]\nname = "absolute"\nblock = "b{height - 1}"\npoint = [0.5, {number(height)}]\nframe = "absolute"\n'
            column(scenario, axis, height, density, speed, f'sides = "{sides}"\n{half_space}', motion(axis) + absolute + SHAKE)
            text += f'\n[[run]]\nname = "{scenario}"\nscenario = "scenarios/column_{scenario.replace(" ", "_")}.toml"\n'
            for t in (0.45, 0.5, 0.6, 0.7):
                known = surface(t, height, density, speed, below, speed_below) - velocity(t)
                text += quantity(f"velocity of the top against the outcrop at {t} s", f"at('top.v{axis}', {t})", "m/s", expected=float(f"{known:.9g}"), absolute_tolerance=2e-3)
            known = surface(0.6, height, density, speed, below, speed_below)
            text += quantity("its absolute velocity at 0.6 s", f"at('absolute.v{axis}', 0.6)", "m/s", expected=float(f"{known:.9g}"), absolute_tolerance=2e-3)
            known = surface(0.6, height, density, speed, below, speed_below, displacement)
            text += quantity("its absolute displacement at 0.6 s", f"at('absolute.u{axis}', 0.6)", "m", expected=float(f"{known:.9g}"), absolute_tolerance=5e-5)
            text += residual
    column("rigid base", "y", 40, 2400, 800, 'base = "rigid"\nsides = "roller"', motion("y") + SHAKE)
    text += '\n[[run]]\nname = "rigid base"\nscenario = "scenarios/column_rigid_base.toml"\n'
    for t in (0.5, 0.7, 1.0):
        known = surface(t, 40, 2400, 800, math.inf, 1) - velocity(t)
        text += quantity(f"velocity of the top against the base at {t} s", "at('top.vy', %s)" % t, "m/s", expected=float(f"{known:.9g}"), absolute_tolerance=6e-3)
    text += residual
    struck_bar()
    text += '\n[[run]]\nname = "what comes back from the base"\nscenario = "scenarios/column_struck.toml"\n'
    text += '[run.points]\nkeys = ["boundary.vp"]\nvalues = [[400.0], [640.0], [800.0], [1000.0], [1600.0]]\n'
    text += quantity("velocity of the pulse that comes back, over the one that went down", "at('middle.vy', 0.095)/at('middle.vy', 0.045)",
                     expected="(1 - set('boundary.vp')/800)/(1 + set('boundary.vp')/800)", absolute_tolerance=1e-3)
    text += residual
    layer()
    for axis, kind in (("x", "shear"), ("y", "pressure")):
        text += f'\n[[run]]\nname = "layer, {kind}"\nscenario = "scenarios/bonded_layer_{axis}.toml"\n'
        speed = 800 * (1 if axis == "x" else math.sqrt(3))
        for t in (0.45, 0.5, 0.55):
            known = surface(t, 20, 2400, speed, 2400, speed) - velocity(t)
            text += quantity(f"velocity of the surface at {t} s", f"at('middle.v{axis}', {t})", "m/s", expected=float(f"{known:.9g}"), absolute_tolerance=1e-3)
            text += quantity(f"velocity of the free field beside it at {t} s", f"at('beside.v{axis}', {t})", "m/s",
                             expected=float(f"{known:.9g}"), absolute_tolerance=1e-4)
            text += quantity(f"difference of the velocities at its ends from the middle at {t} s",
                             f"max(abs(at('left.v{axis}', {t}) - at('middle.v{axis}', {t})), abs(at('right.v{axis}', {t}) - at('middle.v{axis}', {t})))", "m/s",
                             at_most=2e-5)
        text += residual
        text += f'\n[[run]]\nname = "layer, {kind}, rock at rest beside it"\nscenario = "scenarios/bonded_layer_{axis}.toml"\nset = ["boundary.sides=viscous"]\n'
        text += quantity("difference of the velocities at its left end from the middle at 0.5 s",
                         f"abs(at('left.v{axis}', 0.5) - at('middle.v{axis}', 0.5))", "m/s", at_least=1e-3)
    resting_layer()
    text += '\n[[run]]\nname = "rest stays rest"\nscenario = "scenarios/resting_layer.toml"\n'
    for stage in ("rest", "rest again"):
        text += quantity(f"velocity at the end of the stage {stage}",
                         f"max(abs(after('{stage}', 'left.vx')), abs(after('{stage}', 'middle.vy')))", "m/s", at_most=1e-6)
    text += quantity("settlement while at rest", "after('rest', 'middle.uy') - after('settle', 'middle.uy')", "m", expected=0.0, absolute_tolerance=1e-9)
    text += quantity("settlement from the first equilibrium to the last stage", "after('rest again', 'middle.uy') - after('settle', 'middle.uy')", "m",
                     expected=0.0, absolute_tolerance=1e-9)
    text += balance(1e-5)
    case("seismic_boundary", text + oblique_waves())
