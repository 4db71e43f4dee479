"""Runs from Python: the same bits as the program, steered step by step, and nothing that breaks the interpreter."""

from __future__ import annotations

import gc
import json
import signal
import threading
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, keyblock, optional
from test_scenario import falling_block

kb = optional("keyblock")
core = optional("keyblock._core")

SHORT = {
    "examples/01-tunnel.toml": {"stage.quiet.duration": 0.1, "stage.'first earthquake'.duration": 0.1, "stage.after.duration": 0.02},
    "examples/03-incline.toml": {},
    "verification/scenarios/beam.toml": {},
}


def scenarios() -> list[tuple[Path, dict[str, float]]]:
    found = [(ROOT / name, changes) for name, changes in SHORT.items() if (ROOT / name).exists()]
    runs = [path for path in (ROOT / "verification/scenarios").glob("*.toml") if "[[stage]]" in path.read_text()]
    more = sorted(runs, key=lambda path: path.stat().st_size)
    return found + [(path, {}) for path in more[: 5 - len(found)]]


@pytest.mark.parametrize("file, changes", scenarios(), ids=lambda value: getattr(value, "stem", ""))
def test_the_bits_are_those_of_the_program(file: Path, changes: dict[str, float], tmp_path: Path) -> None:
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    keyblock("run", file, "-o", "program", *sets, folder=tmp_path)
    theirs = json.loads((tmp_path / "program/summary.json").read_text())
    scenario = kb.Scenario.load(file)
    for key, value in changes.items():
        scenario[key] = value
    ours = scenario.run(tmp_path / "python", threads=2)
    assert ours["state_hash"] == theirs["state_hash"]
    written = json.loads((tmp_path / "python/summary.json").read_text())
    assert written["state_hash"] == ours["state_hash"]
    assert (tmp_path / "python/report.html").stat().st_size > 1000
    assert (tmp_path / "python/scenario.toml").read_text() == (tmp_path / "program/scenario.toml").read_text()
    simulation = kb.Scenario.load(file).simulate() if not changes else scenario.simulate()
    while simulation.advance(7):
        pass
    assert simulation.state_hash == theirs["state_hash"]


def test_arrays_follow_the_steps_and_outlive_the_run() -> None:
    sim = falling_block().simulate()
    before = sim.vertices.copy()
    vertices, velocity = sim.vertices, sim.velocity
    assert vertices.shape == (8, 2) and sim.first_vertex.tolist() == [0, 4, 8]
    assert not vertices.flags.writeable
    sim.advance(100)
    assert sim.time == pytest.approx(0.1) and sim.step == 100
    fallen = before[4:, 1] - vertices[4:, 1]
    assert fallen == pytest.approx(0.5 * 9.81 * 0.1**2, rel=0.02)
    assert np.array_equal(vertices, sim.vertices)
    assert sim.block_velocities[1] == pytest.approx([0, -0.981], rel=1e-9, abs=1e-9)
    assert sim.centroids[1] == pytest.approx([1.0, 0.6 - 0.0490], abs=1e-3)
    last = vertices.copy()
    sim.finish()
    del sim
    gc.collect()
    assert np.array_equal(vertices, last) and np.isfinite(velocity).all()


def test_velocities_that_are_written_act() -> None:
    free, braked = falling_block().simulate(), falling_block().simulate()
    for sim in (free, braked):
        sim.advance(50)
    energy = braked.energy["kinetic"]
    braked.velocity[:] *= 0.5
    braked.advance(1)
    free.advance(1)
    assert braked.block_velocities[1, 1] == pytest.approx(0.5 * free.block_velocities[1, 1], rel=0.02)
    assert braked.energy["input"] == pytest.approx(-0.75 * energy, rel=1e-9)
    # The audit holds all the same.
    e = braked.energy
    assert e["kinetic"] + e["strain"] + e["gravity"] + e["contact"] + e["friction"] + e["damping"] + e["numerical"] - e["input"] == pytest.approx(
        0.0, abs=1e-9 * energy
    )
    braked.velocity = np.zeros_like(braked.velocity)
    assert not braked.velocity.any()
    braked.velocity[0] = float("nan")
    with pytest.raises(kb.InputError, match="finite"):
        braked.advance()
    assert braked.advance() == 1
    with pytest.raises(kb.InputError, match="coefficients"):
        braked.velocity = np.zeros(3)


def incline() -> kb.Scenario:
    """A block that rests on a plane of 20° with friction of 30°."""
    slope = np.tan(np.radians(20.0))
    scenario = falling_block()
    scenario["block"] = [
        {"name": "bed", "outer": [[0, -3], [6, -3], [6, 6 * slope], [0, 0]], "fixed": True},
        {"name": "stone", "outer": [[3, 3 * slope], [4, 4 * slope], [4, 4 * slope + 1], [3, 3 * slope + 1]]},
    ]
    scenario["stage"] = [{"name": "settled", "kind": "settle"}, {"name": "slide", "kind": "rest", "duration": 0.3}]
    return scenario


def test_a_controller_weakens_joints() -> None:
    held = incline().simulate()
    held.run()
    assert abs(held.block_velocities[1]).max() < 1e-3

    weakened: list[float] = []

    @kb.controller(every=10)
    def weaken(sim: kb.Simulation) -> None:
        if sim.time > 0.1 and not weakened:
            sim.strength["joints"].friction = 10.0
            weakened.append(sim.time)

    sim = incline().simulate(controllers=[weaken])
    summary = sim.run()
    assert sim.strength["joints"].friction == pytest.approx(10.0)
    # a = g (sin 20° − tan 10° cos 20°) from then on.
    expected = 9.81 * (np.sin(np.radians(20)) - np.tan(np.radians(10)) * np.cos(np.radians(20))) * (0.3 - weakened[0])
    assert np.hypot(*sim.block_velocities[1]) == pytest.approx(expected, rel=0.01)
    assert summary["hooks"] == [{"name": weaken.name, "hash": weaken.hash}]
    assert "weaken" in weaken.name
    with pytest.raises(kb.InputError, match="joint set"):
        sim.strength["J7"]
    with pytest.raises(kb.InputError):
        sim.strength["joints"].friction = 95.0
    with pytest.raises(kb.InputError):
        sim.strength["joints"].cohesion = float("inf")


def test_a_run_that_is_steered_is_resumed_to_the_same_bits(tmp_path: Path) -> None:
    def pull(sim: kb.Simulation) -> None:
        sim.set_load_factor(0, 1.0 + sim.time)
        if sim.step == 150:
            sim.strength["joints"].friction = 28.0
        if sim.step == 170:
            sim.velocity[:] *= 0.5

    scenario = falling_block()
    scenario["stage"] = [{"name": f"part {k}", "kind": "rest", "duration": 0.1} for k in range(4)]
    scenario["load"] = [{"block": "stone", "point": [1.0, 0.6], "force": [2e4, 0.0]}]
    whole = scenario.run(tmp_path / "whole", controllers=[pull])
    sim = scenario.simulate(tmp_path / "parts", controllers=[pull])
    sim.advance(260)
    del sim
    with pytest.raises(kb.InputError):
        scenario.run(tmp_path / "parts", resume=True)  # without its controller
    resumed = scenario.run(tmp_path / "parts", resume=True, controllers=[pull])
    assert resumed["state_hash"] == whole["state_hash"]
    with pytest.raises(kb.InputError, match="ended"):
        scenario.simulate(tmp_path / "parts", resume=True, controllers=[pull])


def test_motions_are_scaled_by_a_program() -> None:
    def shaken(factor: float, scale: float) -> str:
        scenario = falling_block()
        scenario["motion"] = [{"name": "sine", "x": {"amplitude": 2.0, "frequency": 3.0, "cycles": 1.0}}]
        scenario["stage"] = [{"name": "quake", "kind": "shake", "motion": "sine", "scale": scale}]
        sim = scenario.simulate()
        sim.set_motion_scale(factor)
        sim.run()
        return sim.state_hash

    assert shaken(2.0, 1.0) == shaken(1.0, 2.0) != shaken(1.0, 1.0)


def test_exceptions_come_back_as_themselves(tmp_path: Path) -> None:
    class Mine(Exception):
        pass

    def fail(sim: kb.Simulation) -> None:
        if sim.step == 20:
            raise Mine("at twenty")

    with pytest.raises(Mine, match="at twenty"):
        falling_block().run(tmp_path / "out", controllers=[fail])
    summary = json.loads((tmp_path / "out/summary.json").read_text())
    assert summary["interrupted"] and summary["steps"] == 20
    with pytest.raises(Mine):
        falling_block().run(progress=lambda now: (_ for _ in ()).throw(Mine()))


def test_progress_is_told() -> None:
    told: list[float] = []
    scenario = falling_block()
    scenario.stage[0].duration = 3.0
    scenario.run(progress=lambda now: told.append(now.fraction))
    assert told and told == sorted(told) and told[-1] <= 1.0


def test_ctrl_c_ends_in_good_order(tmp_path: Path) -> None:
    def interrupt(sim: kb.Simulation) -> None:
        if sim.step == 30:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        falling_block().run(tmp_path / "out", controllers=[interrupt])
    assert json.loads((tmp_path / "out/summary.json").read_text())["interrupted"]


def test_what_does_not_fit_the_moment_is_refused() -> None:
    sim = falling_block().simulate()
    refused: list[Exception] = []

    def within(sim: kb.Simulation) -> None:
        for call in (sim.advance, sim.finish, sim.run):
            with pytest.raises(RuntimeError):
                call()
            refused.append(RuntimeError())

    inside = falling_block().simulate(controllers=[within])
    inside.advance(1)
    assert len(refused) == 3

    trouble: list[BaseException] = []

    def other() -> None:
        for _ in range(2000):
            for name in ("velocity", "vertices", "contacts", "centroids", "energy", "state_hash"):
                try:
                    getattr(sim, name)
                except RuntimeError:
                    continue
                except BaseException as error:  # noqa: BLE001
                    trouble.append(error)

    threads = [threading.Thread(target=other) for _ in range(2)]
    for thread in threads:
        thread.start()
    sim.run()
    for thread in threads:
        thread.join()
    assert not trouble
    assert sim.done and sim.advance() == 0
    assert sim.finish() == sim.finish()


@pytest.mark.parametrize(
    "options",
    [{"threads": 0}, {"threads": 10**6}, {"realization": -1}, {"resume": True}, {"resume": True, "replace": True, "folder": "x"}],
)
def test_options_that_are_none(options: dict[str, object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kb.InputError):
        falling_block().simulate(**options)


def test_wrong_types_are_refused() -> None:
    sim = falling_block().simulate()
    for call in (
        lambda: sim.advance("many"),
        lambda: sim.advance(1.5),
        lambda: sim.set_load_factor(-1, 1.0),
        lambda: sim.set_load_factor(10**30, 1.0),
        lambda: core.Simulation.begin(None),
        lambda: core.Simulation.begin("tunnel.toml"),
        lambda: core.Scenario.parse(b"\xff\xfe"),
        lambda: core.Scenario.empty().set(1, 2),
    ):
        with pytest.raises((TypeError, ValueError, RuntimeError)):
            call()
    with pytest.raises(kb.InputError):
        sim.set_load_factor(3, 1.0)
    for kind in (core.Simulation, core.Scenario, core.Block, core.Progress, core.Diagnostic):
        with pytest.raises(TypeError):
            kind()
        with pytest.raises(TypeError):
            kind.__new__(kind)
        with pytest.raises(TypeError):
            object.__new__(kind)
        with pytest.raises(TypeError):
            type("Mine", (kind,), {})
