#!/usr/bin/env python3
"""Writes scenarios/smooth_field.toml: a block under the tractions of the field u = A (x - p)/|x - p|^2 of a centre of dilatation p outside
of it. The tractions are point forces at Gauss points of the edges, so many that they are exact to the last digits for all orders."""
import math
import pathlib

YOUNG, POISSON = 1.0e5, 0.2
AMPLITUDE = 1.0e-7
POLE = (-0.5, 0.7)
CORNERS = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]
POINTS = 20


def gauss_legendre(n):
    """Points and weights on [0, 1]: roots of the Legendre polynomial by Newton's iteration."""
    rule = []
    for k in range(n):
        x = math.cos(math.pi * (k + 0.75) / (n + 0.5))
        for _ in range(100):
            p0, p1 = 1.0, x
            for m in range(2, n + 1):
                p0, p1 = p1, ((2 * m - 1) * x * p1 - (m - 1) * p0) / m
            slope = n * (x * p1 - p0) / (x * x - 1)
            x, step = x - p1 / slope, p1 / slope
            if abs(step) < 1e-16:
                break
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return rule


def displacement(x, y):
    dx, dy = x - POLE[0], y - POLE[1]
    r2 = dx * dx + dy * dy
    return AMPLITUDE * dx / r2, AMPLITUDE * dy / r2


def traction(x, y, n):
    dx, dy = x - POLE[0], y - POLE[1]
    f = 2 * AMPLITUDE * YOUNG / (2 * (1 + POISSON)) / (dx * dx + dy * dy) ** 2
    sxx, sxy = f * (dy * dy - dx * dx), -2 * f * dx * dy
    return sxx * n[0] + sxy * n[1], sxy * n[0] - sxx * n[1]


def forces():
    for k, a in enumerate(CORNERS):
        b = CORNERS[(k + 1) % 4]
        length = math.dist(a, b)
        n = ((b[1] - a[1]) / length, -(b[0] - a[0]) / length)
        for s, w in gauss_legendre(POINTS):
            p = (a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]))
            t = traction(*p, n)
            yield p, (w * length * t[0], w * length * t[1])


work = sum(0.5 * (f[0] * u + f[1] * v) for p, f in forces() for u, v in [displacement(*p)])
text = f"""# A block under the tractions of a smooth field that is no polynomial: a centre of dilatation at {POLE}, outside of it. The energy of the exact
# solution is {work:.15g}. Written by generate_smooth_field.py.
title = "Smooth field"
gravity = [0.0, 0.0]

[rock]
density = 1.0
young = {YOUNG:g}
poisson = {POISSON}
state = "plane-stress"

[time]
step = 1.0

[[block]]
name = "block"
outer = {[list(c) for c in CORNERS]}

# Three springs that carry nothing.
[[support]]
block = "block"
points = [[0.0, 0.0]]
stiffness = 1e8

[[support]]
block = "block"
points = [[2.0, 0.0]]
directions = ["y"]
stiffness = 1e8

"""
for p, f in forces():
    text += f'[[load]]\nblock = "block"\npoint = [{p[0]:.15g}, {p[1]:.15g}]\nforce = [{f[0]:.15g}, {f[1]:.15g}]\n\n'
text += """[[stage]]
name = "loaded"
kind = "settle"
tolerance = 1e-9
"""
pathlib.Path(__file__).with_name("scenarios").joinpath("smooth_field.toml").write_text(text)
