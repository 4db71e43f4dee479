#!/usr/bin/env python3
"""Writes scenarios/voussoir.toml: a beam of blocks that only a thrust holds together."""
import pathlib

BLOCKS, LENGTH, HEIGHT, THRUST = 30, 0.5, 1.0, 2.25e6
FINE = 5  # blocks of order 4 on each side of midspan

span = BLOCKS * LENGTH
text = f"""# A beam of {BLOCKS} blocks, {span:g} m by {HEIGHT:g} m, under its own weight and a thrust of {THRUST:g} N/m on its ends, which rest on points at half
# height. The joints have no tensile strength: around midspan they open from below. The {2 * FINE} blocks there are of order 4, the others of
# order 1. Written by generate_voussoir.py.
title = "Voussoir beam"

[rock]
density = 2500.0
young = 8e10
poisson = 0.2
state = "plane-stress"
order = 1

[joints]
friction = 60.0

[in_situ]
sxx = {-THRUST / HEIGHT:.1f}

[time]
step = 0.01

[[region]]
name = "midspan"
outer = [[{span / 2 - FINE * LENGTH}, 0.0], [{span / 2 + FINE * LENGTH}, 0.0], [{span / 2 + FINE * LENGTH}, {HEIGHT}], \
[{span / 2 - FINE * LENGTH}, {HEIGHT}]]
order = 4

"""
for k in range(BLOCKS):
    a, b = k * LENGTH, (k + 1) * LENGTH
    text += f'[[block]]\nname = "{k}"\nouter = [[{a}, 0.0], [{b}, 0.0], [{b}, {HEIGHT}], [{a}, {HEIGHT}]]\n\n'
for block, x, y0, y1, sign, directions in (("0", 0.0, HEIGHT, 0.0, 1, '["x", "y"]'),
                                           (str(BLOCKS - 1), span, 0.0, HEIGHT, -1, '["y"]')):
    text += (f'[[support]]\nblock = "{block}"\npoints = [[{x}, {HEIGHT / 2}]]\ndirections = {directions}\n\n'
             f'[[load]]\nblock = "{block}"\nfrom = [{x}, {y0}]\nto = [{x}, {y1}]\ntraction = [{sign * THRUST / HEIGHT:.1f}, 0.0]\n\n')
middle = BLOCKS // 2 - 1
for name, block, share in (("top", middle, 1.0), ("three_quarters", middle, 0.75), ("half", middle, 0.5),
                           ("next_top", middle - 1, 1.0)):
    text += (f'[[history]]\nname = "{name}"\nblock = "{block}"\n'
             f'point = [{(block + 0.5) * LENGTH}, {share * HEIGHT}]\n\n')
text += """[[stage]]
name = "settled"
kind = "settle"
tolerance = 1e-6

[[stage]]
name = "at rest"
kind = "rest"
duration = 3.0
"""
pathlib.Path(__file__).with_name("scenarios").joinpath("voussoir.toml").write_text(text)
