"""result.h5 in plain xarray and netCDF4, without keyblock: each group in a process of its own, as a library that falls ends it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import optional

optional("netCDF4")
optional("xarray")

GROUPS = ["", "frames", "contacts", "histories", "steps", "model"]

LOOK = """
import json, sys
import netCDF4, numpy, xarray
path, group = sys.argv[1], sys.argv[2]
with netCDF4.Dataset(path) as file:
    of = file[group] if group else file
    for variable in of.variables.values():
        variable[:], [variable.getncattr(name) for name in variable.ncattrs()]
with xarray.open_dataset(path, group=group or None) as data:
    data.load()
    print(json.dumps({name: [list(v.dims), list(v.shape), str(v.dtype), v.attrs.get("units", ""), v.values.astype(str).ravel()[:2].tolist()]
                      for name, v in data.variables.items()}))
"""


def look(folder: Path, group: str) -> dict[str, list]:
    done = subprocess.run([sys.executable, "-c", LOOK, str(folder / "result.h5"), group], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, f"{group}: {done.returncode} {done.stderr[-2000:]}"
    return json.loads(done.stdout)


@pytest.mark.parametrize("group", GROUPS)
def test_every_group_opens(tunnel_folder: Path, group: str) -> None:
    variables = look(tunnel_folder, group)
    assert variables
    bytes_of_texts = {"texts", "run", "stages", "summary"}
    phony = {name for name, (dims, *_) in variables.items() if any(dim.startswith("phony") for dim in dims)}
    allowed = bytes_of_texts | {"scenario", "record", "block_rings", "ring_start", "block_excavations", "excavation"}
    assert phony <= allowed


def test_dimensions_units_and_names(tunnel_folder: Path) -> None:
    frames = look(tunnel_folder, "frames")
    assert frames["stress"][0] == ["time", "block", "stress_component"] and frames["stress"][3] == "Pa"
    assert frames["displacement"][0] == ["time", "vertex", "component"] and frames["time"][3] == "s"
    assert look(tunnel_folder, "histories")["values"][0] == ["time", "point", "quantity"]
    assert look(tunnel_folder, "histories")["names"][4] == ["crown"]
    assert look(tunnel_folder, "contacts")["slip"][0] == ["contact"]
    assert look(tunnel_folder, "steps")["energy"][0] == ["time", "energy_term"]
    root = look(tunnel_folder, "")
    assert root["stress_component"][4] == ["xx", "yy"] and root["block"][4] == ["0", "1"]
    assert "[[stage]]" in root["scenario"][4][0]


def test_h5py_reads_the_texts(tunnel_folder: Path) -> None:
    h5py = optional("h5py")
    kb = optional("keyblock")
    with h5py.File(tunnel_folder / "result.h5") as file, kb.open(tunnel_folder) as run:
        assert file["scenario"][0].decode() == run.scenario
        assert [name.decode() for name in file["model/block_name"][:]] == run.blocks.names
        assert list(file["frames/status"].attrs["values"].astype("U")) == ["in place", "loosened", "fallen", "excavated"]
        texts = json.loads(bytes(file["texts"][:]).decode())
        assert texts["scenario"] == run.scenario and texts["history_names"] == ["crown"]
        assert np.allclose(file["frames/time"][:], run.frames.time)
