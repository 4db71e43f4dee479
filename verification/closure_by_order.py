#!/usr/bin/env python3
"""How far a pressed tunnel closes, by the size of its blocks, their order and the stiffness of their joints: the table of the user guide.

    python3 verification/closure_by_order.py [PROGRAM]

The scenario is scenarios/pressed_tunnel.toml with other rings: SECTORS blocks around the tunnel, as thick as they are wide."""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release/keyblock").resolve()
SCENARIO = pathlib.Path(__file__).with_name("scenarios") / "pressed_tunnel.toml"
SECTORS = [12, 16, 24, 32, 48]
STIFFNESS = [None, 8e12]  # Pa/m; None: the default, 20 E per metre
RADIUS, HALF_WIDTH = 1.5, 12.0  # m
LAME = 2e6 * RADIUS * 1.2 / 8e9  # m


def traces(sectors):
    """Polylines: rings, then radial joints."""
    radius = RADIUS * (1 + 2 * math.pi / sectors)
    while radius <= 0.95 * HALF_WIDTH:
        yield [(radius * math.cos(2 * math.pi * k / (4 * sectors)), radius * math.sin(2 * math.pi * k / (4 * sectors)))
               for k in range(4 * sectors + 1)]
        radius *= 1 + 2 * math.pi / sectors
    for k in range(sectors):
        angle = 2 * math.pi * (k + 0.5) / sectors
        yield [(r * math.cos(angle), r * math.sin(angle)) for r in (0.98 * RADIUS, 1.5 * HALF_WIDTH)]


def closure(folder, order, stiffness):
    """What the wall moves in by, of Lame's solution."""
    overrides = [f"rock.order={order}"] + ([] if stiffness is None else [f"joints.normal_stiffness={stiffness}"])
    words = [word for override in overrides for word in ("--set", override)]
    subprocess.run([PROGRAM, "run", folder / "tunnel.toml", "-o", folder / "out", "--force", *words], check=True, capture_output=True)
    with (folder / "out/histories.csv").open() as file:
        return -float(list(csv.DictReader(file))[-1]["side.ux"]) / LAME


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "tunnel.toml").write_text(SCENARIO.read_text())
    print("width/D  " + "  ".join(f"order {order}, {'default' if k is None else f'{k:g} Pa/m'}" for k in STIFFNESS for order in (1, 2)))
    for sectors in SECTORS:
        with (folder / "pressed_tunnel.csv").open("w") as file:
            file.write("trace,x,y\n")
            for number, points in enumerate(traces(sectors)):
                file.writelines(f"{number},{x:.9f},{y:.9f}\n" for x, y in points)
        figures = [closure(folder, order, k) for k in STIFFNESS for order in (1, 2)]
        print(f"D/{2 * RADIUS * sectors / (2 * math.pi * RADIUS):.1f}  " + "  ".join(f"{figure:.3f}" for figure in figures), flush=True)
