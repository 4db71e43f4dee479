#!/usr/bin/env python3
"""How long the Python package takes to open a result, to draw it and to make tables of it, each in a process of its own.

    keyblock run examples/01-tunnel.toml -o out/tunnel
    /usr/bin/python3 benchmarks/read_results.py out/tunnel
"""

import os
import subprocess
import sys
import time
from pathlib import Path

PYTHON = Path(__file__).resolve().parents[1] / "python"

# What is timed, and how long it may take for a tunnel of 800 blocks and 280 frames, s.
JOBS = [
    ("import keyblock.results", "", 0.3),
    ("open, summary, stages", "run.summary; run.stages[-1].damage", 1.0),
    ("open, last frame, contacts", "run.frames.at().vertices; run.contacts().slip", 1.0),
    ("open, plot to PNG", "run.plot(save=target + '.png')", 3.0),
    ("open, plot to PDF with joints and forces", "run.plot(joints='state', forces=True, save=target + '.pdf')", 3.0),
    ("open, all frames one by one", "sum(float(f.vertices.max()) for f in run.frames)", 3.0),
    ("open, to_xarray", "run.to_xarray()", 3.0),
    ("open, to_geodataframe", "run.to_geodataframe()", 3.0),
]


def seconds(code: str, folder: str, target: str) -> float:
    script = "import keyblock.results"
    if code:
        script += f"; import keyblock; run = keyblock.open({folder!r}); target = {target!r}; {code}"
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": str(PYTHON), "MPLBACKEND": "Agg"}, check=True)
    return time.perf_counter() - begin


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        print(f"{'what':<45} {'s':>6} {'goal':>6}")
        for what, code, goal in JOBS:
            taken = min(seconds(code, sys.argv[1], f"{folder}/picture") for _ in range(3))
            print(f"{what:<45} {taken:6.2f} {goal:6.1f}{'' if taken <= goal else '  too long'}", flush=True)


if __name__ == "__main__":
    main()
