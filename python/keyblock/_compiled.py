"""The compiled module `core`, or in a sentence why there is none."""

from __future__ import annotations

import platform
from types import ModuleType


def _flags() -> set[str]:
    """What the processor can do, as Linux says it; empty where it does not."""
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            for line in file:
                if line.startswith("flags"):
                    return set(line.partition(":")[2].split())
    except OSError:
        pass
    return set()


def _load() -> ModuleType:
    try:
        from . import _build
    except ImportError:
        raise ImportError(
            "scenarios and runs need the compiled part of keyblock, which is not here: install the package python3-keyblock, or build it "
            "(./dev build) and import it with PYTHONPATH=build/release/python; reading results needs none"
        ) from None
    flags = _flags()
    missing = [name for name in _build.NEEDS if flags and name not in flags]
    if missing:
        raise ImportError(
            f"this keyblock was built for processors with {', '.join(_build.NEEDS)}, and this {platform.machine()} machine lacks "
            f"{', '.join(missing)}; build it here (./dev build)"
        )
    from . import _core

    return _core


core = _load()
Diagnostic, InputError, RunError = core.Diagnostic, core.InputError, core.RunError
