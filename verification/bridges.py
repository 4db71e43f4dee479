"""Case 48, rock bridges, as generate.py writes it."""

import math

from case_text import FILES, NOTE, G, case, number, quantity
from water import WAYS, tangent

SLOPE = """title = "At the limit: a rock bridge in a plane that dips {dip}°"
units = "other"
tilt = {dip}.0

[section]
azimuth = 90.0

[domain]
x = [0.0, {length}]
y = [-1.0, 1.0]
boundary = "free"

[rock]
density = {density}
young = 5.0e10
poisson = 0.2
state = "plane-strain"

[joints]
friction = 60.0
cohesion = 1.0e9

[[trace_map]]
name = "plane"
lines = [[[-1.0, 0.0], [{begin}, 0.0]], [[{end}, 0.0], [{beyond}, 0.0]]]
friction = {joint}.0
cohesion = 0.0

[rock_bridge]
friction = {rock}.0
cohesion = {cohesion}
residual_cohesion = {cohesion}

[cutting]
dead_ends = "bridge"

[[block]]
name = "base"
outer = [[-1.0, -2.0], [{beyond}, -2.0], [{beyond}, -1.0], [-1.0, -1.0]]
fixed = true

[time]
step = 0.005

[[stage]]
name = "settle"
kind = "settle"
"""

# Dip, length of the plane, share of it that is rock, cohesion and friction of that, friction of the joint, weight above.
PLANES = [(40, 10.0, 0.1, 1e6, 45, 30, 1.3e6), (50, 20.0, 0.05, 2e6, 40, 30, 5e6)]


def bridges():
    about = (
        "A plane of which a share k is rock in its middle, below a layer of even thickness: F = (k c L + W cos α (k tan φ + (1 − k) tan φ_j))/(W sin α) (Jennings 1970). "
        "Both joints end in rock, and go on as rock bridges, which keep their cohesion (ideal plasticity). At 1 % from the limit, at every order and number of contacts. It slides if its block is found to move without end, or goes farther than 0.2 % of the block size, as for keyblock safety."
    )
    text = f'title = "Rock bridges"\ncase  = 48\nabout = """{about}"""\n'
    for k, (dip, length, share, cohesion, rock, joint, weight) in enumerate(PLANES):
        a = math.radians(dip)
        factor = (share * cohesion * length + weight * math.cos(a) * (share * tangent(rock) + (1 - share) * tangent(joint))) / (weight * math.sin(a))
        half = 0.5 * share * length
        FILES[f"scenarios/bridge_{k}.toml"] = NOTE + SLOPE.format(
            dip=dip, length=length, density=number(weight / (G * length)), begin=0.5 * length - half, end=0.5 * length + half, beyond=length + 1, joint=joint, rock=rock,
            cohesion=cohesion,
        )  # fmt: skip
        for side, of, bound in (("holds", 0.99, {"at_most": 0.1}), ("slides", 1.01, {"at_least": 1})):
            text += f'\n[[run]]\nname = "plane of {dip}°, F = {factor:.6f}: {side}"\nscenario = "scenarios/bridge_{k}.toml"\nset = ["joints.strength_factor={of * factor:.9f}"]\n{WAYS}'
            text += quantity(
                "blocks that move, or way over 0.2 % of the block size",
                "max(summary('stages.0.equilibrium.moving_blocks'), summary('stages.0.damage.displacement_max_m')/0.0065)", **bound,
            )  # fmt: skip
    case("bridges", text)
