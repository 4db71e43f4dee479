#!/usr/bin/env python3
"""The pictures of docs/gallery.md are those that docs/make_gallery.py makes, and it makes one of them here. Skipped (77) without what the
Python package draws with, unless CI is set."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "docs/make_gallery.py"
LARGEST = 300_000  # bytes
PNG = b"\x89PNG\r\n"


def make(*words):
    done = subprocess.run([sys.executable, SCRIPT, *map(str, words)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def main():
    made = sorted(line.split()[0] for line in make("--list").splitlines())
    shown = sorted(re.findall(r"\]\(images/([^)]*)\)", (ROOT / "docs/gallery.md").read_text()))
    assert shown == made, f"the page shows {shown}, the script makes {made}"
    for name in made:
        size = (ROOT / "docs/images" / name).stat().st_size
        assert size <= LARGEST, f"{name}: {size} bytes"
    missing = [name for name in ("numpy", "h5py", "matplotlib", "PIL") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"not installed for {sys.executable}: {', '.join(missing)}", file=sys.stderr)
        return 1 if os.environ.get("CI") else 77
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        make("--only", "03-block-on-incline", "--runs", out / "runs", "--out", out)
        assert (out / "gallery-03-block-on-incline.png").read_bytes().startswith(PNG)
    return 0


if __name__ == "__main__":
    sys.exit(main())
