"""Functions that steer runs."""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arguments as arguments
from ._sealed import Sealed

if TYPE_CHECKING:
    from .simulation import Simulation


class Controller(Sealed):
    """A function that is called with the Simulation after every `every`-th step. It looks at the run and changes what acts from the next
    step on. What it has to remember between steps must follow from the simulation, or a resumed run goes another way."""

    def __init__(self, function: Callable[[Simulation], Any], every: int = 1, name: str | None = None) -> None:
        if not callable(function) or isinstance(function, type):
            raise TypeError(f"a controller is a function of a Simulation, and not {function!r}")
        if any(is_other(function) for is_other in (inspect.iscoroutinefunction, inspect.isgeneratorfunction, inspect.isasyncgenfunction)):
            raise TypeError(f"{_name_of(function)} is a coroutine or a generator, which would not run; a controller is a plain function")
        if not isinstance(every, (int, np.integer)) or isinstance(every, bool):
            raise TypeError(f"every: a whole number of steps, and not {every!r}")
        if every < 1:
            raise ValueError("every: at least 1")
        self._function = function
        self._every = int(every)
        if name is not None and not arguments.text("name", name).isprintable():
            raise ValueError(f"name: found {name!r}; expected a text of one line")
        self._name = name or _name_of(function)
        self._hash = hashlib.sha256(f"{_source_of(function)}\n{_held_values(function)}{self._every}".encode()).hexdigest()[:16]

    function = property(lambda self: self._function)
    every = property(lambda self: self._every, doc="steps")
    name = property(lambda self: self._name)
    hash = property(lambda self: self._hash, doc="Of its text and what it closes over.")

    def __call__(self, simulation: Simulation) -> Any:
        return self._function(simulation)

    def __repr__(self) -> str:
        return f"<keyblock.Controller {self.name}, every {self.every} steps, {self.hash}>"


def controller(function: Callable[[Simulation], Any] | None = None, *, every: int = 1, name: str | None = None) -> Any:
    """Makes a Controller of a function: `@keyblock.controller(every=10)`. summary.json names it with the hash of its text."""
    if function is not None:
        return Controller(function, every, name)
    return lambda f: Controller(f, every, name)


def controllers_of(given: Any) -> list[Controller]:
    if isinstance(given, (str, bytes, Controller)) or callable(given) or not isinstance(given, Iterable):
        raise TypeError(f"controllers: a list of functions, as controllers=[weaken], and not {given!r}")
    return [c if isinstance(c, Controller) else Controller(c) for c in given]


def _name_of(function: Callable[..., Any]) -> str:
    try:
        place = os.path.basename(inspect.getsourcefile(function) or "") if inspect.isroutine(function) else ""
    except TypeError:  # a function of C
        place = ""
    return f"{place}:{getattr(function, '__qualname__', type(function).__name__)}".lstrip(":")


def _source_of(function: Callable[..., Any]) -> str:
    of = function if inspect.isroutine(function) else type(function)
    try:
        return inspect.getsource(of)
    except (OSError, TypeError):  # typed at a prompt
        code = getattr(of, "__code__", None)
        return repr(of) if code is None else f"{code.co_code.hex()} {code.co_consts!r} {code.co_names!r}"


def _held_values(function: Callable[..., Any]) -> str:
    """What a function closes over, as far as it is plain: `make(8000)` and `make(6000)` are two controllers."""
    if isinstance(function, functools.partial):
        return f"{_source_of(function.func)}\n{_held_values(function.func)}{function.args!r}{sorted(function.keywords.items())!r}\n"
    plain = (bool, int, float, complex, str, bytes, type(None))
    names = getattr(getattr(function, "__code__", None), "co_freevars", ())
    values = [cell.cell_contents for cell in getattr(function, "__closure__", None) or () if _is_full(cell)]
    held = [f"{name}={value!r}" for name, value in zip(names, values) if isinstance(value, plain)]
    held += [f"{value!r}" for value in (getattr(function, "__defaults__", None) or ()) if isinstance(value, plain)]
    holder = getattr(function, "__self__", None) if inspect.isroutine(function) else function
    held += [f"{name}={value!r}" for name, value in sorted(getattr(holder, "__dict__", {}).items()) if isinstance(value, plain)]
    return "".join(f"{text}\n" for text in held)


def _is_full(cell: Any) -> bool:
    try:
        cell.cell_contents
    except ValueError:
        return False
    return True
