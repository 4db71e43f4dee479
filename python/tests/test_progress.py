"""How far a run is: in a notebook, in a terminal, to a function. ipywidgets and IPython are stood in for."""

from __future__ import annotations

import importlib.machinery
import sys
import types
from pathlib import Path
from typing import Any

import pytest
from conftest import optional
from test_scenario import falling_block

kb = optional("keyblock")
optional("keyblock._core")

from keyblock import progress  # noqa: E402


class Widget:
    """What a widget of the stand-in is: its values, and what they were before."""

    def __init__(self, *children: Any, **values: Any) -> None:
        self.seen: list[float] = []
        self.children = children
        for name, value in values.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, value)
        if name == "value":
            self.seen.append(value)


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The kernel of a notebook with ipywidgets; what it displays."""
    shown: list[Any] = []
    widgets: Any = types.ModuleType("ipywidgets")
    widgets.FloatProgress, widgets.Label, widgets.HBox = Widget, Widget, Widget
    ipython: Any = types.ModuleType("IPython")
    ipython.get_ipython = lambda: types.SimpleNamespace(kernel=object())
    display: Any = types.ModuleType("IPython.display")
    display.display = shown.append
    for module in (widgets, ipython, display):
        module.__spec__ = importlib.machinery.ModuleSpec(module.__name__, None)
        monkeypatch.setitem(sys.modules, module.__name__, module)
    return shown


def hide_widgets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ipywidgets", None)


def scenario() -> Any:
    block = falling_block()
    block.stage[0].duration = 3.0
    return block


@pytest.mark.parametrize("choice", [True, "notebook"])
def test_a_bar_in_a_notebook(notebook: list[Any], choice: Any, capsys: pytest.CaptureFixture[str]) -> None:
    scenario().run(progress=choice)
    (box,) = notebook
    bar, label = box.children[0]
    assert bar.seen == sorted(bar.seen) and 0.9 < bar.seen[-1] <= 1.0
    assert bar.bar_style == "success"
    assert "1/1" in label.value and "step" in label.value
    assert capsys.readouterr() == ("", "")


def test_a_bar_is_red_after_an_error(notebook: list[Any]) -> None:
    @kb.controller
    def fail(sim: Any) -> None:
        if sim.step == 20:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        scenario().run(progress=True, controllers=[fail])
    assert notebook[0].children[0][0].bar_style == "danger"


def test_a_line_in_a_notebook_without_ipywidgets(notebook, monkeypatch, capsys) -> None:
    hide_widgets(monkeypatch)
    scenario().run(progress=True)
    said = capsys.readouterr()
    assert notebook == [] and said.err == ""
    assert said.out.startswith("\r") and said.out.count("\n") == 1


@pytest.mark.parametrize("choice", [True, "notebook", "line"])
def test_a_line_elsewhere(choice: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    hide_widgets(monkeypatch)
    scenario().run(progress=choice)
    said = capsys.readouterr()
    assert said.out == ""
    lines = said.err.rstrip("\n").split("\r")[1:]
    assert all(len(line) == 78 for line in lines)
    assert "step" in lines[-1]


def test_no_more_than_ten_looks_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    now, shown = [100.0], []
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    display = types.SimpleNamespace(show=lambda fraction, text: shown.append(fraction), close=lambda ended: shown.append(ended))
    throttled = progress._Throttled(display)
    for step in range(1000):
        now[0] += 0.001
        throttled.show(step / 1000, "")
    throttled.close(True)
    assert 10 <= len(shown) <= 12 and shown[-2:] == [0.999, True]


def test_a_study_has_the_same(tmp_path: Path, notebook: list[Any]) -> None:
    from concurrent.futures import ThreadPoolExecutor

    from test_run_study import scenario as study

    with ThreadPoolExecutor(1) as pool:
        kb.run_study(study(), tmp_path / "out", executor=pool, progress="notebook")
    bar, label = notebook[0].children[0]
    assert bar.value == 1.0 and label.value.endswith("runs") and bar.bar_style == "success"


@pytest.mark.parametrize("wrong", ["bar", 3])
def test_what_it_may_be_is_said(wrong: Any) -> None:
    with pytest.raises(ValueError, match="'notebook', 'line' or None"):
        scenario().run(progress=wrong)
