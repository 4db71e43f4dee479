"""Cases of friction whose normal force changes, as generate.py writes them."""

import math

from case_text import FIXED, STIFF_ROCK, G, box, case, number, quantity, scenario

STEPS = [0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001]
SOFT, STIFF = 1.0e9, 5.0e10


def gravity(slope):
    """In axes along and across a slope in degrees that falls to the right."""
    return G * math.sin(math.radians(slope)), -G * math.cos(math.radians(slope))


def incline(name, *, title, slope, friction, motion, duration, accept=""):
    scenario(
        name, title=title, gravity=gravity(slope), rock=STIFF_ROCK, joints=f"friction = {number(friction)}", step=0.002,
        accept=accept,
        blocks=[("incline", box(-2, -1, 20, 1), FIXED), ("slider", box(0, 0, 1, 0.5), "")],
        histories=[("s", "slider", (0.5, 0.25))], extra=f'[[motion]]\nname = "base"\n{motion}\n\n',
        stages=f'[[stage]]\nname = "settle"\nkind = "settle"\n\n[[stage]]\nname = "shake"\nkind = "shake"\nmotion = "base"\nduration = {number(duration)}\n',
    )


def sine(amplitude, frequency, cycles):
    return f"{{ amplitude = {number(amplitude)}, frequency = {number(frequency)}, cycles = {cycles} }}"


def tilted(before, after, friction):
    """A constant acceleration of the base, so that gravity less it is that of a steeper slope. Where the block goes in 1 s."""
    (x0, y0), (x1, y1) = gravity(before), gravity(after)
    rows = "\n".join(f"{axis} = [[0.0, {number(a)}], [2.0, {number(a)}]]" for axis, a in (("x", x0 - x1), ("y", y0 - y1)))
    incline("incline_tilted", title=f"A block held on {before}°, on an incline that is tilted to {after}° at once", slope=before, friction=friction, motion=rows, duration=1.0,
            accept="scale")
    return 0.5 * (x1 + y1 * math.tan(math.radians(friction)))


def slip_per_cycle(still, swing, frequency):
    """A rigid block in a cycle of acceleration `still` + `swing` sin ωt, at rest as long as that is negative: from the moment where it is zero until the
    block stands again."""
    omega = 2 * math.pi * frequency
    start = math.asin(-still / swing) / omega

    def speed(t):
        return still * (t - start) + swing / omega * (math.cos(omega * start) - math.cos(omega * t))

    low, high = 0.5 / frequency, 1.0 / frequency  # it is fastest before the middle of the cycle, and stands before its end
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if speed(middle) > 0 else (low, middle)
    t = low - start
    return 0.5 * still * t * t + swing / omega * (t * math.cos(omega * start) - (math.sin(omega * low) - math.sin(omega * start)) / omega)


def creep(slope, share, along, across, frequency, cycles):
    """A block held at a share of its limit on a base that is shaken by along and across × sin ωt: its way."""
    x, y = gravity(slope)
    friction = math.tan(math.radians(slope)) / share
    return cycles * slip_per_cycle(x + y * friction, -(along + across * friction), frequency)


def points(values):
    return f'[run.points]\nkeys = ["motion.base.x.amplitude", "motion.base.y.amplitude"]\nvalues = [{", ".join(f"[{number(x)}, {number(y)}]" for x, y in values)}]\n'


def inclines():
    slope, share, frequency, cycles = 25.0, 0.995, 20.0, 20
    friction = math.degrees(math.atan(math.tan(math.radians(slope)) / share))
    way = tilted(23.8, slope, 24.0)
    incline("incline_shaken_across", title="A block that slides down an incline of 45° that is shaken across", slope=45.0, friction=30.0, motion=f"y = {sine(3.0, 5.0, 5)}", duration=1.0)
    incline("creeping", title="A block held at 99.5 % of its limit, shaken at 20 Hz", slope=slope, friction=friction,
            motion=f"x = {sine(-1.0, frequency, cycles)}\ny = {sine(0.0, frequency, cycles)}", duration=cycles / frequency)
    text = f'''title = "Friction and a normal force that changes"
case  = 4
about = """Friction follows the normal force of the same moment; none of its impulse is lost. A block that is held on 23.8° with φ = 24° and then tilted to 25° at once goes ½ g (sin 25° − cos 25° tan 24°) t². A block that slides down 45° with φ = 30° while it is shaken across by a sin ωt: all that its friction does is tan φ times what its normal force does, so that it goes ½ g (sin 45° − cos 45° tan φ) t² − tan φ (∬ a sin ωt dt² + u_y).
A rigid block on 25°, held at 99.5 % of its limit and shaken at 20 Hz, horizontally and across the incline alone: it slides in every cycle from the moment θ at which the shaking overcomes friction until it stands, as in the case of the shaken incline. Default damping and settings."""

[[run]]
name = "tilted"
scenario = "scenarios/incline_tilted.toml"
vary = {{ "rock.young" = [{SOFT:.1e}, {STIFF:.1e}], "time.step" = {STEPS} }}
'''
    text += quantity("distance after 1 s", "end('s.ux') - after('settle', 's.ux')", "m", expected=number(way), tolerance=1e-3)
    text += f'\n[[run]]\nname = "shaken across"\nscenario = "scenarios/incline_shaken_across.toml"\nvary = {{ "time.step" = {STEPS[:-1]} }}\n'
    text += quantity("distance after 1 s", "end('s.ux') - after('settle', 's.ux')", "m", tolerance=1e-4,
                     expected="0.5*9.81*(sin(rad(45)) - cos(rad(45))*tan(rad(30))) - tan(rad(30))*(3/(10*pi) + end('s.uy') - after('settle', 's.uy'))")
    amplitudes = (-1.0, -2.0, -3.0)  # the block slides in the first half of a cycle
    horizontal = [(a * math.cos(math.radians(slope)), a * math.sin(math.radians(slope))) for a in amplitudes]
    across = [(0.0, a) for a in amplitudes]
    for name, shaking, steps in (("shaken horizontally", horizontal, STEPS[3:]), ("shaken across the incline", across, STEPS[4:])):
        text += f'\n[[run]]\nname = "creep, {name}"\nscenario = "scenarios/creeping.toml"\nvary = {{ "time.step" = {steps} }}\n' + points(shaking)
        ways = ", ".join(f"{creep(slope, share, x, y, frequency, cycles):.7f}" for x, y in shaking)
        text += quantity("way in 20 cycles", "end('s.ux') - after('settle', 's.ux')", "m", expected_by_point=f"[{ways}]", tolerance=0.02)
    case("changing_normal_force", text)
