"""The notebooks of examples/notebooks run, and say what is right."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import ROOT, optional

kb = optional("keyblock")
core = optional("keyblock._core")

NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))

# What must hold in the end.
EFFECTS = {
    "01-first-run": lambda n: n["slid"] == pytest.approx(n["exact"], rel=0.01),
    "02-own-controller": lambda n: n["slid"] == pytest.approx(n["position"], rel=2e-3)
    and max(n["slips"]) > 1.0
    and n["pushed"]["stages"][-1]["damage"]["displacement_max_m"] < n["held"]["stages"][-1]["damage"]["displacement_max_m"],
    "03-study": lambda n: n["table"].displacement_max_m.is_monotonic_decreasing and n["limit"].value == pytest.approx(30.0, abs=0.5),
    "04-figures": lambda n: (n["contacts"].slip >= 0).all() and Path("figures.pdf").exists(),
}


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_notebooks_run(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pandas", "matplotlib"):
        optional(name)
    import matplotlib.pyplot as pyplot

    (tmp_path / "examples").symlink_to(ROOT / "examples", target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for k, cell in enumerate(json.loads(file.read_text())["cells"]):
        if cell["cell_type"] != "code":
            assert cell["source"]
            continue
        assert cell["outputs"] == [], "notebooks are kept without outputs"
        code = tmp_path / f"cell{k}.py"  # in files, as the text of controllers is read
        code.write_text("".join(cell["source"]))
        exec(compile(code.read_text(), str(code), "exec"), names)  # noqa: S102
    pyplot.close("all")
    assert EFFECTS[file.stem](names)


def test_there_are_notebooks() -> None:
    assert {file.stem for file in NOTEBOOKS} == set(EFFECTS)
