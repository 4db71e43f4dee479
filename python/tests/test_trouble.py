"""Results that are not there, not finished, damaged, or of another format: each is told in a sentence."""

from __future__ import annotations

import importlib.util
import os
import random
import signal
import subprocess
import time
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import PROGRAM, TUNNEL, optional

import keyblock as kb

HAS_MAPS = importlib.util.find_spec("geopandas") is not None  # a hundred packages, which CI does without


def test_paths_without_results(tmp_path):
    with pytest.raises(kb.NoResultError, match="no such file or folder"):
        kb.open(tmp_path / "nothing")
    with pytest.raises(kb.NoResultError, match=r"a folder without a result\.h5"):
        kb.open(tmp_path)
    with pytest.raises(FileNotFoundError):
        kb.open(tmp_path)
    (tmp_path / "run.json").write_text("{}")
    with pytest.raises(kb.NoResultError, match='keep = "all"'):
        kb.open(tmp_path)
    with pytest.raises(kb.NoResultError, match="neither a plan.json nor a study.json"):
        kb.open_study(tmp_path)
    with pytest.raises(kb.NoResultError, match=r"it has no limit\.json"):
        kb.open_limit(tmp_path)


def test_files_that_are_no_results(tmp_path):
    file = tmp_path / "result.h5"
    for contents in (b"", b"x = 1\n" * 100):
        file.write_bytes(contents)
        with pytest.raises(kb.FormatError, match="is no HDF5 file"):
            kb.open(tmp_path)
    with h5py.File(file, "w") as other:
        other["x"] = 1
    with pytest.raises(kb.FormatError, match="but no result of keyblock"):
        kb.open(file)


def test_a_future_format_is_refused_in_a_sentence(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        file.attrs["format_version"] = np.int32(3)
    with pytest.raises(kb.FormatError) as refused:
        kb.open(copy)
    assert str(refused.value) == f"{copy / 'result.h5'} has format 3, and this package reads formats up to 2: take a newer keyblock"


def test_results_of_earlier_versions_are_read(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        del file["frames/velocity"], file["model/block_young"], file["model/block_poisson"], file["model/block_stress_ratio_zz"]
        file.attrs["format_version"] = np.int32(1)
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in names:
            for attribute in list(file[name].attrs):
                del file[name].attrs[attribute]
    with kb.open(copy) as run:
        assert np.isnan(run.frames.at().velocity).all()
        assert np.isnan(run.blocks.young).all()
        assert len(run.blocks.materials) == 1
        assert run.frames.at().status_names[0] == "in place"


def test_stages_by_the_names_of_earlier_versions(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        for name in ("summary", "run"):
            file[name].resize(0, axis=0)
        text = bytes(file["stages"][:])
        for now, earlier in ((b"pga_m_s2", b"pga"), (b"wall_time_s", b"wall_time"), (b"largest_speed_m_s", b"largest_speed")):
            assert now in text
            text = text.replace(now, earlier)
        file["stages"].resize(len(text), axis=0)
        file["stages"][:] = np.frombuffer(text, dtype=np.uint8)
    with pytest.warns(kb.UnfinishedWarning), kb.open(copy) as run:
        assert run.stages["first earthquake"].pga_m_s2 == pytest.approx(3.0)
        assert run.stages["first earthquake"].wall_time_s > 0.0


def test_numbers_of_contacts_that_later_versions_add(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        gap = file["contacts/gap"][:]
        file["contacts"].create_dataset("twice_the_gap", data=2.0 * gap).attrs["units"] = "m"
    with kb.open(copy) as run:
        contacts = run.contacts()
        assert contacts.twice_the_gap == pytest.approx(2.0 * contacts.gap)
        assert contacts.table()["twice_the_gap"].tolist() == contacts.twice_the_gap.tolist()
        assert contacts.table().attrs["units"]["twice_the_gap"] == "m"
        with pytest.raises(AttributeError, match="contacts have no 'pressure'"):
            contacts.pressure
    with h5py.File(copy / "result.h5", "r+") as file:
        replace(file, "contacts/twice_the_gap", gap[:-1])
    with pytest.raises(kb.DamagedError, match="contacts/twice_the_gap has a size of"):
        kb.open(copy)


def test_datasets_that_are_missing_or_do_not_fit(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        del file["frames/stress"]
    with kb.open(copy) as run, pytest.raises(kb.DamagedError, match="frames/stress is missing"):
        run.frames.at().stress
    with h5py.File(copy / "result.h5", "r+") as file:
        start = file["model/ring_start"][:]
        file["model/ring_start"][:] = np.where(np.arange(len(start)) == 1, start + 10**6, start)
    with kb.open(copy) as run, pytest.raises(kb.DamagedError, match="the parts of model do not fit each other"):
        run.blocks


def test_rows_that_were_never_written_are_damaged(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        del file["stages"]
        file.create_dataset("stages", shape=(10**10,), dtype="u1", chunks=(1024,))
    with kb.open(copy) as run, pytest.raises(kb.DamagedError, match="stages says that it has 10000000000 rows, and holds fewer"):
        run.stages


def test_outlines_of_one_moment_are_read_once(tunnel, monkeypatch):
    read, names = type(tunnel._file).read, []
    monkeypatch.setattr(type(tunnel._file), "read", lambda file, name, *rows: (names.append(name), read(file, name, *rows))[1])
    for block in range(len(tunnel.blocks)):
        ring = tunnel.rings(block)[0]
    assert names.count("frames/displacement") == 1
    np.testing.assert_array_equal(ring, tunnel.frames[-1].rings(len(tunnel.blocks) - 1)[0])
    np.testing.assert_array_equal(tunnel.rings(0, 0.0)[0], tunnel.frames.at(0.0).rings(0)[0])


def replace(file: h5py.File, name: str, data: object) -> None:
    attributes = dict(file[name].attrs)
    del file[name]
    dataset = file.create_dataset(name, data=data)
    for key in ("units", "unit", "description"):
        if key in attributes:
            dataset.attrs[key] = attributes[key]


@pytest.mark.parametrize("how", ["one row less", "one row more", "flat", "empty"])
def test_parts_that_do_not_fit_each_other_are_damaged(copy, how):
    with h5py.File(copy / "result.h5") as file:
        names = [f"{group}/{name}" for group in ("model", "frames", "contacts", "histories", "steps") for name in file[group]]
    undamaged = (copy / "result.h5").read_bytes()
    for name in names:
        (copy / "result.h5").write_bytes(undamaged)
        with h5py.File(copy / "result.h5", "r+") as file:
            data = file[name][()]
            if len(data) < 2 or data.dtype.kind not in "iuf":
                continue
            made = {"one row less": data[:-1], "one row more": np.concatenate([data, data[-1:]]), "flat": data.reshape(-1), "empty": data[:0]}[how]
            if made.shape == data.shape:
                continue
            replace(file, name, made)
        with pytest.raises(kb.DamagedError, match="damaged"), kb.open(copy) as run:
            look_at_everything(run)


@pytest.mark.parametrize("text", [b"[]", b"{}", b"[" * 100_000, b"7", b'{"stages": 1}'])
def test_texts_that_hold_something_else_are_damaged(copy, text):
    undamaged = (copy / "result.h5").read_bytes()
    for name in ("summary", "texts"):
        (copy / "result.h5").write_bytes(undamaged)
        with h5py.File(copy / "result.h5", "r+") as file:
            replace(file, name, np.frombuffer(text, dtype=np.uint8))
        try:
            with kb.open(copy) as run:
                look_at_everything(run)
        except kb.KeyblockError:
            continue


def test_a_file_that_is_cut_short(copy):
    file = copy / "result.h5"
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(kb.DamagedError, match="is damaged"), kb.open(copy) as run:
        look_at_everything(run)


def look_at_everything(run: kb.Result) -> None:
    run.summary
    run.stages
    run.blocks[0]
    for frame in (run.frames[0], run.frames.at()):
        frame.vertices, frame.velocity, frame.stress, frame.status_names, frame.order
    run.contacts().table()
    run.histories
    run.energy
    run.steps


def test_bytes_that_nobody_wrote(copy):
    """Whatever is wrong with a file, it is told as such, or does no harm."""
    file = copy / "result.h5"
    whole = file.read_bytes()
    draw = random.Random(5)
    told = 0
    for _ in range(60):
        damaged = bytearray(whole)
        at = draw.randrange(len(whole))
        damaged[at : at + draw.choice([1, 4, 64])] = draw.randbytes(1)
        file.write_bytes(damaged)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", kb.UnfinishedWarning)
                with kb.open(copy) as run:
                    look_at_everything(run)
        except kb.KeyblockError as error:
            told += 1
            assert "result.h5" in str(error) and "\n" not in str(error)
    assert told > 5


def test_a_run_that_did_not_reach_its_end(copy):
    """Its file has neither summary nor the end of its last stage, and a row in the making."""
    with h5py.File(copy / "result.h5", "r+") as file:
        for name in ("summary", "run"):
            file[name].resize(0, axis=0)
        lines = bytes(file["stages"][:]).split(b"\n")
        text = b"\n".join(lines[:-2]) + b"\n" + lines[-2][:40]
        file["stages"].resize(len(text), axis=0)
        file["stages"][:] = np.frombuffer(text, dtype=np.uint8)
        time_of = file["frames/time"][:]
        time_of[-3:] = np.nan
        file["frames/time"][:] = time_of
    with pytest.warns(kb.UnfinishedWarning, match=f"was stopped; {len(time_of) - 3} frames are there so far, and no summary"):
        run = kb.open(copy)
    with run:
        assert len(run.frames) == len(time_of) - 3
        assert run.stages.names == ["in situ", "excavated", "first earthquake", "after"]
        assert [stage.ended for stage in run.stages] == [True, True, True, False]
        assert run.stages["first earthquake"].pga_m_s2 == pytest.approx(3.0)
        if HAS_MAPS:
            assert run.to_geodataframe() is not None
        with pytest.raises(kb.NoResultError, match="no summary before the run ends"):
            run.summary


def test_a_run_without_contacts_yet_is_drawn(copy, tmp_path):
    optional("matplotlib")
    with h5py.File(copy / "result.h5", "r+") as file:
        file["contacts/time"][:] = np.nan
    with kb.open(copy) as run:
        for color, joints in (("slip", "state"), ("plain", "slip"), ("plain", "opening")):
            run.plot(color=color, joints=joints, forces=True, save=tmp_path / "a.png")
        if HAS_MAPS:
            assert np.isnan(run.to_geodataframe().slip).all()
        with pytest.raises(ValueError, match="there are no contacts yet"):
            run.contacts()


def test_a_run_that_was_interrupted_says_so(copy):
    with h5py.File(copy / "result.h5", "r+") as file:
        text = bytes(file["summary"][:]).replace(b'"interrupted": false', b'"interrupted": true', 1)
        file["summary"].resize(len(text), axis=0)
        file["summary"][:] = np.frombuffer(text, dtype=np.uint8)
    with pytest.warns(kb.UnfinishedWarning, match="the run was stopped before its end"):
        kb.open(copy).close()


def wait_for(condition, seconds: float = 30.0):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.02)
    raise TimeoutError("waited in vain")


def frames_so_far(folder: Path) -> int:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", kb.UnfinishedWarning)
            with kb.open(folder) as run:
                return len(run.frames)
    except kb.KeyblockError:
        return 0


def test_a_run_is_read_while_it_goes_on_and_after_it_was_killed(tmp_path):
    (tmp_path / "long.toml").write_text(TUNNEL.replace("duration = 0.2", "duration = 300.0"))
    command = [PROGRAM, "run", "long.toml", "-o", "out"]
    running = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    out = tmp_path / "out"
    try:
        wait_for(lambda: frames_so_far(out) > 2)
        with pytest.warns(kb.UnfinishedWarning, match="still goes on, or was killed"):
            run = kb.open(out)
        with run:
            seen = len(run.frames)
            assert run.frames.at().vertices.shape == run.blocks.vertices.shape
            wait_for(lambda: len(run.refresh().frames) > seen)
            assert len(run.frames) == seen
            assert run.stages[0].ended
    finally:
        os.kill(running.pid, signal.SIGKILL)
        running.wait()
    assert frames_so_far(out) > seen


def test_a_closed_result_says_so(tunnel_folder):
    run = kb.open(tunnel_folder)
    run.close()
    with pytest.raises(ValueError, match="was closed"):
        run.blocks
