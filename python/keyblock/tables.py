"""Tables over time: pandas.DataFrame where pandas is installed, dictionaries of arrays elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _optional
from ._hdf5 import ResultFile

if TYPE_CHECKING:
    from .blocks import Blocks

HISTORY_COLUMNS = ["ux", "uy", "vx", "vy", "sxx", "syy", "sxy"]  # of results that do not name them
ELEMENT_COLUMNS = ["force", "elongation"]
BREAK_MODES = ("tension", "shear", "opening")
RELEASE_COLUMNS = ["stage", "step", "excavation", "released", "crown", "springline", "mean"]


def table(columns: Mapping[Any, np.ndarray], time: np.ndarray, units: Mapping[Any, str]) -> Any:
    """Columns over time, s. Where pandas is missing: the columns by their names, and "time"."""
    if not _optional.has("pandas"):
        return {"time": time, **columns}
    import pandas

    frame = pandas.DataFrame(dict(columns), index=pandas.Index(time, name="time"))
    frame.attrs["units"] = dict(units)
    return frame


def data_frame(rows: Sequence[Mapping[str, Any]], what: str, columns: list[str] | None = None) -> Any:
    """Rows as pandas.DataFrame. Throws MissingPackageError without pandas."""
    return _optional.need("pandas", f"a table of {what}").DataFrame(list(rows), columns=columns)


def histories(file: ResultFile) -> Any:
    """Displacement, velocity, stress and acceleration of the chosen points, force and elongation of the chosen elements; columns (point, quantity)."""
    time = file.complete_times("histories")
    values = file.read("histories/values", slice(0, len(time)))
    quantities, units = file.columns("histories/values", HISTORY_COLUMNS), file.units("histories/values")
    points = file.texts("histories/names")
    columns = {(p, q): values[:, i, k] for i, p in enumerate(points) for k, q in enumerate(quantities)}
    unit_of = dict(zip(quantities, units))
    of_elements = "histories/element_values"
    if file.has(of_elements):
        values = file.read(of_elements, slice(0, len(time)))
        quantities = file.columns(of_elements, ELEMENT_COLUMNS)
        names = file.texts("histories/element_names")
        columns |= {(e, q): values[:, i, k] for i, e in enumerate(names) for k, q in enumerate(quantities)}
        unit_of |= dict(zip(quantities, file.units(of_elements)))
    found = table(columns, time, unit_of)
    if not isinstance(found, dict):
        import pandas

        found.columns = pandas.MultiIndex.from_tuples(list(columns), names=["point", "quantity"]) if columns else (
            pandas.MultiIndex.from_arrays([[], []], names=["point", "quantity"])
        )
    return found


def joints(file: ResultFile, names: Sequence[str]) -> Any:
    """A row for each joint set and trace map, or for each trace where traces have strengths of their own; `names` are those of the rows."""
    columns: dict[str, Any] = {"joint": list(names), "trace": np.empty(0, dtype=int)}
    numbers: list[str] = []
    if names:
        columns["trace"] = file.read("joints/trace")
        numbers = [name for name in file.names_in("joints") if file.kind(f"joints/{name}") == "f"]
        columns |= {name: file.read(f"joints/{name}") for name in ("length", *numbers) if name in numbers}
    if not _optional.has("pandas"):
        return columns
    import pandas

    frame = pandas.DataFrame(columns)
    frame.attrs["units"] = {name: file.unit(f"joints/{name}") for name in numbers}
    return frame


def breaks(file: ResultFile, blocks: Blocks, origin: np.ndarray) -> Any:
    """A row for each event of breaking; places are those of the scenario."""
    time = file.complete_times("breaks") if file.has("breaks/time") else np.zeros(0)

    def read(name: str) -> np.ndarray:
        return file.read(f"breaks/{name}", slice(0, len(time))) if len(time) else np.zeros(0, dtype=int)

    element, mode = read("element"), read("mode")
    kinds = read("edge_kind")
    names = ["joints" if kind == 0 else name for kind, name in zip(kinds, blocks.edge_names(kinds, read("edge_index")))]
    if (element >= 0).any():
        known = file.texts("elements/name")
        names = [known[e] if e >= 0 else name for e, name in zip(element, names)]
    position = origin + (read("position") if len(time) else np.zeros((0, 2)))
    columns = {
        "name": np.array(names, dtype=object), "mode": np.array([BREAK_MODES[m] for m in mode], dtype=object),
        "stage": read("stage"), "step": read("step"), "x": position[:, 0], "y": position[:, 1], "length": read("length").astype(float),
        "block_a": read("block_a"), "block_b": read("block_b"), "trace": read("trace"), "element": element,
    }  # fmt: skip
    return table(columns, time, {"x": "m", "y": "m", "length": "m"})


def energy(file: ResultFile) -> Any:
    """Terms of the energy balance of the steps that were kept, J/m; `residual_ratio` has no unit."""
    time = file.complete_times("steps")
    values = file.read("steps/energy", slice(0, len(time)))
    names = file.texts("steps/energy_names")
    units = {name: "" if name == "residual_ratio" else "J/m" for name in names}
    return table({name: values[:, k] for k, name in enumerate(names)}, time, units)


def steps(file: ResultFile) -> Any:
    """What each step that was kept took: iterations, contacts, step size, penetration, largest displacement."""
    time = file.complete_times("steps")
    names = ["step", "stage", "step_size", "iterations", "closed_contacts", "penetration", "max_displacement"]
    columns = {name: file.read(f"steps/{name}", slice(0, len(time))) for name in names}
    return table(columns, time, {name: file.unit(f"steps/{name}") for name in names})


def elements(rows: Sequence[Mapping[str, Any]]) -> Any:
    """Springs, supports and other elements: a row each, with what it carries at the end of the run and carried at the most; None where there are none.

    N per metre of thickness, of springs tension is positive; m; s. NaN where there is no limit. Without pandas: a dictionary of arrays.
    """
    if not rows:
        return None
    columns: dict[str, np.ndarray] = {}
    for name, first in rows[0].items():
        if name in ("from", "to"):
            for axis in (0, 1):
                columns[f"{name}_{'xy'[axis]}"] = np.array([row[name][axis] for row in rows], dtype=float)
        elif isinstance(first, bool):
            columns[name] = np.array([row[name] for row in rows], dtype=bool)
        elif name in ("name", "kind", "peak_stage"):
            columns[name] = np.array([row[name] for row in rows], dtype=object)
        else:
            columns[name] = np.array([np.nan if row[name] is None else row[name] for row in rows], dtype=float)
    if not _optional.has("pandas"):
        return columns
    import pandas

    return pandas.DataFrame(columns)


def release(stages: Sequence[Mapping[str, Any]]) -> Any:
    """Ground reaction: a row for each equilibrium of an excavation that was opened in parts; None where there is none.

    Lengths in m, NaN where a later excavation took the wall away. Without pandas: a dictionary of arrays.
    """
    rows = [
        (k, p["step"], p["excavation"], p["released"], p["crown_m"], p["springline_m"], p["mean_m"])
        for k, stage in enumerate(stages)
        for p in stage["release"]
    ]
    if not rows:
        return None
    types = (int, int, object, float, float, float, float)
    columns: dict[str, np.ndarray] = {name: np.array(column, dtype=t) for name, column, t in zip(RELEASE_COLUMNS, zip(*rows), types)}
    if not _optional.has("pandas"):
        return columns
    import pandas

    frame = pandas.DataFrame(columns)
    frame.attrs["units"] = dict.fromkeys(("crown", "springline", "mean"), "m")
    return frame
