"""Whether the datasets of result.h5 fit each other. All that reads them may rely on it: what does not fit is a damaged file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .errors import DamagedError

if TYPE_CHECKING:
    from ._hdf5 import ResultFile

# Sizes by letter: n blocks, v vertices, r starts of rings, m elements, j joints, w breaks. A letter takes the size where it is met first.
_MODEL = {
    "model/block_area": "n",
    "model/block_centroid": "n2",
    "model/block_density": "n",
    "model/block_fixed": "n",
    "model/block_name": "n",
    "model/block_order": "n",
    "model/block_poisson": "n",
    "model/block_stress_ratio_zz": "n",
    "model/block_young": "n",
    "model/vertices": "v2",
    "model/edge_index": "v",
    "model/edge_kind": "v",
    "model/edge_trace": "v",
    "model/ring_start": "r",
    "model/block_rings": "b",
    "frames/time": "t",
    "frames/stage": "t",
    "frames/step": "t",
    "frames/displacement": "tv2",
    "frames/order": "tn",
    "frames/status": "tn",
    "frames/stress": "tn3",
    "frames/velocity": "tn2",
    "elements/name": "m",
    "elements/kind": "m",
    "elements/limit": "m",
    "elements/spacing": "m",
    "elements/reference": "m22",
    "elements/block": "m2",
    "elements/ends": "tm22",
    "elements/present": "tm",
    "elements/force": "tm",
    "elements/elongation": "tm",
    "elements/yielded": "tm",
    "contacts/block_a": "c",
    "contacts/block_b": "c",
    "contacts/contact": "c",
    "contacts/edge_index": "c",
    "contacts/edge_kind": "c",
    "contacts/normal": "c2",
    "contacts/position": "c2",
    "contacts/state": "c",
    "contacts/water_pressure": "c",
    "contacts/time": "s",
    "contacts/stage": "s",
    "contacts/step": "s",
    "contacts/end": "s",
    "histories/time": "h",
    "histories/step": "h",
    "histories/values": "hpq",
    "histories/element_names": "f",
    "histories/element_values": "hf2",
    "breaks/time": "w",
    "breaks/stage": "w",
    "breaks/step": "w",
    "breaks/mode": "w",
    "breaks/position": "w2",
    "breaks/length": "w",
    "breaks/block_a": "w",
    "breaks/block_b": "w",
    "breaks/edge_kind": "w",
    "breaks/edge_index": "w",
    "breaks/trace": "w",
    "breaks/element": "w",
    "steps/time": "k",
    "steps/stage": "k",
    "steps/step": "k",
    "steps/step_size": "k",
    "steps/iterations": "k",
    "steps/closed_contacts": "k",
    "steps/penetration": "k",
    "steps/max_displacement": "k",
    "steps/energy": "ke",
}
_TEXTS = frozenset({"model/block_name", "elements/name", "elements/kind", "histories/element_names"})
# Rows that a run still writes, which are not complete at the same time.
_GROWING = frozenset("tcshkw")


def check(file: ResultFile) -> None:
    """Throws DamagedError, which names what does not fit. Reads the shapes, and the places where snapshots end."""
    sizes: dict[str, tuple[int, str]] = {}
    from .contacts import NUMBERS  # which needs files that fit

    of_contacts = {f"contacts/{name}": "c" for name in (*NUMBERS, *file.contact_numbers())}
    of_joints = {f"joints/{name}": "j" for name in file.names_in("joints")}
    for name, letters in (of_contacts | of_joints | _MODEL).items():
        if not file.has(name):
            continue
        shape = file.shape(name)
        if len(shape) != len(letters):
            raise _damaged(file, f"{name} has {len(shape)} dimensions, not {len(letters)}")
        if name not in _TEXTS and file.kind(name) not in "iuf":
            raise _damaged(file, f"{name} holds no numbers")
        for letter, size in zip(letters, shape, strict=True):
            if letter in _GROWING and file.grows:
                continue
            known, first = (int(letter), "") if letter.isdigit() else sizes.setdefault(letter, (size, name))
            if size != known:
                raise _damaged(file, f"{name} has a size of {size}, not {known}{f' as {first}' if first else ''}")
    _check_places(file, sizes)
    for name, letter in (("elements/name", "m"), ("histories/element_names", "f")):
        if letter in sizes and (not file.has(name) or len(file.texts(name)) != sizes[letter][0]):
            raise _damaged(file, f"there are not {sizes[letter][0]} names in {name}")


def _check_places(file: ResultFile, sizes: dict[str, tuple[int, str]]) -> None:
    """Places in other datasets; those of rings are looked at where rings are made."""
    blocks = sizes.get("n", (0, ""))[0]
    if file.has("model/block_excavations") and file.has("model/excavation") and blocks:
        places = file.read("model/block_excavations")
        last = file.shape("model/excavation")[0]
        if places.shape != (blocks + 1,) or places[0] != 0 or places[-1] != last or not _ascends(places):
            raise _damaged(file, f"model/block_excavations does not ascend from 0 to {last}")
    if file.has("breaks/mode") and "w" in sizes:
        for name, least, count in (("mode", 0, 3), ("edge_kind", 0, 5), ("element", -1, sizes.get("m", (0, ""))[0])):
            if not _are_places(file.read(f"breaks/{name}"), least, count):
                raise _damaged(file, f"breaks/{name} has numbers that name nothing")
    if file.has("contacts/end") and "c" in sizes:
        ends = file.read("contacts/end")
        if len(ends) and (not _ascends(ends) or ends[0] < 0 or ends[-1] > sizes["c"][0]):
            raise _damaged(file, "contacts/end does not ascend to the number of contacts")


def _are_places(numbers: np.ndarray, least: int, count: int) -> bool:
    return bool(((numbers >= least) & (numbers < count)).all())


def _ascends(places: np.ndarray) -> bool:
    return bool((np.diff(places.astype(np.int64)) >= 0).all())


def _damaged(file: ResultFile, what: str) -> DamagedError:
    return DamagedError(f"{file.path} is damaged: {what}")
