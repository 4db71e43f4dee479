#!/usr/bin/env python3
"""Compares rules of time integration: what they bring down in shaken tunnels, what they cost, and problems with known answers.

    integrators.py KEYBLOCK [--realizations N] [--scenes REGEX] [--rules REGEX] [--json FILE] [--table FILE]

Each scene is a tunnel in a jointed rock mass; the same realizations are run with every rule, one after another, so that the times of a
realization are of the same minutes. Times depend on the machine and on what else it does: compare them within a scene. `--table` prints the tables
of a file that `--json` wrote.
"""

import argparse
import csv
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "verification" / "scenarios"

# name: overrides
RULES = {
    "shi": [],
    "shi, θ 0.9": ["solver.theta=0.9"],
    "shi, θ 0.7": ["solver.theta=0.7"],
    "shi, θ 0.5": ["solver.theta=0.5"],
    "generalized-α, 0": ["solver.integrator=generalized-alpha", "solver.spectral_radius=0"],
    "generalized-α, 0.3": ["solver.integrator=generalized-alpha", "solver.spectral_radius=0.3"],
    "generalized-α, 0.8": ["solver.integrator=generalized-alpha", "solver.spectral_radius=0.8"],
    "shi, Δt 0.5 ms": ["time.step=0.0005"],
    "generalized-α, 0, Δt 0.5 ms": ["solver.integrator=generalized-alpha", "solver.spectral_radius=0", "time.step=0.0005"],
    "average acceleration": ["solver.integrator=average-acceleration"],
}

TUNNEL = """title = "A shaken tunnel"

[section]
azimuth = 0.0

[domain]
x = [-8.0, 8.0]
y = [-8.0, 8.0]

[rock]
density = 2500.0
young = 5.0e9
poisson = 0.2
state = "plane-strain"

[joints]
friction = 30.0

{sets}
[in_situ]
depth = 10.0
k0 = 0.5

[[excavation]]
name = "tunnel"
shape = "circle"
center = [0.0, 0.0]
diameter = 5.0

[time]
step = 0.002

[[motion]]
name = "sine"
x = {{ amplitude = {amplitude}, frequency = {frequency}, cycles = 6 }}

[[stage]]
name = "in situ"
kind = "settle"

[[stage]]
name = "excavated"
kind = "settle"
excavate = ["tunnel"]

{rest}[[stage]]
name = "shake"
kind = "shake"
motion = "sine"
duration = 2.2

[output]
frame_interval = 1.0
contact_interval = 1.0
"""

SET = """[[joint_set]]
name = "J{k}"
dip = {dip}
dip_direction = {direction}
spacing = {{ mean = {spacing}, std = 0.2, distribution = "uniform" }}
length = {length}
gap = {gap}

"""
ENDLESS = "100.0", "0.0"
SHORT = '{ mean = 3.0, std = 1.0, distribution = "uniform" }', '{ mean = 0.3, std = 0.1, distribution = "uniform" }'
REST = '[[stage]]\nname = "quiet"\nkind = "rest"\nduration = 1.0\n\n'


def joint_sets(*sets, persistence):
    length, gap = persistence
    return "".join(SET.format(k=k + 1, dip=dip, direction=direction, spacing=spacing, length=length, gap=gap)
                   for k, (dip, direction, spacing) in enumerate(sets))


TWO, THREE = ((50.0, 0.0, 0.8), (60.0, 180.0, 0.9)), ((55.0, 0.0, 0.75), (65.0, 180.0, 0.8), (12.0, 0.0, 0.7))
# What is loose comes down before the shaking; what comes down while it shakes; blocks that strike others all the time.
SCENES = {
    "two sets, loose blocks down before": TUNNEL.format(sets=joint_sets(*TWO, persistence=ENDLESS), amplitude=6.0, frequency=3.0, rest=REST),
    "two sets, strongly shaken": TUNNEL.format(sets=joint_sets(*TWO, persistence=ENDLESS), amplitude=15.0, frequency=3.0, rest=""),
    "three sets, blocks fall while it shakes": TUNNEL.format(sets=joint_sets(*THREE, persistence=SHORT), amplitude=8.0, frequency=4.0, rest=""),
}


def run(keyblock, scenario, folder, overrides):
    command = ["nice", "-n", "10", keyblock, "run", scenario, "-o", folder / "out", "--force", "--threads", "1", *overrides]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stderr}")
    return json.loads((folder / "out" / "summary.json").read_text())


def settings(*overrides):
    return [word for override in overrides for word in ("--set", override)]


def measure_tunnel(keyblock, scenario, folder, realization, rule):
    summary = run(keyblock, scenario, folder, ["--realization", str(realization), *settings(*RULES[rule])])
    dynamic = [stage for stage in summary["stages"] if stage["kind"] != "settle"]
    damage = dynamic[-1]["damage"]
    steps = sum(stage["steps"] for stage in dynamic)
    return {
        "realization": realization, "blocks": summary["blocks"],
        "fallen_blocks": damage["fallen_blocks"], "fallen_area_m2": damage["fallen_area_m2"], "loosened_area_m2": damage["loosened_area_m2"],
        "largest_slip_mm": 1e3 * damage["slip_max_m"], "mean_slip_mm": 1e3 * damage["slip_mean_m"],
        "solutions_per_step": summary["open_close"]["mean_iterations"], "unconverged_steps": summary["open_close"]["unconverged_steps"],
        "ms_per_step": 1e3 * sum(stage["wall_time_s"] for stage in dynamic) / steps,
        "energy_residual": summary["energy"]["residual_ratio"], "largest_overlap_mm": 1e3 * summary["max_overlap_m"],
    }


def history(folder):
    with open(folder / "out" / "histories.csv", newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}


def slid(keyblock, folder, scenario, overrides):
    """m, of the block in the dynamic stages: since the last row at the time 0, if there is one, and else since the start."""
    run(keyblock, CASES / scenario, folder, settings(*overrides))
    rows = history(folder)
    still = [x for t, x in zip(rows["time"], rows["s.ux"]) if t == 0.0]
    return rows["s.ux"][-1] - (still[-1] if still else 0.0)


def gravity(slope):
    return f"gravity=[{9.81 * math.sin(math.radians(slope))!r}, {-9.81 * math.cos(math.radians(slope))!r}]"


def slides(slope, friction, step):
    """Error of the way of a block that is set down on an incline."""
    def measure(keyblock, folder, rule):
        way = slid(keyblock, folder, "incline.toml", [gravity(slope), f"joints.friction={friction}", f"time.step={step}", *RULES[rule]])
        known = 0.5 * 9.81 * (math.sin(math.radians(slope)) - math.cos(math.radians(slope)) * math.tan(math.radians(friction)))
        return way / known - 1.0
    return measure


def sticks(step):
    """m, a block that is set down and has to stay."""
    def measure(keyblock, folder, rule):
        return abs(slid(keyblock, folder, "incline.toml", [gravity(30.0), "joints.friction=31.0", f"time.step={step}", *RULES[rule]]))
    return measure


def creeps(step):
    """Error of the way of a block that is held at 99.5 % of its limit and shaken horizontally by 1 m/s² at 20 Hz."""
    def measure(keyblock, folder, rule):
        turn = math.radians(25.0)
        motion = [f"motion.base.x.amplitude={-math.cos(turn)!r}", f"motion.base.y.amplitude={-math.sin(turn)!r}"]
        return slid(keyblock, folder, "creeping.toml", [*motion, f"time.step={step}", *RULES[rule]]) / 0.00832 - 1.0
    return measure


def wave(frequency, step):
    """Share of the height that a vibration of this frequency loses in a cycle, without damping of rock and contacts."""
    def measure(keyblock, folder, rule):
        cycles = 20
        omega = 2 * math.pi * frequency
        run(keyblock, CASES / "block_on_spring.toml", folder, settings(
            f"support.0.stiffness={2600.0 * omega**2!r}", f"time.step={step}", f"stage.swing.duration={round(cycles / frequency / step) * step!r}", *RULES[rule]))
        x = history(folder)["b.ux"]
        # Of an oscillation x_{n+1} = t x_n − d x_{n−1}: least squares over all rows.
        a = [[sum(p * q for p, q in zip(u, v)) for v in (x[1:-1], x[:-2])] for u in (x[1:-1], x[:-2])]
        b = [sum(p * q for p, q in zip(u, x[2:])) for u in (x[1:-1], x[:-2])]
        det = a[0][0] * a[1][1] - a[0][1] * a[1][0]
        t, d = (b[0] * a[1][1] - a[0][1] * b[1]) / det, -(a[0][0] * b[1] - a[1][0] * b[0]) / det
        angle = math.acos(max(-1.0, min(1.0, 0.5 * t / math.sqrt(d))))
        return 1.0 - d ** (math.pi / angle)
    return measure


# name: (how, unit)
KNOWN = {
    "slides 28°, φ 15°, Δt 20 ms": (slides(28.0, 15.0, 0.02), "%"),
    "slides 25°, φ 24°, 20 ms": (slides(25.0, 24.0, 0.02), "%"),
    "2 ms": (slides(25.0, 24.0, 0.002), "%"),
    "0.5 ms": (slides(25.0, 24.0, 0.0005), "%"),
    "sticks 30°, φ 31°, 2 ms": (sticks(0.002), "µm"),
    "0.1 ms": (sticks(0.0001), "µm"),
    "creeps, 2 ms": (creeps(0.002), "%"),
    "1 ms": (creeps(0.001), "%"),
    "0.2 ms": (creeps(0.0002), "%"),
    "vibration of 3 Hz, 2 ms": (wave(3.0, 0.002), "%"),
    "10 Hz, 2 ms": (wave(10.0, 0.002), "%"),
    "30 Hz, 2 ms": (wave(30.0, 0.002), "%"),
}
SCALE = {"%": 100.0, "µm": 1e6}


def significant(x):
    return f"{x:.2f}" if abs(x) < 10 else f"{x:.1f}" if abs(x) < 100 else f"{x:.0f}"


def print_known(known):
    print("\n| problem | " + " | ".join(known) + " |\n|---|" + "---|" * len(known))
    for name, (_, unit) in KNOWN.items():
        print(f"| {name}, {unit} | " + " | ".join(significant(SCALE[unit] * known[rule][name]) for rule in known) + " |")


def print_tunnels(scene, rules):
    first = next(iter(rules.values()))
    print(f"\n{scene}: {len(first)} realizations, {statistics.mean(row['blocks'] for row in first):.0f} blocks\n")
    print("| rule | fallen blocks | m² | more, fewer blocks than `shi` | loosened m² | largest slip, median, mm | largest, mm | solutions a step | time of `shi` | energy residual, mean, largest | overlap, mean, largest, mm |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    base = rules.get("shi", first)
    for rule, rows in rules.items():
        def mean(key):
            return statistics.mean(row[key] for row in rows)

        def most(key):
            return max(row[key] for row in rows)
        pairs = [(row["fallen_blocks"], other["fallen_blocks"]) for row, other in zip(rows, base)]
        time = statistics.median(row["ms_per_step"] / other["ms_per_step"] for row, other in zip(rows, base))
        print(f"| {rule} | {mean('fallen_blocks'):.2f} | {mean('fallen_area_m2'):.3f} | {sum(a > b for a, b in pairs)}, {sum(a < b for a, b in pairs)} | "
              f"{mean('loosened_area_m2'):.2f} | {statistics.median(row['largest_slip_mm'] for row in rows):.2f} | {most('largest_slip_mm'):.0f} | "
              f"{mean('solutions_per_step'):.1f} | {time:.2f} | {100 * mean('energy_residual'):.2f}, {100 * most('energy_residual'):.2f} % | "
              f"{mean('largest_overlap_mm'):.2f}, {most('largest_overlap_mm'):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keyblock", nargs="?")
    parser.add_argument("--realizations", type=int, default=20)
    parser.add_argument("--scenes", default="", help="regular expression; `known` for the problems with known answers")
    parser.add_argument("--rules", default="")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--table", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.table:
        results = json.loads(arguments.table.read_text())
    else:
        results = measure(arguments)
    if results["known"]:
        print_known(results["known"])
    for scene, rules in results["scenes"].items():
        print_tunnels(scene, rules)


def measure(arguments):
    rules = [rule for rule in RULES if re.search(arguments.rules, rule)]
    results = {"known": {}, "scenes": {}}
    if arguments.json and arguments.json.exists():
        results = json.loads(arguments.json.read_text())

    def keep():
        if arguments.json:
            arguments.json.write_text(json.dumps(results, ensure_ascii=False, indent=1) + "\n")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if re.search(arguments.scenes, "known"):
            for rule in (rule for rule in rules if "Δt" not in rule):
                results["known"][rule] = {problem: how(arguments.keyblock, folder, rule) for problem, (how, _) in KNOWN.items()}
                keep()
        for scene, text in SCENES.items():
            if not re.search(arguments.scenes, scene):
                continue
            (folder / "scene.toml").write_text(text)
            of_scene = results["scenes"].setdefault(scene, {})
            for realization in range(arguments.realizations):
                for rule in rules:
                    rows = of_scene.setdefault(rule, [])
                    if any(row["realization"] == realization for row in rows):
                        continue
                    rows.append(measure_tunnel(arguments.keyblock, folder / "scene.toml", folder, realization, rule))
                    print(f"{scene}, {realization}, {rule}: {rows[-1]['fallen_blocks']} blocks, {rows[-1]['ms_per_step']:.2f} ms", file=sys.stderr)
                keep()
    return results


if __name__ == "__main__":
    main()
