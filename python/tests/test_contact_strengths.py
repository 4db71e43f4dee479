"""Contacts of a running simulation: what is copied of them, and strengths of single ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, TUNNEL, optional
from test_steering import balance

kb = optional("keyblock")
core = optional("keyblock._core")


def held_on_slope(**keys: object) -> kb.Scenario:
    """A block on a slope of 30°, held by friction of 40°."""
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    scenario.joints.friction = 40.0
    for key, value in keys.items():
        scenario[key.replace("__", ".")] = value
    return scenario


SOLVERS: list[dict[str, object]] = [{}, {"rock__order": 2}, {"rock__order": 3}, {"solver__face_contacts": 3}, {"joints__normal_stiffness": 1e9}]


@pytest.mark.parametrize("keys", SOLVERS, ids=str)
def test_the_strength_of_single_contacts(keys: dict[str, object], tmp_path: Path) -> None:
    """All contacts of a block with 10°: it slides as by Coulomb's law, while the strength of the joints stays."""
    held = held_on_slope(**keys).run()
    assert held["stages"][-1]["damage"]["displacement_max_m"] < 1e-3

    @kb.controller
    def weaken(sim: kb.Simulation) -> None:
        if sim.step == 2:
            sim.contacts.set_strength(friction=10.0)

    sim = held_on_slope(**keys).simulate(tmp_path / "out", controllers=[weaken])
    while not sim.done and sim.step < 100:
        sim.advance()
    assert sim.strength["joints"].friction == pytest.approx(40.0)
    assert sim.contacts.friction == pytest.approx(np.full(len(sim.contacts), 10.0))
    assert all(given == (pytest.approx(10.0), None, None) for given in sim.contact_strengths.values())
    before, time = np.hypot(*sim.block_velocities[1]), sim.time
    sim.advance(50)
    grows = (np.hypot(*sim.block_velocities[1]) - before) / (sim.time - time)
    assert grows == pytest.approx(9.81 * (0.5 - np.cos(np.pi / 6) * np.tan(np.radians(10.0))), rel=5e-3)
    assert abs(balance(sim)) < 1e-3 * sim.energy["friction"]
    sim.contacts.reset_strength()
    assert sim.contact_strengths == {}
    sim.advance(1)
    assert sim.contacts.friction == pytest.approx(np.full(len(sim.contacts), 40.0))


def test_strengths_of_contacts_stay_in_checkpoints(tmp_path: Path) -> None:
    (tmp_path / "tunnel.toml").write_text(TUNNEL)
    scenario = kb.Scenario.load(tmp_path / "tunnel.toml")

    @kb.controller(every=3)
    def weaken(sim: kb.Simulation) -> None:
        contacts = sim.contacts
        moved = contacts[contacts.slip > 1e-5]
        moved.set_strength(friction=20.0, cohesion=np.zeros(len(moved)))
        contacts[:2].reset_strength()

    whole = scenario.run(controllers=[weaken])
    assert whole["state_hash"] == scenario.run(controllers=[weaken], threads=2)["state_hash"] != scenario.run()["state_hash"]
    steps = whole["steps"]
    with scenario.simulate(tmp_path / "out", controllers=[weaken]) as sim:
        sim.advance(steps * 3 // 4)
    resumed = scenario.run(tmp_path / "out", controllers=[weaken], resume=True)
    assert resumed["state_hash"] == whole["state_hash"]


def test_strengths_of_contacts_that_cannot_be_are_refused() -> None:
    sim = held_on_slope().simulate()
    assert len(sim.contacts) == 0 and len(sim.contacts.of("")) == 0
    sim.advance(3)
    contacts = sim.contacts
    with pytest.raises(kb.InputError, match="degrees, from 0 to less than 90"):
        contacts.set_strength(friction=90.0)
    with pytest.raises(kb.InputError, match="at least 0"):
        contacts.set_strength(cohesion=-1.0)
    with pytest.raises(kb.InputError, match="finite number"):
        contacts.set_strength(tension=float("nan"))
    with pytest.raises(ValueError, match=f"one for each of {len(contacts)} contacts"):
        contacts.set_strength(friction=[1.0] * (len(contacts) + 1))
    with pytest.raises(TypeError, match="friction, cohesion or tension"):
        contacts.set_strength()
    with pytest.raises(TypeError, match="mask"):
        contacts[0]
    with pytest.raises(TypeError, match="columns"):
        list(contacts)
    with pytest.raises(IndexError):
        contacts[np.ones(len(contacts) + 1, dtype=bool)]
    with pytest.raises(AttributeError, match="did you mean 'friction'"):
        contacts.fricton = 3.0
    with pytest.raises(AttributeError, match="only be read"):
        contacts.friction = 3.0
    with pytest.raises(ValueError, match="read-only"):
        contacts.friction[:] = 3.0
    assert sim.contact_strengths == {}


def test_contacts_that_are_kept_stay_as_they_were() -> None:
    """Columns are copied when they are asked for: also then they are those of their step."""
    twin, sim = held_on_slope().simulate(), held_on_slope().simulate()
    for each in (twin, sim):
        each.strength["joints"].friction = 10.0
        each.advance(5)
    kept, wanted = sim.contacts, twin.contacts.slip.copy()
    part = kept[kept.block_a == 1]
    assert sim.contacts is kept
    sim.advance(20)
    assert np.array_equal(kept.slip, wanted) and np.array_equal(part.slip, wanted[kept.block_a == 1])
    assert sim.contacts.slip.max() > kept.slip.max()
    inside: list[kb.simulation.Contacts] = []
    sim = held_on_slope().simulate(controllers=[lambda now: inside.append(now.contacts)])
    sim.advance(6)
    twin = held_on_slope().simulate()
    for contacts in inside:
        twin.advance()
        assert np.array_equal(contacts.normal_force, twin.contacts.normal_force)


def test_looking_at_contacts_copies_nothing_else() -> None:
    (sim := held_on_slope().simulate()).advance(3)
    contacts = sim.contacts
    contacts.slip.max()
    assert set(contacts._columns) == {"slip"}


def test_strength_left_is_in_results(tmp_path: Path) -> None:
    """A block slides down a slope of 30° and wears its joint: 1 − slip / d_c, then nothing."""
    scenario = kb.Scenario.load(ROOT / "verification/scenarios/weakening_slide.toml")
    a = np.radians(30.0)
    scenario["gravity"] = [-9.81 * float(np.sin(a)), -9.81 * float(np.cos(a))]
    scenario.joints.update(friction=29.5, residual_friction=25.0, weakening_slip=0.02)
    scenario.output = {"contact_interval": 0.05}
    scenario.run(tmp_path / "worn")
    with kb.open(tmp_path / "worn") as run:
        before = run.contacts(0.0)
        assert before.strength_left == pytest.approx(1.0), "what turns gravity on takes no strength"
        left = []
        for time in np.linspace(0.05, 1.0, 20):
            contacts = run.contacts(time)
            # Strength is what the last step had, in which the block goes by up to 0.7 mm.
            worn = np.clip((contacts.slip - before.slip) / 0.02, 0.0, 1.0)
            assert np.all(contacts.strength_left >= 1.0 - worn - 1e-9) and np.all(contacts.strength_left <= 1.0 - worn + 0.0007 / 0.02)
            left.append(float(contacts.strength_left.min()))
        assert left == sorted(left, reverse=True) and left[0] > 0.9 and left[-1] == 0.0 and any(0.1 < value < 0.9 for value in left)
        assert contacts.table().attrs["units"]["strength_left"] == ""
    page = (tmp_path / "worn/report.html").read_text()
    assert '"piece.lost"' in page and '"piece.pressure"' not in page
