#!/usr/bin/env python3
"""Runs random scenarios, and says how many ended and how well: errors by kind, energy residuals by rule of integration, overlaps."""

import argparse
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from all_keys import scenario_of_all_keys
from random_scenario import random_scenario

ROOT = Path(__file__).resolve().parents[2]
MOST_RESIDUAL = 0.01
MOST_OVERLAP = 0.01  # of the size of a block, beyond the depth that contacts press vertices in
MOST_UNEXPLAINED = 0.02  # of the size of a block: depth of a vertex that no closure of a joint explains


class Outcome:
    """How one scenario went."""

    def __init__(self, seed, facts, size):
        self.seed, self.facts, self.size = seed, facts, size
        self.error = ""  # empty: it ended
        self.residual = self.overlap = self.unexplained = self.seconds = 0.0
        self.unconverged = self.across_gaps = 0

    @property
    def is_crash(self):
        """What no scenario may do, whatever is in it."""
        return re.match(r"signal|internal error|no answer|other bits", self.error) is not None

    @property
    def is_refused(self):
        """By `check`, with a reason: ends of springs are drawn without a look at the blocks."""
        return self.error.startswith("exit 1: ") and "found a point of the block of from" in self.error

    def faults(self):
        found = [self.error] if self.error and not self.is_refused else []
        if self.residual > MOST_RESIDUAL:
            found.append(f"energy residual {100 * self.residual:.2f} %")
        if self.overlap > MOST_OVERLAP:
            found.append(f"overlap {100 * self.overlap:.2f} % of a block more than contacts press in")
        if self.unexplained > MOST_UNEXPLAINED:
            found.append(f"a vertex {100 * self.unexplained:.2f} % of a block deeper than joints close")
        if self.across_gaps > 0:
            found.append(f"{self.across_gaps} forces across gaps")
        if self.unconverged > 0:
            found.append(f"{self.unconverged} unconverged steps")
        return found


def run(program, scenario, folder, threads, seconds):
    """The summary, or what went wrong."""
    command = [program, "run", scenario, "-o", folder, "--threads", str(threads), "--force"]
    # Of the processor: what else the machine does is no fault of the run.
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))  # noqa: E731
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, preexec_fn=limit)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None, f"no answer in {seconds} s"
    if done.returncode < 0:
        return None, f"signal {-done.returncode}"
    if done.returncode == 3:
        return None, "internal error: " + done.stderr.splitlines()[0]
    errors_of_computation = done.returncode == 2 and "errors of the computation" in done.stderr
    if done.returncode != 0 and not errors_of_computation:
        lines = [line for line in done.stderr.splitlines() if line and not line.startswith(("warning", scenario.name + ": warning"))]
        return None, f"exit {done.returncode}: {lines[-1] if lines else ''}"
    return json.loads((folder / "summary.json").read_text()), ""


def killed_and_resumed(program, scenario, folder, whole, seed):
    """The hash of the state of a run that is killed at a random moment, and goes on with two threads; what went wrong."""
    command = [program, "run", scenario, "-o", folder, "--threads", "1"]
    started = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    draw = random.Random(seed)
    try:
        started.wait(draw.uniform(0.02, 1.0) * whole)
    except subprocess.TimeoutExpired:
        started.send_signal(draw.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
        started.wait()
    again = subprocess.run([*command[:-1], "2", "--resume"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if again.returncode < 0 or again.returncode == 3 or not (folder / "summary.json").exists():
        # Killed before there was anything to go on with.
        return None, "" if again.returncode == 1 else f"resumed: exit {again.returncode}"
    return json.loads((folder / "summary.json").read_text())["state_hash"], ""


def try_seed(program, seed, seconds, with_two_threads, make=random_scenario, kill=False):
    text, facts, size = make(seed)
    outcome = Outcome(seed, facts, size)
    with tempfile.TemporaryDirectory(prefix="keyblock-random-") as name:
        folder = Path(name)
        scenario = folder / "scenario.toml"
        scenario.write_text(text)
        start = time.monotonic()
        summary, outcome.error = run(program, scenario, folder / "out", 1, seconds)
        outcome.seconds = time.monotonic() - start
        if summary is None:
            return outcome
        outcome.residual = summary["energy"]["residual_ratio"]
        vertices = summary["contact_checks"]
        outcome.overlap = (summary["max_overlap_m"] - vertices["deepest_m"]) / size
        outcome.unexplained = vertices["unexplained_m"] / size
        outcome.across_gaps = vertices["across_gaps"]
        outcome.unconverged = summary["open_close"]["unconverged_steps"]
        if with_two_threads:
            second, outcome.error = run(program, scenario, folder / "two", 2, seconds)
            if second is not None and second["state_hash"] != summary["state_hash"]:
                outcome.error = "other bits with two threads"
        if kill and not outcome.error:
            state, outcome.error = killed_and_resumed(program, scenario, folder / "killed", outcome.seconds, seed)
            if state is not None and state != summary["state_hash"]:
                outcome.error = "other bits when it is killed and resumed"
    return outcome


def without_numbers(text):
    """What errors of one kind have in common."""
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", re.sub(r"/\S*/", "", text))[:100]


def table(outcomes):
    ended = [o for o in outcomes if not o.error]
    lines = [f"{len(outcomes)} scenarios, {len(ended)} ended, {sum(o.seconds for o in outcomes):.0f} s"]
    for kind, count in Counter(without_numbers(o.error) for o in outcomes if o.error).most_common():
        lines.append(f"  error: {count} × {kind}")
    for fact in ("integrator", "order", "kind", "demanding"):
        for value in sorted({o.facts[fact] for o in ended}, key=str):
            of_value = [o for o in ended if o.facts[fact] == value]
            beyond = [o for o in of_value if o.residual > MOST_RESIDUAL]
            deep = [o for o in of_value if o.overlap > MOST_OVERLAP]
            unconverged = [o for o in of_value if o.unconverged > 0]
            lines.append(
                f"  {fact} {value}: {len(of_value)} ended; residual over 1 %: {len(beyond)}, largest {100 * max(o.residual for o in of_value):.3g} %; "
                f"overlap over 1 % of a block: {len(deep)}, largest {100 * max(o.overlap for o in of_value):.3g} %; "
                f"with unconverged steps: {len(unconverged)}; with forces across gaps: {sum(o.across_gaps > 0 for o in of_value)}; "
                f"deepest unexplained: {100 * max(o.unexplained for o in of_value):.3g} %"
            )
    return "\n".join(lines)


def keep(outcome, folder, make):
    folder.mkdir(parents=True, exist_ok=True)
    text, _, _ = make(outcome.seed)
    (folder / f"{outcome.seed}.toml").write_text(f"# {'; '.join(outcome.faults())}\n{text}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=os.environ.get("KEYBLOCK", str(ROOT / "build/release/keyblock")))
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--seeds", type=int, nargs="+", metavar="SEED", help="these, in place of --first and --count")
    parser.add_argument("--minutes", type=float, default=1e9, help="no new scenario after so many")
    parser.add_argument("--seconds", type=int, default=60, help="of the processor, for one run")
    parser.add_argument("--threads-every", type=int, default=5, help="every so many run again with two threads")
    parser.add_argument("--keep", type=Path, help="folder for the scenarios that failed")
    parser.add_argument("--strict", action="store_true", help="fail for any scenario with a fault, and not only for crashes")
    parser.add_argument("--show", type=int, metavar="SEED", help="write this scenario and end")
    parser.add_argument("--all-keys", action="store_true", help="scenarios with boundaries, staged opening, support, damping, tilt and springs")
    parser.add_argument("--kill", action="store_true", help="kill each run at a random moment, resume it, and compare")
    arguments = parser.parse_args()
    make = scenario_of_all_keys if arguments.all_keys else random_scenario
    if arguments.show is not None:
        print(make(arguments.show)[0], end="")
        return 0
    outcomes = []
    end = time.monotonic() + 60.0 * arguments.minutes
    for seed in arguments.seeds or range(arguments.first, arguments.first + arguments.count):
        if time.monotonic() > end:
            break
        outcome = try_seed(arguments.program, seed, arguments.seconds, seed % arguments.threads_every == 0, make, arguments.kill)
        outcomes.append(outcome)
        if outcome.faults():
            print(f"seed {seed} ({', '.join(f'{k} {v}' for k, v in outcome.facts.items())}): {'; '.join(outcome.faults())}", flush=True)
            if arguments.keep:
                keep(outcome, arguments.keep, make)
    print(table(outcomes))
    return 1 if any(o.is_crash or (arguments.strict and o.faults()) for o in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
