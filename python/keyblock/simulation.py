"""Runs step by step, and functions that steer them.

    @keyblock.controller(every=10)
    def weaken(sim):
        if sim.contacts.slip.max() > 5e-3:
            sim.strength["J1"].friction = 25.0

    scenario.run("out/weak", controllers=[weaken])

Units are SI, forces and energies per metre of thickness, coordinates local ones.
"""

from __future__ import annotations

import json
import logging
import os
import sys
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from . import _arguments as arguments
from ._compiled import core as _core
from ._sealed import Sealed
from .controllers import Controller as Controller
from .controllers import controller as controller
from .controllers import controllers_of
from .progress import Progress as _Shown
from .progress import words_of_run
from .scenario import Scenario, core_of
from .simulated_contacts import Contacts
from .steering import JointStrength, SimulatedBlocks, Springs, Strengths, read_only

Progress = _core.Progress

# Begins and ends of runs, and warnings of the input: `logging.basicConfig(level="INFO")` shows them.
_log = logging.getLogger("keyblock")
_log.addHandler(logging.NullHandler())


class Simulation(Sealed):
    """A run that is taken step by step. Between steps it can be looked at and changed; what changes it belongs in a controller where the
    run is to be resumed. Arrays stay valid as long as they are kept, also after the simulation has gone.

        with scenario.simulate() as sim:
            while not sim.done:
                sim.advance(100)
                print(sim.time, sim.energy["kinetic"])
    """

    def __init__(
        self,
        scenario: Scenario,
        folder: str | os.PathLike[str] | None = None,
        *,
        realization: int = 0,
        threads: int = 1,
        resume: bool = False,
        replace: bool = False,
        controllers: Sequence[Controller | Callable[[Simulation], Any]] = (),
    ) -> None:
        """`folder`: where results go, None: nowhere. `threads`: any number gives the same bits. `resume`: goes on from the checkpoint in
        the folder, with the same controllers. `replace`: results of other input there may go. Throws InputError, RunError."""
        self._blocks: SimulatedBlocks | None = None
        self._contacts: weakref.ref[Contacts] | None = None
        self._names: list[str] | None = None
        self._folder = "" if folder is None else arguments.path("folder", folder)
        self._controllers = controllers_of(controllers)
        self._core = _core.Simulation.begin(
            core_of(scenario),
            folder=self._folder,
            realization=arguments.count("realization", realization),
            threads=arguments.count("threads", threads),
            resume=arguments.flag("resume", resume),
            replace=arguments.flag("replace", replace),
            hooks=[(c.name, c.hash) for c in self._controllers],
        )
        for warning in self._core.warnings:
            _log.warning("%s", warning)
        _log.info("%s of %d blocks begins%s", "resumed run" if resume else "run", self._core.blocks, f" in {self._folder}" if self._folder else "")

    @classmethod
    def _of_study(cls, core: _core.Simulation, controllers: Sequence[Controller]) -> Simulation:
        """That of a run which a study takes step by step."""
        simulation = cls.__new__(cls)
        simulation._blocks = simulation._contacts = simulation._names = None
        simulation._folder, simulation._controllers, simulation._core = "", list(controllers), core
        return simulation

    # ── going on ──

    def advance(self, steps: int = 1) -> int:
        """Takes steps of the plan, over the ends of stages; returns how many, which are fewer at the end of the run. Throws RunError where
        the run cannot go on, and what a controller throws."""
        steps = arguments.whole("steps", steps, least=0)
        self._leave_contacts()
        return self._core.advance(steps, self._after_step if self._controllers else None, None)

    def advance_to(self, time: float) -> int:
        """Steps until the simulated time, s, is reached. Static steps take none."""
        time = arguments.number("time", time)
        if not time >= 0.0:
            raise ValueError(f"time: found {time}; expected seconds, at least 0")
        taken = 0
        while self.time < time and not self.done:
            taken += self.advance()
        return taken

    def run(self, progress: Callable[[Progress], Any] | bool | str | None = None) -> dict[str, Any]:
        """All that is left of the run; then finish(). `progress`: a function of a Progress; True for a bar in a notebook and a line elsewhere;
        "notebook" or "line" for one of them. Ctrl-C and exceptions of controllers end it in good order and come back."""
        self._leave_contacts()
        with _Shown(progress, words_of_run) as shown:
            try:
                self._core.advance(sys.maxsize, self._after_step if self._controllers else None, shown.call)
            except BaseException:
                self._end_after_failure()
                raise
        return self.finish()

    def finish(self) -> dict[str, Any]:
        """Ends the run where it is, writes what remains, and lets the folder go. Returns what summary.json has. Throws RunError, once all is
        written, where a whole run has errors of the computation; called again, it returns the summary all the same."""
        summary = json.loads(self._core.finish())
        _log.info("run ended after %d steps, %g s%s", summary["steps"], self._core.time, f", in {self._folder}" if self._folder else "")
        return summary

    def close(self) -> None:
        """Lets the folder go as it is: without finish(), it has what a killed run leaves, results and a checkpoint. The run can still be
        looked at, but goes on no more."""
        self._core.close()

    def stop(self) -> None:
        """The run ends within the step at hand. From any thread."""
        self._core.stop()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *error: object) -> None:
        if any(error):
            self._end_after_failure()
        else:
            self.finish()

    def _end_after_failure(self) -> None:
        """In good order as far as that goes; the first failure is the one to be told about."""
        try:
            self.stop()
            self.finish()
        except Exception:
            pass
        finally:
            self.close()

    def _after_step(self) -> None:
        step = self._core.step
        try:
            for each in self._controllers:
                if step % each.every == 0:
                    each(self)
        finally:
            self._leave_contacts()

    def _leave_contacts(self) -> None:
        """Contacts that somebody still has stay as they are when the simulation goes on."""
        contacts = None if self._contacts is None else self._contacts()
        self._contacts = None
        if contacts is not None:
            contacts._complete()

    # ── what it is like ──

    @property
    def done(self) -> bool:
        """There is nothing left to do."""
        return self._core.done

    @property
    def time(self) -> float:
        """s, simulated."""
        return self._core.time

    @property
    def step(self) -> int:
        """Steps of the run up to now."""
        return self._core.step

    @property
    def stage(self) -> str:
        """Name of the stage at hand, or of the last one."""
        names = self._core.stages
        return names[min(self._core.stage, len(names) - 1)]

    @property
    def stages(self) -> tuple[str, ...]:
        """Names of all stages."""
        return tuple(self._core.stages)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What seems odd in the input."""
        return tuple(self._core.warnings)

    @property
    def state_hash(self) -> str:
        """Of positions, velocities and memory of contacts: equal for equal bits."""
        return self._core.state_hash

    @property
    def blocks(self) -> SimulatedBlocks:
        """All blocks, by index or name, with their names, materials, stress; `len(sim.blocks)` of them. The frame, if any, is the last one."""
        if self._blocks is None:
            self._blocks = SimulatedBlocks(self, self._core.block_facts)
        return self._blocks

    @property
    def origin(self) -> np.ndarray:
        """(2,), m: real coordinates of (0, 0) of local ones. `sim.vertices + sim.origin` are real."""
        return read_only(np.array(self._core.origin))

    @property
    def vertices(self) -> np.ndarray:
        """(vertices, 2), m: where they are now; follows the steps. Read only. Local coordinates."""
        return self._core.vertices

    @property
    def first_vertex(self) -> np.ndarray:
        """(blocks + 1,): block b has the vertices first_vertex[b] … first_vertex[b + 1] − 1."""
        return read_only(self._core.first_vertex)

    @property
    def present(self) -> np.ndarray:
        """(blocks,): False once a block is excavated."""
        return read_only(self._core.present.astype(bool))

    @property
    def centroids(self) -> np.ndarray:
        """(blocks, 2), m: mass centres now; a copy. Local coordinates."""
        return read_only(self._core.centroids)

    @property
    def block_velocities(self) -> np.ndarray:
        """(blocks, 2), m/s, of mass centres; a copy."""
        return read_only(self._core.block_velocities)

    @property
    def velocity(self) -> np.ndarray:
        """(coefficients,), m/s: velocities of all coefficients of the displacement polynomials, docs/theory.md. Follows the steps. What is
        written here acts from the next step on: `sim.velocity[:] *= 0.5` is a brake."""
        return self._core.velocity

    @velocity.setter
    def velocity(self, values: np.ndarray) -> None:
        self._core.velocity = np.ascontiguousarray(arguments.array("velocity", values))

    @property
    def first_coefficient(self) -> np.ndarray:
        """(blocks,): where the coefficients of each block begin."""
        return read_only(self._core.first_coefficient)

    @property
    def contacts(self) -> Contacts:
        """After the last step; none before the first one. Only columns that are looked at are copied."""
        known = None if self._contacts is None else self._contacts()
        if known is not None and known._step == self._core.step:
            return known
        if self._names is None:
            self._names = self._core.joint_names
        contacts = Contacts(self._core, self._names)
        self._contacts = weakref.ref(contacts)
        return contacts

    @property
    def contact_strengths(self) -> Mapping[tuple[int, int], tuple[float | None, float | None, float | None]]:
        """Those that Contacts.set_strength has given: by vertex and edge, friction (degrees), cohesion and tension (Pa); None: that of the joint."""
        return MappingProxyType({(vertex, edge): (friction, cohesion, tension) for vertex, edge, friction, cohesion, tension in self._core.contact_strengths})

    @property
    def stress(self) -> np.ndarray:
        """(blocks, 3), Pa: mean xx, yy, xy of each block; tension positive; a copy."""
        return read_only(self._core.stress)

    @property
    def status(self) -> np.ndarray:
        """(blocks,): 0 in place, 1 loosened, 2 fallen, 3 excavated; a copy."""
        return read_only(self._core.status)

    @property
    def damage(self) -> Mapping[str, float]:
        """Measures of damage so far, by their names in summary.json: `sim.damage["fallen_area_m2"]`. Empty before the first excavation."""
        return MappingProxyType(self._core.damage)

    @property
    def ground_acceleration(self) -> np.ndarray:
        """(2,), m/s², of the ground now; zero outside of shaking stages."""
        return read_only(np.array(self._core.ground_acceleration))

    @property
    def energy(self) -> Mapping[str, float]:
        """J per metre thickness, by name; losses and inputs since the start."""
        return MappingProxyType(self._core.energy)

    # ── what can be changed ──

    @property
    def strength(self) -> Strengths:
        """By the name of a joint set or trace map, "joints" for all others, or "frame": `sim.strength["J1"].friction = 25`."""
        return Strengths(self._core)

    @property
    def springs(self) -> Springs:
        """The [[spring]]s, by place or name: `sim.springs["bolt 1"].force`; stiffness and force can be set."""
        return Springs(self._core)

    def apply_force(self, block: int | str, force: Any, point: Any = None, slot: int = 0) -> None:
        """A force on a block, (2,), N per metre thickness. It acts from the next step on until it is changed; another one of the same `slot` takes
        its place, and zero takes it away. `point`: where it acts, (2,), m, local coordinates, as the block lies now; None: its mass centre. It goes
        with the block without turning. Its work is in energy["input"], and it is in checkpoints."""
        where = None if point is None else arguments.pair("point", point, "x and y in m")
        along = arguments.pair("force", force, "along x and y in N per metre")
        pushed = self.blocks.index_of(block if isinstance(block, str) else arguments.whole("block", block, least=0))
        self._core.set_force(pushed, along, where, arguments.whole("slot", slot, least=0))

    @property
    def forces(self) -> tuple[tuple[int, int, tuple[float, float]], ...]:
        """Those that apply_force has put: block, slot, force."""
        return tuple((block, slot, (force[0], force[1])) for block, slot, force in self._core.forces)

    def set_load_factor(self, load: int, factor: float) -> None:
        """Factor on a load, by its place among [[load]], beside its own."""
        self._core.set_load_factor(arguments.whole("load", load, least=0), arguments.number("factor", factor))

    def set_motion_scale(self, factor: float) -> None:
        """Factor on ground motions, beside that of the stage. Throws InputError with a seismic boundary."""
        self._core.set_motion_scale(arguments.number("factor", factor))

    def __repr__(self) -> str:
        return f"<keyblock.Simulation, step {self.step}, {self.time:g} s, stage {self.stage!r}>"
