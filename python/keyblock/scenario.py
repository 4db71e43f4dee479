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
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

from ._compiled import core as _core
from .cut import CutBlocks
from .record import did_you_mean

if TYPE_CHECKING:
    from .simulation import Controller, Simulation

_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def key_text(key: str) -> str:
    """One key of a path or a table, in quotes where it needs them."""
    # A JSON string is a TOML string, except for one character that JSON leaves as it is.
    return key if key and set(key) <= _BARE else json.dumps(key, ensure_ascii=False).replace("\x7f", "\\u007f")


def _joined(path: str, name: str) -> str:
    return f"{path}.{key_text(name)}" if path else key_text(name)


class Values(list[Any]):
    """A list as a scenario says it, to be read. What is changed here would not change the scenario, so that it is refused."""

    def _refuse(self, *_: Any, **__: Any) -> Any:
        raise TypeError("a list that was read from a scenario does not change it; set the whole list: scenario.gravity = [0.0, -1.62]")

    __setitem__ = __delitem__ = __iadd__ = __imul__ = _refuse  # type: ignore[assignment]
    append = extend = insert = remove = pop = clear = sort = reverse = _refuse  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return list, (list(self),)


def _read_only(value: Any) -> Any:
    if isinstance(value, list):
        return Values(map(_read_only, value)) if value and isinstance(value[0], list) else Values(value)
    return value


class _LoadOrLoads:
    """`Scenario.load(file)` reads a file; `scenario.load` are the elements of [[load]]."""

    @overload
    def __get__(self, scenario: None, owner: type[Scenario]) -> Callable[[str | os.PathLike[str]], Scenario]: ...
    @overload
    def __get__(self, scenario: Scenario, owner: type[Scenario]) -> Tables: ...
    def __get__(self, scenario: Scenario | None, owner: type[Scenario]) -> Any:
        return owner._load if scenario is None else Tables(scenario, "load")


class _Keys:
    """What scenarios and their tables have in common: keys as items and as attributes. Keys that are not set have the program's default as
    an attribute; `in`, `get` and iteration go by what the scenario says."""

    if TYPE_CHECKING:
        _scenario: Scenario
        _path: str

    def __getitem__(self, key: str) -> Any:
        """What the scenario says; KeyError where it says nothing. Lists of numbers can be read only."""
        path = self._path_of(key)
        if not self._scenario._core.has(path):
            raise KeyError(key)
        return _part(self._scenario, path)

    def __setitem__(self, key: str, value: Any) -> None:
        """Puts a value in the place of the text's; None takes the key out. Throws InputError where the path leads nowhere."""
        path = self._path_of(key)
        if value is not None:
            self._scenario._core.set(path, value)
        elif self._scenario._core.has(path):
            self._scenario._core.remove(path)

    def __delitem__(self, key: str) -> None:
        path = self._path_of(key)
        if not self._scenario._core.has(path):
            raise KeyError(key)
        self._scenario._core.remove(path)

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and self._scenario._core.has(self._path_of(key))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def keys(self) -> list[str]:
        """Keys that the scenario says, in its order."""
        return self._scenario._core.keys(self._path) or []

    def items(self) -> list[tuple[str, Any]]:
        return [(key, _part(self._scenario, _joined(self._path, key))) for key in self]

    def get(self, key: str, default: Any = None) -> Any:
        """As by item, or `default`."""
        return self[key] if key in self else default

    def default(self, key: str) -> Any:
        """What the program takes where the scenario does not say a key; a text where that depends on others, None where there is none."""
        known = _known(self._table_of_keys()).get(key)
        if known is None:
            raise KeyError(f"{key!r} is no key of {self._words()}{did_you_mean(key, _known(self._table_of_keys()))}")
        return _standard(known)

    def defaults(self) -> dict[str, Any]:
        """default() of all keys that there are."""
        return {key: _standard(known) for key, known in _known(self._table_of_keys()).items()}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        name = name[:-1] if name.endswith("_") else name
        path = _joined(self._path, name)
        if self._scenario._core.has(path):
            return _part(self._scenario, path)
        keys = _known(self._table_of_keys())
        known = keys.get(name)
        if known is None and not any(key.startswith(f"{name}.") for key in keys):
            raise AttributeError(f"{self._words()} has no key {name!r}{did_you_mean(name, keys)}")
        if known is None or known.type == "table" or known.type.startswith("see "):
            return Table(self._scenario, path)
        if known.type == "list of tables":
            return Tables(self._scenario, path)
        if known.standard is None:
            raise AttributeError(f"the scenario says nothing of {path}; its default: {known.standard_text}")
        return _read_only(known.standard)

    def __setattr__(self, name: str, value: Any) -> None:
        self[key_text(name[:-1] if name.endswith("_") else name)] = value

    def __delattr__(self, name: str) -> None:
        try:
            del self[key_text(name)]
        except KeyError:
            raise AttributeError(f"the scenario says nothing of {_joined(self._path, name)}") from None

    def __dir__(self) -> list[str]:
        known = {key.partition(".")[0] for key in _known(self._table_of_keys())}
        return sorted({*super().__dir__(), *known, *(key for key in self if key.isidentifier())})

    def _ipython_key_completions_(self) -> list[str]:
        return sorted({*self, *_known(self._table_of_keys())})

    def _path_of(self, key: str) -> str:
        if not isinstance(key, str):
            raise TypeError(f"keys of a scenario are texts, not {type(key).__name__}")
        return f"{self._path}.{key}" if self._path else key

    def _table_of_keys(self) -> str:
        """The path without the places of elements."""
        return _without_places(self._path)

    def _words(self) -> str:
        return self._path or "a scenario"


def _without_places(path: str) -> str:
    return ".".join(part.partition("[")[0] for part in path.split("."))


_known_keys: dict[str, dict[str, Any]] = {}


def _known(table: str) -> dict[str, Any]:
    """What docs/scenario.md says of the keys of a table."""
    if table not in _known_keys:
        _known_keys[table] = {meaning.key: meaning for meaning in _core.Scenario.known_keys(table)}
    return _known_keys[table]


def _standard(known: Any) -> Any:
    if known.standard is not None:
        return _read_only(known.standard)
    return None if known.standard_text in ("none", "required") else known.standard_text


def _part(scenario: Scenario, path: str) -> Any:
    """A value, or a handle of a table or a list of them."""
    core = scenario._core
    if core.is_list_of_tables(path):
        return Tables(scenario, path)
    if core.is_table(path):
        return Table(scenario, path)
    return _read_only(core.value(path))


class Scenario(_Keys):
    """A scenario: its text, and the values that were set. docs/scenario.md has the keys. Nothing but the syntax is checked before
    check(), cut() or run()."""

    load = _LoadOrLoads()

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """An empty scenario, or one from nested mappings and lists as `tomllib.load` gives them. Relative paths count from the folder in
        which Python runs."""
        self._become(_core.Scenario.empty())
        for key, value in (values or {}).items():
            self[key_text(key)] = value

    _path = ""

    @property
    def _scenario(self) -> Scenario:  # type: ignore[override]
        return self

    def _become(self, core: _core.Scenario) -> None:
        object.__setattr__(self, "_core", core)

    @classmethod
    def _load(cls, file: str | os.PathLike[str]) -> Scenario:
        """From a file. Throws InputError when there is none, or when it is no TOML."""
        return cls._of(_core.Scenario.load(os.fspath(file)))

    @classmethod
    def parse(cls, text: str, file: str | os.PathLike[str] = "scenario.toml") -> Scenario:
        """From text. `file` stands in messages; paths in the scenario count from its folder."""
        return cls._of(_core.Scenario.parse(text, os.fspath(file)))

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
                core.set(key, value)
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
        self._core.save(os.fspath(file))

    def __repr__(self) -> str:
        changed = len(self._core.values_set)
        return f"<keyblock.Scenario {self.get('title') or self.file!r}, {changed} value{'' if changed == 1 else 's'} set>"

    # ── what can be done with it ──

    def check(self, realization: int = 0) -> list[str]:
        """Warnings, [] where there are none. Throws InputError; its `diagnostics` are all mistakes, with file, line, column and key."""
        return self._core.check(realization)

    def cut(self, realization: int = 0) -> CutBlocks:
        """The blocks of one of the rock masses that the joint statistics and the seed stand for."""
        return CutBlocks(self._core.cut(realization))

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


class Table(_Keys):
    """A table of a scenario: its keys as attributes, `scenario.rock.young = 4e9`. A key that is a word of Python has an underscore behind
    it: `from_`."""

    def __init__(self, scenario: Scenario, path: str) -> None:
        object.__setattr__(self, "_scenario", scenario)
        object.__setattr__(self, "_path", path)

    def to_dict(self) -> dict[str, Any]:
        """What the scenario says in it; a copy."""
        return self._scenario._core.value(self._path) or {}

    def __len__(self) -> int:
        return len(self.keys())

    def __eq__(self, other: object) -> bool:
        other = other.to_dict() if isinstance(other, Table) else other
        return self.to_dict() == other

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<{self._path} {self.to_dict()}>"


Mapping.register(Table)


class Tables:
    """A list of tables of a scenario: `scenario.stage[0].scale`, `scenario.stage["first earthquake"].scale`."""

    __slots__ = ("_scenario", "_path")

    def __init__(self, scenario: Scenario, path: str) -> None:
        self._scenario = scenario
        self._path = path

    @property
    def names(self) -> list[str]:
        """Of the elements; "" where one has none."""
        return self._scenario._core.keys(self._path) or []

    def to_list(self) -> list[dict[str, Any]]:
        """What the scenario says in it; a copy."""
        return self._scenario._core.value(self._path) or []

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[Table]:
        return (Table(self._scenario, f"{self._path}[{k}]") for k in range(len(self)))

    def __contains__(self, name: object) -> bool:
        return name in self.names if isinstance(name, str) and name else any(table == name for table in self)

    def _place(self, which: int | str) -> int:
        names = self.names
        if isinstance(which, str):
            if which not in names:
                raise KeyError(f"{self._path} has no element named {which!r}{did_you_mean(which, [n for n in names if n])}")
            return names.index(which)
        if not -len(names) <= which < len(names):
            raise IndexError(f"{self._path} has {len(names)} elements")
        return which % len(names)

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            return [self[k] for k in range(*which.indices(len(self)))]
        return Table(self._scenario, f"{self._path}[{self._place(which)}]")

    def __setitem__(self, which: int | str, values: Mapping[str, Any]) -> None:
        self._scenario._core.set(f"{self._path}[{self._place(which)}]", values)

    def __delitem__(self, which: int | str) -> None:
        self._scenario._core.remove(f"{self._path}[{self._place(which)}]")

    def append(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> Table:
        """Another element at the end, by a mapping or by names; values that are None are left out. `from_` is the key `from`."""
        named = {key[:-1] if key.endswith("_") else key: value for key, value in more.items()}
        self._scenario._core.append(self._path, {**(values or {}), **named})
        return self[-1]

    def extend(self, elements: Iterable[Mapping[str, Any]]) -> None:
        """Several at the end."""
        self._scenario._core.extend(self._path, elements)

    def __eq__(self, other: object) -> bool:
        other = other.to_list() if isinstance(other, Tables) else other
        return self.to_list() == other

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<{len(self)} × {self._path}>"
