"""What controllers can do: forces, springs, damage so far; and names that do not exist are refused."""

from __future__ import annotations

import re
import subprocess
import warnings
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from conftest import PROGRAM, ROOT, TUNNEL, optional
from test_scenario import falling_block

kb = optional("keyblock")
core = optional("keyblock._core")


def balance(sim: kb.Simulation) -> float:
    e = sim.energy
    return e["kinetic"] + e["strain"] + e["gravity"] + e["contact"] + e["friction"] + e["damping"] + e["numerical"] + e["radiated"] - e["input"] - e["water"]


def test_a_force_carries_a_block_and_its_work_is_in_the_balance() -> None:
    sim = falling_block().simulate()
    stone = sim.blocks["stone"]
    weight = stone.mass * 9.81
    assert stone.mass == pytest.approx(2500.0) and stone.young == 1e9 and stone.area == pytest.approx(1.0) and not stone.fixed
    sim.apply_force("stone", [0.0, 2.0 * weight])
    sim.advance(100)
    assert stone.velocity == pytest.approx([0.0, 9.81 * 0.1], rel=1e-6, abs=1e-9)
    assert sim.energy["input"] == pytest.approx(2.0 * weight * 0.5 * 9.81 * 0.1**2, rel=0.02)
    assert abs(balance(sim)) < 1e-6 * sim.energy["input"]
    assert sim.forces == ((1, 0, (0.0, 2.0 * weight)),)
    stone.apply_force([0.0, weight])  # takes the place of the first one
    before = stone.velocity.copy()
    sim.advance(50)
    assert stone.velocity == pytest.approx(before, rel=1e-6, abs=1e-9)
    stone.apply_force([0.0, 0.0])
    assert sim.forces == ()


def test_a_force_at_a_corner_turns_a_block_about_its_mass_centre() -> None:
    scenario = falling_block()
    scenario.gravity = [0.0, 0.0]
    scenario.rock.young = 1e11
    sim = scenario.simulate()
    stone = sim.blocks["stone"]
    corner = stone.vertices[np.argmax(stone.vertices.sum(axis=1))].copy()  # the upper right one
    force = 1e4
    sim.apply_force("stone", [0.0, force], corner)
    sim.advance(20)
    arm = corner - sim.centroids[1]
    spin = force * arm[0] / (stone.mass / 6.0) * sim.time  # inertia of a square of side 1: m / 6
    first, second = stone.vertices[0].copy(), stone.vertices[2].copy()
    angle = np.arctan2(*(second - first)[::-1])
    sim.advance(1)
    turned = (np.arctan2(*(stone.vertices[2] - stone.vertices[0])[::-1]) - angle) / 0.001
    assert turned == pytest.approx(spin, rel=0.05)


def test_forces_stay_in_checkpoints(tmp_path: Path) -> None:
    scenario = falling_block()
    scenario["stage"] = [{"name": "up", "kind": "rest", "duration": 0.05}, {"name": "on", "kind": "rest", "duration": 0.05}]

    @kb.controller
    def push(sim: kb.Simulation) -> None:
        if sim.step == 3:
            sim.apply_force("stone", [500.0, 30e3], [1.2, 0.6])

    whole = scenario.run(controllers=[push])
    with scenario.simulate(tmp_path / "out", controllers=[push]) as sim:
        sim.advance(70)
    resumed = scenario.run(tmp_path / "out", controllers=[push], resume=True)
    assert resumed["state_hash"] == whole["state_hash"] != scenario.run()["state_hash"]


def test_resuming_a_steered_run_names_what_steered_it(tmp_path: Path) -> None:
    scenario = falling_block()
    scenario.save(tmp_path / "drop.toml")
    scenario = kb.Scenario.load(tmp_path / "drop.toml")

    @kb.controller(name="push it")
    def push(sim: kb.Simulation) -> None:
        if sim.step == 3:
            sim.apply_force("stone", [500.0, 0.0])

    @kb.controller(name="push it")
    def push_harder(sim: kb.Simulation) -> None:
        sim.apply_force("stone", [900.0, 0.0])

    @kb.controller(name="other: one")
    def other(sim: kb.Simulation) -> None:
        pass

    def stop_early(folder: str, controllers: list[kb.Controller]) -> None:
        sim = scenario.simulate(tmp_path / folder, controllers=controllers)
        sim.advance(20)
        sim.stop()
        sim.finish()

    stop_early("steered", [push, other])
    told = r"controllers of a program have steered: push it, other: one; expected the same controllers, from that program; the rest would run without them"
    with pytest.raises(kb.InputError, match=told):
        scenario.run(tmp_path / "steered", resume=True)
    done = subprocess.run([PROGRAM, "run", "drop.toml", "-o", "steered", "--resume"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1 and re.search(told, done.stderr)
    with pytest.raises(kb.InputError, match="other controllers have steered: push it, other: one; expected the same ones; their text has changed"):
        scenario.run(tmp_path / "steered", resume=True, controllers=[push_harder, other])
    with pytest.raises(kb.InputError, match="expected the same ones, and not other: one"):
        scenario.run(tmp_path / "steered", resume=True, controllers=[other])
    stop_early("free", [])
    with pytest.raises(kb.InputError, match="results of a run without controllers; expected the same run, and none of push it"):
        scenario.run(tmp_path / "free", resume=True, controllers=[push])
    assert scenario.run(tmp_path / "steered", resume=True, controllers=[push, other])["state_hash"] == scenario.run(controllers=[push])["state_hash"]


def hanging() -> kb.Scenario:
    scenario = falling_block()
    scenario["block"] = [
        {"name": "beam", "outer": [[0, 3], [2, 3], [2, 4], [0, 4]], "fixed": True},
        {"name": "stone", "outer": [[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]},
    ]
    scenario.spring.append(name="rope", from_=[1.0, 3.0], to=[1.0, 1.5], stiffness=1e6)
    scenario["stage"] = [{"name": "hung", "kind": "settle"}, {"name": "after", "kind": "rest", "duration": 0.4}]
    return scenario


def test_springs_are_read_and_tightened() -> None:
    sim = hanging().simulate()
    rope = sim.springs["rope"]
    while sim.stage == "hung" and not sim.done:
        sim.advance()
    weight = 2500.0 * 9.81
    assert rope.force == pytest.approx(weight, rel=1e-3) and rope.is_there and rope.stiffness == 1e6
    assert rope.length == pytest.approx(1.5 + weight / 1e6, rel=1e-4)
    height = sim.centroids[1, 1]
    rope.stiffness = 4e6  # keeps its elongation: it pulls with four times the force
    assert rope.force == pytest.approx(4.0 * weight, rel=1e-3)
    rope.force = weight  # as long as that takes: in balance again
    assert rope.force == pytest.approx(weight, rel=1e-9)
    sim.advance(100)
    assert sim.centroids[1, 1] == pytest.approx(height, abs=1e-4)
    assert abs(balance(sim)) < 1e-3 * weight * 0.01
    rope.force = 2.0 * weight
    sim.advance(60)
    assert sim.centroids[1, 1] > height + 1e-3 and abs(balance(sim)) < 1e-3 * sim.energy["kinetic"]
    with pytest.raises(kb.InputError):
        rope.stiffness = -1.0
    with pytest.raises(KeyError, match="did you mean 'rope'"):
        sim.springs["ropes"]
    assert sim.springs[0].name == "rope" and len(sim.springs) == 1
    assert sim.finish()["elements"][0]["elongation_m"] == pytest.approx(rope.length - 1.5, abs=1e-9)


def test_elongation_is_the_change_of_length_since_the_spring_was_installed() -> None:
    scenario = hanging()
    scenario.spring.append(name="late", from_=[1.2, 3.0], to=[1.2, 1.5], stiffness=1e6)
    scenario.stage.append(name="tightened", kind="settle", install=["late"])
    sim = scenario.simulate()
    while sim.stage != "tightened":
        sim.advance()
    before = sim.springs["late"].length
    assert before > 1.5 + 1e-2
    sim.advance()
    sim.springs["late"].force = 2e4  # pretension is no elongation
    while not sim.done:
        sim.advance()
    first, late = sim.finish()["elements"]
    assert late["elongation_m"] == pytest.approx(sim.springs["late"].length - before, abs=1e-9)
    assert late["elongation_m"] < -5e-3 and late["force_n_m"] == pytest.approx(2e4 + 1e6 * late["elongation_m"], rel=1e-3)
    assert first["elongation_m"] == pytest.approx(sim.springs["rope"].length - 1.5, abs=1e-9)


def test_what_cannot_be_pushed_is_refused() -> None:
    sim = falling_block().simulate()
    with pytest.raises(kb.InputError, match="fixed"):
        sim.apply_force("floor", [1.0, 0.0])
    with pytest.raises(kb.InputError, match="a point of block 1"):
        sim.apply_force("stone", [1.0, 0.0], [30.0, 0.0])
    with pytest.raises(kb.InputError, match="finite"):
        sim.apply_force("stone", [float("nan"), 0.0])
    with pytest.raises(KeyError, match="did you mean 'stone'"):
        sim.apply_force("stones", [1.0, 0.0])
    with pytest.raises(IndexError):
        sim.apply_force(7, [1.0, 0.0])
    with pytest.raises(TypeError):
        sim.apply_force("stone", 3.0)


def test_damage_so_far_stops_a_run(tmp_path: Path) -> None:
    (tmp_path / "tunnel.toml").write_text(TUNNEL)
    scenario = kb.Scenario.load(tmp_path / "tunnel.toml")
    seen: list[float] = []

    def stop_when_moved(sim: kb.Simulation) -> None:
        if sim.damage.get("displacement_max_m", 0.0) > 1e-4:
            seen.append(sim.damage["displacement_max_m"])
            sim.stop()

    looked = scenario.run()
    stopped = scenario.run(controllers=[stop_when_moved])
    assert seen and stopped["steps"] < looked["steps"]
    sim = scenario.simulate()
    assert sim.damage == {}
    assert len(sim.blocks) == sim.stress.shape[0] == len(sim.status) and sim.blocks["frame"].fixed
    shaken: list[np.ndarray] = []

    def look(now: kb.Simulation) -> None:  # changes no bit
        now.damage, now.stress, now.status, now.contacts, now.blocks
        shaken.append(now.ground_acceleration)

    assert scenario.run(controllers=[look])["state_hash"] == looked["state_hash"]
    assert max(abs(a[0]) for a in shaken) == pytest.approx(3.0, rel=0.05)


def test_blocks_and_origin_are_those_of_the_results(tmp_path: Path) -> None:
    scenario = kb.Scenario.load(ROOT / "tests/data/concave_blocks.toml")
    sim = scenario.simulate(tmp_path / "out")
    sim.run()
    with kb.open(tmp_path / "out") as run:
        assert len(sim.blocks) == len(run.blocks) and sim.blocks.names == list(run.blocks.names)
        assert np.allclose(sim.blocks.area, run.blocks.area) and np.allclose(sim.blocks.young, run.blocks.young)
        assert np.allclose(sim.centroids + sim.origin, run.blocks.centroid, atol=0.5)
        assert np.allclose(sim.origin, run.blocks.origin)
        assert np.allclose(sim.stress, run.frames.at().stress, rtol=1e-5, atol=1.0)


def test_names_that_do_not_exist_are_refused() -> None:
    sim = falling_block().simulate()
    for wrong in ("gravty", "velocitty", "advance", "time", "blocks"):
        with pytest.raises(AttributeError, match=wrong):
            setattr(sim, wrong, 3)
    with pytest.raises(AttributeError, match="did you mean 'friction'"):
        sim.strength["joints"].fricton = 5
    with pytest.raises(AttributeError):
        kb.Controller(print).evry = 3
    for array in (sim.centroids, sim.block_velocities, sim.first_vertex, sim.present, sim.stress, sim.contacts.slip):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    with pytest.raises(TypeError):
        sim.energy["kinetic"] = 0.0
    assert sim.velocity[sim.first_coefficient[1] + 1] == 0.0
    with pytest.raises(kb.InputError, match="realization"):
        falling_block().cut(-1)
    with pytest.raises(kb.InputError, match="realization"):
        falling_block().check(-1)


def test_a_velocity_that_is_refused_leaves_the_view_alive() -> None:
    sim = falling_block().simulate()
    view = sim.velocity
    view[0] = float("nan")
    with pytest.raises(kb.InputError):
        sim.advance()
    assert np.isfinite(view).all()
    sim.advance(10)
    assert view is not None and np.array_equal(view, sim.velocity) and view.any()


class Threshold:
    def __init__(self, value: float) -> None:
        self.value = value

    def look(self, sim: kb.Simulation) -> None:
        pass

    __call__ = look


def look(threshold: float, sim: kb.Simulation) -> None:
    pass


def test_controllers_with_other_values_are_other_controllers() -> None:
    def make(threshold: float) -> kb.Controller:
        return kb.controller(lambda sim: sim.time > threshold)

    for of in (make, lambda t: kb.Controller(partial(look, t)), lambda t: kb.Controller(Threshold(t).look), lambda t: kb.Controller(Threshold(t))):
        assert of(1.0).hash == of(1.0).hash != of(2.0).hash


async def never_awaited(sim: kb.Simulation) -> None:
    sim.stop()


def never_begun(sim: kb.Simulation) -> Iterator[None]:
    sim.stop()
    yield


def test_controllers_that_would_not_run_are_refused() -> None:
    for wrong in (never_awaited, never_begun):
        with pytest.raises(TypeError, match="would not run"):
            falling_block().run(controllers=[wrong])
    for wrong in ("weaken", 3, Threshold):
        with pytest.raises(TypeError, match="a controller is a function"):
            falling_block().run(controllers=[wrong])
    for wrong in (look, "weaken", kb.controller(lambda sim: None), 3):
        with pytest.raises(TypeError, match=r"controllers=\[weaken\]"):
            falling_block().run(controllers=wrong)
    for every in (2.5, "5", True):
        with pytest.raises(TypeError, match="whole number"):
            kb.Controller(lambda sim: None, every)
    sim = falling_block().simulate()
    with pytest.raises(ValueError, match="at least 0"):
        sim.advance(-1)
    for time in (-1.0, float("nan")):
        with pytest.raises(ValueError, match="at least 0"):
            sim.advance_to(time)


def test_mistakes_are_told_in_words_of_python(tmp_path: Path) -> None:
    falling_block().run(tmp_path / "out")
    other = falling_block()
    other.joints.friction = 20.0
    with pytest.raises(kb.InputError, match="replace=True") as caught:
        other.run(tmp_path / "out")
    assert "--" not in str(caught.value) and "replace=True" in caught.value.diagnostics[0].expected
    with pytest.raises(kb.InputError, match="stop: found 10, as start") as caught:
        kb.find_limit(falling_block(), tmp_path / "limit", "joints.friction", 10, 10)
    assert caught.value.diagnostics[0].file == "stop"
    assert len(kb.run_table(tmp_path / "out")) == 1
    with pytest.raises(kb.NoResultError, match="no folders"):
        kb.run_table([])


@pytest.mark.parametrize("way", ["finish", "close", "with", "exception", "controller"])
def test_a_folder_is_let_go(way: str, tmp_path: Path) -> None:
    scenario = falling_block()
    kept: list[object] = []
    sim = scenario.simulate(tmp_path / "out")
    kept.append(sim)
    with pytest.raises(kb.InputError, match="a simulation of this process"):
        scenario.run(tmp_path / "out")
    with pytest.raises(kb.InputError, match="finish\\(\\) or close\\(\\)"):
        scenario.run(tmp_path / "out", replace=True)
    sim.advance(20)
    with pytest.warns(kb.UnfinishedWarning), kb.open(tmp_path / "out") as beside:
        assert len(beside.blocks) == 2
    if way == "finish":
        sim.finish()
    elif way == "close":
        sim.close()
        assert sim.step == 20
        with pytest.raises(RuntimeError, match="closed"):
            sim.advance()
    elif way == "with":
        with sim:
            sim.advance(5)
    elif way == "exception":
        try:
            with sim:
                raise ValueError("mine")
        except ValueError as error:
            kept.append(error)
    else:
        sim.close()

        def fails(now: kb.Simulation) -> None:
            if now.step == 5:
                raise ValueError("once")

        try:
            scenario.run(tmp_path / "out", controllers=[fails], replace=True)
        except ValueError as error:
            kept.append(error)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kb.UnfinishedWarning)
        opened = kb.open(tmp_path / "out")
    resumed = scenario.run(tmp_path / "out", **({"replace": True} if way == "controller" else {"resume": True}))
    import h5py

    with h5py.File(tmp_path / "out/result.h5") as plain, kb.open(tmp_path / "out") as again:
        assert set(plain) >= {"frames", "contacts"} and again.summary.steps == resumed["steps"]
    opened.close()
    assert resumed["state_hash"] == falling_block().run()["state_hash"]


def test_what_can_only_be_looked_at_says_so() -> None:
    scenario = falling_block()
    sim, blocks = scenario.simulate(), scenario.cut()
    for call in (
        lambda: sim.stages.append("more"),
        lambda: setattr(sim, "stages", ["more"]),
        lambda: sim.forces.append((1, 0, (0.0, 1.0))),
        lambda: setattr(blocks[0], "name", "other"),
        lambda: setattr(blocks[0], "nmae", "other"),
        lambda: blocks[0].rings.append([]),
        lambda: blocks[0].edges[0].append(""),
        lambda: blocks.append(blocks[0]),
        lambda: setattr(blocks, "areas", 0.0),
    ):
        with pytest.raises(AttributeError):
            call()
    with pytest.raises(TypeError, match="scenario.block"):
        blocks[0] = blocks[1]
    for array in (blocks[0].polygon, blocks[0].rings[0], blocks.areas):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
    with pytest.raises(TypeError):
        sim.contact_strengths[(1, 2)] = (10.0, None, None)
    moved = blocks[1].polygon.copy() + [0.0, 1.0]  # how one goes on from there
    scenario.block["stone"].outer = moved
    assert scenario.cut()[1].polygon[:, 1].min() == pytest.approx(blocks[1].polygon[:, 1].min() + 1.0)
    assert len(blocks[:1]) == 1 and blocks[1] in blocks and [b.name for b in reversed(blocks)] == ["stone", "floor"]
