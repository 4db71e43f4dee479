"""Objects of JSON whose fields can be read as attributes, too."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .errors import DamagedError, KeyblockError, NoResultError


class Record(dict):
    """A dictionary: ``r.damage.fallen_area_m2`` is ``r["damage"]["fallen_area_m2"]``. A number that is not known is None."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(str(error.args[0])) from None

    def __missing__(self, name: object) -> Any:
        raise KeyError(f"no field {name!r}{did_you_mean(name, self)}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key for key in self if isinstance(key, str) and key.isidentifier())]

    def __repr__(self) -> str:
        return f"Record({', '.join(map(str, self))})"

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(f"<tr><th>{escape(str(k))}</th><td>{escape(_short(v))}</td></tr>" for k, v in self.items())
        return f"<table>{rows}</table>"


def _short(value: object, longest: int = 80) -> str:
    text = str(value)
    return text if len(text) <= longest else text[: longest - 1] + "…"


def did_you_mean(name: object, known: Any) -> str:
    """The end of a message on a name that is not known: the nearest of those that are, or all of them where they are few."""
    names = [str(k) for k in known]
    close = difflib.get_close_matches(str(name), names, n=1)
    if close:
        return f"; did you mean {close[0]!r}?"
    return f"; there are {', '.join(map(repr, names))}" if 0 < len(names) <= 25 else ""


def parse(text: str, what: str) -> Any:
    """JSON text as records, lists, texts and numbers. Throws DamagedError, which names `what`."""
    try:
        return json.loads(text, object_hook=Record)
    except (ValueError, RecursionError) as error:
        raise DamagedError(f"{what} is damaged: it is no JSON ({error})") from None


def parse_record(text: str, what: str) -> Record:
    """The same of an object."""
    found = parse(text, what)
    if not isinstance(found, Record):
        raise DamagedError(f"{what} is damaged: it is no object")
    return found


@contextmanager
def damaged(what: str) -> Iterator[None]:
    """Records that lack what is looked for in them are damaged, and DamagedError names `what`."""
    try:
        yield
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, KeyblockError):
            raise
        raise DamagedError(f"{what} is damaged: {error}") from None


def read(path: Path) -> Any:
    """The contents of a JSON file. Throws NoResultError and DamagedError."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise NoResultError(f"{path}: no such file") from None
    except UnicodeDecodeError:
        raise DamagedError(f"{path} is damaged: it is no text") from None
    return parse(text, str(path))
