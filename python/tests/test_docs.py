"""What the documents show runs as it stands there."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil

import pytest
from conftest import ROOT, optional

BLOCK = re.compile(r"^```python\n(?P<code>.*?)^```$", re.MULTILINE | re.DOTALL)


# What each snippet did: words that only it has, and what must hold after it. `n` are the names that the page has defined so far.
RESULTS = {
    'keyblock.open("out/tunnel")\nrun.plot': lambda n: n["run"].summary.blocks > 0 and exists("tunnel.pdf"),
    "run.summary.blocks": lambda n: n["run"].steps["penetration"].max() >= 0 and len(n["run"].stages.table()) == len(n["run"].stages),
    "the crown has settled": lambda n: list(n["crown"].columns[:2]) == ["ux", "uy"] and -n["crown"]["uy"].iloc[-1] > 0,
    "heading.release.groupby": lambda n: n["axes"] is not None and len(n["axes"].lines) == len(set(n["heading"].release["excavation"])),
    "frame.principal": lambda n: (n["principal"][:, 0] >= n["principal"][:, 1]).all() and abs(n["frame"].time - 0.3) < 0.05,
    "block = run.blocks[3]": lambda n: n["run"].blocks.area[3] == n["block"].area > 0,
    "elements = heading": lambda n: {name for name, there in zip(n["elements"].names, n["elements"].present) if there}
    == {"heading.crown", "heading.left", "heading.right"} and set(n["elements"].kinds) == {"pressure"} and n["elements"].force[0] == pytest.approx(6.4e5, rel=0.01),
    'groupby("edge").slip.max()': lambda n: (n["contacts"].slip >= 0).all()
    and (n["contacts"].slip == abs(n["contacts"].shear_displacement)).all()
    and (n["contacts"].table().groupby("edge").slip.max() == abs(n["contacts"].table().shear_displacement).groupby(n["contacts"].table().edge).max()).all()
    and abs(n["contacts"].force_on("frame")).max() > 0,
    "# open, sliding, locked": lambda n: exists("sets.svg"),
    "before-and-after": lambda n: exists("before-and-after.pdf"),
    "run.animate": lambda n: exists("fall.mp4") and exists("fall.gif"),
    "study = keyblock.open": lambda n: len(n["study"].table()) == 6 * 8 and set(n["last"].stage) == {"after"},
    "study.statistics(": lambda n: len(n["study"].statistics("displacement_max_m")) == 8,
    "where = study.map": lambda n: exists("fragility.pdf") and exists("map.png") and 0.0 < n["np"].nanmax(n["where"].fallen) <= 1.0,
    "worst = study.combination": lambda n: exists("worst.png"),
    "safety.key": lambda n: n["safety"].value == pytest.approx(29.9, abs=0.5) and exists("limit.pdf"),
    "run.to_xarray()": lambda n: {"time", "vertex", "block"} <= set(n["dataset"].dims),
    "run.to_geodataframe": lambda n: (n["blocks"].slip.fillna(0) >= 0).all(),
    "run.unfinished or": lambda n: not n["run"].unfinished,
}
RUNS = {
    "a block that falls": lambda n: n["summary"]["steps"] == 500 and exists("stone.png") and n["kb"].open("out/stone").frames.at().block_displacement[1, 1] < -0.19,
    "kb.Scenario.load(\"examples/01-tunnel.toml\")": lambda n: n["scenario"].rock.young == 4e9
    and n["scenario"]["stage.'first earthquake'.scale"] == 2.0
    and n["scenario"].joint_set.names[-1] == "J4",
    "scenario.cut(realization=7)": lambda n: len(n["blocks"]) > 100 and exists("blocks.pdf"),
    "census = scenario.census(": lambda n: 0 < len(n["census"].moving) < len(n["census"]) and n["block"].factor_of_safety < 1.0,
    "progress=lambda now": lambda n: n["summary"]["realization"] == 7 and exists("out/seven/result.h5"),
    "def tell(now)": lambda n: True,
    "kb.run_study(": lambda n: len(n["study"].table()) > 1 and (n["study"].table().status == "done").all(),
    "scenario.simulate() as sim": lambda n: n["sim"].done and 0.90 < n["contacts"].slip.max() < 0.91 and n["contacts"].shear_displacement.min() < -0.9,
    "def weaken(sim)": lambda n: n["weak"]["state_hash"] != n["held"]["state_hash"] and displacement(n["weak"]) > 1.5 > displacement(n["held"]),
    # The equation of motion with 20° up to 5 mm, and then with the friction by the slip at every fifth step of 5 ms: 1.22229 m.
    "def soften(sim)": lambda n: displacement(n["softened"]) == pytest.approx(1.22229, abs=2e-4),
    "kb.Motion(step=0.01": lambda n: n["scenario"].motion["sine"].x[1][1] == n["motion"].x[1] and len(n["scenario"].motion["sine"].x) == 200,
    "def hold(sim)": lambda n: 0.0 < displacement(n["slow"]) < 0.5 * displacement(n["held"]),
    "kb.run_table(": lambda n: sorted(n["table"]["joints.friction"]) == [10.0, 20.0, 30.0]
    and n["table"].sort_values("joints.friction").displacement_max_m.is_monotonic_decreasing,
    "wrong.check()": lambda n: True,
}


def exists(name: str) -> bool:
    return os.path.exists(name)


def displacement(summary: dict) -> float:
    return summary["stages"][-1]["damage"]["displacement_max_m"]


def check_effect(code: str, effects: dict, names: dict) -> None:
    """Every snippet has an effect that is asserted: that it runs says nothing of what it did."""
    found = [effect for words, effect in effects.items() if words in code]
    assert len(found) == 1, f"{len(found)} effects of\n{code}"
    assert found[0](names), f"no such effect of\n{code}"


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
        check_effect(code, RESULTS, names)
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
        check_effect(code, RUNS, names)
        pyplot.close("all")
    said = capsys.readouterr().out
    assert "mine.toml 3 9 rock.young" in said and "weaken" in said
    assert {"stone.png", "blocks.pdf", "out"} <= {path.name for path in tmp_path.iterdir()}


def test_blocks_of_the_page_on_the_result_file(tunnel_folder, tmp_path, monkeypatch, capsys):
    """What plain h5py and xarray read by the page is what the package reads."""
    optional("xarray"), optional("netCDF4")
    import h5py
    import keyblock
    import numpy as np

    (tmp_path / "out").symlink_to(tunnel_folder.parent, target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["read.py", "out/tunnel"])
    script, rings, netcdf = (match["code"] for match in BLOCK.finditer((ROOT / "docs/result-file.md").read_text()))
    names: dict[str, object] = {}
    exec(compile(script, "docs/result-file.md", "exec"), names)  # noqa: S102
    said = capsys.readouterr().out.splitlines()
    with keyblock.open("out/tunnel") as run, h5py.File("out/tunnel/result.h5") as names["f"]:
        last = run.frames.at()
        fallen = np.flatnonzero(last.status == 2)
        assert f"- seed {run.summary.seed} - realization {run.summary.realization}" in said[0]
        number = re.fullmatch(r"largest displacement (\S+) m", said[1])
        assert number and float(number[1]) == pytest.approx(np.hypot(*last.displacement.T).max(), rel=1e-6)
        assert said[2:] == [
            f"block {b} has fallen; it has {len(run.blocks[int(b)].outline)} vertices and {len(run.rings(int(b))) - 1} holes" for b in fallen
        ]
        exec(compile(rings, "docs/result-file.md", "exec"), names)  # noqa: S102
        for b in range(len(run.blocks)):
            assert area_of(names["outlines"](b)) == pytest.approx(run.blocks.area[b], rel=1e-9)
        exec(compile(netcdf, "docs/result-file.md", "exec"), names)  # noqa: S102
        frames = names["frames"]
        assert float(frames.stress.isel(stress_component=1).max()) == max(float(frame.stress[:, 1].max()) for frame in run.frames)
        assert {"time", "block", "vertex", "component"} <= set(frames.dims) and frames.stress.attrs["units"] == "Pa"
        frames.close()


def area_of(rings) -> float:
    """m², of a block: holes run the other way."""
    return 0.5 * sum(float(sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(ring, [*ring[1:], ring[0]]))) for ring in rings)
