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

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._compiled import core as _core
from ._toml import key_text, to_toml
from .cut import CutBlocks

if TYPE_CHECKING:
    from .simulation import Controller, Simulation

_LISTS = frozenset(
    "joint_set trace_map region block excavation load support spring motion stage history".split()
)


class Scenario:
    """A scenario: its text, and the values that were set. docs/scenario.md has the keys. Nothing but the syntax is checked before
    check(), cut() or run()."""

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """An empty scenario, or one from nested mappings and lists as `tomllib.load` gives them. Relative paths count from the folder in
        which Python runs."""
        object.__setattr__(self, "_core", _core.Scenario.empty())
        for key, value in (values or {}).items():
            self[key_text(key)] = value

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Scenario:
        """From a file. Throws InputError when there is none, or when it is no TOML."""
        return cls._of(_core.Scenario.load(os.fspath(file)))

    @classmethod
    def parse(cls, text: str, file: str | os.PathLike[str] = "scenario.toml") -> Scenario:
        """From text. `file` stands in messages; paths in the scenario count from its folder."""
        return cls._of(_core.Scenario.parse(text, os.fspath(file)))

    @classmethod
    def _of(cls, core: _core.Scenario) -> Scenario:
        scenario = cls()
        object.__setattr__(scenario, "_core", core)
        return scenario

    def copy(self) -> Scenario:
        """Another scenario, the same as this one."""
        return self._of(self._core.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Scenario:
        return self.copy()

    def __getstate__(self) -> dict[str, Any]:
        return {"text": self.text, "file": self.file, "changes": self._core.changes, "made": self._core.is_made}

    def __setstate__(self, state: dict[str, Any]) -> None:
        core = _core.Scenario.empty() if state["made"] else _core.Scenario.parse(state["text"], state["file"])
        for change in state["changes"]:
            core.set(*_split(change))
        object.__setattr__(self, "_core", core)

    # ── values ──

    def __setitem__(self, key: str, value: Any) -> None:
        """Puts a value in the place of the text's. Throws InputError where the path leads nowhere."""
        self._core.set(key, to_toml(value))

    def __getitem__(self, key: str) -> Any:
        """What the scenario says; KeyError where it says nothing. Defaults of the program are in docs/scenario.md."""
        found = self._core.json(key)
        if not found:
            raise KeyError(key)
        return json.loads(found)

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and bool(self._core.json(key))

    def get(self, key: str, default: Any = None) -> Any:
        """As `scenario[key]`, or `default`."""
        return self[key] if key in self else default

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return _part(self, name)

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def to_dict(self) -> dict[str, Any]:
        """All that the scenario says, as nested dictionaries and lists."""
        return json.loads(self._core.json())

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
        """Writes toml(). Paths in the scenario then count from the folder of the file."""
        with open(file, "w", encoding="utf-8") as out:
            out.write(self.toml())

    def __repr__(self) -> str:
        changed = len(self._core.changes)
        return f"<keyblock.Scenario {self.get('title') or self.file!r}, {changed} value{'' if changed == 1 else 's'} set>"

    # ── what can be done with it ──

    def check(self, realization: int = 0) -> list[str]:
        """Warnings, [] where there are none. Throws InputError; its `diagnostics` are all mistakes, with file, line, column and key."""
        return self._core.check(realization)

    def cut(self, realization: int = 0) -> CutBlocks:
        """The blocks of one of the rock masses that the joint statistics and the seed stand for."""
        return CutBlocks(self._core.cut(realization))

    def simulate(self, folder: str | os.PathLike[str] | None = None, **options: Any) -> Simulation:
        """A run to be taken step by step; the options are those of Simulation."""
        from .simulation import Simulation

        return Simulation(self, folder, **options)

    def run(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        controllers: Sequence[Controller] = (),
        progress: Any = None,
        **options: Any,
    ) -> dict[str, Any]:
        """All stages, as `keyblock run` does. Returns what summary.json has. `controllers` are called after steps, see
        keyblock.controller; `progress` is a function of a Progress; True for a bar in a notebook and a line elsewhere; "notebook" or "line"
        for one of them. Ctrl-C ends the run in good order: what was computed is kept, and `resume=True` goes on."""
        from .simulation import Simulation

        simulation = Simulation(self, folder, controllers=controllers, **options)
        return simulation.run(progress=progress)


def _split(change: str) -> tuple[str, str]:
    quote = ""
    for place, letter in enumerate(change):
        if not quote and letter == "=":
            return change[:place], change[place + 1 :]
        if not quote and letter in "'\"":
            quote = letter
        elif letter == quote:
            quote = ""
    raise ValueError(change)


def _part(scenario: Scenario, path: str) -> Any:
    """A value, or a handle of a table or list that is or may be there."""
    value = scenario.get(path)
    if isinstance(value, list) and (not value or isinstance(value[0], dict)) or (value is None and path in _LISTS):
        return Tables(scenario, path)
    if value is None or isinstance(value, dict):
        return Table(scenario, path)
    return value


class Table:
    """A table of a scenario: its keys as attributes, `scenario.rock.young = 4e9`."""

    def __init__(self, scenario: Scenario, path: str) -> None:
        object.__setattr__(self, "_scenario", scenario)
        object.__setattr__(self, "_path", path)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        path = f"{self._path}.{key_text(name)}"
        value = self._scenario.get(path)
        if value is None:
            raise AttributeError(f"the scenario says nothing of {path}")
        return _part(self._scenario, path)

    def __setattr__(self, name: str, value: Any) -> None:
        self._scenario[f"{self._path}.{key_text(name)}"] = value

    __getitem__ = __getattr__
    __setitem__ = __setattr__

    def to_dict(self) -> dict[str, Any]:
        """What the scenario says in it."""
        return self._scenario.get(self._path, {})

    def __bool__(self) -> bool:
        return bool(self.to_dict())

    def __repr__(self) -> str:
        return f"<{self._path} {self.to_dict()}>"


class Tables:
    """A list of tables of a scenario: `scenario.stage[0].scale`, `scenario.stage["first earthquake"].scale`."""

    def __init__(self, scenario: Scenario, path: str) -> None:
        self._scenario = scenario
        self._path = path

    def _items(self) -> list[dict[str, Any]]:
        return self._scenario.get(self._path, [])

    def __len__(self) -> int:
        return len(self._items())

    def __iter__(self) -> Iterator[Table]:
        return (self[k] for k in range(len(self)))

    def __getitem__(self, which: int | str) -> Table:
        items = self._items()
        if isinstance(which, str):
            places = [k for k, item in enumerate(items) if item.get("name") == which]
            if not places:
                raise KeyError(f"{self._path} has no element named {which!r}")
            which = places[0]
        if which < 0:
            which += len(items)
        if not 0 <= which < len(items):
            raise IndexError(f"{self._path} has {len(items)} elements")
        return Table(self._scenario, f"{self._path}[{which}]")

    def append(self, **values: Any) -> Table:
        """Another element at the end; `values` that are None are left out."""
        self._scenario._core.append(self._path, to_toml(values))
        return self[-1]

    def __repr__(self) -> str:
        return f"<{len(self)} × {self._path}>"
