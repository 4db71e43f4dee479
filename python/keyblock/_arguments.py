"""What is handed to a function of this package, looked at before it acts: another kind of thing is refused in a sentence, and never turned into
what it may have meant. Texts and truth values are no numbers."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np


def _plain(value: Any) -> Any:
    """Numbers of numpy, and arrays without dimensions, as those of Python."""
    return value.item() if isinstance(value, (np.generic, np.ndarray)) and value.ndim == 0 else value


def _refuse(name: str, value: Any, expected: str) -> TypeError:
    shown = repr(value)
    return TypeError(f"{name}: found {shown if len(shown) <= 60 else type(value).__name__}; expected {expected}")


def number(name: str, value: Any, expected: str = "a number") -> float:
    plain = _plain(value)
    if isinstance(plain, bool) or not isinstance(plain, numbers.Real):
        raise _refuse(name, value, expected)
    return float(plain)


def number_or_none(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value, "a number, or None")


def whole(name: str, value: Any, least: int | None = None) -> int:
    expected = "a whole number" if least is None else f"a whole number, at least {least}"
    plain = _plain(value)
    if isinstance(plain, bool) or not isinstance(plain, numbers.Integral):
        raise _refuse(name, value, expected)
    taken = int(plain)
    if least is not None and taken < least:
        raise ValueError(f"{name}: found {taken}; expected {expected}")
    if taken.bit_length() > 62:
        raise ValueError(f"{name}: found a number of {taken.bit_length()} bits; expected {expected}")
    return taken


def count(name: str, value: Any, least: int | None = None) -> int:
    """Of threads, runs, realizations: what the core takes, which says what else it does not like."""
    taken = whole(name, value, least)
    if abs(taken) > 2**31 - 1:
        raise ValueError(f"{name}: found {taken}; expected a whole number below 2147483648")
    return taken


def flag(name: str, value: Any) -> bool:
    plain = _plain(value)
    if not isinstance(plain, bool):
        raise _refuse(name, value, "True or False")
    return plain


def text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise _refuse(name, value, "a text")
    return str(value)


def texts(name: str, value: Any) -> list[str]:
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise _refuse(name, value, "a list of texts")
    return [text(name, one) for one in value]


def path(name: str, value: Any) -> str:
    try:
        return os.fsdecode(os.fspath(value))
    except TypeError:
        raise _refuse(name, value, "a path") from None


def pair(name: str, value: Any, meaning: str) -> list[float]:
    """Two numbers along x and y."""
    expected = f"two numbers, {meaning}"
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable) or getattr(value, "ndim", 1) == 0:
        raise _refuse(name, value, expected)
    items = list(value)
    if len(items) != 2:
        raise ValueError(f"{name}: found {len(items)} elements; expected {expected}")
    return [number(name, item, f"{expected} in it") for item in items]


def table(name: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise _refuse(name, value, "a mapping of keys to values")
    return value


def array(name: str, value: Any) -> np.ndarray:
    """Of floats, from numbers of any kind, and of nothing else."""
    try:
        found = np.asarray(value)
    except (TypeError, ValueError):  # rows of different lengths
        raise _refuse(name, value, "an array of numbers") from None
    if found.dtype.kind not in "iuf":
        raise _refuse(name, value, "an array of numbers" if found.ndim else "a number")
    return found.astype(float)


def finite(name: str, value: Any) -> float:
    taken = number(name, value)
    if not math.isfinite(taken):
        raise ValueError(f"{name}: found {taken}; expected a finite number")
    return taken
