"""Runs step by step, and functions that steer them.

    @keyblock.controller(every=10)
    def weaken(sim):
        if sim.contacts.slip.max() > 5e-3:
            sim.strength["J1"].friction = 25.0

    scenario.run("out/weak", controllers=[weaken])

Units are SI, forces and energies per metre of thickness, coordinates local ones.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ._compiled import core as _core
from .progress import Progress as _Shown
from .progress import words_of_run
from .record import did_you_mean

if TYPE_CHECKING:
    from .scenario import Scenario

Progress = _core.Progress


class Controller:
    """A function that is called with the Simulation after every `every`-th step. It looks at the run and changes what acts from the next
    step on. What it has to remember between steps must follow from the simulation, or a resumed run goes another way."""

    def __init__(self, function: Callable[[Simulation], Any], every: int = 1, name: str | None = None) -> None:
        if not callable(function):
            raise TypeError("a controller is a function of a Simulation")
        if every < 1:
            raise ValueError("every: at least 1")
        self.function = function
        self.every = int(every)
        self.name = name or _name_of(function)
        self.hash = hashlib.sha256(f"{_source_of(function)}\n{self.every}".encode()).hexdigest()[:16]

    def __call__(self, simulation: Simulation) -> Any:
        return self.function(simulation)

    def __repr__(self) -> str:
        return f"<keyblock.Controller {self.name}, every {self.every} steps, {self.hash}>"


def controller(function: Callable[[Simulation], Any] | None = None, *, every: int = 1, name: str | None = None) -> Any:
    """Makes a Controller of a function: `@keyblock.controller(every=10)`. summary.json names it with the hash of its text."""
    if function is not None:
        return Controller(function, every, name)
    return lambda f: Controller(f, every, name)


def _name_of(function: Callable[..., Any]) -> str:
    place = os.path.basename(inspect.getsourcefile(function) or "") if inspect.isroutine(function) else ""
    return f"{place}:{getattr(function, '__qualname__', type(function).__name__)}".lstrip(":")


def _source_of(function: Callable[..., Any]) -> str:
    of = function if inspect.isroutine(function) else type(function)
    try:
        return inspect.getsource(of)
    except (OSError, TypeError):  # typed at a prompt
        code = getattr(of, "__code__", None)
        return repr(of) if code is None else f"{code.co_code.hex()} {code.co_consts!r} {code.co_names!r}"


@dataclass(frozen=True)
class Contacts:
    """Contacts after a step: copies, one element each. Forces in N per metre thickness, lengths in m."""

    block_a: np.ndarray  #: the block with the vertex
    block_b: np.ndarray  #: the block with the edge
    state: np.ndarray  #: 0 open, 1 sliding, 2 locked
    position: np.ndarray  #: (n, 2)
    normal: np.ndarray  #: (n, 2), unit vectors out of block_b
    length: np.ndarray
    gap: np.ndarray  #: negative where the contact is pressed
    slip: np.ndarray  #: since the excavation: the magnitude
    shear_displacement: np.ndarray  #: the same with its sign: of block_a along (−normal y, normal x)
    normal_force: np.ndarray  #: compression positive
    shear_force: np.ndarray
    joint_code: np.ndarray  #: place in `joint_names`
    joint_names: list[str]  #: of joint sets, trace maps and excavations; "domain"; "" for edges of blocks of the scenario

    @property
    def joint(self) -> np.ndarray:
        """What each contact's edge is a piece of, by name."""
        return np.array(self.joint_names, dtype=object)[self.joint_code]

    def __len__(self) -> int:
        return len(self.block_a)

    def of(self, joint: str) -> Contacts:
        """Those of one joint set, trace map or excavation."""
        if joint not in self.joint_names:
            raise KeyError(f"no joint set {joint!r}{did_you_mean(joint, [name for name in self.joint_names if name])}")
        codes = [code for code, name in enumerate(self.joint_names) if name == joint]
        chosen = np.isin(self.joint_code, codes)
        columns = {field.name: getattr(self, field.name) for field in fields(self)}
        return Contacts(**{name: column if name == "joint_names" else column[chosen] for name, column in columns.items()})


class JointStrength:
    """Friction (degrees), cohesion and tension (Pa) of joints, to be read and set. Bonds that have broken stay broken."""

    def __init__(self, core: _core.Simulation, joint: str) -> None:
        self._core, self._joint = core, joint

    def _get(self) -> tuple[float, float, float]:
        return self._core.strength(self._joint)

    def _set(self, place: int, value: float) -> None:
        values = list(self._get())
        values[place] = float(value)
        self._core.set_strength(self._joint, *values)

    friction = property(lambda self: self._get()[0], lambda self, value: self._set(0, value))
    cohesion = property(lambda self: self._get()[1], lambda self, value: self._set(1, value))
    tension = property(lambda self: self._get()[2], lambda self, value: self._set(2, value))

    def __repr__(self) -> str:
        friction, cohesion, tension = self._get()
        return f"<{self._joint}: friction {friction:g}°, cohesion {cohesion:g} Pa, tension {tension:g} Pa>"


class _Strengths:
    def __init__(self, core: _core.Simulation) -> None:
        self._core = core

    def __getitem__(self, joint: str) -> JointStrength:
        strength = JointStrength(self._core, joint)
        strength._get()  # an unknown name is refused here
        return strength


class Simulation:
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
        self._controllers = [c if isinstance(c, Controller) else Controller(c) for c in controllers]
        self._core = _core.Simulation.begin(
            scenario._core,
            folder="" if folder is None else os.fspath(folder),
            realization=realization,
            threads=threads,
            resume=resume,
            replace=replace,
            hooks=[(c.name, c.hash) for c in self._controllers],
        )

    # ── going on ──

    def advance(self, steps: int = 1) -> int:
        """Takes steps of the plan, over the ends of stages; returns how many, which are fewer at the end of the run. Throws RunError where
        the run cannot go on, and what a controller throws."""
        return self._core.advance(steps, self._after_step if self._controllers else None, None)

    def advance_to(self, time: float) -> int:
        """Steps until the simulated time, s, is reached. Static steps take none."""
        taken = 0
        while self.time < time and not self.done:
            taken += self.advance()
        return taken

    def run(self, progress: Callable[[Progress], Any] | bool | str | None = None) -> dict[str, Any]:
        """All that is left of the run; then finish(). `progress`: a function of a Progress; True for a bar in a notebook and a line elsewhere;
        "notebook" or "line" for one of them. Ctrl-C and exceptions of controllers end it in good order and come back."""
        with _Shown(progress, words_of_run) as shown:
            try:
                self._core.advance(sys.maxsize, self._after_step if self._controllers else None, shown.call)
            except BaseException:
                self._end_after_failure()
                raise
        return self.finish()

    def finish(self) -> dict[str, Any]:
        """Ends the run where it is, writes what remains, and lets the folder go. Returns what summary.json has."""
        return json.loads(self._core.finish())

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
        for each in self._controllers:
            if step % each.every == 0:
                each(self)

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
    def stages(self) -> list[str]:
        """Names of all stages."""
        return self._core.stages

    @property
    def warnings(self) -> list[str]:
        """What seems odd in the input."""
        return self._core.warnings

    @property
    def state_hash(self) -> str:
        """Of positions, velocities and memory of contacts: equal for equal bits."""
        return self._core.state_hash

    @property
    def blocks(self) -> int:
        """How many there are. The frame, if any, is the last one."""
        return self._core.blocks

    @property
    def vertices(self) -> np.ndarray:
        """(vertices, 2), m: where they are now; follows the steps. Read only. Local coordinates."""
        return self._core.vertices

    @property
    def first_vertex(self) -> np.ndarray:
        """(blocks + 1,): block b has the vertices first_vertex[b] … first_vertex[b + 1] − 1."""
        return self._core.first_vertex

    @property
    def present(self) -> np.ndarray:
        """(blocks,): False once a block is excavated."""
        return self._core.present.astype(bool)

    @property
    def centroids(self) -> np.ndarray:
        """(blocks, 2), m: mass centres now; a copy. Local coordinates."""
        return self._core.centroids

    @property
    def block_velocities(self) -> np.ndarray:
        """(blocks, 2), m/s, of mass centres; a copy."""
        return self._core.block_velocities

    @property
    def velocity(self) -> np.ndarray:
        """(coefficients,), m/s: velocities of all coefficients of the displacement polynomials, docs/theory.md. Follows the steps. What is
        written here acts from the next step on: `sim.velocity[:] *= 0.5` is a brake."""
        return self._core.velocity

    @velocity.setter
    def velocity(self, values: np.ndarray) -> None:
        self._core.velocity = np.ascontiguousarray(values, dtype=float)

    @property
    def first_coefficient(self) -> np.ndarray:
        """(blocks,): where the coefficients of each block begin."""
        return self._core.first_coefficient

    @property
    def contacts(self) -> Contacts:
        """After the last step; none before the first one."""
        return Contacts(**self._core.contacts)

    @property
    def energy(self) -> dict[str, float]:
        """J per metre thickness, by name; losses and inputs since the start."""
        return self._core.energy

    # ── what can be changed ──

    @property
    def strength(self) -> _Strengths:
        """By the name of a joint set or trace map, "joints" for all others, or "frame": `sim.strength["J1"].friction = 25`."""
        return _Strengths(self._core)

    def set_load_factor(self, load: int, factor: float) -> None:
        """Factor on a load, by its place among [[load]], beside its own."""
        self._core.set_load_factor(load, factor)

    def set_motion_scale(self, factor: float) -> None:
        """Factor on ground motions, beside that of the stage. Throws InputError with a seismic boundary."""
        self._core.set_motion_scale(factor)

    def __repr__(self) -> str:
        return f"<keyblock.Simulation, step {self.step}, {self.time:g} s, stage {self.stage!r}>"
