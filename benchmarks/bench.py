#!/usr/bin/env python3
"""Times whole scenes against the goals, prints a table and writes JSON.

    bench.py KEYBLOCK [--json FILE] [--scenes REGEX] [--repeat N] [--instructions]

Each scene is run as a user would run it; the time of a step is that of its shaking stage, from summary.json, the median of the
repetitions; that of many tunnels is their mean, each run once. Machines differ and are shared: compare ratios taken in one run. With
--instructions a few steps of each scene are run under valgrind, whose counts are the same on every rerun; KEYBLOCK is then the program
of the preset `profile`.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
TUNNEL = (ROOT / "examples" / "01-tunnel.toml").read_text().replace('"motions/', f'"{ROOT}/examples/motions/')
QUAKE_STAGE = "first earthquake"
QUAKE = f"stage.'{QUAKE_STAGE}'"


def tunnel(order, duration=None):
    """The demo; `duration`: s of its shaking, all of it where nothing is said."""
    overrides = [f"rock.order={order}", "stage.after.duration=0.002"]
    return TUNNEL, overrides if duration is None else [*overrides, f"{QUAKE}.duration={duration}"]


def hard_tunnel(name):
    """One whose steps are hard, by its file."""
    text = (ROOT / "benchmarks" / "hard-tunnels" / f"{name}.toml").read_text()
    return text.replace('"../../examples/motions/', f'"{ROOT}/examples/motions/'), []


# s of shaking, the same for all: their first steps are unlike those that follow, and one frame is written in each
GRIDS = 0.08

# name: (scenario and overrides, stage, goal in ms a step or None, arguments)
STEPS = {
    "tunnel, order 1": (lambda: tunnel(1), QUAKE_STAGE, 0.6, []),
    "tunnel, order 2": (lambda: tunnel(2), QUAKE_STAGE, None, []),
    "tunnel, order 1, first 2 s": (lambda: tunnel(1, 2.0), QUAKE_STAGE, None, []),
    "tunnel, order 2, first 2 s": (lambda: tunnel(2, 2.0), QUAKE_STAGE, None, []),
    "hard tunnel, steep sets": (lambda: hard_tunnel("steep-sets"), "quake", None, []),
    "hard tunnel, blocky": (lambda: hard_tunnel("blocky"), "quake", None, []),
    "wall of 512 bricks": (lambda: (scenes.wall(20, 25, 1.0), []), "shake", 0.4, []),
    "wall of 2,025 bricks": (lambda: (scenes.wall(40, 50, 0.4), []), "shake", 1.8, []),
    "grid of 1,000 blocks": (lambda: (scenes.grid(1_000, GRIDS), []), "shake", None, []),
    "grid of 10,000 blocks": (lambda: (scenes.grid(10_000, GRIDS), []), "shake", None, []),
    "grid of 20,000 blocks": (lambda: (scenes.grid(20_000, GRIDS), []), "shake", None, []),
    "grid of 20,000 blocks, 2 threads": (lambda: (scenes.grid(20_000, GRIDS), []), "shake", None, ["--threads", "2"]),
    "grid of 100,000 blocks": (lambda: (scenes.grid(100_000, GRIDS), []), "shake", None, []),
}
# How hard a tunnel is to compute is decided by what falls in it, so that one says little of the others.
SEEDS = range(1, 11)
# name: order
MANY = {f"{len(SEEDS)} other tunnels, order {order}, first 1 s": order for order in (1, 2)}
CUTS = {"cutting 20,000 cells": (20_000, 0.3), "cutting 1,000,000 cells": (1_000_000, 30.0)}

# name: scenario and overrides; their dynamic steps are counted, settling is not
COUNTED = {
    "tunnel, order 1": lambda: (TUNNEL, ["stage.quiet.duration=0.1", f"{QUAKE}.duration=0.1", "stage.after.duration=0.002"]),
    "wall of 512 bricks": lambda: (scenes.wall(20, 25, 0.1), []),
    "grid of 1,000 blocks": lambda: (scenes.grid(1_000, 0.1), []),
}


def run(command):
    """Wall time in s and largest memory in kB."""
    before = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    error = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{error}")
    return time.perf_counter() - before, usage.ru_maxrss


def step_scene(keyblock, folder, scene, arguments):
    text, overrides = scene
    (folder / "scene.toml").write_text(text)
    command = [keyblock, "run", folder / "scene.toml", "-o", folder / "out", "--force", *arguments]
    for override in overrides:
        command += ["--set", override]
    _, memory = run(command)
    return json.loads((folder / "out" / "summary.json").read_text()), memory


def time_steps(keyblock, scene, stage_name, arguments):
    """ms a step, summary.json and largest memory in kB."""
    with tempfile.TemporaryDirectory() as folder:
        summary, memory = step_scene(keyblock, pathlib.Path(folder), scene, arguments)
    stage = next(s for s in summary["stages"] if s["name"] == stage_name)
    return 1e3 * stage["wall_time_s"] / stage["steps"], summary, memory


def measure_many(keyblock, name, _):
    """The mean over realizations, each run once."""
    text, overrides = tunnel(MANY[name], 1.0)
    times = [time_steps(keyblock, (text, [*overrides, f"seed={seed}"]), QUAKE_STAGE, [])[0] for seed in SEEDS]
    return {"value": statistics.mean(times), "unit": "ms/step", "goal": None, "all": times}


def measure_steps(keyblock, name, repeat):
    make, stage_name, goal, arguments = STEPS[name]
    times = []
    for _ in range(repeat):
        time_of_step, summary, memory = time_steps(keyblock, make(), stage_name, arguments)
        times.append(time_of_step)
    blocks = summary["blocks"]
    return {"value": statistics.median(times), "unit": "ms/step", "goal": goal, "all": times, "blocks": blocks,
            "solutions_per_step": summary["open_close"]["mean_iterations"], "kB_per_block": memory / blocks,
            "state_hash": summary["state_hash"], "profile": summary["profile"]}


def count_instructions(keyblock, name):
    text, overrides = COUNTED[name]()
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = pathlib.Path(name_of_folder)
        (folder / "scene.toml").write_text(text)
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder / 'counts'}",
                   "--toggle-collect=keyblock::dynamics::Stepper::advance(*",
                   keyblock, "run", folder / "scene.toml", "-o", folder / "out"]
        for override in overrides:
            command += ["--set", override]
        run(command)
        counted = int(re.search(r"^(?:totals|summary): (\d+)", (folder / "counts").read_text(), re.MULTILINE)[1])
        stages = json.loads((folder / "out" / "summary.json").read_text())["stages"]
    steps = sum(stage["steps"] for stage in stages if stage["kind"] != "settle")
    return {"value": counted / steps / 1e6, "unit": "M/step", "goal": None}


def measure_cut(keyblock, name, repeat):
    cells, goal = CUTS[name]
    times = []
    for _ in range(repeat):
        with tempfile.TemporaryDirectory() as name_of_folder:
            folder = pathlib.Path(name_of_folder)
            (folder / "scene.toml").write_text(scenes.grid(cells, 0.1))
            seconds, memory = run([keyblock, "cut", folder / "scene.toml", "-o", folder / "out"])
            times.append(seconds)
    return {"value": statistics.median(times), "unit": "s", "goal": goal, "all": times, "MB": memory / 1000.0}


def machine():
    """Kinds of processors that share a name differ by family and model."""
    cpu = {}
    for line in open("/proc/cpuinfo"):
        name, _, value = line.partition(":")
        cpu.setdefault(name.strip(), value.strip())
    model = cpu.get("model name", "")
    if "cpu family" in cpu:
        model += f" (family {cpu['cpu family']}, model {cpu['model']})"
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True, check=False).stdout.split("\n")[0]
    return {"processor": model, "cores": os.cpu_count(), "system": f"{platform.system()} {platform.machine()}", "compiler": compiler}


def derived(results):
    """Goals on ratios of scenes."""
    rows = {}
    get = lambda name: results.get(name, {}).get("value")  # noqa: E731
    for row, one, two in (
        ("tunnel, order 2 over order 1", "tunnel, order 1", "tunnel, order 2"),
        ("tunnel, order 2 over order 1, first 2 s", "tunnel, order 1, first 2 s", "tunnel, order 2, first 2 s"),
        (f"{len(SEEDS)} other tunnels, order 2 over order 1", *MANY),
    ):
        if get(one) and get(two):
            rows[row] = {"value": get(two) / get(one), "unit": "x", "goal": 4.0}
    small, large = results.get("grid of 1,000 blocks"), results.get("grid of 100,000 blocks")
    if small and large:
        growth = (large["value"] / large["blocks"]) / (small["value"] / small["blocks"])
        rows["time per block, 100,000 over 1,000"] = {"value": growth, "unit": "x", "goal": 100**0.15}
        rows["memory per block, 100,000"] = {"value": large["kB_per_block"], "unit": "kB", "goal": 12.0}
    serial, parallel = get("grid of 20,000 blocks"), get("grid of 20,000 blocks, 2 threads")
    if serial and parallel:
        rows["2 threads, 20,000 blocks"] = {"value": serial / parallel, "unit": "x faster", "goal": 1.7, "more_is_better": True}
    return rows


def table(results):
    lines = [f"{'scene':<40} {'measured':>12}  {'goal':>8}  {'ratio':>6}"]
    for name, r in results.items():
        goal = "" if r["goal"] is None else f"{r['goal']:.3g}"
        ratio = "" if r["goal"] is None else f"{r['value'] / r['goal']:.2f}"
        lines.append(f"{name:<40} {r['value']:>9.3g} {r['unit']:<8} {goal:>4}  {ratio:>6}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keyblock")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--scenes", default="", help="regular expression on the names")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--instructions", action="store_true", help="count instructions instead of time")
    arguments = parser.parse_args()
    results = {}
    count = lambda keyblock, name, _: count_instructions(keyblock, name)  # noqa: E731
    kinds = ((COUNTED, count),) if arguments.instructions else ((STEPS, measure_steps), (MANY, measure_many), (CUTS, measure_cut))
    for names, measure in kinds:
        for name in names:
            if re.search(arguments.scenes, name):
                print(f"{name} ...", file=sys.stderr)
                results[name] = measure(arguments.keyblock, name, arguments.repeat)
    results |= derived(results)
    print(table(results))
    if arguments.json:
        document = {"date": datetime.date.today().isoformat(), "machine": machine(), "results": results}
        temporary = arguments.json.with_suffix(".tmp")
        temporary.write_text(json.dumps(document, indent=1) + "\n")
        temporary.rename(arguments.json)


if __name__ == "__main__":
    main()
