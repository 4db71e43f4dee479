"""The compiled module `core`, or in a sentence why there is none."""

from __future__ import annotations

import platform
import re
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING


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
    try:
        from . import _core
    except ImportError as error:
        raise ImportError(_why_not(error)) from None
    return _core


def _why_not(error: ImportError) -> str:
    """In a sentence why there is no module beside `_build`."""
    here = Path(__file__).parent
    own = f"Python {sys.version_info.major}.{sys.version_info.minor}"
    others = sorted({match["version"] for path in here.glob("_core*.so") if (match := re.search(r"cpython-(?P<version>\d+)-", path.name))})
    if any(here.glob(f"_core{suffix}") for suffix in EXTENSION_SUFFIXES):
        return f"the compiled part of keyblock cannot be loaded: {error}"
    if others:
        names = ", ".join(f"{version[0]}.{version[1:]}" for version in others)
        return f"the compiled part of keyblock here is for Python {names}, and this is {own}: use that one, or build it for this one (./dev build with -DKEYBLOCK_PYTHON_PROGRAM={sys.executable})"
    return "the compiled part of keyblock was not built: ./dev build, or ninja -C build/release keyblock_python, makes it; reading results needs none"


if TYPE_CHECKING:
    from . import _core as core
else:
    core = _load()
Diagnostic, InputError, RunError = core.Diagnostic, core.InputError, core.RunError
