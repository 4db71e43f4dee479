"""The results of one run: result.h5 as arrays, tables and pictures.

    run = keyblock.open("out/tunnel")
    run.stages["first earthquake"].damage.fallen_area_m2
    run.plot(time=12.3, color="displacement", save="tunnel.pdf")

Units are SI, forces and energies per metre of thickness, tension positive in stresses, coordinates real ones.
"""

from __future__ import annotations

import warnings
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from . import _arguments as arguments
from . import record, tables
from ._hdf5 import ResultFile
from .blocks import JOINT_SET, TRACE_MAP, Blocks
from .contacts import Contacts, ContactSnapshots
from .errors import DamagedError, NoResultError, UnfinishedWarning
from .frames import Frames, When
from .stages import Stages, read_stages

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes


class Result:
    """The results of a run. Nothing is read before it is asked for."""

    def __init__(self, path: str | Path, *, warn: bool = True) -> None:
        """`path` is the folder of a run, or its result.h5. Throws NoResultError, FormatError and DamagedError."""
        path = Path(path)
        self.path = path / "result.h5" if path.is_dir() else path
        if not self.path.is_file():
            raise NoResultError(_why_not(path))
        self._file = ResultFile(self.path)
        if warn and (why := self.unfinished):
            warnings.warn(f"{self.path}: {why}", UnfinishedWarning, stacklevel=2)

    # ── the file ──

    def close(self) -> None:
        """What was read stays; what was not can be read no more."""
        self._file.close()

    def __enter__(self) -> Result:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def refresh(self) -> Result:
        """The results as they stand now: for a run that still goes on. The earlier object stays as it was."""
        return Result(self.path, warn=False)

    @property
    def unfinished(self) -> str:
        """Why the results are those of a part of the run, in a sentence; empty where it has reached its end."""
        if self._summary is not None:
            return "the run was stopped before its end" if self._summary.get("interrupted") else ""
        count = len(self._file.complete_times("frames"))
        goes_on = "still goes on, or was killed" if (self.path.parent / "lock").exists() else "was stopped"
        return f"the run {goes_on}; {count} frames are there so far, and no summary"

    @property
    def title(self) -> str:
        return str(self._file.attribute("title"))

    @property
    def scenario(self) -> str:
        """The scenario that was run, TOML."""
        return self._file.texts("scenario")[0]

    # ── numbers ──

    @cached_property
    def _summary(self) -> record.Record | None:
        text = self._file.bytes_as_text("summary")
        return record.parse_record(text, f"summary of {self.path}") if text else None

    @property
    def summary(self) -> record.Record:
        """What summary.json holds. Throws NoResultError while there is none; `stages` are known earlier."""
        if self._summary is None:
            raise NoResultError(f"{self.path}: there is no summary before the run ends")
        return self._summary

    @cached_property
    def stages(self) -> Stages:
        """All stages that have begun, by number or name."""
        return Stages(read_stages(self._file, self._summary, self.blocks.record.excavation_names), self.blocks.record.get("stage_names"))

    @cached_property
    def histories(self) -> Any:
        """What the chosen points and elements did: a table over time with columns (point, quantity). Of an element: force and elongation."""
        return tables.histories(self._file)

    @cached_property
    def energy(self) -> Any:
        """Terms of the energy balance over time, J/m."""
        return tables.energy(self._file)

    @cached_property
    def steps(self) -> Any:
        """What steps took: iterations, closed contacts, penetration, … over time."""
        return tables.steps(self._file)

    @cached_property
    def joints(self) -> Any:
        """Strengths of joints: a row for each joint set and trace map, or for each trace where traces have strengths of their own.

        Columns `joint`, `trace` (−1: the whole set or map) and SI numbers, angles in degrees. NaN of what does not weaken. Rows of a trace are those
        of edges with `blocks.edge_trace`."""
        if not self._file.has("joints/edge_kind"):
            return tables.joints(self._file, [])
        kinds, numbers = self._file.read("joints/edge_kind"), self._file.read("joints/edge_index")
        if not {int(kind) for kind in kinds} <= {JOINT_SET, TRACE_MAP}:
            raise DamagedError(f"{self.path} is damaged: joints/edge_kind has more than joint sets and trace maps")
        return tables.joints(self._file, self.blocks.edge_names(kinds, numbers))

    @cached_property
    def breaks(self) -> Any:
        """Events of breaking over time: bonds of joints, what slip and opening take from joints that weaken, and elements that rupture.

        Columns `name` (set, map, outline or element), `mode` ("tension", "shear"), `stage`, `step`, `x` and `y`, m, `length`, m of joint, `block_a`,
        `block_b`, `trace` and `element` (−1: none). No rows where nothing broke or could break."""
        return tables.breaks(self._file, self.blocks, self.blocks.origin)

    @property
    def elements(self) -> Any:
        """Springs, supports and other elements: what each carries at the end and carried at the most. None without. At a moment: `frames[3].elements`."""
        return tables.elements(self.summary.get("elements") or [])

    @property
    def release(self) -> Any:
        """Ground reaction of excavations that were opened in parts: closure over the share released. None without."""
        return tables.release(self.stages)

    # ── the section ──

    @cached_property
    def blocks(self) -> Blocks:
        """The blocks in their reference position."""
        return Blocks(self._file)

    def rings(self, block: int | str, time: When = None) -> list[np.ndarray]:
        """Outlines of a block as it lies: the outer ring, then holes, each (n, 2), m."""
        return self.frames.rings(self.blocks.index_of(block), time)

    @cached_property
    def frames(self) -> Frames:
        """The moments that were kept: `frames[3]`, `frames.at(12.3)`, `frames.at("first earthquake")`."""
        return Frames(self._file, self.blocks, self.stages.planned)

    @cached_property
    def contact_snapshots(self) -> ContactSnapshots:
        """The moments at which contacts were kept; fewer than frames."""
        return ContactSnapshots(self._file, self.blocks, self.stages.planned)

    def contacts(self, time: When = None) -> Contacts:
        """Contacts at the snapshot nearest to a time in s, at the end of a stage, or of the run."""
        return self.contact_snapshots.at(time)

    # ── pictures, other libraries ──

    def plot(self, time: When = None, color: Any = "displacement", **options: Any) -> Axes:
        """Draws the section at a moment; see `keyblock.plot.plot` for the options. Returns matplotlib's axes."""
        from . import plot

        return plot.plot(self, time, color, **options)

    def animate(self, path: str | Path, color: Any = "displacement", **options: Any) -> Path:
        """Writes a film of the run, MP4 or GIF; see `keyblock.animate.animate` for the options."""
        from . import animate

        return animate.animate(self, path, color, **options)

    def export(self, format: str, folder: str | Path | None = None, *, replace: bool = False) -> list[Path]:
        """Files for other programs, as `keyblock export`: "vtk" for ParaView, "csv", or "geojson"; returns them. `folder`: by default one of the
        name of the format beside the results. `replace`: other files there that are in the way may go. Needs the compiled module."""
        from ._compiled import core

        target = self.path.parent / format if folder is None else Path(folder)
        return [Path(file) for file in core.export_run(self.path.parent, target, arguments.text("format", format), arguments.flag("replace", replace) or folder is None)]

    def to_xarray(self, frames: slice = slice(None)) -> Any:
        """Frames as xarray.Dataset with the dimensions time, vertex, block and component."""
        from . import convert

        return convert.to_xarray(self, frames)

    def to_geodataframe(self, time: When = None, crs: Any = None) -> Any:
        """The blocks as they lie, as geopandas.GeoDataFrame: a polygon each, with displacement, stress and status."""
        from . import convert

        return convert.to_geodataframe(self, time, crs)

    def __repr__(self) -> str:
        return f"<keyblock result {str(self.path)!r}: {self.title!r}, {len(self.blocks)} blocks, {self.frames!r}>"


def _why_not(path: Path) -> str:
    if not path.exists():
        return f"{path}: no such file or folder"
    if not path.is_dir():
        return f"{path}: not a file"
    if (path / "run.json").exists():
        return f'{path}: a run of a study that kept no result.h5; take keep = "all" in [study]'
    return f"{path}: a folder without a result.h5, so not one that a run of keyblock has written"
