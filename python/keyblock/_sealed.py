"""Objects whose attributes are all known: a name that does not exist cannot be set by mistake."""

from __future__ import annotations

from typing import Any

from .record import did_you_mean


class Sealed:
    """Attributes are those of the class that can be set, and private ones."""

    def __setattr__(self, name: str, value: Any) -> None:
        known = getattr(type(self), name, None)
        if not name.startswith("_") and not isinstance(known, property):
            public = [word for word in dir(type(self)) if not word.startswith("_")]
            what = "can only be called or read" if known is not None else f"does not exist{did_you_mean(name, public)}"
            raise AttributeError(f"{type(self).__name__}.{name} {what}")
        if isinstance(known, property) and known.fset is None:
            raise AttributeError(f"{type(self).__name__}.{name} can only be read")
        object.__setattr__(self, name, value)
