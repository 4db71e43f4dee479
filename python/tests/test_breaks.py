"""Events of breaking."""

from __future__ import annotations

import numpy as np
import pytest

import keyblock
from conftest import optional


def pulled(**joint):
    """A block of 2 x 1 m below a roof, pulled down by 1 kPa more every second. Without gravity."""
    scenario = keyblock.Scenario()
    scenario.gravity = [0.0, 0.0]
    scenario.rock.update(density=2600.0, young=1e10, poisson=0.2)
    scenario.joints.friction = 30.0
    scenario.block.append(name="roof", outer=[[0, 1], [2, 1], [2, 3], [0, 3]], fixed=True)
    scenario.block.append(name="hung", outer=[[0, 0], [2, 0], [2, 1], [0, 1]])
    scenario.interface.append(name="bond", between=["roof", "hung"], friction=30.0, **joint)
    scenario.load.append({"block": "hung", "from": [0, 0], "to": [2, 0], "traction": [0.0, -1000.0], "time": [[0, 0], [100, 100]]})
    scenario.time.step = 0.005
    scenario.stage.append(name="pull", kind="rest", duration=12.0)
    return scenario


def test_a_joint_that_breaks_is_an_event_with_time_place_and_name(tmp_path):
    optional("pandas")
    pulled(cohesion=1e6, tension=1e4).run(tmp_path / "out")
    with keyblock.open(tmp_path / "out") as run:
        breaks = run.breaks
        assert breaks.name.tolist() == ["bond", "bond"] and breaks["mode"].tolist() == ["tension", "tension"]
        np.testing.assert_allclose(breaks.index, 10.0, atol=0.02)
        np.testing.assert_allclose(np.sort(breaks.x), [0.0, 2.0], atol=1e-3)
        assert breaks.length.sum() == pytest.approx(2.0) and (breaks.element == -1).all() and (breaks.stage == 0).all()
        assert breaks.attrs["units"]["length"] == "m"
        (count,) = run.summary["breaks"]
        assert (count["name"], count["events"], count["length_m"]) == ("bond", 2, pytest.approx(2.0))
        assert count["first_s"] == breaks.index[0]


def test_nothing_breaks_where_nothing_may(tmp_path):
    optional("pandas")
    pulled().run(tmp_path / "out")
    with keyblock.open(tmp_path / "out") as run:
        assert len(run.breaks) == 0 and run.summary["breaks"] == []
