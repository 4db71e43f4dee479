"""What the documents show runs as it stands there."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil

import pytest
from conftest import ROOT, optional

BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL)


def test_blocks_of_the_page(tunnel_folder, heading_folder, study_folder, limit_folder, tmp_path, monkeypatch, capsys):
    for name in ("pandas", "matplotlib", "xarray"):
        optional(name)
    import matplotlib.pyplot as pyplot

    (tmp_path / "out").symlink_to(tunnel_folder.parent, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    blocks = [match["code"] for match in BLOCK.finditer((ROOT / "docs/python.md").read_text())]
    assert len(blocks) > 10
    names: dict[str, object] = {}
    maps = importlib.util.find_spec("geopandas") is not None
    for code in blocks:
        if "geodataframe" in code and not maps:
            continue
        if "animate" in code and shutil.which("ffmpeg") is None and not os.environ.get("CI"):
            pytest.skip("ffmpeg is not installed")
        exec(compile(code, "docs/python.md", "exec"), names)  # noqa: S102
        pyplot.close("all")
    written = {path.name for path in tmp_path.iterdir()}
    assert {"tunnel.pdf", "sets.svg", "before-and-after.pdf", "fall.mp4", "fall.gif", "fragility.pdf", "map.png", "limit.pdf"} <= written
    assert "the run has reached its end" in capsys.readouterr().out


def test_blocks_of_the_page_on_runs(tmp_path, monkeypatch, capsys):
    optional("matplotlib")
    optional("keyblock._core")
    import matplotlib.pyplot as pyplot

    (tmp_path / "examples").symlink_to(ROOT / "examples", target_is_directory=True)
    (tmp_path / "study.toml").write_text((ROOT / "tests/data/study/gallery.toml").read_text())
    monkeypatch.chdir(tmp_path)
    page = ROOT / "docs/python-runs.md"
    blocks = [match["code"] for match in BLOCK.finditer(page.read_text())]
    assert len(blocks) > 6
    names: dict[str, object] = {}
    for number, code in enumerate(blocks):
        # In files of their own, as the text of controllers is read.
        file = tmp_path / f"block{number}.py"
        file.write_text(code)
        exec(compile(code, str(file), "exec"), names)  # noqa: S102
        pyplot.close("all")
    said = capsys.readouterr().out
    assert "mine.toml 3 9 rock.young" in said and "weaken" in said
    assert {"stone.png", "blocks.pdf", "out"} <= {path.name for path in tmp_path.iterdir()}
