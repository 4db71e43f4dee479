#!/usr/bin/env python3
"""Draws docs/images/scaling.svg from the JSON of bench.py: plot.py RESULTS.json OUT.svg"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "verification"))
from svg_plot import Chart  # noqa: E402


def main():
    results = json.loads(pathlib.Path(sys.argv[1]).read_text())["results"]
    grids = [r for name, r in results.items() if name.startswith("grid of") and "threads" not in name]
    blocks = [r["blocks"] for r in grids]
    x = [math.log10(n) for n in blocks]
    chart = Chart("Grid of blocks, order 1, shaken; one thread", "log₁₀ of the number of blocks", "µs per block and step", log_y=True)
    chart.marks("measured", x, [1e3 * r["value"] / r["blocks"] for r in grids], marker="circle")
    first = 1e3 * grids[0]["value"] / blocks[0]
    chart.line("goal: N^0.15", x, [first * (n / blocks[0]) ** 0.15 for n in blocks], color="#566573", dash="6 4")
    pathlib.Path(sys.argv[2]).write_text(chart.svg())


if __name__ == "__main__":
    main()
