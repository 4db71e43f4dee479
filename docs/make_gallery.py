#!/usr/bin/env python3
"""The pictures of docs/gallery.md, from the examples: each example is run, some shortened, and drawn with the Python package.

    ./dev gallery                              all of them, into docs/images; most of an hour on two cores
    ./dev gallery --only 03-block-on-incline --only 04-wall
    make_gallery.py --list                     what there is

Runs stay in build/gallery, so that a picture can be drawn again at once. A change of the picture alone runs nothing.
"""

import argparse
import os
import pathlib
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILT = ROOT / "build/release/python"
sys.path.insert(0, str(BUILT if BUILT.exists() else ROOT / "python"))

WIDTH = 150  # mm, of a picture
DPI = 150
LARGEST = 300_000  # bytes of a file


@dataclass
class Picture:
    """A picture of an example: `values` are those of --set, `draw` returns a figure of matplotlib."""

    example: str
    draw: Callable[[Any], Any]
    values: dict[str, Any] = field(default_factory=dict)
    study: bool = False

    @property
    def sets(self) -> list[str]:
        return [word for key, value in self.values.items() for word in ("--set", f"{key}={value}")]

    def folder(self, runs: pathlib.Path) -> pathlib.Path:
        return runs / self.example

    def run(self, program: str, runs: pathlib.Path) -> None:
        folder, scenario = self.folder(runs), ROOT / f"examples/{self.example}.toml"
        words = ["study", "run"] if self.study else ["run"]
        # Results of the same input are gone on with; others go.
        again = ["--resume"] if (folder / ("plan.json" if self.study else "checkpoint.bin")).exists() else []
        subprocess.run([program, *words, str(scenario), "-o", str(folder), *self.sets, *again], check=True, stdin=subprocess.DEVNULL)


def section(time: str | None, color: str = "displacement", **options: Any) -> Callable[[Any], Any]:
    return lambda run: run.plot(time, color, width=WIDTH, **options).figure


def moments(color: str, times: list[Any], titles: list[str], **options: Any) -> Callable[[Any], Any]:
    """Sections beside each other, with one scale."""

    def draw(run: Any) -> Any:
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(1, len(times), figsize=(WIDTH / 25.4 * 1.2, WIDTH / 25.4 * 0.6), layout="constrained")
        for ax, time, title in zip(axes, times, titles):
            run.plot(time, color, ax=ax, title=title, axes=False, legend=ax is axes[-1], **options)
        return figure

    return draw


def ground_reaction(run: Any) -> Any:
    """The opening in parts, and how far the walls have come in over the share released."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH / 25.4 * 1.2, WIDTH / 25.4 * 0.6), layout="constrained")
    run.plot("bench supported", "displacement", ax=left, legend=False, axes=False, exaggeration=100, window=(-9, 9, -8, 9), title="Displacements, 100 times as large")
    for name, rows in run.release.groupby("excavation"):
        for place in ("crown", "springline"):
            if rows[place].notna().any():
                right.plot(100 * rows.released, 1000 * rows[place], marker="o", markersize=3, label=f"{name}, {place}")
    right.set(xlabel="share released, %", ylabel="closure of the wall, mm", title="Ground reaction")
    right.legend()
    right.grid(alpha=0.3)
    return figure


def fragility(study: Any) -> Any:
    """Where blocks fall at the strongest shaking, and how probable each level of damage is."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH / 25.4 * 1.4, WIDTH / 25.4 * 0.6), layout="constrained")
    key = next(iter(study.axes))
    study.map({key: max(study.axes[key])}).plot(left)
    left.set_title(f"Where rock falls, scale {max(study.axes[key])}", loc="left")
    for level in ("light", "moderate"):
        for curve in study.fragility(level, "pga_m_s2"):
            curve.plot(right)
    right.set(title="How probable it is", ylabel="probability of more than the level")
    return figure


SHAKEN = "stage.'first earthquake'"

PICTURES = {
    "01-tunnel": Picture("01-tunnel", section("first earthquake"), {f"{SHAKEN}.scale": 3.0, f"{SHAKEN}.duration": 8.0, "stage.after.duration": 0.1}),
    "02-tunnel-in-situ": Picture("02-tunnel-in-situ", section("excavated", "major", stress=True, window=(-7, 7, -7, 7)), {"stage.quiet.duration": 0.02, f"{SHAKEN}.duration": 0.02}),
    "03-block-on-incline": Picture("03-block-on-incline", section("slide", "displacement", arrows="displacement")),
    "04-wall": Picture("04-wall", moments("displacement", ["stands", "shaken"], ["before", "after the shaking"], log=False, vmin=0.0, label="Displacement")),
    "05-trace-map": Picture("05-trace-map", section("quiet", "displacement", joints="slip", window=(466002, 466014, 6691584, 6691596))),
    "08-study-fragility": Picture("08-study-fragility", fragility, study=True, values={
        "study.realizations": 32, "domain.x": "[-7.0, 7.0]", "domain.y": "[-7.0, 7.0]", f"{SHAKEN}.duration": 5.0, "stage.after.duration": 1.0,
    }),
    "10-heading-and-bench": Picture("10-heading-and-bench", ground_reaction),
    "11-tunnel-in-waves": Picture("11-tunnel-in-waves", section("earthquake", "displacement", joints="slip"), {"stage.earthquake.duration": 8.0}),
}  # fmt: skip


def save(figure: Any, path: pathlib.Path) -> None:
    """As PNG of 256 colours, the same bytes from the same figure."""
    from io import BytesIO

    from PIL import Image

    drawn = BytesIO()
    figure.savefig(drawn, format="png", dpi=DPI, bbox_inches="tight", metadata={"Software": None})
    Image.open(drawn).convert("RGB").quantize(256).save(path, optimize=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", choices=PICTURES, help="this picture; may be given several times")
    parser.add_argument("--list", action="store_true", help="files and commands")
    parser.add_argument("--program", default=os.environ.get("KEYBLOCK", str(ROOT / "build/release/keyblock")))
    parser.add_argument("--runs", type=pathlib.Path, default=ROOT / "build/gallery", help="folder of the runs")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images", help="folder of the pictures")
    arguments = parser.parse_args()
    chosen = {name: PICTURES[name] for name in arguments.only or PICTURES}
    if arguments.list:
        for name, picture in chosen.items():
            print(f"gallery-{name}.png", "study run" if picture.study else "run", f"examples/{picture.example}.toml", *picture.sets)
        return 0
    import matplotlib

    matplotlib.use("Agg")
    import keyblock
    import matplotlib.pyplot as plt

    arguments.out.mkdir(parents=True, exist_ok=True)
    too_large = []
    for name, picture in chosen.items():
        picture.run(arguments.program, arguments.runs)
        path = arguments.out / f"gallery-{name}.png"
        figure = picture.draw(keyblock.open(picture.folder(arguments.runs)))
        save(figure, path)
        plt.close(figure)
        size = path.stat().st_size
        print(f"{path}: {size} bytes", flush=True)
        too_large += [path] if size > LARGEST else []
    for path in too_large:
        print(f"{path} is larger than {LARGEST} bytes", file=sys.stderr)
    return 1 if too_large else 0


if __name__ == "__main__":
    sys.exit(main())
