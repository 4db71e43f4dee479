"""What springs, supports and all else that carries a force carry at a moment."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from . import tables

if TYPE_CHECKING:
    from ._hdf5 import ResultFile
    from .blocks import Blocks


class Elements:
    """All elements of a model at one moment, in the order of summary.json; nothing is read before it is asked for.

    N per metre of thickness, m; places in real coordinates. Of springs tension is positive, of all else the force is the size of the resultant.
    A model without elements has none: `len(elements) == 0`.
    """

    def __init__(self, file: ResultFile, blocks: Blocks, frame: int | None) -> None:
        """`frame`: None for the reference position."""
        self._file, self._blocks, self._frame = file, blocks, frame
        self.names: list[str] = file.texts("elements/name") if file.has("elements/name") else []

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def kinds(self) -> list[str]:
        """(n,), as "spring", "bolt", "dowel" and "support"."""
        return self._file.texts("elements/kind") if len(self) else []

    @cached_property
    def limit(self) -> np.ndarray:
        """(n,), N/m, the largest force that each can carry; infinite where there is no limit."""
        return self._file.read("elements/limit") if len(self) else np.zeros(0)

    @cached_property
    def spacing(self) -> np.ndarray:
        """(n,), m out of plane, of which a section has one; infinite of what goes on through the section, and in results of earlier versions."""
        return self._file.read("elements/spacing") if self._file.has("elements/spacing") else np.full(len(self), np.inf)

    @property
    def force_of_one(self) -> np.ndarray:
        """(n,), N, of one bolt; NaN of what goes on through the section."""
        return np.where(np.isfinite(self.spacing), self.force * np.where(np.isfinite(self.spacing), self.spacing, 0.0), np.nan)

    @cached_property
    def local(self) -> np.ndarray:
        """Ends in local coordinates, (n, 2, 2), m: from and to, x and y."""
        if not len(self):
            return np.zeros((0, 2, 2))
        return self._file.read("elements/reference") if self._frame is None else self._file.read("elements/ends", self._frame)

    @property
    def ends(self) -> np.ndarray:
        """The same in real coordinates."""
        return self.local + self._blocks.origin

    def _numbers(self, name: str) -> np.ndarray:
        if not len(self) or self._frame is None:
            return np.zeros(len(self))
        return self._file.read(f"elements/{name}", self._frame)

    @cached_property
    def force(self) -> np.ndarray:
        """(n,), N/m."""
        return self._numbers("force")

    @cached_property
    def elongation(self) -> np.ndarray:
        """(n,), m, since it was put in; of supports the mean way of what they hold."""
        return self._numbers("elongation")

    @cached_property
    def yielded(self) -> np.ndarray:
        """(n,), m, of the elongation, that does not come back."""
        return self._numbers("yielded")

    @cached_property
    def moment(self) -> np.ndarray:
        """(n,), N m/m, of liners: positive where it stretches the side of the opening. Files of earlier versions do not have it."""
        return self._numbers("moment")

    @cached_property
    def shear(self) -> np.ndarray:
        """(n,), N/m, the shear force of liners. Files of earlier versions do not have it."""
        return self._numbers("shear")

    @cached_property
    def present(self) -> np.ndarray:
        """(n,), whether it is there."""
        return self._numbers("present").astype(bool)

    @property
    def utilization(self) -> np.ndarray:
        """(n,), size of the force over the limit, of liners the largest stress over its strength; NaN where there is none."""
        if len(self) and self._frame is not None and "liner" in self.kinds:
            return self._numbers("utilization")
        return np.where(np.isfinite(self.limit), np.abs(self.force) / self.limit, np.nan)

    def index_of(self, name: str) -> int:
        """Throws KeyError where no element has the name."""
        if name not in self.names:
            from . import record

            raise KeyError(f"no element {name!r}{record.did_you_mean(name, self.names)}")
        return self.names.index(name)

    def _of_liners(self) -> dict[str, np.ndarray]:
        return {"moment": self.moment, "shear": self.shear} if "liner" in self.kinds else {}

    def table(self) -> Any:
        """A row for each, as pandas.DataFrame. Throws MissingPackageError without pandas."""
        columns: dict[str, Any] = {
            "name": self.names, "kind": self.kinds, "present": self.present, "force": self.force, "elongation": self.elongation,
            "yielded": self.yielded, **self._of_liners(), "limit": self.limit, "utilization": self.utilization, "spacing": self.spacing,
        }  # fmt: skip
        rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
        return tables.data_frame(rows, "elements", list(columns))

    def __repr__(self) -> str:
        return f"<{len(self)} elements, {int(self.present.sum())} of them there>"
