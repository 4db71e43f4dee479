"""Scenarios: read, made from scratch, changed, checked, cut and run.

    scenario = keyblock.Scenario.load("tunnel.toml")
    scenario["rock.young"] = 4e9                       # key paths as for --set
    scenario.rock.density = 2300                       # the same, as attributes
    scenario.joint_set.append(name="J4", dip=60, dip_direction=200, spacing=0.5, length=2.0, gap=0.2)
    scenario.check()                                   # warnings; InputError with all mistakes
    blocks = scenario.cut(realization=7)
    summary = scenario.run("out/7", realization=7)

Units are SI, coordinates real ones.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

from . import _arguments as arguments
from ._compiled import core as _core
from .census import Census
from .cut import CutBlocks
from .scenario_tables import Keys, Tables, key_text

if TYPE_CHECKING:
    from .simulation import Controller, Simulation


class _LoadOrLoads:
    """`Scenario.load(file)` reads a file; `scenario.load` are the elements of [[load]]."""

    @overload
    def __get__(self, scenario: None, owner: type[Scenario]) -> Callable[[str | os.PathLike[str]], Scenario]: ...
    @overload
    def __get__(self, scenario: Scenario, owner: type[Scenario]) -> Tables: ...
    def __get__(self, scenario: Scenario | None, owner: type[Scenario]) -> Any:
        return owner._load if scenario is None else Tables(scenario, "load")


class Scenario(Keys):
    """A scenario: its text, and the values that were set. docs/scenario.md has the keys. Keys that are set must be known; nothing else but
    the syntax is checked before check(), cut() or run()."""

    load = _LoadOrLoads()

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """An empty scenario, or one from nested mappings and lists as `tomllib.load` gives them. Relative paths count from the folder in
        which Python runs."""
        self._become(_core.Scenario.empty())
        for key, value in arguments.table("values", {} if values is None else values).items():
            self[key_text(arguments.text("key", key))] = value

    _path = ""

    @property
    def _scenario(self) -> Scenario:  # type: ignore[override]
        return self

    def _become(self, core: _core.Scenario) -> None:
        object.__setattr__(self, "_core", core)

    @classmethod
    def _load(cls, file: str | os.PathLike[str]) -> Scenario:
        """From a file. Throws InputError when there is none, or when it is no TOML."""
        return cls._of(_core.Scenario.load(arguments.path("file", file)))

    @classmethod
    def parse(cls, text: str, file: str | os.PathLike[str] = "scenario.toml") -> Scenario:
        """From text. `file` stands in messages; paths in the scenario count from its folder."""
        return cls._of(_core.Scenario.parse(arguments.text("text", text), arguments.path("file", file)))

    @classmethod
    def _of(cls, core: _core.Scenario) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._become(core)
        return scenario

    def copy(self) -> Scenario:
        """Another scenario, the same as this one."""
        return self._of(self._core.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Scenario:
        return self.copy()

    def __getstate__(self) -> dict[str, Any]:
        if self._core.is_made:
            return {"file": self.file, "values": self._core.value()}
        return {"text": self.text, "file": self.file, "changes": self._core.values_set}

    def __setstate__(self, state: dict[str, Any]) -> None:
        if "values" in state:
            core = _core.Scenario.made({key_text(key): value for key, value in state["values"].items()}, state["file"])
        else:
            core = _core.Scenario.parse(state["text"], state["file"])
            for key, value in state["changes"]:
                core.restore(key, value)
        self._become(core)

    # ── values ──

    def to_dict(self) -> dict[str, Any]:
        """All that the scenario says, as nested dictionaries and lists; copies."""
        return self._core.value()

    @property
    def text(self) -> str:
        """As it was read; made of what was set where the scenario began empty."""
        return self._core.text

    @property
    def file(self) -> str:
        """Its name in messages; paths in the scenario count from its folder."""
        return os.fspath(self._core.file)

    def toml(self) -> str:
        """The whole scenario as TOML, with what was set in its place, without comments."""
        return self._core.toml()

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes it. Relative paths of motions and trace maps are rewritten, as they count from the folder of the new file."""
        self._core.save(arguments.path("file", file))

    def __repr__(self) -> str:
        changed = len(self._core.values_set)
        return f"<keyblock.Scenario {self.get('title') or self.file!r}, {changed} value{'' if changed == 1 else 's'} set>"

    # ── what can be done with it ──

    def check(self, realization: int = 0) -> list[str]:
        """Warnings, [] where there are none. Throws InputError; its `diagnostics` are all mistakes, with file, line, column and key."""
        return self._core.check(arguments.count("realization", realization))

    def cut(self, realization: int = 0) -> CutBlocks:
        """The blocks of one of the rock masses that the joint statistics and the seed stand for."""
        return CutBlocks(self._core.cut(arguments.count("realization", realization)))

    def census(self, realization: int = 0, factor: float = 1.5) -> Census:
        """The key blocks of one of the rock masses: what falls or slides into the openings by limit equilibrium, without a run. `factor`:
        of safety, at least 1, that the forces of the blocks are for. Throws InputError where no rock has a free face."""
        return Census(self._core.census(arguments.count("realization", realization), arguments.number("factor", factor)))

    def simulate(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        realization: int = 0,
        threads: int = 1,
        resume: bool = False,
        replace: bool = False,
        controllers: Sequence[Controller | Callable[[Simulation], Any]] = (),
    ) -> Simulation:
        """A run to be taken step by step; the options are those of Simulation."""
        from .simulation import Simulation

        return Simulation(self, folder, realization=realization, threads=threads, resume=resume, replace=replace, controllers=controllers)

    def run(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        realization: int = 0,
        threads: int = 1,
        resume: bool = False,
        replace: bool = False,
        controllers: Sequence[Controller | Callable[[Simulation], Any]] = (),
        progress: Any = None,
    ) -> dict[str, Any]:
        """All stages, as `keyblock run` does. Returns what summary.json has. `controllers` are called after steps, see
        keyblock.controller; `progress` is a function of a Progress; True for a bar in a notebook and a line elsewhere; "notebook" or "line"
        for one of them. Ctrl-C ends the run in good order: what was computed is kept, and `resume=True` goes on."""
        simulation = self.simulate(
            folder, realization=realization, threads=threads, resume=resume, replace=replace, controllers=controllers
        )
        return simulation.run(progress=progress)


def core_of(scenario: Scenario) -> _core.Scenario:
    """What the compiled module works on."""
    if not isinstance(scenario, Scenario):
        raise TypeError(f"scenario: found {type(scenario).__name__}; expected a keyblock.Scenario, as Scenario.load(file) gives it")
    return scenario._core
