#!/usr/bin/env python3
"""Whether two programs end in the same state, bit by bit: the tool beside a rebuilding that changes no result.

    state_hashes.py PROGRAM --write FILE        the hash of the state at the end of each scenario, as JSON
    state_hashes.py PROGRAM --against FILE      compares with such a file; exit code 1 where one differs

Scenarios: all examples without a study, all scenarios of the verification, those of tests/data/hard, and variants of
examples/01-tunnel.toml (orders, rules of integration, contact, solvers). Dynamic stages are cut to --steps steps (400), static stages
to twice as many as they are given. Hashes depend on the machine's C library, so no file of them is kept here.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[1]
TUNNEL = ROOT / "examples/01-tunnel.toml"
VARIANTS = {
    "order 2": ["rock.order=2"],
    "order 3": ["rock.order=3"],
    "average acceleration": ['solver.integrator="average-acceleration"'],
    "generalized alpha": ['solver.integrator="generalized-alpha"'],
    "generalized alpha, order 2": ['solver.integrator="generalized-alpha"', "rock.order=2"],
    "conjugate residuals": ["--solver=iterative"],
    "block Cholesky": ["--solver=block"],
    "cohesion": ["joints.cohesion=2e4", "joints.tension=1e4"],
    "strong shaking": ["stage.3.scale=5.0"],
    "another rock": ["seed=7"],
}


def scenarios():
    """Name, file and values of each."""
    folders = ("examples", "verification/scenarios", "tests/data/hard")
    for path in sorted(p for folder in folders for p in (ROOT / folder).glob("*.toml")):
        if "study" not in tomllib.loads(path.read_text()):
            yield str(path.relative_to(ROOT)), path, []
    for name, values in VARIANTS.items():
        yield f"examples/01-tunnel.toml, {name}", TUNNEL, values


def cut_short(path, most_steps):
    """Values that end dynamic stages after so many steps."""
    scenario = tomllib.loads(path.read_text())
    step = scenario.get("time", {}).get("step", 0.001)
    return [
        f"stage.{k}.duration={most_steps * step!r}"
        for k, stage in enumerate(scenario.get("stage", []))
        if stage.get("kind") != "settle" and stage.get("duration", float("inf")) > most_steps * step
    ]


def state_hash(program, path, values, threads):
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", path, "-o", f"{folder}/out", "--threads", str(threads)]
        for value in values:
            command += [value] if value.startswith("--") else ["--set", value]
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            return f"exit code {done.returncode}: {done.stderr.strip().splitlines()[-1:]}"
        summary = json.loads(pathlib.Path(folder, "out/summary.json").read_text())
        return f"{summary['state_hash']} after {summary['steps']} steps"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", metavar="FILE", type=pathlib.Path)
    what.add_argument("--against", metavar="FILE", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=400, help="most steps of a dynamic stage (400)")
    parser.add_argument("--threads", type=int, default=1, help="of a run (1); hashes are the same for any number")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at once")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    hashes = {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        running = {
            name: pool.submit(state_hash, program, path, [*cut_short(path, arguments.steps), *values], arguments.threads)
            for name, path, values in scenarios()
        }
        for name, hash_of in running.items():
            hashes[name] = hash_of.result()
    if arguments.write:
        arguments.write.write_text(json.dumps(hashes, indent=1) + "\n")
        print(f"{len(hashes)} hashes in {arguments.write}")
        return 0
    known = json.loads(arguments.against.read_text())
    differ = [name for name in sorted(hashes | known) if hashes.get(name) != known.get(name)]
    for name in differ:
        print(f"{name}: {known.get(name, 'not known')} | {hashes.get(name, 'not there any more')}")
    print(f"{len(hashes) - len(differ)} of {len(hashes)} states are the same")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
