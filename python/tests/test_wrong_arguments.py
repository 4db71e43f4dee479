"""Every public function and method, called with the wrong kinds of things, says in a sentence what it expects."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import optional
from test_scenario import falling_block
from test_steering import hanging

kb = optional("keyblock")
core = optional("keyblock._core")

WRONG = [3, -1, 1.5, 2**70, True, None, "2", "", b"2", [], [1.0], [1.0, 2.0, 3.0], {}, {"a": 1}, object(), float("nan"), 1j, np.zeros((2, 2)), np.array(["a"]), print]

# What a message of pybind11 says of no argument in particular.
RAW = re.compile(r"incompatible (function|constructor) arguments|Invoked with|Unable to (cast|convert)|takes no keyword|_core\.\w+ object")


def spring_run() -> kb.Simulation:
    sim = hanging().simulate()
    sim.advance(3)
    return sim


def things(folder: Path) -> dict[str, Callable[[], Any]]:
    """Makers of the objects whose methods are called; anew each time, as calls change them."""
    scenario = falling_block()

    def results() -> kb.Result:
        if not (folder / "run").exists():
            scenario.run(folder / "run")
        return kb.open(folder / "run")

    return {
        "results": results,
        "frames": lambda: results().frames,
        "blocks of results": lambda: results().blocks,
        "contacts of results": lambda: results().contacts(),
        "scenario": falling_block,
        "Scenario": lambda: kb.Scenario,
        "rock": lambda: falling_block().rock,
        "blocks of a scenario": lambda: falling_block().block,
        "simulation": spring_run,
        "blocks": lambda: spring_run().blocks,
        "block": lambda: spring_run().blocks["stone"],
        "springs": lambda: spring_run().springs,
        "contacts": lambda: spring_run().contacts,
        "strengths": lambda: spring_run().strength,
        "cut blocks": scenario.cut,
        "Motion": lambda: kb.Motion,
        "TraceMap": lambda: kb.TraceMap,
        "keyblock": lambda: kb,
    }


# They end by themselves, need other programs, or draw.
LEFT_OUT = {"run", "verify", "plot", "animate", "open", "open_run", "open_study", "open_limit", "Result", "Study", "Limit", "run_study", "find_limit", "find_safety", "run_table"}


def methods(of: Any) -> list[str]:
    names = [name for name in dir(of) if not name.startswith("_") and name not in LEFT_OUT]
    names += [name for name in ("__getitem__", "__setitem__", "__delitem__", "__contains__") if hasattr(type(of), name)]
    found = []
    for name in names:
        try:
            value = getattr(of, name)
        except AttributeError:  # a key without a value
            continue
        if callable(value) and not (inspect.isclass(value) and issubclass(value, (BaseException,))):
            found.append(name)
    return found


class Told:
    """Calls, and keeps what they say that is no sentence."""

    def __init__(self) -> None:
        self.raw: list[str] = []

    def __call__(self, call: Callable[[], Any], what: str) -> None:
        try:
            call()
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
            if RAW.search(text):
                self.raw.append(f"{what}: {text[:300]}")


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some of the wrong values are names of folders after all: what is written there is of the test."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def told() -> Iterator[Told]:
    calls = Told()
    yield calls
    assert not calls.raw, "\n".join(calls.raw)


@pytest.mark.parametrize("of", sorted(things(Path())))
def test_wrong_kinds_are_told_in_sentences(of: str, tmp_path: Path, told: Told) -> None:
    make = things(tmp_path)[of]
    for name in methods(make()):
        for wrong in WRONG:
            kept = make()
            told(lambda: getattr(kept, name)(wrong), f"{of}.{name}({wrong!r})")
            told(lambda: getattr(kept, name)(wrong, wrong), f"{of}.{name}({wrong!r}, {wrong!r})")
        try:
            keywords = [k for k, p in inspect.signature(getattr(make(), name)).parameters.items() if p.kind is p.KEYWORD_ONLY]
        except (TypeError, ValueError):
            continue
        for keyword in keywords:
            for wrong in WRONG:
                told(lambda: getattr(make(), name)(**{keyword: wrong}), f"{of}.{name}({keyword}={wrong!r})")


def test_options_of_runs_studies_and_limits_are_told(tmp_path: Path, told: Told) -> None:
    scenario = falling_block()
    for wrong in WRONG:
        for option in ("folder", "realization", "threads", "resume", "replace", "controllers", "progress"):
            told(lambda: scenario.run(**{"folder": tmp_path / "out", "replace": True, option: wrong}), f"run({option}={wrong!r})")
            told(lambda: scenario.simulate(**({option: wrong} if option != "progress" else {})), f"simulate({option}={wrong!r})")
        for option in ("folder", "resume", "workers", "executor", "controllers", "progress"):
            told(lambda: kb.run_study(scenario, **{"folder": tmp_path / "study", option: wrong}), f"run_study({option}={wrong!r})")
        for option in ("folder", "key", "start", "stop", "until", "above", "since", "tolerance", "realizations", "scan", "workers", "resume"):
            given = {"folder": tmp_path / "limit", "key": "jonts.friction", "start": 1.0, "stop": 2.0, option: wrong}
            told(lambda: kb.find_limit(scenario, **given), f"find_limit({option}={wrong!r})")
        for option in ("folder", "stage", "sets", "area", "moved", "start", "stop", "tolerance", "realizations", "sweep", "workers", "resume"):
            given = {"folder": tmp_path / "safety", "start": 1.0, "stop": 1.0, option: wrong}
            told(lambda: kb.find_safety(scenario, **given), f"find_safety({option}={wrong!r})")
        for option in ("cases", "names", "orders", "all", "workers"):
            told(lambda: kb.verify(**{"cases": tmp_path, "names": ["no such"], option: wrong}), f"verify({option}={wrong!r})")
        for function in (kb.run_study, kb.find_limit):
            told(lambda: function(wrong, tmp_path / "x", *(["a", 1, 2] if function is kb.find_limit else [])), f"{function.__name__}({wrong!r})")


def refused(call: Callable[[], Any], kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=words):
        call()


def test_what_was_meant_is_asked_for() -> None:
    sim = spring_run()
    force = [1.0, 0.0]
    for call, kind, words in [
        (lambda: sim.apply_force("stone", [1.0, 2.0, 3.0]), ValueError, "force: found 3 elements; expected two numbers"),
        (lambda: sim.apply_force("stone", 3.0), TypeError, "force: found 3.0; expected two numbers"),
        (lambda: sim.apply_force("stone", ["1", "2"]), TypeError, "force: found '1'; expected two numbers"),
        (lambda: sim.apply_force("stone", force, [1.0]), ValueError, "point: found 1 elements"),
        (lambda: sim.apply_force("stone", force, slot=-1), ValueError, "slot: found -1; expected a whole number, at least 0"),
        (lambda: sim.apply_force("stone", force, slot=1.5), TypeError, "slot: found 1.5"),
        (lambda: sim.apply_force(-1, force), ValueError, "block: found -1"),
        (lambda: sim.apply_force(1.0, force), TypeError, "block: found 1.0"),
        (lambda: sim.apply_force(True, force), TypeError, "block: found True"),
        (lambda: sim.blocks["stone"].apply_force(force, slot="0"), TypeError, "slot: found '0'"),
        (lambda: sim.advance(1.5), TypeError, "steps: found 1.5; expected a whole number"),
        (lambda: sim.advance("2"), TypeError, "steps: found '2'"),
        (lambda: sim.advance_to("2"), TypeError, "time: found '2'; expected a number"),
        (lambda: sim.set_load_factor(-1, 1.0), ValueError, "load: found -1"),
        (lambda: sim.set_motion_scale("2"), TypeError, "factor: found '2'"),
        (lambda: sim.contacts.set_strength(30), TypeError, r"named values only: set_strength\(friction=30\)"),
        (lambda: sim.contacts.set_strength(friction=True), TypeError, "friction: found True; expected a number"),
        (lambda: sim.contacts.set_strength(friction="20"), TypeError, "friction: found '20'; expected a number"),
        (lambda: sim.contacts.set_strength(cohesion=["1"]), TypeError, "cohesion: found"),
        (lambda: setattr(sim.strength["joints"], "friction", True), TypeError, "friction: found True; expected a number"),
        (lambda: setattr(sim.strength["joints"], "friction", "20"), TypeError, "friction: found '20'; expected a number"),
        (lambda: setattr(sim.springs[0], "stiffness", "1e6"), TypeError, "stiffness: found '1e6'; expected a number"),
        (lambda: setattr(sim.springs[0], "force", True), TypeError, "force: found True; expected a number"),
        (lambda: setattr(sim, "velocity", "0"), TypeError, "velocity: found '0'"),
        (lambda: sim.strength[3], TypeError, "joint: found 3; expected a text"),
        (lambda: hanging().simulate(threads="2"), TypeError, "threads: found '2'; expected a whole number"),
        (lambda: hanging().simulate(threads=0), ValueError, "threads"),
        (lambda: hanging().simulate(resume="yes"), TypeError, "resume: found 'yes'; expected True or False"),
        (lambda: hanging().cut("1"), TypeError, "realization: found '1'"),
        (lambda: hanging().check(1.0), TypeError, "realization: found 1.0"),
        (lambda: kb.Scenario.load(3), TypeError, "file: found 3; expected a path"),
        (lambda: kb.Scenario.parse(b"x = 1"), TypeError, "text: found b'x = 1'; expected a text"),
        (lambda: kb.run_study("study.toml", "out"), TypeError, "scenario: found str; expected a keyblock.Scenario"),
        (lambda: kb.find_limit(hanging(), "out", "joints.friction", "1", 2), TypeError, "start: found '1'; expected a number"),
        (lambda: kb.controller(lambda sim: None, name=3), TypeError, "name: found 3; expected a text"),
        (lambda: kb.controller(lambda sim: None, name="a\nb"), ValueError, "name: found .*one line"),
        (lambda: kb.Motion("0.01", [1.0, 2.0]), TypeError, "step: found '0.01'; expected a number"),
    ]:
        refused(call, kind, words)
    # Numbers of numpy are numbers.
    sim.apply_force(np.int64(1), np.array([1.0, 0.0]), slot=np.int32(2))
    assert sim.forces == ((1, 2, (1.0, 0.0)),)
    sim.contacts.set_strength(friction=np.float32(20.0))
    sim.strength["joints"].friction = np.float64(21.0)
    assert sim.strength["joints"].friction == 21.0 and sim.advance(np.int64(1)) == 1
