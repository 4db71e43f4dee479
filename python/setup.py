"""Packs what CMake has built, if it is there: the wheel is then for this Python and this kind of machine."""

from pathlib import Path

from setuptools import Distribution, setup


class Built(Distribution):
    def has_ext_modules(self) -> bool:
        return any(Path("keyblock").glob("_core*.so"))


setup(distclass=Built)
