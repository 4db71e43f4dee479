"""Results whose checksums are right and whose contents are not: each is read, or refused with a reason, by the program and by the package."""

from __future__ import annotations

import random
import resource
import shutil
import subprocess
from collections.abc import Callable
from typing import Any

import h5py
import numpy as np
import pytest
from conftest import PROGRAM

import keyblock as kb

REFUSALS = (kb.FormatError, kb.DamagedError, kb.NoResultError)
CHANGES = 50
SEEDS = 4  # each with so many


def write(file: h5py.File, name: str, data: Any, attributes: dict[str, Any]) -> None:
    del file[name]
    dataset = file.create_dataset(name, data=data)
    for key, value in attributes.items():
        dataset.attrs[key] = value


def numbers(draw: random.Random, data: np.ndarray) -> np.ndarray:
    """One of the numbers, or all, become odd ones."""
    changed = data.copy()
    large = 2**31 - 1 if data.dtype.itemsize >= 4 else 127
    odd: list[float] = [large, 255 if data.dtype.kind == "u" else -1, draw.randint(0, 120)]
    if data.dtype.kind == "f":
        odd += [np.nan, np.inf, 1e300 if data.dtype == np.float64 else 1e38]
    place = draw.choice([0, data.size - 1, draw.randrange(data.size), None])
    if place is None:
        changed[...] = draw.choice(odd)
    else:
        changed.flat[place] = draw.choice(odd)
    return changed


def text(draw: random.Random, file: h5py.File) -> None:
    name = draw.choice(["stages", "run", "summary", "model/record"])
    data, attributes = file[name][()], dict(file[name].attrs)
    is_string = data.dtype.kind in "SO"
    words = (bytes(data.flat[0]) if is_string else bytes(data)).rstrip(b"\0")
    place = draw.randrange(max(1, len(words)))
    changed = draw.choice([words[:place], b"[]", b"{}", b"[" * 100000, b"\xff" + words, words[:place] + bytes([draw.randrange(32, 127)]) + words[place + 1 :]])
    write(file, name, np.array([changed]) if is_string else np.frombuffer(changed, dtype=np.uint8), attributes)


def attribute(draw: random.Random, file: h5py.File, name: str) -> None:
    if draw.random() < 0.5:
        key = draw.choice(list(file[name].attrs) or ["x"])
        file[name].attrs[key] = draw.choice(["", 0, np.zeros(5), "x" * 10000, "m, m"])
    else:
        key = draw.choice(["format", "format_version", "title", "version", "seed", "realization"])
        file.attrs[key] = draw.choice(["", 0, -1, np.zeros(5), "2", 3, "x" * 60000, 2**63 - 1])


def another_object(draw: random.Random, file: h5py.File, name: str) -> None:
    """In the place of a dataset."""
    dtype, shape = file[name].dtype, file[name].shape
    del file[name]
    kind = draw.choice(["nothing", "group", "soft link", "external link", "huge"])
    if kind == "group":
        file.create_group(name)
    elif kind == "soft link":
        file[name] = h5py.SoftLink("/" + name)
    elif kind == "external link":
        file[name] = h5py.ExternalLink("/etc/passwd", "/x")
    elif kind == "huge" and shape:
        file.create_dataset(name, shape=(10**10, *shape[1:]), dtype=dtype, chunks=(1024, *shape[1:]))


def change(draw: random.Random, file: h5py.File) -> str:
    """What was done."""
    names: list[str] = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    name = draw.choice(sorted(names))
    data, attributes = file[name][()], dict(file[name].attrs)
    is_array, is_number = getattr(data, "ndim", 0) > 0, data.dtype.kind in "iuf"
    how = draw.choice(["object", "length", "numbers", "type", "dimensions", "text", "attribute"])
    if how == "object":
        another_object(draw, file, name)
    elif how == "length" and is_array and len(data):
        cut = data[: max(0, len(data) - draw.randint(1, 3))]
        write(file, name, draw.choice([data[:0], cut, np.concatenate([data, data[-1:], data[-1:]]), data.flat[0]]), attributes)
    elif how == "numbers" and is_number and data.size:
        write(file, name, numbers(draw, np.atleast_1d(data)), attributes)
    elif how == "type":
        write(file, name, data.astype(draw.choice(["f8", "i8", "u1", "f4", "i2"])) if is_number else np.zeros(3), attributes)
    elif how == "dimensions" and is_array:
        write(file, name, data.reshape(-1) if data.ndim > 1 else data.reshape(-1, 1), attributes)
    elif how == "text":
        text(draw, file)
    else:
        attribute(draw, file, name)
    return f"{how} of {name}"


def looks(run: kb.Run) -> dict[str, Callable[[], Any]]:
    return {
        "blocks": lambda: (len(run.blocks), repr(run.blocks)),
        "rings": lambda: [run.rings(b) for b in range(min(len(run.blocks), 300))],
        "rings at the end": lambda: [run.rings(b, run.frames.time[-1]) for b in range(min(len(run.blocks), 5))],
        "frames": lambda: (run.frames.time, run.frames[-1], repr(run.frames)),
        "displacement": lambda: run.frames[-1].displacement,
        "contacts": lambda: run.contacts().slip,
        "histories": lambda: repr(run.histories),
        "steps": lambda: repr(run.steps),
        "joints": lambda: repr(run.joints),
        "energy": lambda: repr(run.energy),
        "stages": lambda: list(run.stages),
        "summary": lambda: dict(run.summary),
        "title": lambda: run.title,
        "scenario": lambda: run.scenario,
        "release": lambda: repr(run.release),
    }


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", range(SEEDS))
def test_datasets_that_do_not_fit_together(tunnel_folder, tmp_path, seed):
    draw = random.Random(seed)
    limit = 4 << 30
    wrong = []
    for k in range(CHANGES):
        folder = tmp_path / str(k)
        folder.mkdir()
        shutil.copy(tunnel_folder / "result.h5", folder)
        shutil.copy(tunnel_folder / "summary.json", folder)
        with h5py.File(folder / "result.h5", "r+") as file:
            what = change(draw, file)
        try:
            run = kb.open(folder)
        except REFUSALS:
            run = None
        except Exception as error:
            wrong.append(f"{what}: open: {type(error).__name__}: {error}")
            run = None
        for name, look in looks(run).items() if run else ():
            try:
                look()
            except REFUSALS:
                pass
            except Exception as error:
                wrong.append(f"{what}: {name}: {type(error).__name__}: {str(error)[:200]}")
        if run:
            run.close()
        if k % 4 == 0:
            for words in (["report", folder], ["export", folder, "--format", draw.choice(["csv", "vtk", "geojson"])]):
                done = subprocess.run(
                    [PROGRAM, *map(str, words)],
                    capture_output=True,
                    timeout=60,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
                )
                if done.returncode not in (0, 1):
                    wrong.append(f"{what}: {words[0]}: exit {done.returncode}: {done.stderr.decode(errors='replace')[-300:]}")
        shutil.rmtree(folder)
    assert not wrong, "\n".join(wrong)
