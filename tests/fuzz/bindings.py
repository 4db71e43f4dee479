#!/usr/bin/env python3
"""Calls the Python module with what nobody would: wrong types and shapes, arrays kept after the run has gone, calls from within calls, threads.

    PYTHONPATH=build/release/python tests/fuzz/bindings.py [MINUTES] [--seed N]

An exception is right; the end of the interpreter is not. Each seed runs in a process of its own; one that dies is printed.
"""

import argparse
import gc
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def falling_block(kb, chance):
    scenario = kb.Scenario.parse(
        """
        rock = { density = 2500.0, young = 1e9, poisson = 0.2, order = %d }
        joints = { friction = 30.0 }
        time = { step = 0.002 }
        block = [ { name = "floor", outer = [[0, -1], [2, -1], [2, 0], [0, 0]], fixed = true },
                  { name = "stone", outer = [[0.5, 0.02], [1.5, 0.02], [1.5, 1.1], [0.5, 1.1]] } ]
        spring = [ { name = "rope", from = [1.0, 0.0], to = [1.0, 0.15], stiffness = 1e4 } ]
        load = [ { block = "stone", point = [1.0, 0.6], force = [1e3, 0.0] } ]
        stage = [ { name = "settled", kind = "settle" }, { name = "a", kind = "rest", duration = 0.05 }, { name = "b", kind = "rest", duration = 0.05 } ]
        """
        % chance.choice([1, 1, 2, 3])
    )
    return scenario


def anything(chance, depth=0):
    import numpy as np

    simple = [
        None, 0, 1, -1, 2**31, 2**63, -(2**64), 10**40, 0.5, float("nan"), float("inf"), -1e308, True, "", "J1", "joints", "rock.young", "a..b", "\0", "é😀" * 9,
        "x" * 10000, b"bytes", object(), len, type, (), [], {}, [1, [2, "x"]], {"a": {1: 2}}, range(3), np.zeros(0), np.zeros((2, 3)), np.array(3.0), np.arange(5, dtype=np.int8),
        np.array(["a"], dtype=object), np.zeros(4)[::2], memoryview(b"abc"), iter([1]), lambda *a, **k: None, Exception(), slice(1), ...,
    ]  # fmt: skip
    value = chance.choice(simple)
    return [value, anything(chance, depth + 1)] if depth < 3 and chance.random() < 0.05 else value


def poke(chance, things, kept):
    """One call, or one attribute, of something."""
    thing = chance.choice(things)
    if not (type(thing) if not isinstance(thing, type) else thing).__module__.startswith("keyblock"):
        return  # something else was put in its place
    names = [name for name in dir(thing) if not name.startswith("__") or name in ("__init__", "__class__", "__getitem__", "__setitem__", "__call__", "__len__")]
    if not names:
        return
    name = chance.choice(names)
    if name == "run" and chance.random() < 0.8:
        return
    value = getattr(thing, name)
    if callable(value) and chance.random() < 0.8:
        arguments = [anything(chance) if chance.random() < 0.7 else chance.choice(things + kept) for _ in range(chance.randint(0, 4))]
        if name in ("load", "_load", "save", "simulate", "run"):
            arguments = [argument for argument in arguments if not isinstance(argument, str)]
        value = value(*arguments)
    elif chance.random() < 0.3:
        setattr(thing, name, anything(chance))
    kept.append(value)
    del kept[:-30]


def weaken(chance, sim):
    """Strengths of contacts: right ones, and places that are none."""
    import numpy as np

    size = chance.randint(0, 4)
    places = [np.array([chance.choice([-1, 0, 1, 3, 4, 5, 7, 8, 2**31 - 1, -(2**31)]) for _ in range(size)], dtype=np.int32) for _ in range(2)]
    values = [chance.choice([None, np.full(size, chance.choice([0.0, 10.0, 89.9, 90.0, -1.0, float("nan"), float("inf"), 1e300]))]) for _ in range(3)]
    sim._core.set_contact_strengths(*places, *values)
    if chance.random() < 0.5:
        sim.contacts.set_strength(friction=chance.choice([5.0, anything(chance)]))
    if chance.random() < 0.3:
        sim._core.forget_contact_strengths(*places)


def one(seed):
    import numpy as np

    sys.path.insert(0, str(ROOT / "build/release/python"))
    import keyblock as kb

    core = sys.modules["keyblock._core"] if "keyblock._core" in sys.modules else __import__("keyblock._core")._core
    chance = random.Random(seed)
    kept = []

    def controller(sim):
        if chance.random() < 0.3:
            safely(lambda: poke(chance, [sim, sim._core], kept))
        if chance.random() < 0.02:
            raise ValueError("out of a step")

    def safely(call):
        try:
            call()
        except (Exception, KeyboardInterrupt):
            pass

    scenario = falling_block(kb, chance)
    sim = scenario.simulate(controllers=[controller] if chance.random() < 0.5 else [])
    views = [sim.vertices, sim.velocity, sim.contacts]
    things = [sim.blocks, sim.blocks[1], sim.springs, sim.strength["joints"], scenario.rock, scenario.stage, scenario.stage[0], scenario.load]
    things += [*sim.springs, scenario, sim, scenario._core, sim._core, core.Scenario, core.Simulation, core.Block, core.InputError, kb.Motion, kb.TraceMap, kb.Controller, *scenario._core.cut()]
    if chance.random() < 0.7:
        safely(lambda: sim.advance(chance.randint(1, 30)))
        safely(lambda: things.extend([sim.contacts, sim.contacts[:3], sim.contacts[sim.contacts.gap < 0.0], sim.contacts.of("")]))
    threads = []
    if chance.random() < 0.5:
        threads = [threading.Thread(target=lambda: [safely(lambda: poke(chance, [sim, sim._core], kept)) for _ in range(100)]) for _ in range(2)]
        for thread in threads:
            thread.start()
    for _ in range(200):
        safely(lambda: poke(chance, things, kept))
        if chance.random() < 0.2:
            safely(lambda: sim.advance(chance.randint(1, 5)))
        if chance.random() < 0.1:
            safely(lambda: weaken(chance, sim))
        if chance.random() < 0.05:
            safely(lambda: views[1].__setitem__(slice(None), chance.choice([0.0, 1e9, float("nan"), -1.0])))
    for thread in threads:
        thread.join()
    del things, sim, scenario
    gc.collect()
    assert all(isinstance(float(np.sum(view)), float) for view in views[:2])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("minutes", type=float, nargs="?", default=1.0)
    parser.add_argument("--seed", type=int)
    arguments = parser.parse_args()
    if arguments.seed is not None:
        one(arguments.seed)
        return 0
    end = time.monotonic() + 60.0 * arguments.minutes
    first = random.SystemRandom().randrange(10**9)
    count = died = 0
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() < end:
            done = subprocess.run([sys.executable, "-X", "faulthandler", __file__, "--seed", str(first + count)], cwd=folder, capture_output=True, text=True, timeout=300)
            count += 1
            if done.returncode < 0 or "Assertion" in done.stderr:
                died += 1
                print(f"seed {first + count - 1}: exit code {done.returncode}\n{done.stderr[-3000:]}", flush=True)
    print(f"{count} seeds, {died} of them broke the interpreter")
    return 1 if died else 0


if __name__ == "__main__":
    sys.exit(main())
