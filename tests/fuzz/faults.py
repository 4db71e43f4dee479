#!/usr/bin/env python3
"""Disks that fail and processes that are killed, at random places: the run that goes on from there ends as one that nothing happened to, or
says what to do. `faults.py [MINUTES]`; without minutes a few places of each kind."""

import errno
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "integration"))
from program import INCLINE, PROGRAM  # noqa: E402

LIBRARY = os.environ["FAULTS_LIBRARY"]
ERRORS = {
    "write": (errno.ENOSPC, errno.EIO), "fsync": (errno.EIO, errno.ENOSPC), "rename": (errno.EIO, errno.ENOSPC),
    "ftruncate": (errno.ENOSPC, errno.EIO),
}  # fmt: skip
PLACES = 4  # of each call, in a short test
KILLS = 4
SECOND_STAGE = '\n[[stage]]\nname = "then"\nkind = "rest"\nduration = 0.05\n'


def without_times(value):
    if isinstance(value, list):
        return [without_times(item) for item in value]
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in ("wall_time_s", "ms_per_step", "profile")}
    return value


class Trial:
    """A folder with a scenario, and the results of a run that nothing happened to."""

    def __init__(self, folder, duration):
        self.folder = Path(folder)
        self.duration = duration
        (self.folder / "scenario.toml").write_text(INCLINE.replace("duration = 0.5", f"duration = {duration}") + SECOND_STAGE)
        self.seconds = time.monotonic()
        done = self.run("whole")
        self.seconds = time.monotonic() - self.seconds
        assert done.returncode == 0, done.stderr
        self.whole = self.results("whole")

    def run(self, out, *options, **environment):
        return subprocess.run(
            [PROGRAM, "run", "scenario.toml", "-o", out, *options], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
            timeout=120, env=os.environ | environment,
        )  # fmt: skip

    def results(self, out):
        """What does not depend on the clock."""
        summary = json.loads((self.folder / out / "summary.json").read_text())
        report = (self.folder / out / "report.html").read_text()
        assert report.rstrip().endswith("</html>"), f"{out}: half a report"
        return without_times(summary), (self.folder / out / "histories.csv").read_bytes()

    def check_whole(self, out, what):
        assert self.results(out) == self.whole, f"{what}: other results"
        left = [path.name for path in (self.folder / out).iterdir() if path.name.endswith((".tmp", "lock"))]
        assert not left, f"{what}: left {left}"

    def go_on(self, out, what):
        done = self.run(out, "--resume")
        if done.returncode == 1 and "without --resume" in done.stderr:
            done = self.run(out, "--force")
        assert done.returncode == 0, f"{what}: to go on is refused: {done.returncode} {done.stderr}"
        self.check_whole(out, what)

    def count(self, call):
        """How often a run makes this call."""
        self.run("counted", "--force", LD_PRELOAD=LIBRARY, FAULT_CALL=call, FAULT_BELOW=str(self.folder), FAULT_COUNT=str(self.folder / "count"))
        return int((self.folder / "count").read_text())

    def fail_at(self, call, place, number, lasts):
        what = f"{call} number {place}, {errno.errorcode[number]}{', and all that follow' if lasts else ''}"
        out = f"{call}-{place}-{number}-{lasts}"
        faults = {"LD_PRELOAD": LIBRARY, "FAULT_CALL": call, "FAULT_AT": str(place), "FAULT_ERROR": str(number), "FAULT_BELOW": str(self.folder)}
        if lasts:
            faults["FAULT_LASTS"] = "1"
        done = self.run(out, **faults)
        assert done.returncode in (0, 1, 2), f"{what}: {done.returncode}\n{done.stderr}"
        if done.returncode != 0:
            assert os.strerror(number) in done.stderr, f"{what}: does not say why\n{done.stderr}"
        if done.returncode == 0:
            self.check_whole(out, what)
        else:
            self.go_on(out, what)
        return done.returncode != 0

    def kill_after(self, seconds, out):
        run = subprocess.Popen(
            [PROGRAM, "run", "scenario.toml", "-o", out], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        time.sleep(seconds)
        run.kill()
        self.go_on(out, f"killed after {seconds:.3f} s") if run.wait() < 0 else self.check_whole(out, "not killed")


def report(name, tries, failures):
    print(f"{name}: {tries} tries, {failures} of which failed as they were told to", flush=True)


def some_places(draw, count):
    """The first call, the last one, and some between."""
    return sorted({1, count, *(draw.randint(1, count) for _ in range(PLACES - 2))})


def main():
    end = time.monotonic() + 60.0 * float(sys.argv[1]) if len(sys.argv) > 1 else 0.0
    draw = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="keyblock-faults-") as name:
        trial = Trial(name, 0.05)
        counts = {call: trial.count(call) for call in ERRORS}
        assert min(counts.values()) > 0, counts
        tries = {call: [] for call in ERRORS}
        while True:
            for call, numbers in ERRORS.items():
                for place in some_places(draw, counts[call]):
                    tries[call].append(trial.fail_at(call, place, draw.choice(numbers), draw.random() < 0.5))
            if time.monotonic() > end - 30.0:
                break
        for call, failed in tries.items():
            report(call, len(failed), sum(failed))
            assert any(failed), f"no {call} failed"
    with tempfile.TemporaryDirectory(prefix="keyblock-faults-") as name:
        trial = Trial(name, 3.0)
        kills = 0
        while kills < KILLS or time.monotonic() < end:
            trial.kill_after(draw.uniform(0.0, trial.seconds), f"killed{kills}")
            kills += 1
        print(f"killed: {kills} times", flush=True)


if __name__ == "__main__":
    main()
