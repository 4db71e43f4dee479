"""What springs and other elements carry, frame by frame."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import keyblock
from conftest import optional

WEIGHT = 2600.0 * 9.81


@pytest.fixture
def anchors(anchors_folder):
    with keyblock.open(anchors_folder) as run:
        yield run


def test_each_frame_has_what_they_carry(anchors):
    last = anchors.frames.at().elements
    assert (last.names, last.kinds) == (["first", "second"], ["spring", "spring"])
    np.testing.assert_allclose(last.force / WEIGHT, [1.1, -0.1], atol=1e-3)
    np.testing.assert_allclose(last.elongation * 6.28319e7, last.force, rtol=1e-6)
    assert last.present.all() and not last.yielded.any()
    np.testing.assert_allclose(last.ends[0, 0], [0.5, 3.0], atol=1e-9)
    assert last.utilization[0] == pytest.approx(1.1 * WEIGHT / 1e5, rel=1e-3) and np.isnan(last.utilization[1])
    assert last.limit[0] == 1e5 and np.isinf(last.limit[1]) and np.isinf(last.spacing).all() and np.isnan(last.force_of_one).all()
    before = anchors.frames[0].elements
    assert before.present.tolist() == [True, False]
    assert last.index_of("second") == 1
    with pytest.raises(KeyError, match="no element 'secnd'.*second"):
        last.index_of("secnd")
    # The end of the run is what the summary says.
    assert anchors.summary["elements"][1]["force_n_m"] == pytest.approx(last.force[1])


def test_bolts_have_the_force_of_one(tmp_path):
    """A block of 2 x 1 m hangs on bolts of which there is one every 1.5 m."""
    scenario = keyblock.Scenario()
    scenario.rock.update(density=2600.0, young=1e10, poisson=0.2)
    scenario.joints.friction = 30.0
    scenario.block.append(name="roof", outer=[[0, 1], [2, 1], [2, 3], [0, 3]], fixed=True)
    scenario.block.append(name="hung", outer=[[0, 0], [2, 0], [2, 1], [0, 1]])
    bar = {"diameter": 0.025, "spacing": 1.5, "yield": 4e5, "grout_stiffness": 8e9, "grout_strength": 4e5}
    scenario.bolt.append({"name": "b", "from": [1, 0], "to": [1, 2.5], **bar})
    scenario.time.step = 0.002
    scenario.stage.append(name="hangs", kind="settle")
    scenario.run(tmp_path / "out")
    with keyblock.open(tmp_path / "out") as run:
        bolts = run.frames[-1].elements
        assert (bolts.names, bolts.kinds, bolts.spacing.tolist()) == (["b"], ["bolt"], [1.5])
        np.testing.assert_allclose(bolts.force, 2 * WEIGHT, rtol=1e-3)
        np.testing.assert_allclose(bolts.force_of_one, 3 * WEIGHT, rtol=1e-3)
        assert run.summary["elements"][0]["force_n"] == pytest.approx(bolts.force_of_one[0])
        assert run.summary["stages"][0]["damage"]["ruptured_elements"] == 0


def test_a_table_has_a_row_for_each(anchors):
    optional("pandas")
    table = anchors.frames.at().elements.table()
    assert table.name.tolist() == ["first", "second"] and "utilization" in table


def test_a_history_follows_one(anchors):
    optional("pandas")
    cell = anchors.histories["cell"]
    assert list(cell.columns) == ["force", "elongation"]
    assert np.isnan(cell["force"].iloc[0])  # not installed yet
    assert cell["force"].iloc[-1] == pytest.approx(-0.1 * WEIGHT, rel=1e-2)
    assert anchors.histories.attrs["units"]["force"] == "N/m"
    assert {"ux", "sxx"} <= set(anchors.histories["b"].columns)


def test_measures_of_a_stage_have_them(anchors):
    damage = anchors.stages["hang"].damage
    assert damage.largest_utilization == pytest.approx(1.2 * WEIGHT / 1e5, rel=1e-3)
    assert damage.yielded_elements == 0


def test_runs_without_have_none(tunnel):
    elements = tunnel.frames.at().elements
    assert len(elements) == 0 and elements.force.shape == (0,) and elements.ends.shape == (0, 2, 2)
    assert "0 elements" in repr(elements)


def test_they_are_drawn_with_their_force(anchors):
    optional("matplotlib")
    lines = lambda ax: [c for c in ax.collections if type(c).__name__ == "LineCollection" and c.get_zorder() == 6.6]  # noqa: E731
    ax = anchors.plot("unload", "plain")
    (drawn,) = lines(ax)
    assert len(drawn.get_segments()) == 2
    first, second = drawn.get_linewidths()
    assert (first, second) == pytest.approx((1.0 + 2.2 * 0.281, 3.2), abs=0.01)  # 28 % of its limit; all of the largest of its kind
    labels = [text.get_text() for text in ax.figure.legends[0].texts] if ax.figure.legends else [t.get_text() for t in ax.get_legend().texts]
    assert any("limit" in label for label in labels)
    assert not lines(anchors.plot("unload", "plain", elements=False))
    (hung,) = lines(anchors.plot("hang", "plain"))
    assert len(hung.get_segments()) == 1
    far = lines(anchors.plot("unload", "plain", exaggeration=1000.0, since="start"))[0].get_segments()
    moved = anchors.frames.at().elements.ends[0, 1] - np.array([0.5, 0.9])
    np.testing.assert_allclose(far[0][1], np.array([0.5, 0.9]) + 1000.0 * moved, rtol=1e-6)


def test_other_libraries_get_them(anchors):
    optional("xarray")
    frames = anchors.to_xarray()
    assert frames.element_force.dims == ("time", "element") and frames.element.values.tolist() == ["first", "second"]


def test_what_does_not_fit_is_damaged(anchors_folder, tmp_path):
    h5py = optional("h5py")
    for change, words in (
        (lambda f: f["elements"].pop("force"), None),
        (lambda f: (f["elements"].pop("limit"), f["elements"].create_dataset("limit", data=[1.0])), "elements/limit"),
        (lambda f: (f["elements"].pop("present"), f["elements"].create_dataset("present", data=[[1]])), "elements/present"),
    ):
        folder = tmp_path / f"copy{words or 'none'}".replace("/", "-")
        shutil.copytree(anchors_folder, folder)
        with h5py.File(folder / "result.h5", "r+") as file:
            change(file)
        with pytest.raises(keyblock.DamagedError, match=words or "elements/force is missing"):
            keyblock.open(folder).frames.at().elements.force  # noqa: B018
