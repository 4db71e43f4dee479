"""Tables of a scenario, and lists of them: keys as items and as attributes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from . import _arguments as arguments
from ._compiled import core as _core
from .record import did_you_mean

if TYPE_CHECKING:
    from .scenario import Scenario


_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def key_text(key: str) -> str:
    """One key of a path or a table, in quotes where it needs them."""
    # A JSON string is a TOML string, except for one character that JSON leaves as it is.
    return key if key and set(key) <= _BARE else json.dumps(key, ensure_ascii=False).replace("\x7f", "\\u007f")


def _plain(name: str) -> str:
    """The key that an attribute or a named argument stands for: words of Python have an underscore behind them."""
    return name[:-1] if name.endswith("_") else name


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


class Keys:
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
        """Puts a value in the place of the text's; None takes the key out. Throws InputError where the path leads nowhere, and for keys that
        the program does not know."""
        path = self._path_of(key)
        if value is not None:
            self._scenario._core.set(path, value)
        elif self._scenario._core.has(path):
            self._scenario._core.remove(path)
        else:
            self._scenario._core.check_keys(path)

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

    def setdefault(self, key: str, default: Any) -> Any:
        """What the scenario says of a key; where it says nothing, `default` from now on."""
        if key not in self:
            self[key] = default
        return self.get(key)

    def update(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> None:
        """Sets several keys, by a mapping or by names. `from_` is the key `from`."""
        for key, value in {**arguments.table("values", {} if values is None else values), **{_plain(name): value for name, value in more.items()}}.items():
            self[key] = value

    def default(self, key: str) -> Any:
        """What the program takes where the scenario does not say a key; a text where that depends on others, None where there is none."""
        known = _known(self._table_of_keys()).get(key)
        if known is None:
            raise KeyError(f"{key!r} is no key of {self._words()}{self._meant(key)}")
        return _standard(known)

    def defaults(self) -> dict[str, Any]:
        """default() of all keys that there are."""
        return {key: _standard(known) for key, known in _known(self._table_of_keys()).items()}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        name = _plain(name)
        path = _joined(self._path, name)
        if self._scenario._core.has(path):
            return _part(self._scenario, path)
        keys = _known(self._table_of_keys())
        known = keys.get(name)
        if known is None and not any(key.startswith(f"{name}.") for key in keys):
            raise self._no_key(name)
        if known is None or known.type == "table" or known.type.startswith("see "):
            return Table(self._scenario, path)
        if known.type == "list of tables":
            return Tables(self._scenario, path)
        if known.standard is None:
            raise AttributeError(f"the scenario says nothing of {path}; its default: {known.standard_text}")
        return _read_only(known.standard)

    def __setattr__(self, name: str, value: Any) -> None:
        key = key_text(_plain(name))
        if self._is_unknown(key) and (value is not None or key not in self):
            raise self._no_key(_plain(name))
        self[key] = value

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

    def _is_unknown(self, key: str) -> bool:
        try:
            _core.Scenario.check_keys(self._path_of(key))
        except _core.InputError:
            return True
        return False

    def _no_key(self, name: str) -> AttributeError:
        return AttributeError(f"{self._words()} has no key {name!r}{self._meant(name)}")

    def _meant(self, name: str) -> str:
        """The end of a message on a key that is not known."""
        try:
            _core.Scenario.check_keys(_joined(self._path, name))
        except _core.InputError as error:
            if hint := error.diagnostics[-1].hint:
                return f"; {hint}"
        return did_you_mean(name, dict.fromkeys(key.partition(".")[0] for key in _known(self._table_of_keys())))

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


class Table(Keys):
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
        which = arguments.whole(self._path, which)
        if not -len(names) <= which < len(names):
            raise IndexError(f"{self._path} has {len(names)} elements")
        return which % len(names)

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            return [self[k] for k in range(*which.indices(len(self)))]
        return Table(self._scenario, f"{self._path}[{self._place(which)}]")

    def __setitem__(self, which: int | str, values: Mapping[str, Any]) -> None:
        self._scenario._core.set(f"{self._path}[{self._place(which)}]", arguments.table(self._path, values))

    def __delitem__(self, which: int | str) -> None:
        self._scenario._core.remove(f"{self._path}[{self._place(which)}]")

    def append(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> Table:
        """Another element at the end, by a mapping or by names; values that are None are left out. `from_` is the key `from`."""
        named = {_plain(key): value for key, value in more.items()}
        self._scenario._core.append(self._path, {**arguments.table(self._path, {} if values is None else values), **named})
        return self[-1]

    def extend(self, elements: Iterable[Mapping[str, Any]]) -> None:
        """Several at the end."""
        if not isinstance(elements, Iterable):
            raise TypeError(f"{self._path}: found {elements!r}; expected a list of mappings")
        self._scenario._core.extend(self._path, [arguments.table(self._path, element) for element in elements])

    def __eq__(self, other: object) -> bool:
        other = other.to_list() if isinstance(other, Tables) else other
        return self.to_list() == other

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<{len(self)} × {self._path}>"
