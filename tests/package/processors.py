#!/usr/bin/env python3
"""Programs that were built for several kinds of processors end in the same state, bit by bit.

    processors.py PROGRAM PROGRAM…

Five scenarios, of which each has solvers and laws of its own. Dynamic stages are cut to 100 steps. A program whose instructions this
processor lacks is named and left out. Exit code 1 where a state differs, or fewer than two programs can run."""

import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
from state_hashes import cut_short, state_hash  # noqa: E402

MOST_STEPS = 100
SCENARIOS = {
    "a tunnel, shaken": ("01-tunnel", []),
    "a tunnel, blocks of order 2, generalized alpha": ("01-tunnel", ["rock.order=2", 'solver.integrator="generalized-alpha"']),
    "masonry": ("04-wall", []),
    "an opening in parts, conjugate residuals": ("10-heading-and-bench", ["--solver=iterative"]),
    "a tunnel in waves": ("11-tunnel-in-waves", []),
}


def starts(program):
    done = subprocess.run([program, "--version"], capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{program}: left out: {done.stderr.strip()}")
    return done.returncode == 0


def main(programs):
    able = [program for program in programs if starts(program)]
    if len(able) < 2:
        print("fewer than two programs run on this processor")
        return 1
    differ = 0
    for name, (example, values) in SCENARIOS.items():
        path = ROOT / f"examples/{example}.toml"
        hashes = {}
        for program in able:
            begin = time.monotonic()
            hashes[program] = state_hash(program, path, [*cut_short(path, MOST_STEPS), *values], 2)
            print(f"{hashes[program]:>40}  {time.monotonic() - begin:6.1f} s  {program}", flush=True)
        same = len(set(hashes.values())) == 1 and "exit code" not in hashes[able[0]]
        differ += not same
        print(f"{name}: {'the same bits' if same else 'NOT the same'}", flush=True)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
