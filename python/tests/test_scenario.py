"""Scenarios from Python."""

from __future__ import annotations

import copy
import pickle
import types
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, keyblock, optional

kb = optional("keyblock")
core = optional("keyblock._core")

TUNNEL = ROOT / "examples/01-tunnel.toml"


def falling_block() -> kb.Scenario:
    """A block that falls on another one, made from nothing."""
    scenario = kb.Scenario({"title": "drop"})
    scenario.rock.density = 2500
    scenario.rock.young = 1e9
    scenario["rock.poisson"] = 0.2
    scenario.rock.state = "plane-strain"
    scenario.joints.friction = 30
    scenario.block.append(name="floor", outer=[[0, -1], [2, -1], [2, 0], [0, 0]], fixed=True)
    scenario.block.append(name="stone", outer=np.array([[0.5, 0.1], [1.5, 0.1], [1.5, 1.1], [0.5, 1.1]]))
    scenario.time.step = 0.001
    scenario.stage.append(name="fall", kind="rest", duration=0.3)
    return scenario


def test_values_are_read_and_set() -> None:
    scenario = kb.Scenario.load(TUNNEL)
    assert scenario["rock.young"] == scenario.rock.young == 3e9
    assert scenario.joint_set["J2"].dip == scenario["joint_set.J2.dip"] == scenario.joint_set[1].dip
    scenario["rock.young"] = np.float64(4e9)
    scenario.stage["first earthquake"].scale = 2
    scenario.joint_set[-1].spacing.mean = 0.6
    assert scenario.rock.young == 4e9
    assert scenario["stage.'first earthquake'.scale"] == 2
    assert scenario.joint_set["J3"].spacing.mean == 0.6
    assert "rock.young" in scenario and "rock.colour" not in scenario
    assert scenario.get("boundary.base", "none") == "none"
    with pytest.raises(KeyError):
        scenario["boundary.base"]
    with pytest.raises(AttributeError):
        scenario.rock.colour  # noqa: B018
    with pytest.raises(KeyError):
        scenario.joint_set["J9"]
    assert len(scenario.joint_set) == 3
    assert [table.name for table in scenario.joint_set] == ["J1", "J2", "J3"]


def test_a_scenario_from_scratch_is_the_same_as_its_text(tmp_path: Path) -> None:
    scenario = falling_block()
    assert scenario.check() == []
    again = kb.Scenario.parse(scenario.toml())
    assert again.to_dict() == scenario.to_dict()
    scenario.save(tmp_path / "drop.toml")
    keyblock("check", "drop.toml", folder=tmp_path)
    assert scenario.run()["state_hash"] == again.run()["state_hash"]
    assert len(scenario.cut()) == 2
    assert scenario.cut()[1].name == "stone"


def test_what_is_replaced_counts_no_more() -> None:
    scenario = kb.Scenario.load(ROOT / "examples/04-wall.toml")
    bricks = len(scenario.block)
    for k in range(20):
        scenario.block.append(name=f"more {k}", outer=[[5 + k, 0], [6 + k, 0], [6 + k, 1], [5 + k, 1]])
        scenario.block[-1].fixed = True
    scenario.rock.young = 1e9
    scenario.rock.young = 2e9
    scenario["rock"] = {**scenario.rock.to_dict(), "density": 2000.0}
    assert len(scenario.block) == bricks + 20 and scenario.block["more 7"].fixed
    # The list of blocks as it became, what was set in its last element, and the last [rock].
    assert [change.partition("=")[0] for change in scenario._core.changes] == ["block", f"block[{bricks + 19}].fixed", "rock"]
    assert kb.Scenario.parse(scenario.toml()).to_dict() == scenario.to_dict()
    with pytest.raises(kb.InputError, match="a list"):
        scenario._core.append("rock", {"young": 1})


def test_copies_are_apart_and_pickled() -> None:
    scenario = falling_block()
    other = copy.deepcopy(scenario)
    other.rock.young = 2e9
    assert scenario.rock.young == 1e9
    assert pickle.loads(pickle.dumps(other)).to_dict() == other.to_dict()
    loaded = kb.Scenario.load(TUNNEL)
    loaded["stage.'first earthquake'.scale"] = 2.5
    assert pickle.loads(pickle.dumps(loaded)).to_dict() == loaded.to_dict()


def test_mistakes_come_with_their_places() -> None:
    scenario = kb.Scenario.parse("[rock]\ndensity = -5\nyoung = 'stiff'\ncolour = 3\n", "mine.toml")
    with pytest.raises(kb.InputError) as caught:
        scenario.check()
    found = caught.value.diagnostics
    assert len(found) >= 3
    young = next(d for d in found if d.key == "rock.young")
    assert (young.file, young.line, young.column) == ("mine.toml", 3, 9)
    assert "stiff" in young.found and young.expected
    assert str(young).startswith("mine.toml:3:9: rock.young")
    assert "rock.colour" in {d.key for d in found}
    assert isinstance(caught.value, ValueError)
    scenario = kb.Scenario.load(TUNNEL)
    scenario["rock.young"] = -1.0
    with pytest.raises(kb.InputError, match="rock.young: found the number -1.0"):
        scenario.check()
    with pytest.raises(kb.InputError):
        scenario["a..b"] = 3
    with pytest.raises(kb.InputError):
        scenario["joint_set.J9.dip"] = 3
    with pytest.raises(kb.InputError):
        kb.Scenario.load("no/such.toml")
    with pytest.raises(kb.InputError):
        kb.Scenario.parse("[rock\n")


@pytest.mark.parametrize("value", [object(), b"bytes", {1, 2} and (x for x in [object()]), lambda: 3, 1j])
def test_values_that_are_none_are_refused(value: object) -> None:
    scenario = kb.Scenario()
    with pytest.raises(TypeError):
        scenario["rock.young"] = value


@pytest.mark.parametrize(
    "value",
    [0, -3, 1.5, 1e-300, 0.1, True, "", "a'b\"c\\d\n\t\x01\x7fé😀", [], [1, [2.5, "x"]], {"a b": 1, "c": {"d": [True]}}, np.arange(3), np.eye(2)],
)
def test_values_come_back(value: object) -> None:
    scenario = kb.Scenario()
    scenario["rock.young"] = value
    expected = value.tolist() if isinstance(value, np.ndarray) else value
    assert scenario["rock.young"] == expected
    assert kb.Scenario.parse(scenario.toml())["rock.young"] == expected


def test_unknown_keys_are_refused_at_once() -> None:
    scenario = kb.Scenario.load(TUNNEL)
    before = scenario.to_dict()
    for table, name, meant in [
        (scenario, "jointset", "joint_set"),
        (scenario.rock, "yung", "young"),
        (scenario.joints, "kn", "normal_stiffness"),
        (scenario.solver, "pennalty", "penalty"),
        (scenario.joint_set[0], "dipp", "dip"),
        (scenario.stage["first earthquake"], "scal", "scale"),
        (scenario.joint_set[0].spacing, "meen", "mean"),
        (scenario.motion[0].components[0], "azimut", "azimuth"),
    ]:
        with pytest.raises(AttributeError, match=f"no key '{name}'; did you mean '{meant}'"):
            setattr(table, name, 1)
        with pytest.raises(AttributeError, match=f"no key '{name}'; did you mean '{meant}'"):
            setattr(table, name, None)
        for change in (
            lambda: table.__setitem__(name, 1),
            lambda: table.setdefault(name, 1),
            lambda: table.update({name: 1}),
            lambda: table.update(**{name: 1}),
        ):
            with pytest.raises(kb.InputError, match=f"{name}: found an unknown key.*did you mean '{meant}'") as caught:
                change()
            assert caught.value.diagnostics[0].found == "an unknown key"
    for change in (
        lambda: scenario.__setitem__("rock", {"yung": 1}),
        lambda: scenario.__setitem__("rock.yung", 1),
        lambda: scenario["rock"].__setitem__("yung", 1),
        lambda: setattr(scenario, "rock", {"yung": 1}),
        lambda: scenario.joint_set.append(name="J9", dipp=3),
        lambda: scenario.joint_set.append(name="J9", spacing={"meen": 3}),
        lambda: scenario.joint_set.extend([{"name": "J9"}, {"name": "J8", "dipp": 3}]),
        lambda: scenario.joint_set.__setitem__(0, {"dipp": 3}),
        lambda: scenario.motion.append(name="m", x={"amplitud": 3}),
        lambda: kb.Scenario({"rock": {"density": 3, "yung": 1}}),
        lambda: kb.Scenario({"study": {"vary": [{"kee": "rock.young"}]}}),
    ):
        with pytest.raises(kb.InputError, match="an unknown key.*did you mean"):
            change()
    with pytest.raises(kb.InputError) as caught:
        scenario["rock"] = {"yung": 1, "densty": 2}
    assert [d.key for d in caught.value.diagnostics] == ["rock.yung", "rock.densty"]
    assert scenario.to_dict() == before


def test_known_keys_are_taken_everywhere() -> None:
    for file in sorted((ROOT / "examples").glob("*.toml")) + sorted((ROOT / "verification").glob("*.toml")):
        said = kb.Scenario.load(file).to_dict()
        try:
            kb.Scenario.load(file).check()
        except kb.InputError as error:
            if any(d.found == "an unknown key" for d in error.diagnostics):
                continue  # a case of the verification has keys of its own
        again = kb.Scenario(said)
        assert again.to_dict() == said
        for name, table in said.items():
            if isinstance(table, dict):
                again[name].update(table)
    scenario = kb.Scenario()
    scenario.rock.update(young=1e9, poisson=0.2)
    assert scenario.rock.setdefault("young", 3.0) == 1e9 and scenario.rock.setdefault("density", 2500.0) == 2500.0
    scenario.stage.append(name="open", kind="settle", release={"any name": 0.5})
    scenario.spring.append(from_=[0, 0], to=[1, 1], stiffness=1.0)
    scenario.spring[0].update(from_=[0, 1])
    assert scenario.spring[0].from_ == [0.0, 1.0]


def test_what_was_read_with_unknown_keys_is_kept() -> None:
    scenario = kb.Scenario.parse("[rock]\nyung = 3\n[[joint_set]]\nname = 'J'\ndipp = 3\n")
    scenario.rock.density = 2500.0
    scenario.joint_set.append(name="K")
    assert pickle.loads(pickle.dumps(scenario)).to_dict() == scenario.to_dict()
    assert scenario.rock.yung == 3
    scenario.rock.yung = None
    assert "yung" not in scenario.rock and pickle.loads(pickle.dumps(scenario)).to_dict() == scenario.to_dict()
    with pytest.raises(kb.InputError, match="unknown key"):
        scenario.check()


def test_blocks_are_those_of_the_program(tmp_path: Path) -> None:
    blocks = kb.Scenario.load(TUNNEL).cut(realization=2)
    keyblock("cut", TUNNEL, "-o", "cut", "--realization", "2", folder=tmp_path)
    import json

    there = json.loads((tmp_path / "cut/blocks.geojson").read_text())["features"]
    assert len(blocks) == len(there)
    for block, feature in zip(blocks, there, strict=True):
        ring = np.array(feature["geometry"]["coordinates"][0])[:-1]
        assert np.allclose(np.sort(ring, axis=0), np.sort(block.polygon, axis=0))
    assert blocks.areas.sum() == pytest.approx(400.0)
    assert {"J1", "J2", "J3", "tunnel", "domain"} >= {name for block in blocks for ring in block.edges for name in ring}
    assert "tunnel" in blocks.excavations


def test_key_blocks_are_those_of_the_program(tmp_path: Path) -> None:
    scenario = kb.Scenario.load(TUNNEL)
    census = scenario.census(realization=2, factor=2.0)
    keyblock("cut", TUNNEL, "-o", "cut", "--census", "--factor", "2", "--realization", "2", folder=tmp_path)
    import json

    there = json.loads((tmp_path / "cut/census.json").read_text())
    assert [block.block for block in census] == [block["block"] for block in there["blocks"]]
    assert census.layers == there["layers"] > 1
    assert (census.wall, census.wanted_factor, census.assumptions) == (there["wall_m"], 2.0, there["assumptions"])
    assert census.areas.sum() == pytest.approx(there["totals"]["moving_area_m2"])
    assert census.depths.max() == there["totals"]["deepest_m"]
    assert census.area_per_metre == pytest.approx(there["totals"]["area_m2_per_m"])
    blocks = scenario.cut(realization=2)
    for block, other in zip(census, there["blocks"], strict=True):
        assert block.area == blocks[block.block].area == other["area_m2"]
        assert (block.mode, block.force, list(block.joints)) == (other["mode"], other["force_n_m"], other["joints"])
        assert block.moves == (block.factor_of_safety < 1.0) == (other["layer"] is not None)
        assert np.isinf(block.factor_of_safety) == (other["factor_of_safety"] is None)
        assert block.centroid.shape == block.direction.shape == (2,)
    with pytest.raises(kb.InputError, match="at least 1"):
        scenario.census(factor=0.5)
    with pytest.raises(kb.InputError, match="gravity"):
        scenario.gravity = 0.0
        scenario.census()


def test_key_blocks_are_a_table() -> None:
    optional("pandas")
    table = kb.Scenario.load(TUNNEL).census().table()
    assert {"block", "mode", "factor_of_safety", "x", "y"} <= set(table.columns)
    assert (table[table.layer > 0].factor_of_safety < 1.0).all()


def test_blocks_are_drawn(tmp_path: Path) -> None:
    optional("matplotlib")
    axes = kb.Scenario.load(TUNNEL).cut().plot()
    assert axes.get_xlabel() == "x (m)"
    axes.figure.savefig(tmp_path / "blocks.png")


def trace(channel: str, data: list[float], delta: float = 0.01) -> types.SimpleNamespace:
    return types.SimpleNamespace(data=np.array(data), stats=types.SimpleNamespace(delta=delta, channel=channel))


def test_motions_of_traces() -> None:
    motion = kb.Motion.from_obspy(trace("HNE", [1.0, 2.0, 3.0]), trace("HNZ", [0.0, 1.0, 0.0]), section=90.0)
    assert np.allclose(motion.x, [1, 2, 3]) and np.allclose(motion.y, [0, 1, 0]) and motion.duration == pytest.approx(0.02)
    turned = kb.Motion.from_obspy(trace("HNN", [1.0, 2.0]), section=60.0, factor=2.0)
    assert np.allclose(turned.x, [1.0, 2.0])
    scenario = falling_block()
    motion.add_to(scenario, "pulse", at="base")
    scenario.stage.append(name="quake", kind="shake", motion="pulse")
    assert scenario.check() is not None
    assert scenario.motion["pulse"].x[1] == [0.01, 2.0]
    with pytest.raises(ValueError, match="azimuths"):
        kb.Motion.from_obspy(trace("HN1", [1.0, 2.0]), section=0.0)
    with pytest.raises(ValueError, match="time steps"):
        kb.Motion.from_obspy(trace("HNE", [1.0, 2.0]), trace("HNN", [1.0, 2.0], 0.02), section=0.0)
    with pytest.raises(ValueError, match="finite"):
        kb.Motion(0.01, [1.0, float("nan")])


def test_trace_maps_of_frames() -> None:
    class Line:
        geom_type = "LineString"

        def __init__(self, coords: list[tuple[float, float]]) -> None:
            self.coords = coords

    class Several:
        geom_type = "MultiLineString"
        geoms = [Line([(0, 0), (1, 1)]), Line([(2, 0), (3, 1)])]

    class Frame(dict):
        geometry = [Line([(0, 0), (1, 0), (2, 1)]), Several()]

        def __len__(self) -> int:
            return 2

    traces = kb.TraceMap.from_geodataframe(Frame(set=["a", "b"]), name="set")
    assert traces.names == ["a", "b", "b"] and traces.sets == ["a", "b"]
    scenario = falling_block()
    traces.add_to(scenario, friction=20)
    assert scenario.trace_map["b"].lines == [[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]]
    assert scenario.trace_map["a"].points == [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]]
    assert scenario.trace_map["a"].friction == 20
    with pytest.raises(ValueError, match="shape"):
        kb.TraceMap([[1, 2, 3]])
