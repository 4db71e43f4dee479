"""Of case 34, seismic boundaries: waves that come at an angle upon a base that takes up what comes straight, as boundaries.py writes them."""

import cmath
import math

from case_text import FILES, NOTE, box, number, point, quantity

DENSITY, SHEAR_SPEED, POISSON = 2400, 800, 0.25
PRESSURE_SPEED = SHEAR_SPEED * math.sqrt(2 * (1 - POISSON) / (1 - 2 * POISSON))
FREQUENCY, SAMPLES = 10.0, 16  # Hz; of a period
SPEEDS = {"pressure": PRESSURE_SPEED, "shear": SHEAR_SPEED}


def slowness(w, kx, kind):
    """Wave number across the base of a wave of the wave number kx along it; imaginary where it does not go away from it."""
    return cmath.sqrt((w / SPEEDS[kind]) ** 2 - kx**2)


def reflected(w, kx, kind):
    """Share of the energy that comes back from dashpots ρ v_p across and ρ v_s along the base (Lysmer & Kuhlemeyer 1969). All over iω and ρ:
    displacements are ∇Φ and (∂ψ/∂y, −∂ψ/∂x), with y upwards."""
    mu, lame = SHEAR_SPEED**2, PRESSURE_SPEED**2 - 2 * SHEAR_SPEED**2

    def missing(kind, up):
        ky = -slowness(w, kx, kind) if up else slowness(w, kx, kind)  # e^(iωt + i ky y)
        ux, uy = (kx, ky) if kind == "pressure" else (ky, -kx)
        shear, normal = mu * (ky * ux + kx * uy), lame * (kx * ux + ky * uy) + 2 * mu * ky * uy
        return shear - w * SHEAR_SPEED * ux, normal - w * PRESSURE_SPEED * uy  # traction on the model below: −(σ_xy, σ_yy) = −C v

    (a, c), (b, d), (e, f) = missing("pressure", True), missing("shear", True), missing(kind, False)
    determinant = a * d - b * c
    amplitudes = {"pressure": (-e * d + b * f) / determinant, "shear": (-a * f + c * e) / determinant}
    return sum(abs(amplitudes[k]) ** 2 * slowness(w, kx, k).real for k in SPEEDS) / slowness(w, kx, kind).real


def guide(kind, degrees, cycles):
    """A strip of rock whose sides mirror: a wave and its mirror image go down in it. Width, height, time at the end, and the known share."""
    speed, w0 = SPEEDS[kind], 2 * math.pi * FREQUENCY
    kx = w0 / speed * math.sin(math.radians(degrees))
    duration = cycles / FREQUENCY
    count = round(duration * FREQUENCY * SAMPLES)
    # A wave train under Blackman's window, as a sum of waves.
    def train(t):
        s = t / duration
        return (0.42 - 0.5 * math.cos(2 * math.pi * s) + 0.08 * math.cos(4 * math.pi * s)) * math.sin(w0 * t) if 0 < s < 1 else 0.0
    period, step = 4 * duration, 1 / (FREQUENCY * SAMPLES)
    spectrum = {}
    for k in range(1, round(2 * FREQUENCY * period)):
        w = 2 * math.pi * k / period
        if w > kx * speed * 1.001:
            spectrum[w] = 2 / period * step * sum(train(i * step) * cmath.exp(-1j * w * i * step) for i in range(count))
    weight = {w: abs(x) ** 2 * w * slowness(w, kx, kind).real for w, x in spectrum.items()}
    known = sum(x * reflected(w, kx, kind) for w, x in weight.items()) / sum(weight.values())
    mu = DENSITY * SHEAR_SPEED**2
    rows = {"normal": [], "shear": []}
    for i in range(-SAMPLES, count + SAMPLES + 1):
        t = i * step
        normal = shear = 0.0
        for w, x in spectrum.items():
            wave, ky = x * cmath.exp(1j * w * t), slowness(w, kx, kind)
            if kind == "pressure":
                normal -= ((DENSITY * w**2 - 2 * mu * kx**2) * wave).real
                shear -= (2j * mu * kx * ky * wave).real
            else:
                normal -= (2j * mu * kx * ky * wave).real
                shear += (mu * (kx**2 - ky**2) * wave).real
        rows["normal"].append((t + SAMPLES * step, normal))
        rows["shear"].append((t + SAMPLES * step, shear))
    largest = max(abs(f) for column in rows.values() for _, f in column)
    tables = {k: ", ".join(f"[{number(t)}, {f / largest:.5f}]" for t, f in column) for k, column in rows.items()}
    down = speed * math.cos(math.radians(degrees))
    # What comes back first is at the base again when all of the wave has been there.
    up = max(SPEEDS[k] ** 2 / w0 * slowness(w0, kx, k).real for k in SPEEDS)
    lasts = duration + 2 * SAMPLES * step
    height = lasts * max(0.8 * down, 0.65 * up)
    return kx, height, height / down + lasts, tables, known


def oblique_waves():
    """Rows of the case; its scenarios."""
    text = ""
    left = "summary('energy.kinetic') + summary('energy.strain') + summary('energy.contact')"
    young, order, pieces = 2 * DENSITY * SHEAR_SPEED**2 * (1 + POISSON), 5, 3
    for kind, degrees, cycles in (("pressure", 20, 8), ("pressure", 40, 8), ("pressure", 60, 24), ("shear", 20, 8), ("shear", 50, 16)):
        kx, height, end, tables, known = guide(kind, degrees, cycles)
        width, count = math.pi / kx, math.ceil(height / (60 if kind == "pressure" else 30))
        name = f"oblique_{kind}_{degrees}"
        scenario = NOTE + f'title = "A wave of {kind} at {degrees} degrees"\ngravity = [0.0, 0.0]\n\n[rock]\ndensity = {number(DENSITY)}\nyoung = {number(young)}\n'
        scenario += f'poisson = {POISSON}\nstate = "plane-strain"\norder = {order}\n\n[joints]\nfriction = 45.0\ncohesion = 1.0e12\ntension = 1.0e12\n'
        scenario += "normal_stiffness = 1.0e13\nshear_stiffness = 1.0e13\n\n[time]\nstep = 0.001\n\n[boundary]\nsides = \"roller\"\n\n"
        scenario += "[solver]\nrock_damping = 0.0\ncontact_damping = 0.0\n"
        size = round(height / count, 3)
        width = round(width, 6)
        for k in range(count):
            scenario += f'\n[[block]]\nname = "b{k}"\nouter = [{", ".join(point(p) for p in box(0, k * size, width, size))}]\n'
        for part, shape, axis in (("normal", math.cos, 1), ("shear", math.sin, 0)):
            for i in range(pieces):
                at = [width * (i + share) / pieces for share in (1, 0.5, 0)]  # counter-clockwise
                values = [[0.0, 0.0] for _ in at]
                for value, x in zip(values, at):
                    value[axis] = round(1e5 * shape(kx * x), 3)
                scenario += f'\n[[load]]\nblock = "b{count - 1}"\nfrom = {point((round(at[0], 6), count * size))}\nto = {point((round(at[2], 6), count * size))}\n'
                scenario += f"traction = {point(values[0])}\ntraction_middle = {point(values[1])}\ntraction_end = {point(values[2])}\ntime = [{tables[part]}]\n"
        scenario += f'\n[[stage]]\nname = "wave"\nkind = "rest"\nduration = {end:.4f}\n'
        FILES[f"scenarios/{name}.toml"] = scenario
        text += f'\n[[run]]\nname = "wave of {kind} at {degrees}° from the normal"\nscenario = "scenarios/{name}.toml"\n'
        text += "" if degrees == 40 else "long = true\n"
        text += quantity("share of its energy that comes back", f"({left})/({left} + summary('energy.radiated'))",
                         expected=float(f"{known:.6g}"), absolute_tolerance=0.003)
    return text
