"""What the documents show runs as it stands there."""

from __future__ import annotations

import os
import re
import shutil

import pytest
from conftest import ROOT, optional

BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL)


def test_blocks_of_the_page(tunnel_folder, heading_folder, study_folder, limit_folder, tmp_path, monkeypatch, capsys):
    for name in ("pandas", "matplotlib", "xarray", "geopandas"):
        optional(name)
    import matplotlib.pyplot as pyplot

    (tmp_path / "out").symlink_to(tunnel_folder.parent, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    blocks = [match["code"] for match in BLOCK.finditer((ROOT / "docs/python.md").read_text())]
    assert len(blocks) > 10
    names: dict[str, object] = {}
    for code in blocks:
        if "animate" in code and shutil.which("ffmpeg") is None and not os.environ.get("CI"):
            pytest.skip("ffmpeg is not installed")
        exec(compile(code, "docs/python.md", "exec"), names)  # noqa: S102
        pyplot.close("all")
    written = {path.name for path in tmp_path.iterdir()}
    assert {"tunnel.pdf", "sets.svg", "before-and-after.pdf", "fall.mp4", "fall.gif", "fragility.pdf", "map.png", "limit.pdf"} <= written
    assert "the run has reached its end" in capsys.readouterr().out
