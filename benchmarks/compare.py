#!/usr/bin/env python3
"""Whether one program is faster than another: the tunnel of example 01 in many realizations, shortly, by both at once.

    compare.py BEFORE AFTER [--order N] [--realizations N] [--seconds S]

Which steps have impacts is decided by the last digit of a sum, so that one realization takes 15 % more or less time with any change of
rounding. Of many, the geometric mean of the ratios says what the change is worth, and its standard error how well that is known. The two
run at once, each on a processor of its own, which they exchange from one realization to the next.
"""

import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import tempfile

import bench

STAGES = ("quiet", "first earthquake")


def begin(keyblock, folder, processor, scene):
    text, overrides = scene
    folder.mkdir()
    (folder / "scene.toml").write_text(text)
    command = [keyblock, "run", folder / "scene.toml", "-o", folder / "out"]
    for override in overrides:
        command += ["--set", override]
    with open(folder / "log", "w") as log:
        return subprocess.Popen(
            command, stdout=log, stderr=log, preexec_fn=lambda: os.sched_setaffinity(0, {processor})
        )


def end(process, folder):
    """Seconds of the dynamic stages, solutions a step and state."""
    if process.returncode != 0:
        raise RuntimeError(f"{process.args[0]} failed:\n{(folder / 'log').read_text()}")
    summary = json.loads((folder / "out" / "summary.json").read_text())
    seconds = sum(stage["wall_time_s"] for stage in summary["stages"] if stage["name"] in STAGES)
    return seconds, summary["open_close"]["mean_iterations"], summary["state_hash"]


def measure(programs, seed, order, seconds):
    text, overrides = bench.tunnel(order, seconds)
    scene = text, [*overrides, f"seed={seed}", f"stage.quiet.duration={2 * seconds}"]
    processors = sorted(os.sched_getaffinity(0))[:2]
    if len(processors) < 2:
        raise RuntimeError("needs two processors")
    with tempfile.TemporaryDirectory() as folder:
        folders = [pathlib.Path(folder) / name for name in ("before", "after")]
        running = [begin(p, f, processors[(k + seed) % 2], scene) for k, (p, f) in enumerate(zip(programs, folders))]
        for process in running:
            process.wait()  # both, before the folder goes with what one of them says of its failure
        return [end(process, f) for process, f in zip(running, folders)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--order", type=int, default=1)
    parser.add_argument("--realizations", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=0.2, help="of shaking, after twice as many of rest")
    arguments = parser.parse_args()
    if arguments.realizations < 2:
        parser.error("--realizations: at least 2")
    programs = [p.resolve(strict=True) for p in (arguments.before, arguments.after)]
    logarithms, solutions, same = [], [0.0, 0.0], 0
    for seed in range(1, arguments.realizations + 1):
        before, after = measure(programs, seed, arguments.order, arguments.seconds)
        logarithms.append(math.log(after[0] / before[0]))
        solutions = [s + r[1] / arguments.realizations for s, r in zip(solutions, (before, after))]
        same += before[2] == after[2]
    error = statistics.stdev(logarithms) / math.sqrt(len(logarithms))
    print(f"time, after over before: {math.exp(statistics.mean(logarithms)):.3f} ± {error:.3f} "
          f"(median {math.exp(statistics.median(logarithms)):.3f}), {len(logarithms)} realizations of order {arguments.order}")
    print(f"solutions a step: {solutions[0]:.2f}, {solutions[1]:.2f}; the same bits in {same} realizations")


if __name__ == "__main__":
    main()
