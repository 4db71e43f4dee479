"""Arrays go into scenarios at the cost of arrays, and what is read of a scenario cannot be changed by mistake."""

from __future__ import annotations

import pickle
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import BUILT, ROOT, optional

kb = optional("keyblock")
core = optional("keyblock._core")

ROCK = {"rock": {"density": 2500.0, "young": 1e10, "poisson": 0.2}, "joints": {"friction": 20.0}, "time": {"step": 0.005}}

# Each is a program of its own, so that the peak of memory is its own.
MOTION = """
motion = kb.Motion(0.005, np.random.default_rng(1).normal(size=60_000))
def work(): motion.add_to(scenario, "m")
"""
TRACES = """
points = np.random.default_rng(1).uniform(0, 100, (10_000, 2))
traces = kb.TraceMap([[p, p + [3.0, 1.0]] for p in points], names=[f"t{k}" for k in range(len(points))])
def work(): traces.add_to(scenario, friction=30.0)
"""
BLOCKS = """
blocks = [dict(name=f"b{k}", outer=[[k, 0.0], [k + 1.0, 0.0], [k + 1.0, 1.0], [k, 1.0]]) for k in range(5_000)]
def work():
    global scenario
    scenario = kb.Scenario({**rock, "block": blocks})
"""
APPENDED = """
rings = [[[k, 0.0], [k + 1.0, 0.0], [k + 1.0, 1.0], [k, 1.0]] for k in range(5_000)]
def work():
    for k, ring in enumerate(rings): scenario.block.append(name=f"b{k}", outer=ring)
"""
AS_TOML = """
toml = "[" + ", ".join(f"[{0.005 * k!r}, {0.001 * k!r}]" for k in range(20_000)) + "]"
def work(): scenario._core.set_toml("motion", "[{ name = 'm', x = " + toml + " }]")
"""


def measured(code: str) -> list[float]:
    """Times of work, of one value after it, of pickling and back, over that of a million additions in Python; MB that all that took."""
    program = f"""
import pickle, resource, time
import numpy as np, keyblock as kb
rock = {ROCK!r}
scenario = kb.Scenario(rock)
{code}
peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
before = peak()
seconds = []
def additions(): sum(k * k for k in range(1_000_000))
def timed(call):
    begin = time.process_time(); call(); seconds.append(time.process_time() - begin)
timed(work)
def one_value(): scenario.joints.friction = 30.0
timed(one_value)
def there_and_back(): assert pickle.loads(pickle.dumps(scenario)).to_dict() == scenario.to_dict()
timed(there_and_back)
used = peak() - before
timed(additions)
print(*(s / seconds[-1] for s in seconds[:-1]), used)
"""
    done = subprocess.run([sys.executable, "-c", program], env={"PYTHONPATH": str(BUILT), "PATH": ""}, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return [float(word) for word in done.stdout.split()]


@pytest.mark.parametrize("code", [MOTION, TRACES, BLOCKS, APPENDED, AS_TOML], ids=["motion", "traces", "blocks", "appended", "toml"])
def test_arrays_cost_what_arrays_cost(code: str) -> None:
    work, one_value, pickled, memory = measured(code)
    # What is done per item again and again takes hundreds of times as much.
    assert work < 60.0 and one_value < 0.2 and pickled < 60.0 and memory < 200.0


def test_long_records_run_and_are_the_same_bits_as_text(tmp_path: Path) -> None:
    samples = 0.5 * np.sin(0.02 * np.arange(2_000))
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    kb.Motion(0.005, samples).add_to(scenario, "m")
    scenario.stage.append(name="shaken", kind="shake", motion="m", duration=0.1)
    text = kb.Scenario.parse(scenario.toml(), scenario.file)
    assert scenario.run()["state_hash"] == text.run()["state_hash"] == pickle.loads(pickle.dumps(scenario)).run()["state_hash"]


def test_what_is_read_is_not_edited_by_mistake() -> None:
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    scenario.gravity = [0.0, -9.81]
    with pytest.raises(TypeError, match="set the whole list"):
        scenario.gravity[1] = -1.62
    with pytest.raises(TypeError, match="set the whole list"):
        scenario.block[0].outer.append([1.0, 1.0])
    with pytest.raises(TypeError, match="set the whole list"):
        scenario.block[0].outer[0][0] = 3.0
    assert scenario.gravity == [0.0, -9.81] and pickle.loads(pickle.dumps(scenario.gravity)) == [0.0, -9.81]
    scenario["rock"]["young"] = 3e9
    assert scenario.rock.young == 3e9
    scenario.to_dict()["rock"]["young"] = 1.0
    assert scenario.rock.young == 3e9


def test_keys_are_listed_unset_and_have_defaults() -> None:
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    assert "young" in scenario.rock and "rock" in scenario and "colour" not in scenario.rock
    assert list(scenario)[:2] == scenario.keys()[:2] and set(scenario.rock) >= {"density", "young"}
    assert dict(scenario.rock.items())["young"] == scenario.rock.young and {**scenario.rock} == scenario.rock.to_dict()
    assert scenario.gravity == [0.0, -9.81] and "gravity" not in scenario
    assert scenario.joints.cohesion == 0.0 and scenario.joints.default("cohesion") == 0.0
    with pytest.raises(AttributeError, match="default"):
        del scenario.rock.young
        scenario.rock.young
    assert "young" not in scenario.rock
    scenario.joints.cohesion = 1e4
    scenario.joints.cohesion = None
    assert "cohesion" not in scenario.joints
    stages = len(scenario.stage)
    scenario.stage.append(name="more", kind="rest", duration=1.0)
    assert "more" in scenario.stage and scenario.stage.names[-1] == "more"
    del scenario.stage["more"]
    assert len(scenario.stage) == stages and "more" not in scenario.stage
    del scenario["joints"]
    assert "joints" not in scenario
    assert {"rock", "stage", "check", "joint_set"} <= set(dir(scenario)) and "poisson" in dir(scenario.rock)
    with pytest.raises(AttributeError, match="did you mean 'rock'"):
        scenario.rcok.young = 3e9
    with pytest.raises(AttributeError, match="did you mean 'friction'"):
        scenario.joints.frictoin  # noqa: B018
    with pytest.raises(KeyError, match="no element named 'mor'"):
        scenario.stage["mor"]


def test_loads_are_reached() -> None:
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    name = next(name for name in scenario.block.names if name and not scenario.block[name].get("fixed"))
    scenario.load.append(block=name, point=[1.5, 5.4], force=[1e3, 0.0])
    assert len(scenario.load) == 1 and scenario.load[0].force == [1e3, 0.0]
    scenario.load[0].from_ = 0.5
    assert scenario.load[0].to_dict()["from"] == 0.5
    scenario.spring.append(from_=[0.0, 0.0], to=[1.0, 1.0])
    assert scenario.spring[0]["from"] == [0.0, 0.0]
    del scenario.spring[0], scenario.load[0]
    assert len(scenario.load) == 0


def test_saved_paths_count_from_the_new_file(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir(), (tmp_path / "b").mkdir()
    (tmp_path / "a/record.csv").write_text("time (s),acceleration (m/s2)\n" + "".join(f"{0.01 * k},{0.1 * (k % 3)}\n" for k in range(50)))
    scenario = kb.Scenario.load(ROOT / "examples/03-block-on-incline.toml")
    text = scenario.toml() + '\n[[motion]]\nname = "m"\nx = { file = "record.csv" }\n[[stage]]\nname = "s"\nkind = "shake"\nmotion = "m"\nduration = 0.02\n'
    (tmp_path / "a/s.toml").write_text(text)
    first = kb.Scenario.load(tmp_path / "a/s.toml")
    first.check()
    first.save(tmp_path / "b/s.toml")
    second = kb.Scenario.load(tmp_path / "b/s.toml")
    second.check()
    assert second.motion["m"].x.file == "../a/record.csv"


def test_only_real_numbers_are_accelerations() -> None:
    for wrong in (np.ones(5) * 1j, [True, False], ["1", "2"]):
        with pytest.raises(kb.DataError, match="real numbers"):
            kb.Motion(0.01, wrong)
