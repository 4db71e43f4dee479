#!/usr/bin/env python3
"""Draws the pictures of docs/hsiung-shi.md from the folders of the studies of examples 06 and 07.

    study_figures.py PAPER TWO DOCS_IMAGES

PAPER and TWO are the folders of `keyblock study run` with examples 06 and 07. Each figure puts the ends of some runs side by side.
"""

import csv
import pathlib
import re
import sys

SCALE = "stage.'first earthquake'.scale"
WIDTH, GAP, CAPTION = 300, 14, 44


def runs(folder):
    with open(folder / "runs.csv", newline="") as file:
        return [row | {"folder": folder} for row in csv.DictReader(file)]


def find(rows, realization, **values):
    """The run of a realization with these values on the axes, compared as numbers."""
    keys = {"scale": SCALE, "order": "rock.order"}
    for row in rows:
        if int(row["realization"]) == realization and all(float(row[keys[k]]) == v for k, v in values.items()):
            return row
    raise SystemExit(f"no run of realization {realization} with {values}")


def fallen(row, stage="after"):
    return float(row[f"{stage}.fallen_area_m2"])


def picture(row):
    """The inside of a thumbnail and the size of its window."""
    text = (row["folder"] / "runs" / row["key"] / "thumbnail.svg").read_text()
    window = re.search(r'viewBox="([^"]*)"', text)[1]
    stroke = re.search(r'stroke-width="([^"]*)"', text)[1]
    return window, stroke, text[text.index("</style>") + len("</style>") : text.rindex("</svg>")]


STYLE = (
    "<style>.r{fill:#e4e1d8;stroke:#6b6f73}.x{fill:#d3d5d7;stroke:#6b6f73}.l{fill:#e69f00;stroke:#33373b}"
    ".f{fill:#d55e00;stroke:#33373b}.o{fill:none;stroke:#c2185b}"
    "text{font:15px Helvetica,Arial,sans-serif;fill:#222}</style>"
)


def figure(path, panels):
    """panels: (caption, run)."""
    width = len(panels) * (WIDTH + GAP) - GAP
    height = WIDTH + CAPTION
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}">{STYLE}',
             f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for k, (caption, row) in enumerate(panels):
        window, stroke, inside = picture(row)
        x = k * (WIDTH + GAP)
        parts.append(f'<svg x="{x}" width="{WIDTH}" height="{WIDTH}" viewBox="{window}" stroke-width="{stroke}" '
                     f'stroke-linejoin="round">{inside}</svg>')
        parts.append(f'<text x="{x}" y="{WIDTH + 18}">{caption}</text>')
        parts.append(f'<text x="{x}" y="{WIDTH + 37}">{fallen(row):.2f} m² fallen</text>')
    temporary = path.with_suffix(".tmp")
    temporary.write_text("".join(parts) + "</svg>\n")
    temporary.rename(path)


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    paper, two = (runs(pathlib.Path(name)) for name in sys.argv[1:3])
    images = pathlib.Path(sys.argv[3])
    fifth = [(f"({'abc'[k]}) realization {k + 1}, 1/5", find(paper, k, scale=1.0, order=1)) for k in range(3)]
    figure(images / "study-geometry.svg", fifth)
    for k in range(3):
        amplitudes = [(name, find(paper, k, scale=scale, order=1))
                      for name, scale in (("1/5", 1.0), ("2/5", 2.0), ("1/2", 2.5), ("full scale", 5.0))]
        figure(images / f"study-amplitude-{k + 1}.svg", amplitudes)
    figure(images / "study-repeated.svg", [(f"({'abc'[k]}) realization {k + 1}, twice 1/5", find(two, k)) for k in range(3)])
    figure(images / "study-order.svg", [(f"realization {k + 1}, full scale, order {n}", find(paper, k, scale=5.0, order=n))
                                        for k in (0, 1) for n in (1, 2)])


if __name__ == "__main__":
    main()
