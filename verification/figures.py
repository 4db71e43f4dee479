#!/usr/bin/env python3
"""Draws the figures of docs/beams.md: those of Hsiung (2001) with the results of keyblock, and the convergence with the order.

    keyblock verify --all --format json -o verification.json
    python3 verification/figures.py --keyblock build/release/keyblock --json verification.json

Runs the scenarios that it needs (about two minutes), and writes SVG files to docs/images.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

from svg_plot import Chart

HERE = pathlib.Path(__file__).resolve().parent
AXIS = [1, 2, 3, 4, 5, 6, 7, 8]
CRITICAL = {3: 211.93, 4: 205.64, 5: 204.72}
LOADS = [200, 203, 204, 204.5, 205, 205.5, 206, 207, 208, 209.3, 211, 212, 213, 215, 217.5, 220, 225, 230]


class Runs:
    def __init__(self, keyblock):
        self.keyblock = str(keyblock)

    def __call__(self, scenario, *overrides):
        """Columns of histories.csv, and the summary."""
        with tempfile.TemporaryDirectory() as folder:
            command = [self.keyblock, "run", str(HERE / "scenarios" / f"{scenario}.toml"), "-o", folder + "/out"]
            for override in overrides:
                command += ["--set", override]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise SystemExit(done.stderr)
            rows = list(csv.reader(open(folder + "/out/histories.csv", encoding="utf-8")))
            summary = json.load(open(folder + "/out/summary.json", encoding="utf-8"))
        return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}, summary


def ends(columns, names, component):
    return [columns[f"{name}.{component}"][-1] for name in names]


def axis_names():
    return [f"x{x}" for x in AXIS[:-1]] + ["tip"]


def axial(run):
    chart = Chart("Beam under an axial load (Figure 2 of the paper)", "distance from the fixed end, m", "displacement, 10⁻⁵ m")
    chart.line("theory", [0, 8], [0, 8], color="#566573", dash="6 4")
    for kind, orders in (("distributed", [1, 3, 4]), ("point", [1, 3, 4, 5, 10])):
        for order in orders:
            columns, _ = run(f"axial_{kind}", f"rock.order={order}")
            y = [1e5 * u for u in ends(columns, axis_names(), "ux")]
            chart.marks(f"order {order}, {'spread' if kind == 'distributed' else 'point load'}", AXIS, y,
                        marker="square" if kind == "distributed" else "circle")
    return chart


def cantilever(run):
    chart = Chart("Cantilever under a point load (Figure 4)", "distance from the fixed end, m", "deflection, mm")
    xs = [8 * k / 40 for k in range(41)]
    chart.line("theory", xs, [x * x * (24 - x) / (6e5 / 12) * 1e3 for x in xs], color="#566573", dash="6 4")
    for order in (1, 2, 3, 5, 10):
        columns, _ = run("cantilever_point", f"rock.order={order}")
        chart.marks(f"order {order}", AXIS, [-1e3 * u for u in ends(columns, axis_names(), "uy")])
    chart.marks("paper, orders 2, 3, 10", [8, 8, 8], [20.48 * r for r in (0.7297, 0.9791, 1.0191)], color="#000000",
                marker="cross")
    return chart


def simply_supported(run):
    chart = Chart("Simply supported beam (Figure 6)", "distance from the left end, m", "deflection over load, mm/T")
    xs = [10 * k / 80 for k in range(81)]

    def theory(x):
        x = min(x, 10 - x)
        return x * (300 - 4 * x * x) / (48e5 / 12) * 1e3

    chart.line("theory", xs, [theory(x) for x in xs], color="#566573", dash="6 4")
    places = [1, 2, 3, 4, 5, 6, 7, 8, 9, 9.5]
    names = ["x1", "x2", "x3", "x4", "middle", "x6", "x7", "x8", "x9", "x9_5"]
    for order in (1, 2, 3, 4, 5):
        columns, _ = run("simply_supported", f"rock.order={order}")
        chart.marks(f"order {order}", places, [-1e3 * u for u in ends(columns, names, "uy")])
    chart.marks("paper, orders 4, 5", [5, 5], [2.5 * r for r in (0.9872, 1.0022)], color="#000000", marker="cross")
    return chart


def tip_ratios(rows):
    chart = Chart("Held at points, or along the edge", "order of the displacement polynomial",
                  "tip deflection / theory with shear")
    chart.line("theory", [1, 10], [1, 1], color="#566573", dash="6 4")
    shear = 0.02048 / 0.0207104
    for name, case_run in (("points, point load", "cantilever, point load"), ("points, spread load", "cantilever, end shear"),
                           ("edge, spread load", "cantilever, fixed edge")):
        chosen = sorted((r["order"], r["computed"]) for r in rows
                        if r["case"] == 13 and r["run"] == case_run and r["quantity"] == "tip deflection / theory")
        chart.line(name, [o for o, _ in chosen], [shear * v for _, v in chosen], marker="circle")
    chart.y_range = (0.95, 1.015)
    return chart


def buckling(run):
    chart = Chart("Deflection that remains after a push (Figure 8)", "axial load, T", "deflection to the side of the push, m")
    for order, push in ((3, 1.0), (4, 1.0), (5, 1.0), (4, 0.1)):
        loads = sorted(LOADS + [CRITICAL[order] - 0.25, CRITICAL[order] + 0.25])
        y = []
        for load in loads:
            columns, _ = run("buckling", f"rock.order={order}", f"load[0].force=[{-load}, 0.0]",
                             f"load[1].force=[0.0, {-push}]")
            y.append(-columns["tip.uy"][-1])
        if push == 1.0:
            chart.line(f"order {order}, push of 1 T", loads, y, marker="circle")
        else:
            chart.marks(f"order {order}, push of {push} T", loads, y, marker="square")
    for k, (order, load) in enumerate(CRITICAL.items()):
        chart.line(f"critical, order {order}", [load, load], [-0.2, 6], dash="3 4",
                   color=["#1f4e79", "#c0392b", "#1e8449"][k])
    chart.y_range = (-0.3, 6)
    return chart


def buckling_steps(run):
    chart = Chart("Free end under 209.3 T, pushed and let go (Figure 9)", "static step",
                  "deflection to the side of the push, m")
    for order in (3, 4, 5):
        columns, summary = run("buckling", f"rock.order={order}", "load[0].force=[-209.3, 0.0]")
        first = sum(stage["steps"] for stage in summary["stages"][:1])
        y = [-u for u in columns["tip.uy"]][first:]
        chart.line(f"order {order}", range(len(y)), y)
    chart.line("straight", [0, 1500], [0, 0], color="#566573", dash="6 4")
    chart.x_range, chart.y_range = (0, 1500), (-0.3, 5)
    return chart


def convergence(rows):
    chart = Chart("Error against order, smooth field", "order of the displacement polynomial", "error in the energy norm",
                  log_y=True)
    chosen = sorted((r["order"], r["computed"]) for r in rows if r["quantity"] == "error in the energy norm")
    chart.line("one block", [o for o, _ in chosen], [v for _, v in chosen], marker="circle")
    return chart


def step_time(run):
    chart = Chart("Time of a step against order, one block", "order of the displacement polynomial", "time of a step, ms",
                  log_y=True)
    orders, times = range(1, 13), []
    for order in orders:
        _, summary = run("vibration_bending", f"rock.order={order}", "stage.free.duration=0.6")
        stage = summary["stages"][1]
        times.append(1e3 * stage["wall_time_s"] / stage["steps"])
    chart.line("dynamic step", orders, times, marker="circle")
    return chart


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--keyblock", type=pathlib.Path, required=True, help="the program")
    parser.add_argument("--json", type=pathlib.Path, required=True, help="what keyblock verify --format json wrote")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=HERE.parent / "docs" / "images")
    arguments = parser.parse_args()
    run = Runs(arguments.keyblock.resolve())
    rows = json.loads(arguments.json.read_text())["rows"]
    charts = {"beam-axial": axial(run), "beam-cantilever": cantilever(run), "beam-simply-supported": simply_supported(run),
              "beam-edge": tip_ratios(rows), "beam-buckling": buckling(run), "beam-buckling-steps": buckling_steps(run),
              "convergence": convergence(rows), "step-time": step_time(run)}
    for name, chart in charts.items():
        (arguments.output / f"{name}.svg").write_text(chart.svg(), encoding="utf-8")
        print(arguments.output / f"{name}.svg")


if __name__ == "__main__":
    main()
