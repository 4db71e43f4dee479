"""What can go wrong when results are read, one class per kind."""

from __future__ import annotations


class KeyblockError(Exception):
    """Base of all errors of this package."""


class NoResultError(KeyblockError, FileNotFoundError):
    """There is no result of keyblock at a path."""

    __str__ = Exception.__str__


class FormatError(KeyblockError, ValueError):
    """A file is no result, or of a format that this version does not know."""


class DamagedError(KeyblockError, ValueError):
    """A result file is damaged: a checksum is wrong, a dataset is missing, or its parts do not fit each other."""


class DataError(KeyblockError, ValueError):
    """Arrays, or data of another library, cannot be used as they are."""


class MissingPackageError(KeyblockError, ImportError):
    """Something was asked for that needs an optional package, and the package is not installed."""


class UnfinishedWarning(UserWarning):
    """The run still goes on, or did not reach its end: what it has written so far is there."""
