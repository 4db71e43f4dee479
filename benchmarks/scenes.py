"""Scenarios of the benchmarks that are too long to be written by hand: walls in running bond, grids of blocks."""

import math

HEAD = """title = "{title}"

[section]
azimuth = 90.0

[rock]
density = 2270.0
young = 3.0e9
poisson = 0.21
order = {order}

[joints]
friction = 39.0

[time]
step = 0.002

[[motion]]
name = "sine"
x = {{ amplitude = 2.943, frequency = 2.0, cycles = {cycles} }}   # 0.3 g
"""

STAGES = """
[[stage]]
name = "settle"
kind = "settle"
max_steps = {settle}

[[stage]]
name = "shake"
kind = "shake"
motion = "sine"
duration = {duration:.3f}

[output]
frame_interval = {duration:.3f}
contact_interval = {duration:.3f}
"""


def head(title, order, duration):
    return HEAD.format(title=title, order=order, cycles=2.0 * duration)


def block(name, x0, y0, x1, y1, fixed=False):
    outer = f"[[{x0}, {y0}], [{x1}, {y0}], [{x1}, {y1}], [{x0}, {y1}]]"
    return f'\n[[block]]\nname = "{name}"\nouter = {outer}\n' + ("fixed = true\n" if fixed else "")


def wall(columns, rows, duration, order=1):
    """Bricks of 1 × 0.5 m in running bond between a floor and two fixed columns."""
    text = head(f"Wall of {columns} by {rows} bricks", order, duration)
    height = 0.5 * rows
    text += block("floor", -1.0, -1.0, columns + 1.0, 0.0, True)
    text += block("left", -1.0, 0.0, 0.0, height, True) + block("right", columns, 0.0, columns + 1.0, height, True)
    for row in range(rows):
        joints = [float(k) for k in range(columns + 1)]
        if row % 2 == 1:
            joints = [0.0] + [k + 0.5 for k in range(columns)] + [float(columns)]
        for k in range(len(joints) - 1):
            text += block(f"b{row}-{k}", joints[k], 0.5 * row, joints[k + 1], 0.5 * (row + 1))
    return text + STAGES.format(settle=60, duration=duration)


def grid(blocks, duration, order=1):
    """Two sets of endless joints a metre apart in a square frame: about as many blocks as asked."""
    side = 0.5 * round(math.sqrt(blocks))
    text = head(f"Grid of {blocks} blocks", order, duration)
    text += f'\n[domain]\nx = [{-side}, {side}]\ny = [{-side}, {side}]\nboundary = "frame"\n'
    text += "\n[in_situ]\ndepth = 30.0\nk0 = 0.5\n"  # in equilibrium from the start
    for name, dip in (("vertical", 90.0), ("horizontal", 0.0)):
        text += f'''
[[joint_set]]
name = "{name}"
dip = {dip}
dip_direction = 90.0
spacing = {{ mean = 1.0, distribution = "constant" }}
length = {{ mean = {10 * side + 10}, distribution = "constant" }}
gap = {{ mean = 0.0, distribution = "constant" }}
'''
    return text + STAGES.format(settle=10, duration=duration)
