"""Runs as arrays and tables: against what the program itself exports, and against known answers."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, keyblock, optional

import keyblock as kb


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def exported(tunnel_folder: Path) -> Path:
    keyblock("export", tunnel_folder, "--format", "csv", folder=tunnel_folder.parent)
    return tunnel_folder / "csv"


def test_a_run_is_opened_by_its_folder_and_by_its_file(tunnel_folder):
    for path in (tunnel_folder, str(tunnel_folder), tunnel_folder / "result.h5"):
        with kb.open(path) as run:
            assert isinstance(run, kb.Result)
            assert run.title == "A small gallery"
            assert "[[excavation]]" in run.scenario
    assert "tunnel" in repr(kb.open(tunnel_folder))


def test_summary_by_attributes_and_by_items(tunnel, tunnel_folder):
    told = json.loads((tunnel_folder / "summary.json").read_text())
    assert tunnel.summary == told
    assert tunnel.summary.energy.kinetic == tunnel.summary["energy"]["kinetic"] == told["energy"]["kinetic"]
    with pytest.raises(AttributeError, match="did you mean 'energy'"):
        tunnel.summary.enrgy


def test_stages_by_name_and_number(tunnel):
    assert tunnel.stages.names == ["in situ", "excavated", "first earthquake", "after"]
    stage = tunnel.stages["first earthquake"]
    assert stage is tunnel.stages[2]
    assert stage.kind == "shake" and stage.ended and stage.index == 2
    assert stage.damage == tunnel.summary.stages[2].damage
    assert stage.pga_m_s2 == pytest.approx(3.0)
    assert tunnel.stages["excavated"].excavate == ["gallery"]
    assert tunnel.stages[-1].end_time == pytest.approx(tunnel.frames.time[-1])
    with pytest.raises(KeyError, match="did you mean 'first earthquake'"):
        tunnel.stages["frst earthquake"]
    with pytest.raises(IndexError, match="4 stages"):
        tunnel.stages[4]


def test_the_motion_of_a_stage_is_the_sine_that_was_asked_for(tunnel):
    optional("pandas")
    motion = tunnel.stages["first earthquake"].motion
    assert motion.x.abs().max() == pytest.approx(3.0, rel=0.02)
    assert motion.y.abs().max() == 0.0
    assert motion.attrs["units"]["x"] == "m/s2"


def test_stages_as_a_table(tunnel):
    optional("pandas")
    table = tunnel.stages.table()
    assert table.loc["after", "fallen_area_m2"] == tunnel.stages["after"].damage.fallen_area_m2


def test_strengths_of_joints_are_those_of_the_exported_table(tunnel, exported):
    with open(exported / "joints.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    table = tunnel.joints
    assert list(table["joint"]) == [row["name"] for row in rows]
    for name in ("length", "friction", "cohesion"):
        assert list(table[name]) == [float(row[name]) for row in rows]
    assert table.attrs["units"]["cohesion"] == "Pa"
    assert np.isnan(table["residual_friction"]).all() and (table["trace"] == -1).all(), "all traces of a set are alike"
    blocks = tunnel.blocks
    is_joint = np.isin(blocks.edge_kind, (1, 2))
    assert (blocks.edge_trace[is_joint] >= 0).all() and (blocks.edge_trace[~is_joint] == -1).all()


def test_frames_are_those_of_the_exported_table(tunnel, exported):
    of_frames: dict[int, list[dict[str, str]]] = {}
    for row in rows_of(exported / "blocks.csv"):
        of_frames.setdefault(int(row["frame"]), []).append(row)
    assert sorted(of_frames) == list(range(len(tunnel.frames)))
    for k in (0, len(tunnel.frames) // 2, len(tunnel.frames) - 1):
        frame, rows = tunnel.frames[k], of_frames[k]
        blocks = [int(row["block"]) for row in rows]
        assert blocks == np.flatnonzero(frame.is_there).tolist()
        assert float(rows[0]["time"]) == frame.time and int(rows[0]["step"]) == frame.step

        def column(name: str, rows: list[dict[str, str]] = rows) -> np.ndarray:
            return np.array([float(row[name]) for row in rows])

        np.testing.assert_allclose(frame.centroid[blocks], np.column_stack([column("x"), column("y")]), atol=1e-9)
        np.testing.assert_allclose(frame.block_displacement[blocks], np.column_stack([column("ux"), column("uy")]), atol=1e-9)
        np.testing.assert_allclose(frame.stress[blocks].T, [column("sxx"), column("syy"), column("sxy")], rtol=1e-5, atol=1e-3)
        assert [frame.status_names[b] for b in blocks] == [row["status"] for row in rows]


def test_contacts_are_those_of_the_exported_table(tunnel, exported):
    rows = [row for row in rows_of(exported / "contacts.csv") if int(row["step"]) == tunnel.contacts().step]
    contacts = tunnel.contacts()
    assert len(contacts) == len(rows) > 0
    for name in ("length", "gap", "slip", "normal_force", "shear_force", "block_a", "block_b"):
        np.testing.assert_allclose(getattr(contacts, name), [float(row[name]) for row in rows], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(contacts.position, [[float(row["x"]), float(row["y"])] for row in rows], rtol=1e-9)
    assert contacts.state_names == [row["state"] for row in rows]
    kinds = {"free", "domain"}
    assert contacts.edge_names == [row["edge"] if row["edge"] in kinds else row["edge_name"] for row in rows]


def test_histories_are_those_of_the_csv(tunnel, tunnel_folder):
    pandas = optional("pandas")
    table = pandas.read_csv(tunnel_folder / "histories.csv", index_col="time")
    histories = tunnel.histories
    assert histories.columns.names == ["point", "quantity"]
    for quantity in ("ux", "uy", "vx", "vy", "sxx", "syy", "sxy", "ax", "ay"):
        np.testing.assert_allclose(histories["crown", quantity], table[f"crown.{quantity}"], rtol=1e-12)
    assert histories["crown"].ux.name == "ux"
    assert histories.attrs["units"]["vx"] == "m/s"
    assert histories.attrs["units"]["ax"] == "m/s2"


def test_a_run_without_points_has_an_empty_table(heading_folder):
    optional("pandas")
    with kb.open(heading_folder) as run:
        assert run.histories.shape[1] == 0
        assert run.histories.columns.names == ["point", "quantity"]


def test_release_is_that_of_the_exported_table(heading_folder, tunnel):
    pandas = optional("pandas")
    assert tunnel.release is None
    keyblock("export", heading_folder, "--format", "csv", folder=heading_folder.parent)
    with kb.open(heading_folder) as run:
        pandas.testing.assert_frame_equal(run.release, pandas.read_csv(heading_folder / "csv/release.csv"))
        assert run.release.attrs["units"]["crown"] == "m"


def test_elements_are_those_of_the_exported_table(tmp_path, tunnel):
    pandas = optional("pandas")
    assert tunnel.elements is None
    keyblock("run", ROOT / "verification/scenarios/hanging_block.toml", "-o", "hung", folder=tmp_path)
    keyblock("export", "hung", "--format", "csv", folder=tmp_path)
    with kb.open(tmp_path / "hung") as run:
        table = pandas.read_csv(tmp_path / "hung/csv/elements.csv")
        # A block that is let go on a spring pulls at it with twice its weight.
        assert run.elements.peak_force_n_m[0] == pytest.approx(2 * 9.81 * 2600.0, rel=0.01)
        for name in ("force_n_m", "elongation_m", "peak_force_n_m", "from_y"):
            assert run.elements[name].to_numpy() == pytest.approx(table[name].to_numpy(), rel=1e-12)


def test_energy_and_steps(tunnel, exported):
    optional("pandas")
    rows = rows_of(exported / "steps.csv")
    assert len(tunnel.energy) == len(tunnel.steps) == len(rows)
    np.testing.assert_allclose(tunnel.energy.kinetic, [float(row["kinetic"]) for row in rows])
    assert tunnel.steps.iterations.tolist() == [int(row["iterations"]) for row in rows]
    assert tunnel.energy.attrs["units"]["kinetic"] == "J/m"
    assert tunnel.energy.attrs["units"]["residual_ratio"] == ""
    assert tunnel.steps.attrs["units"]["penetration"] == "m"


def test_a_block_slides_as_far_as_it_should(incline_folder):
    way = 0.5 * 9.81 * (math.sin(math.radians(30)) - math.cos(math.radians(30)) * math.tan(math.radians(20)))
    with kb.open(incline_folder) as run:
        slider = run.blocks.index_of("slider")
        assert np.hypot(*run.frames.at(1.0).block_displacement[slider]) == pytest.approx(way, rel=2e-3)
        assert np.hypot(*run.frames.at(1.0).velocity[slider]) == pytest.approx(2.0 * way, rel=1e-2)
        assert run.frames[0].block_displacement[slider] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_forces_on_a_block_at_rest_are_its_weight(out):
    settle = ("--set", 'stage.slide.kind="settle"', "--set", "joints.friction=40.0")
    scenario = (ROOT / "examples/03-block-on-incline.toml").read_text().replace("duration = 1.0", "")
    out.mkdir(exist_ok=True)
    (out / "rest.toml").write_text(scenario)
    keyblock("run", "rest.toml", "-o", "rest", "--force", *settle, folder=out)
    with kb.open(out / "rest") as run:
        block = run.blocks["slider"]
        weight = block.area * block.density * 9.81
        np.testing.assert_allclose(run.contacts().force_on("slider"), [0.0, weight], atol=0.01 * weight)
        np.testing.assert_allclose(run.contacts().force_on("base"), [0.0, -weight], atol=0.01 * weight)
        principal, angle = run.frames.at().principal
        s = run.frames.at().stress[block.index].astype(float)
        c, n = math.cos(angle[block.index]), math.sin(angle[block.index])
        assert principal[block.index].sum() == pytest.approx(s[0] + s[1])
        assert s[0] * c * c + s[1] * n * n + 2.0 * s[2] * c * n == pytest.approx(principal[block.index, 0], abs=1.0)


# ── moments ──


def test_the_nearest_frame(tunnel):
    time = tunnel.frames.time
    assert tunnel.frames.at(0.31).index == int(np.argmin(np.abs(time - 0.31)))
    # Of the static frames at 0 s the last.
    assert tunnel.frames.at(0.0).index == int(np.flatnonzero(time == 0.0)[-1])
    assert tunnel.frames.at().index == len(time) - 1
    assert tunnel.frames.at("excavated").index == int(np.flatnonzero(tunnel.frames.stage == 1)[-1])
    assert tunnel.frames[-1].index == len(time) - 1
    assert [frame.index for frame in tunnel.frames[1:6:2]] == [1, 3, 5]
    assert len(list(tunnel.frames)) == len(time)


def test_moments_that_are_not_there(tunnel):
    with pytest.raises(ValueError, match=r"no frames at 100 s: there are some from 0 to 0\.7"):
        tunnel.frames.at(100.0)
    with pytest.raises(KeyError, match="did you mean 'after'"):
        tunnel.frames.at("aftr")
    with pytest.raises(IndexError, match="no frame 5000"):
        tunnel.frames[5000]
    with pytest.raises(ValueError, match="no contacts at -3 s"):
        tunnel.contacts(-3.0)


def test_contacts_belong_to_a_moment(tunnel):
    assert tunnel.contacts("excavated").stage == "excavated"
    assert tunnel.contacts("excavated").step == tunnel.frames.at("excavated").step
    assert tunnel.contact_snapshots.near(tunnel.frames.at("excavated")).step == tunnel.frames.at("excavated").step
    assert tunnel.contact_snapshots.time[-1] == tunnel.contacts().time


# ── blocks ──


def test_outlines(tunnel):
    frame_block = tunnel.blocks["frame"]
    assert frame_block.fixed and len(frame_block.holes) == 1
    for block in tunnel.blocks:
        twice = [np.sum(r[:, 0] * np.roll(r[:, 1], -1) - np.roll(r[:, 0], -1) * r[:, 1]) for r in block.rings]
        assert twice[0] > 0.0 and all(t < 0.0 for t in twice[1:])
        assert 0.5 * sum(twice) == pytest.approx(block.area, rel=1e-9)
    np.testing.assert_allclose(tunnel.blocks.outlines.centroids(tunnel.blocks.local), tunnel.blocks.centroid, atol=1e-9)


def test_outlines_of_blocks_as_they_lie(tunnel):
    last = tunnel.frames.at()
    for ring, reference in zip(tunnel.rings(3), tunnel.blocks[3].rings):
        start = int(np.flatnonzero((tunnel.blocks.vertices == reference[0]).all(axis=1) & (tunnel.blocks.outlines.vertex_block == 3))[0])
        np.testing.assert_allclose(ring - reference, last.displacement[start : start + len(ring)], atol=1e-12)
    assert (tunnel.rings(3)[0] == last.rings(3)[0]).all()


def test_coordinates_are_real_ones(far_folder):
    with kb.open(far_folder) as run:
        assert run.blocks["far"].outline[0] == pytest.approx([466014.0, 6699999.0])
        assert run.blocks.area[run.blocks.index_of("dart")] == pytest.approx(1.33185)
        fallen = run.frames.at(0.1).centroid[run.blocks.index_of("far")]
        assert fallen == pytest.approx([466014.25, 6699999.25 - 9.81 / 2 * 0.1**2], abs=1e-3)


def test_blocks_by_name_index_and_as_a_table(tunnel):
    optional("pandas")
    assert tunnel.blocks[-1].index == len(tunnel.blocks) - 1
    assert len(tunnel.blocks[2:5]) == 3
    with pytest.raises(KeyError, match="no block 'fram'; did you mean 'frame'"):
        tunnel.blocks["fram"]
    with pytest.raises(IndexError, match="no block 5000"):
        tunnel.blocks[5000]
    table = tunnel.blocks.table()
    assert table.area.sum() == pytest.approx(tunnel.blocks.area.sum())
    assert (table.excavation == "gallery").sum() == (tunnel.frames.at().status == 3).sum() > 0
    assert table.attrs["units"]["young"] == "Pa"


def test_materials(tunnel, out):
    assert tunnel.blocks.materials == pytest.approx(np.array([[2500.0, 2.0e9, 0.2]]))
    assert set(tunnel.blocks.material.tolist()) == {-1, 0}
    layered = (ROOT / "tests/data/study/gallery.toml").read_text().split("[study]")[0]
    layered += '\n[[region]]\nname = "soft"\nouter = [[-3, -3], [3, -3], [3, -2], [-3, -2]]\nyoung = 1.0e9\n'
    (out / "layers.toml").write_text(layered)
    keyblock("run", "layers.toml", "-o", "layers", "--force", folder=out)
    with kb.open(out / "layers") as run:
        assert run.blocks.materials == pytest.approx(np.array([[2500.0, 1.0e9, 0.2], [2500.0, 2.0e9, 0.2]]))
        soft = run.blocks.material == 0
        assert run.blocks.centroid[soft, 1].max() < run.blocks.centroid[run.blocks.material == 1, 1].mean()


@pytest.mark.parametrize("name", ["tunnel", "heading"])
def test_stretches_of_joint_lie_between_their_blocks(name, request):
    """Along joints of rock in place, both ends of the stretch of each contact lie on the outlines of both blocks."""
    geometry = pytest.importorskip("shapely.geometry")
    with kb.open(request.getfixturevalue(f"{name}_folder")) as run:
        contacts, frame = run.contacts("in situ"), run.frames.at("in situ")
        joints = np.flatnonzero((contacts.edge_kind == 1) & (contacts.length > 0.0))
        assert len(joints) > 50
        shapes = [geometry.Polygon(rings[0], rings[1:]).boundary for rings in (frame.rings(b) for b in range(len(run.blocks)))]
        stretches = contacts.stretches(frame.local)[joints]
    for ends, a, b in zip(stretches, contacts.block_a[joints], contacts.block_b[joints]):
        for end in ends:
            assert max(shapes[a].distance(geometry.Point(end)), shapes[b].distance(geometry.Point(end))) < 1e-3
    assert np.hypot(*(stretches[:, 1] - stretches[:, 0]).T) == pytest.approx(contacts.length[joints])


# ── other libraries ──


def test_xarray(tunnel):
    optional("xarray")
    found = tunnel.to_xarray()
    assert dict(found.sizes) == {
        "time": len(tunnel.frames),
        "vertex": len(tunnel.blocks.local),
        "block": len(tunnel.blocks),
        "component": 2,
        "stress_component": 3,
    }
    k = tunnel.frames.at(0.3).index
    np.testing.assert_array_equal(found.displacement.sel(time=0.3, method="nearest"), tunnel.frames[k].displacement)
    np.testing.assert_array_equal(found.stress.sel(stress_component="yy")[k], tunnel.frames[k].stress[:, 1])
    np.testing.assert_array_equal(found.simulated_time, tunnel.frames.time)
    assert (np.diff(found.time) > 0.0).all()
    assert np.abs(found.time - found.simulated_time).max() < 1e-3
    assert found.velocity.attrs["units"] == "m/s" and found.x.attrs["units"] == "m"
    assert tunnel.to_xarray(slice(2, 9, 3)).sizes["time"] == 3
    assert tunnel.to_xarray(slice(-1, None)).time.item() == pytest.approx(tunnel.frames.time[-1], abs=1e-3)


def test_geodataframe_is_what_is_exported(far_folder, tunnel, tmp_path):
    geopandas = pytest.importorskip("geopandas")  # a hundred packages, which CI does without
    keyblock("export", far_folder, "--format", "geojson", "-o", tmp_path / "geojson", folder=tmp_path)
    told = geopandas.read_file(tmp_path / "geojson/stage_1_fall.geojson")
    with kb.open(far_folder) as run:
        found = run.to_geodataframe("fall")
    assert found.name.tolist() == told.name.tolist()
    for ours, theirs in (("ux", "ux_m"), ("displacement", "displacement_m"), ("syy", "syy_pa")):
        np.testing.assert_allclose(found[ours], told[theirs], rtol=1e-5, atol=1e-9)
    assert all(ours.equals_exact(theirs, 1e-6) for ours, theirs in zip(found.geometry, told.geometry))
    in_rock = tunnel.to_geodataframe()
    assert len(in_rock) == tunnel.frames.at().is_there.sum()
    assert (in_rock.geometry.area[~in_rock.fixed]).sum() == pytest.approx(in_rock.area[~in_rock.fixed].sum(), rel=1e-3)
    assert in_rock.attrs["units"]["sxx"] == "Pa"


def test_the_version_is_that_of_the_program():
    assert f"project(keyblock VERSION {kb.__version__} " in (ROOT / "CMakeLists.txt").read_text()
