"""Water in Python: what contacts and elements have of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import optional
from test_scenario import falling_block

kb = optional("keyblock")

GAMMA = 1000 * 9.81


def test_pressures_of_contacts_and_forces_on_blocks(tmp_path: Path) -> None:
    scenario = falling_block()
    scenario["block.stone.outer"] = [[0.5, 0.0], [1.5, 0.0], [1.5, 1.0], [0.5, 1.0]]
    scenario.water.append(name="lake", head=3.0)
    del scenario["stage.fall"]
    scenario.stage.append(name="settle", kind="settle")
    summary = scenario.run(tmp_path / "out")
    assert summary["water"]["name"] == "lake"
    with kb.open(tmp_path / "out") as run:
        contacts = run.contacts()
        assert contacts.water_pressure == pytest.approx(3.0 * GAMMA, rel=1e-6)
        # Buoyancy: effective forces carry the weight under water.
        assert contacts.normal_force.sum() == pytest.approx(1500 * 9.81, rel=1e-3)
        elements = run.frames.at().elements
        assert dict(zip(elements.names, elements.force, strict=True))["water.stone"] == pytest.approx(GAMMA, rel=1e-3)
