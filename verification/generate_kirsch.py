#!/usr/bin/env python3
"""Writes scenarios/kirsch.toml: a quarter of a plate with a circular hole, in bonded blocks, under the tractions of Kirsch's solution."""
import math
import pathlib

RADII = [1.0, 1.15, 1.4, 1.8, 2.4]
SECTORS = 9
WALL_CHORDS = 8  # of a block at the hole
SX, SY = -1.0e6, -0.5e6


def stress(x, y):
    """Kirsch (1898): (sxx, syy, sxy) around a hole of radius 1."""
    r2, theta = x * x + y * y, math.atan2(y, x)
    mean, half, c, s = (SX + SY) / 2, (SX - SY) / 2, math.cos(2 * theta), math.sin(2 * theta)
    r = mean * (1 - 1 / r2) + half * (1 - 4 / r2 + 3 / r2**2) * c
    t = mean * (1 + 1 / r2) - half * (1 + 3 / r2**2) * c
    shear = -half * (1 + 2 / r2 - 3 / r2**2) * s
    cc, ss, cs = math.cos(theta) ** 2, math.sin(theta) ** 2, math.sin(theta) * math.cos(theta)
    return (r * cc + t * ss - 2 * shear * cs, r * ss + t * cc + 2 * shear * cs,
            (r - t) * cs + shear * (cc - ss))


def point(r, share):
    angle = share * math.pi / 2
    return [0.0 if share == 1 else round(r * math.cos(angle), 12), round(r * math.sin(angle), 12)]


def traction(p, n):
    sxx, syy, sxy = stress(*p)
    return [round(sxx * n[0] + sxy * n[1], 3), round(sxy * n[0] + syy * n[1], 3)]


def block(ring, sector):
    a, b = sector / SECTORS, (sector + 1) / SECTORS
    inner, outer = RADII[ring], RADII[ring + 1]
    chords = WALL_CHORDS if ring == 0 else 1
    wall = [point(inner, b + (a - b) * k / chords) for k in range(chords + 1)]
    p, q = point(outer, a), point(outer, b)
    name = f"{ring}-{sector}"
    text = f'[[block]]\nname = "{name}"\nouter = {[p, q] + wall}\n\n'
    for side, direction, ends in ((0, "y", (wall[-1], p)), (SECTORS - 1, "x", (q, wall[0]))):
        if sector == side:
            text += (f'[[support]]\nblock = "{name}"\nfrom = {ends[0]}\nto = {ends[1]}\n'
                     f'directions = ["{direction}"]\nstiffness = 1e15\n\n')
    if ring == len(RADII) - 2:
        length = math.dist(p, q)
        n = [(q[1] - p[1]) / length, -(q[0] - p[0]) / length]
        middle = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2]
        text += (f'[[load]]\nblock = "{name}"\nfrom = {p}\nto = {q}\ntraction = {traction(p, n)}\n'
                 f'traction_middle = {traction(middle, n)}\ntraction_end = {traction(q, n)}\n\n')
    return text


TEXT = f"""# A quarter of a plate with a circular hole of radius 1 under a stress of {SX:g} Pa in x and {SY:g} Pa in y from afar: bonded blocks, with
# the tractions of Kirsch's solution on the outer boundary. Written by generate_kirsch.py.
title = "Circular hole"
gravity = [0.0, 0.0]

[rock]
density = 2500.0
young = 1e10
poisson = 0.25
state = "plane-stress"
order = 4

[joints]
friction = 30.0
cohesion = 1e12
tension = 1e12
normal_stiffness = 1e14
shear_stiffness = 1e14

[time]
step = 1.0

"""
TEXT += "".join(block(ring, sector) for ring in range(len(RADII) - 1) for sector in range(SECTORS))
TEXT += f"""[[history]]
name = "top"
block = "0-{SECTORS - 1}"
point = [0.0, 1.0]

[[history]]
name = "side"
block = "0-0"
point = [1.0, 0.0]

[[stage]]
name = "loaded"
kind = "settle"
tolerance = 1e-6
"""
pathlib.Path(__file__).with_name("scenarios").joinpath("kirsch.toml").write_text(TEXT)
