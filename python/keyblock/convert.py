"""Results for other libraries: xarray and geopandas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _optional
from .frames import STATUS, When

if TYPE_CHECKING:
    from .results import Result

# Moments of static stages have one time. Those of a Dataset differ by this much, so that times can be looked up, s.
_APART = 1e-6


def distinct_times(time: np.ndarray) -> np.ndarray:
    """Times that grow strictly: where several are equal, the later ones are a microsecond apart."""
    found = time.copy()
    for k in range(1, len(found)):
        found[k] = max(found[k], found[k - 1] + _APART)
    return found


def to_xarray(run: Result, rows: slice = slice(None)) -> Any:
    """Frames as xarray.Dataset: dimensions time, vertex, block, component and stress_component; units in the attributes.

    Moments of static stages have one time; in the coordinate `time` they are a microsecond apart. `simulated_time` has the true ones.
    """
    xarray = _optional.need("xarray", "Result.to_xarray")
    file, frames, blocks = run._file, run.frames, run.blocks
    # Rows that are complete, in order.
    begin, stop, step = rows.indices(len(frames))
    if step < 1:
        raise ValueError(f"found frames in steps of {step}; expected 1 or more")
    rows = slice(begin, max(stop, begin), step)
    quantities = {
        "displacement": ("time", "vertex", "component"),
        "velocity": ("time", "block", "component"),
        "stress": ("time", "block", "stress_component"),
        "status": ("time", "block"),
        "order": ("time", "block"),
    }
    of_elements = ("force", "elongation", "yielded", "present")
    variables: dict[str, Any] = {}
    for name, dimensions in quantities.items():
        dataset = f"frames/{name}"
        if file.has(dataset):
            attributes = {"units": file.unit(dataset), "description": file.description(dataset)}
            variables[name] = (dimensions, file.read(dataset, rows), attributes)
    for name in of_elements if file.has("elements/name") else ():
        dataset = f"elements/{name}"
        attributes = {"units": file.unit(dataset), "description": file.description(dataset)}
        variables[f"element_{name}"] = (("time", "element"), file.read(dataset, rows), attributes)
    flags = {"flag_values": np.arange(len(STATUS), dtype=np.uint8), "flag_meanings": " ".join(s.replace(" ", "_") for s in STATUS)}
    variables["status"][2].update(flags)
    metres = {"units": "m"}
    coordinates = {
        "time": ("time", distinct_times(frames.time)[rows], {"units": "s"}),
        "simulated_time": ("time", frames.time[rows], {"units": "s"}),
        "stage": ("time", frames.stage[rows], {"names": run.stages.planned}),
        "step": ("time", frames.step[rows]),
        "component": ["x", "y"],
        "stress_component": ["xx", "yy", "xy"],
        "x": ("vertex", blocks.vertices[:, 0], metres),
        "y": ("vertex", blocks.vertices[:, 1], metres),
        "vertex_block": ("vertex", blocks.outlines.vertex_block),
        "block": ("block", np.arange(len(blocks))),
        "block_name": ("block", np.asarray(blocks.names, dtype=str)),
        "block_x": ("block", blocks.centroid[:, 0], metres),
        "block_y": ("block", blocks.centroid[:, 1], metres),
        "area": ("block", blocks.area, {"units": "m2"}),
        "density": ("block", blocks.density, {"units": "kg/m3"}),
        "fixed": ("block", blocks.fixed),
    }
    if file.has("elements/name"):
        coordinates["element"] = ("element", np.asarray(file.texts("elements/name"), dtype=str))
    attributes = {"title": run.title, "source": f"keyblock {file.attribute('version')}"}
    return xarray.Dataset(variables, coordinates, attributes)


def to_geodataframe(run: Result, time: When = None, crs: Any = None) -> Any:
    """Blocks as they lie at a moment, as geopandas.GeoDataFrame; excavated ones are left out.

    Columns: block, name, status, fixed, area, density, ux, uy, displacement (m, of the centroid since the start), vx, vy (m/s),
    sxx, syy, sxy, sigma_1 (the larger), sigma_3 (Pa, tension positive), slip (m, the largest of its joints). `crs`: of the
    coordinates, as geopandas takes it; those of a section have none.
    """
    geopandas = _optional.need("geopandas", "Result.to_geodataframe")
    shapely = _optional.need("shapely.geometry", "Result.to_geodataframe")
    blocks, frame = run.blocks, run.frames.at(time)
    contacts = run.contact_snapshots.near(frame)
    which = np.flatnonzero(frame.is_there)
    vertices, principal = frame.vertices, frame.principal[0]
    shapes = []
    for b in which:
        outer, *holes = blocks.outlines.of(int(b), vertices)
        shapes.append(shapely.Polygon(outer, holes))
    u = frame.block_displacement
    columns = {
        "block": np.arange(len(blocks)),
        "name": np.asarray(blocks.names, dtype=object),
        "status": np.asarray(frame.status_names, dtype=object),
        "fixed": blocks.fixed,
        "area": blocks.area,
        "density": blocks.density,
        "ux": u[:, 0],
        "uy": u[:, 1],
        "displacement": np.hypot(u[:, 0], u[:, 1]),
        "vx": frame.velocity[:, 0],
        "vy": frame.velocity[:, 1],
        "sxx": frame.stress[:, 0],
        "syy": frame.stress[:, 1],
        "sxy": frame.stress[:, 2],
        "sigma_1": principal[:, 0],
        "sigma_3": principal[:, 1],
        "slip": np.full(len(blocks), np.nan) if contacts is None else contacts.slip_of_blocks,
    }
    found = geopandas.GeoDataFrame({name: column[which] for name, column in columns.items()}, geometry=shapes, crs=crs)
    pascal, metres, speed = "Pa", "m", "m/s"
    found.attrs = {
        "time": frame.time,
        "stage": frame.stage,
        "units": {"area": "m2", "density": "kg/m3", "vx": speed, "vy": speed}
        | dict.fromkeys(("ux", "uy", "displacement", "slip"), metres)
        | dict.fromkeys(("sxx", "syy", "sxy", "sigma_1", "sigma_3"), pascal),
    }
    return found
