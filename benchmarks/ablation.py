#!/usr/bin/env python3
"""What each accelerator is worth: scenes run with all of them, and with each one switched off, alone.

    ablation.py PROGRAM [--realizations N] [--seconds S] [--without NAME ...] [--scenes REGEX]

Processor time, so that other work on the machine matters little; cutting and settling, which a very short run takes, are taken off.
Prints a Markdown table: the geometric mean of the ratios, without over with, its standard error, and the largest ratio of a scene.
A ratio of 1.00 says that the accelerator gains nothing.
"""

import argparse
import math
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

import bench
import scenes

NAMES = ["kept-factor", "low-rank-update", "local-solve", "increment-history", "earlier-attempt",
         "steady-pairs", "single-precision"]


def processor_seconds(keyblock, scene, arguments):
    text, overrides = scene
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(text)
        command = [keyblock, "run", folder / "scene.toml", "-o", folder / "out", "--threads", "1", *arguments]
        for override in overrides:
            command += ["--set", override]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        message = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            raise RuntimeError(f"{command} failed:\n{message.decode()}")
        return usage.ru_utime


def tunnel(order, seed, seconds):
    text, overrides = bench.tunnel(order, seconds)
    return text, [*overrides, f"seed={seed}", f"stage.quiet.duration={seconds}"]


def kinds(realizations, seconds):
    """name: pairs of a scene and the same with next to no steps."""
    def tunnels(order, count, length):
        return [(tunnel(order, s, length), tunnel(order, s, 0.002)) for s in range(1, count + 1)]

    def one(make, length):  # as often as tells its noise
        return 5 * [((make(length), []), (make(0.004), []))]

    return {
        "tunnels, order 1": tunnels(1, realizations, seconds),
        "tunnels, order 2": tunnels(2, max(2, realizations // 5), seconds / 4),
        "wall of 512 bricks": one(lambda t: scenes.wall(20, 25, t), seconds),
        "grid of 1,000 blocks": one(lambda t: scenes.grid(1_000, t), seconds),
    }


def ratios(keyblock, pairs, names):
    """name: for each scene, processor time without it over that with it."""
    found = {name: [] for name in names}
    for scene, begun in pairs:
        base = processor_seconds(keyblock, begun, [])
        whole = processor_seconds(keyblock, scene, []) - base
        for name in names:
            found[name].append((processor_seconds(keyblock, scene, ["--without", name]) - base) / whole)
    return found


def cell(values):
    logarithms = [math.log(v) for v in values]
    mean = math.exp(statistics.mean(logarithms))
    error = statistics.stdev(logarithms) / math.sqrt(len(values))
    return f"{mean:.2f} ± {error:.2f} (at most {max(values):.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--realizations", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=0.8, help="of rest, and as many of shaking")
    parser.add_argument("--scenes", default="", help="only those whose name it matches")
    parser.add_argument("--without", nargs="+", default=NAMES, choices=NAMES)
    arguments = parser.parse_args()
    if arguments.realizations < 2:
        parser.error("--realizations: at least 2")
    keyblock = arguments.program.resolve(strict=True)
    table = {kind: ratios(keyblock, pairs, arguments.without)
             for kind, pairs in kinds(arguments.realizations, arguments.seconds).items()
             if re.search(arguments.scenes, kind)}
    print("| without | " + " | ".join(table) + " |")
    print("|---" * (len(table) + 1) + "|")
    for name in arguments.without:
        print(f"| `{name}` | " + " | ".join(cell(table[kind][name]) for kind in table) + " |")


if __name__ == "__main__":
    main()
