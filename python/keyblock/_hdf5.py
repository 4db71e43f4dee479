"""The file result.h5 as arrays, with its units and names. What is wrong with the file is said here, once for all that read it."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from . import _fits, _optional, record
from .errors import DamagedError, FormatError, NoResultError

FORMAT = "keyblock result"
NEWEST_VERSION = 2

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
# Deflate makes nothing smaller than by this. A dataset that says more was never written: its rows are read as zeros, all 10¹⁰ of them.
_LARGEST_COMPRESSION = 1040
_ALWAYS_TAKEN = 1 << 24  # bytes: with those it is not asked

# What h5py throws where a file does not hold what it says.
_BROKEN = (KeyError, OSError, RuntimeError, ValueError, TypeError, IndexError, MemoryError)


def text_of(value: Any) -> str:
    """A text as h5py hands it out: bytes, str, or an empty array."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value if isinstance(value, str) else ""


def _open(h5py: Any, path: Path) -> Any:
    """A file that is complete is opened as any other. One that a run still writes, or was killed over, says that it is open for writing.

    Then it is read as one that grows. A damaged file must not be: there HDF5 waits long for each checksum to come right. Within a
    process all that opens a file must say the same of locks: HDF5's own default, as h5py.File and the compiled module do. A run writes
    into a file of its own and renames it, so that a lock of a reader is in nobody's way.
    """
    try:
        return _open_locked(h5py, path)
    except OSError as error:
        # The second: this process has opened the file as one that grows, and it was completed since.
        if "open for write" not in str(error) and "SWMR" not in str(error):
            raise
        return _open_locked(h5py, path, swmr=True)


def _open_locked(h5py: Any, path: Path, **mode: Any) -> Any:
    """Without locks where the file system has none."""
    try:
        return h5py.File(path, "r", **mode)
    except OSError as error:
        if "unable to lock file" not in str(error):
            raise
        return h5py.File(path, "r", locking=False, **mode)


class ResultFile:
    """result.h5, open for reading, while its run goes on as well."""

    def __init__(self, path: Path) -> None:
        h5py = _optional.need("h5py", "reading result.h5")
        self.path = path
        if not path.is_file():
            raise NoResultError(f"{path}: no such file")
        with path.open("rb") as file:
            if file.read(len(_SIGNATURE)) != _SIGNATURE:
                raise FormatError(f"{path} is no HDF5 file, or its beginning is damaged")
        try:
            self._file = _open(h5py, path)
        except (OSError, RuntimeError, ValueError) as error:
            raise DamagedError(f"{path} is damaged: it cannot be opened ({error})") from None
        self._grows = bool(self._file.swmr_mode)
        try:
            self._check_format()
            _fits.check(self)
        except BaseException:
            self.close()
            raise

    def _check_format(self) -> None:
        version = self.attribute("format_version")
        if self.attribute("format") != FORMAT or not isinstance(version, (int, np.integer)):
            raise FormatError(f"{self.path} is an HDF5 file, but no result of keyblock")
        if version > NEWEST_VERSION:
            raise FormatError(
                f"{self.path} has format {version}, and this package reads formats up to {NEWEST_VERSION}: take a newer keyblock"
            )

    @property
    def grows(self) -> bool:
        """Whether a run still writes it."""
        return self._grows

    def close(self) -> None:
        self._file.close()

    @property
    def is_open(self) -> bool:
        return bool(self._file)

    def attribute(self, name: str) -> Any:
        """An attribute of the file; texts as str."""
        try:
            value = self._file.attrs.get(name)
        except _BROKEN as error:
            raise DamagedError(f"{self.path} is damaged: its attributes cannot be read ({error})") from None
        return text_of(value) if isinstance(value, (bytes, str)) else value

    def has(self, name: str) -> bool:
        """Whether there is such a dataset: results of earlier versions have fewer."""
        try:
            return name in self._file
        except _BROKEN as error:
            raise DamagedError(f"{self.path} is damaged: {name} cannot be found ({error})") from None

    def _dataset(self, name: str) -> Any:
        if not self.is_open:
            raise ValueError(f"{self.path} was closed")
        try:
            dataset = self._file[name]
            if self._grows and hasattr(dataset, "refresh"):
                dataset.refresh()
        except _BROKEN:
            raise DamagedError(f"{self.path} is damaged: {name} is missing or cannot be read") from None
        if not hasattr(dataset, "shape"):
            raise DamagedError(f"{self.path} is damaged: {name} is no dataset")
        if self._says_more_than_it_holds(dataset):
            raise DamagedError(f"{self.path} is damaged: {name} says that it has {dataset.shape[0]} rows, and holds fewer")
        return dataset

    @staticmethod
    def _says_more_than_it_holds(dataset: Any) -> bool:
        said = dataset.size * dataset.dtype.itemsize if dataset.size else 0
        return bool(said > _ALWAYS_TAKEN and said > _LARGEST_COMPRESSION * dataset.id.get_storage_size())

    def read(self, name: str, rows: Any = ()) -> np.ndarray:
        """The rows of a dataset, all by default. Throws DamagedError where it is missing or its checksum is wrong."""
        dataset = self._dataset(name)
        try:
            return dataset[rows]
        except _BROKEN as error:
            raise DamagedError(f"{self.path} is damaged: {name} cannot be read ({error})") from None

    # Texts of any length lie in a heap without a checksum, and a wrong byte there ends the interpreter. `texts` has all of them as bytes.
    _IN_TEXTS = {
        "model/block_name": "block_names",
        "histories/names": "history_names",
        "histories/element_names": "element_history_names",
        "steps/energy_names": "energy_names",
        "elements/name": "element_names",
        "elements/kind": "element_kinds",
    }

    @cached_property
    def _texts(self) -> dict[str, Any]:
        """Empty in files of earlier versions, whose texts have one length each."""
        return record.parse_record(self.bytes_as_text("texts"), f"texts of {self.path}") if self.has("texts") else {}

    def texts(self, name: str) -> list[str]:
        if not self._texts:
            return [text_of(value) for value in self.read(name)]
        try:
            if name in self._IN_TEXTS:
                return [str(text) for text in self._texts.get(self._IN_TEXTS[name], [])]
            return [str(self._texts[name.rpartition("/")[2]])]
        except KeyError:
            raise DamagedError(f"{self.path} is damaged: {name} is missing") from None

    def bytes_as_text(self, name: str) -> str:
        """Of a dataset that holds the bytes of a text."""
        return bytes(self.read(name)).partition(b"\0")[0].decode("utf-8", "replace")

    def kind(self, name: str) -> str:
        """Of the numbers of a dataset, as numpy has it: "f", "i", "u", or another letter."""
        return str(self._dataset(name).dtype.kind)

    def shape(self, name: str) -> tuple[int, ...]:
        return tuple(self._dataset(name).shape)

    def names_in(self, group: str) -> list[str]:
        """Of all datasets of a group, in alphabetical order; none where there is no such group."""
        try:
            return list(self._file[group]) if self.has(group) else []
        except _BROKEN as error:
            raise DamagedError(f"{self.path} is damaged: {group} cannot be read ({error})") from None

    def contact_numbers(self) -> list[str]:
        """Names of the columns of `contacts` that are numbers, one for each contact."""
        paths = {name: f"contacts/{name}" for name in self.names_in("contacts") if name != "time"}
        return [name for name, path in paths.items() if self.kind(path) == "f" and len(self.shape(path)) == 1]

    def complete_times(self, group: str) -> np.ndarray:
        """Times of the rows of a group that are complete, s. While a run goes on, a row may be in the making."""
        time = self.read(f"{group}/time")
        unwritten = np.flatnonzero(np.isnan(time))
        time = time[: unwritten[0]] if unwritten.size else time
        if np.isinf(time).any():
            raise DamagedError(f"{self.path} is damaged: {group}/time has a moment that is infinite")
        return time

    def _attribute(self, name: str, attribute: str) -> Any:
        """Of a dataset; None where it has none, or none that can be read."""
        try:
            return self._dataset(name).attrs.get(attribute)
        except _BROKEN:
            return None

    def unit(self, name: str) -> str:
        """Unit of a dataset; "" for numbers without one. Of columns that differ: one for each, after commas."""
        unit = text_of(self._attribute(name, "units")) or text_of(self._attribute(name, "unit"))
        return "" if unit == "1" else unit

    def units(self, name: str) -> list[str]:
        """Unit of each column of a dataset."""
        units = self.unit(name).split(", ")
        if len(units) == 1:
            units *= self.shape(name)[-1]
        return ["" if unit == "1" else unit for unit in units]

    def description(self, name: str) -> str:
        return text_of(self._attribute(name, "description"))

    def columns(self, name: str, otherwise: list[str]) -> list[str]:
        """Names of the last dimension; `otherwise` in files of versions that did not write them."""
        return self._names(name, "columns", otherwise)

    def values(self, name: str, otherwise: list[str]) -> list[str]:
        """The words that numbers stand for, by number."""
        return self._names(name, "values", otherwise)

    def _names(self, name: str, attribute: str, otherwise: list[str]) -> list[str]:
        if self._texts:
            return list(self._texts.get("meanings", {}).get(name, {}).get(attribute, otherwise))
        found = self._attribute(name, attribute)
        return otherwise if found is None else [text_of(value) for value in found]
