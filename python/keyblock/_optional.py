"""Packages that are needed for a part of the package only."""

from __future__ import annotations

import importlib
import importlib.util
from types import ModuleType

from .errors import MissingPackageError

# By the name of the module: the package of Debian, and the name for pip.
_PACKAGES = {
    "h5py": ("python3-h5py", "h5py"),
    "pandas": ("python3-pandas", "pandas"),
    "matplotlib": ("python3-matplotlib", "matplotlib"),
    "xarray": ("python3-xarray", "xarray"),
    "geopandas": ("python3-geopandas", "geopandas"),
    "shapely": ("python3-shapely", "shapely"),
    "PIL": ("python3-pil", "pillow"),
}


def has(name: str) -> bool:
    """Whether the module can be imported."""
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def need(name: str, purpose: str) -> ModuleType:
    """Imports a module. Throws MissingPackageError with the command that installs it where it is not there."""
    top = name.partition(".")[0]
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.partition(".")[0] != top:
            raise MissingPackageError(f"{purpose} needs {top}, which cannot be imported: {error}") from None
        debian, pip = _PACKAGES[top]
        raise MissingPackageError(
            f"{purpose} needs {top}, which is not installed: apt install {debian}, or pip install {pip}"
        ) from None
