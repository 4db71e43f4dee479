"""Case 22, semicircular arches, as generate.py writes it."""

import math

from case_text import FIXED, box, case, quantity, scenario

LEAST_THICKNESS = {9: 0.10213, 15: 0.10627, 21: 0.10679, 27: 0.10678}  # over the mean radius


def arch_blocks(count, ratio, arcs=6):
    """Voussoirs of mean radius 1 m times 10 whose faces are chords of the arcs."""
    radius = 10.0
    inner, outer = radius * (1 - ratio / 2), radius * (1 + ratio / 2)
    blocks = [("left", box(-outer - 1, -1, outer - inner + 2, 1), FIXED), ("right", box(inner - 1, -1, outer - inner + 2, 1), FIXED)]
    for k in range(count):
        angles = [math.pi * (k + j / arcs) / count for j in range(arcs + 1)]
        ring = [(outer * math.cos(t), outer * math.sin(t)) for t in angles] + [(inner * math.cos(t), inner * math.sin(t)) for t in reversed(angles)]
        blocks.append((f"v{k}", [(round(x, 12), round(abs(y) if abs(y) < 1e-9 else y, 12)) for x, y in ring], ""))
    return blocks


def arches():
    text = '''title = "Semicircular arch"
case  = 22
about = """A semicircular arch of N equal rigid voussoirs stands under its own weight when it is thick enough (Milankovitch 1907; Heyman 1969). Least thickness over mean radius, for hinges at the joints alone: 0.10213, 0.10627, 0.10679 and 0.10678 with N = 9, 15, 21, 27. 2 % thicker it stands, 2 % thinner it falls, and so it does with 0.5 %; friction 50°, so that no joint slides, and joints so stiff that what they are crushed by at the hinges counts for nothing beside 0.5 % of the thickness."""
'''
    for count, least in LEAST_THICKNESS.items():
        for word, share, factor in (("thicker", "2 %", 1.02), ("thicker", "0.5 %", 1.005), ("thinner", "0.5 %", 0.995), ("thinner", "2 %", 0.98)):
            name = f"arch_{count}_{round(1000 * factor)}"
            crown = f"v{count // 2}"
            scenario(
                name, title=f"An arch of {count} voussoirs, {share} {word} than the least that stands",
                rock='density = 2600.0\nyoung = 1.0e12\npoisson = 0.0\nstate = "plane-stress"',
                joints="friction = 50.0\nnormal_stiffness = 1.0e15", step=0.001,
                blocks=arch_blocks(count, least * factor), histories=[("crown", crown, (0.0, 10.0))],
                stages='[[stage]]\nname = "stand"\nkind = "rest"\nduration = 4.0\n',
            )
            text += f'\n[[run]]\nname = "{count} voussoirs, {share} {word}"\nscenario = "scenarios/{name}.toml"\n'
            text += quantity("way of the crown in 4 s", "maxabs('crown.uy')", "m", **({"at_most": 0.01} if word == "thicker" else {"at_least": 0.5}))
    case("arch", text)
