"""Python values as TOML, on one line, for `Scenario.set`."""

from __future__ import annotations

import json
import math
import numbers
import os
from collections.abc import Iterable, Mapping
from typing import Any

_BARE = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")


def key_text(key: str) -> str:
    """One key of a path or a table, in quotes where it needs them."""
    return key if key and set(key) <= _BARE else _string(key)


def _string(text: str) -> str:
    # A JSON string is a TOML string, except for one character that JSON leaves as it is.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(value: Any) -> str:
    value = float(value)
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(value)


def to_toml(value: Any, depth: int = 32) -> str:
    """`value` may be a text, path, boolean, number, mapping, or anything that can be iterated: lists, tuples, numpy arrays. Throws
    TypeError for other values, and ValueError for more than 32 lists and tables within each other."""
    if depth == 0:
        raise ValueError("lists and tables lie too deep within each other")
    if hasattr(value, "item") and getattr(value, "ndim", None) == 0:
        value = value.item()  # numpy's numbers
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, os.PathLike):
        return _string(os.fsdecode(value))
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return _number(value)
    if isinstance(value, Mapping):
        parts = (f"{key_text(str(k))} = {to_toml(v, depth - 1)}" for k, v in value.items() if v is not None)
        return "{ " + ", ".join(parts) + " }"
    if isinstance(value, Iterable) and not isinstance(value, (bytes, bytearray, memoryview)):
        return "[" + ", ".join(to_toml(item, depth - 1) for item in value) + "]"
    raise TypeError(f"a scenario has no values of type {type(value).__name__}")
