"""Case 35, Rayleigh damping, as generate.py writes it."""

import cmath
import math

from boundaries import STRONG, velocity
from case_text import FILES, FIXED, NOTE, STIFF_ROCK, box, case, number, point, quantity, scenario

RATIO, FREQUENCY = 0.05, 3.0  # of damping, and the Hz at which it is meant
KINDS = {"stiffness": (0.0, 2.0), "rayleigh": (1.0, 1.0), "mass": (2.0, 0.0)}  # α/(ζω) and βω/ζ


def damping(kind, more=""):
    return f'[solver]\ndamping = {{ ratio = {RATIO}, frequency = {FREQUENCY}, kind = "{kind}"{more} }}\n'


def ratio(kind, frequency):
    """½ (α/ω + β ω)"""
    mass, stiffness = KINDS[kind]
    return 0.5 * RATIO * (mass * FREQUENCY / frequency + stiffness * frequency / FREQUENCY)


def block_on_joint():
    """A stiff block of 1 m on a soft joint swings up and down."""
    joints = "friction = 45.0\ncohesion = 1.0e12\ntension = 1.0e12\nnormal_stiffness = 1.0e6"
    scenario(
        "damped_block", title="A block that swings on a soft joint", gravity=(0.0, 0.0), rock=STIFF_ROCK, joints=joints, step=1e-4,
        blocks=[("base", box(0, -1, 1, 1), FIXED), ("block", box(0, 0, 1, 1), "velocity = [0.0, 0.01]\n")],
        histories=[("block", "block", (0.5, 0.5))], extra=damping("rayleigh", ", force = true") + "\n",
        stages='[[stage]]\nname = "swing"\nkind = "rest"\nduration = 3.0\n',
    )


HEIGHT, SPEED, SIZE = 40, 800, 2


def swinging_column():
    """A bonded column on a rigid base, let go with the velocity of its first mode of pressure."""
    text = NOTE + f'title = "A column that swings up and down"\ngravity = [0.0, 0.0]\n\n[rock]\ndensity = 2400.0\nyoung = {number(2400 * SPEED**2)}\npoisson = 0.0\n'
    text += f'state = "plane-stress"\n\n[joints]\n{STRONG}\n\n[time]\nstep = 0.001\n\n[boundary]\nbase = "rigid"\nsides = "roller"\n\n{damping("rayleigh")}'
    for k in range(HEIGHT // SIZE):
        v = 0.01 * math.sin(math.pi * (k + 0.5) * SIZE / (2 * HEIGHT))
        text += f'\n[[block]]\nname = "b{k}"\nouter = [{", ".join(point(p) for p in box(0, k * SIZE, SIZE, SIZE))}]\nvelocity = [0.0, {number(round(v, 9))}]\n'
    text += f'\n[[history]]\nname = "top"\nblock = "b{HEIGHT // SIZE - 1}"\npoint = [1.0, {HEIGHT}.0]\n'
    FILES["scenarios/damped_column.toml"] = text + '\n[[stage]]\nname = "swing"\nkind = "rest"\nduration = 1.2\n'


def top_of_damped_layer(t, height, density, speed, viscosity, period=6.0, step=0.002, fastest=25.0):
    """m/s: the free top of a layer of Kelvin-Voigt rock, G (1 + iωβ), on an elastic half-space of the same rock, against its outcrop."""
    samples = [(k * step, velocity(k * step)) for k in range(round(1.2 / step))]
    total = 0.0
    for k in range(1, round(fastest * period)):
        w = 2 * math.pi * k / period
        outcrop = sum(v * cmath.exp(-1j * w * s) for s, v in samples) * step
        slowed = speed * cmath.sqrt(1 + 1j * w * viscosity)
        phase = w * height / slowed
        top = 1 / (cmath.cos(phase) + 1j * slowed / speed * cmath.sin(phase))
        total += 2 / period * ((top - 1) * outcrop * cmath.exp(1j * w * t)).real
    return total


def damped_layers():
    for axis in "xy":
        text = FILES[f"scenarios/bonded_layer_{axis}.toml"].replace("A bonded layer", "A damped bonded layer")
        undamped = "[solver]\nrock_damping = 0.0\ncontact_damping = 0.0\n"
        assert undamped in text
        FILES[f"scenarios/damped_layer_{axis}.toml"] = text.replace(undamped, damping("rayleigh"))


def decay(column, period, cycles):
    """The ratio of damping by what is left after some cycles, from the first peak on."""
    first, last = f"at('{column}', {number(period / 4)})", f"at('{column}', {number(period / 4 + cycles * period)})"
    return f"abs(log({first}/{last}))/hypot({number(2 * math.pi * cycles)}, log({first}/{last}))"


def dampings():
    text = f'''title = "Rayleigh damping"
case  = 35
about = """Damping of {RATIO:.0%} at {FREQUENCY:g} Hz, in proportion to stiffness, to mass, or half to each. What swings alone loses
ζ(ω) = ½ (α/ω + β ω): a block on a soft joint, by Shi's rule, and a column of bonded blocks on a rigid base, by the rule that goes with seismic
boundaries. In a layer with the free field at its sides the ground has the part of stiffness alone, as nothing moves against it: its top moves
as that of a layer of G (1 + iωβ), and it stays one-dimensional."""
'''
    balance = quantity("energy that is not accounted for, over the largest term", "summary('energy.residual_ratio')", at_most=1e-6)
    block_on_joint()
    for kind in KINDS:
        for frequency in (1.0, 3.0, 10.0):
            stiffness = 2600 * (2 * math.pi * frequency) ** 2
            sets = [f"joints.normal_stiffness={stiffness:.10g}", f"solver.damping.kind={kind}", f"time.step={5e-5 / frequency:.3g}",
                    f"stage.swing.duration={2.5 / frequency:.4g}"]
            if kind == "stiffness":
                sets.append("solver.damping.force=false")
            text += f'\n[[run]]\nname = "{kind}, {frequency:g} Hz"\nscenario = "scenarios/damped_block.toml"\nset = {sets}\n'.replace("'", '"')
            # With the period of the damped oscillation peaks are where they are looked for.
            known = ratio(kind, frequency)
            period = 1 / (frequency * math.sqrt(1 - known**2))
            text += quantity("damping ratio", decay("block.uy", round(period, 6), 2), expected=float(f"{known:.9g}"), tolerance=0.01)
            text += balance
    for kind in KINDS:
        sets = [f"joints.normal_stiffness={2600 * (20 * math.pi) ** 2:.10g}", f"solver.damping.kind={kind}", "time.step=0.002", "stage.swing.duration=0.3"]
        text += f'\n[[run]]\nname = "{kind}, 10 Hz, long steps"\nscenario = "scenarios/damped_block.toml"\nset = {sets}\n'.replace("'", '"')
        period = 0.1 / math.sqrt(1 - ratio(kind, 10) ** 2)
        text += quantity("damping ratio with that of the rule", decay("block.uy", round(period, 6), 2), expected="summary('damping.2.total')", tolerance=0.02)
    swinging_column()
    frequency = SPEED / (4 * HEIGHT)
    for kind in KINDS:
        known = ratio(kind, frequency)
        period = 1 / (frequency * math.sqrt(1 - known**2))
        text += f'\n[[run]]\nname = "column, {kind}"\nscenario = "scenarios/damped_column.toml"\nset = ["solver.damping.kind={kind}"]\n'
        text += quantity("damping ratio of its first mode", decay("top.uy", round(period, 6), 4), expected=float(f"{known:.9g}"), tolerance=0.01)
        text += balance
    damped_layers()
    viscosity = RATIO / (2 * math.pi * FREQUENCY)
    for axis, kind in (("x", "shear"), ("y", "pressure")):
        speed = 800 * (1 if axis == "x" else math.sqrt(3))
        text += f'\n[[run]]\nname = "layer, {kind}"\nscenario = "scenarios/damped_layer_{axis}.toml"\n'
        for t in (0.45, 0.5, 0.55):
            known = top_of_damped_layer(t, 20, 2400, speed, viscosity)
            text += quantity(f"velocity of the surface at {t} s", f"at('middle.v{axis}', {t})", "m/s", expected=float(f"{known:.9g}"), absolute_tolerance=1e-3)
            text += quantity(f"difference of the velocities at its ends from the middle at {t} s",
                             f"max(abs(at('left.v{axis}', {t}) - at('middle.v{axis}', {t})), abs(at('right.v{axis}', {t}) - at('middle.v{axis}', {t})))", "m/s",
                             at_most=2e-5)
        text += balance
    case("damping", text)
