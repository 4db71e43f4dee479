"""Pictures and films: what is in them, and that the files are what their names say."""

from __future__ import annotations

import os
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import optional

import keyblock as kb

matplotlib = optional("matplotlib")
import matplotlib.pyplot  # noqa: E402

from keyblock import fields, plot, section  # noqa: E402


def collections(ax, kind):
    return [found for found in ax.collections if type(found).__name__ == kind]


@pytest.fixture(autouse=True)
def close_figures():
    yield
    import matplotlib.pyplot as pyplot

    pyplot.close("all")


@pytest.mark.parametrize(("name", "begin"), [("a.pdf", b"%PDF"), ("a.png", b"\x89PNG"), ("a.svg", b"<?xml")])
def test_files(tunnel, tmp_path, name, begin):
    tunnel.plot(save=tmp_path / name)
    assert (tmp_path / name).read_bytes().startswith(begin)
    assert not matplotlib.pyplot.get_fignums()  # what is saved keeps no window open


def test_fonts_stay_text_in_pdf(tunnel, tmp_path):
    tunnel.plot(save=tmp_path / "a.pdf")
    assert b"/Type3" not in (tmp_path / "a.pdf").read_bytes()


def test_a_format_that_cannot_be_written(tunnel, tmp_path):
    with pytest.raises(ValueError, match=r"found the ending '\.doc'; expected pdf, svg, png"):
        tunnel.plot(save=tmp_path / "a.doc")


@pytest.mark.parametrize("color", fields.NAMES)
def test_every_colour(tunnel, color):
    ax = tunnel.plot(0.3, color)
    blocks = collections(ax, "PathCollection")[1]
    assert len(blocks.get_paths()) == (tunnel.frames.at(0.3).is_there & ~tunnel.blocks.fixed).sum()
    shades = {tuple(shade) for shade in blocks.get_facecolors()}
    assert len(shades) > 1 or color in ("density", "material", "order", "plain", "status", "excavation")


def test_the_frame_is_left_out_of_the_limits(tunnel):
    ax = tunnel.plot()
    # The domain is 6 m wide; a margin of the frame around it is shown.
    assert ax.get_xlim() == pytest.approx((-3.18, 3.18), abs=1e-3)
    assert len(collections(ax, "PathCollection")[0].get_paths()) == 1


def test_blocks_far_away_do_not_hide_the_rest(incline_folder):
    with kb.open(incline_folder) as run:
        left, right, _, _ = section.extent(run)
        assert left < 0.0 and right > 10.0  # fixed blocks count where there is no domain


def test_a_window_and_a_title(tunnel):
    ax = tunnel.plot("excavated", window=(-1, 1, -2, 2), title="Crown")
    assert ax.get_xlim() == (-1, 1) and ax.get_ylim() == (-2, 2)
    assert ax.get_title(loc="left") == "Crown"
    assert tunnel.plot("excavated").get_title(loc="left") == "excavated, t = 0.00 s"


def bar_of(ax):
    return ax.child_axes[0]


def test_the_colour_bar_has_a_unit(tunnel):
    assert bar_of(tunnel.plot(color="stress")).get_ylabel() == "Most compressive principal stress in kPa"
    bar = bar_of(tunnel.plot(color="displacement", vmin=0, vmax=2e-3, log=False))
    assert bar.get_ylabel() == "Displacement of the blocks in mm"
    assert bar.get_ylim() == pytest.approx((0.0, 2.0))
    bar = bar_of(tunnel.plot(color="displacement", vmin=1e-5, vmax=1.0, log=True))
    assert [tick.get_text() for tick in bar.get_yticklabels()] == ["10 µm", "100 µm", "1 mm", "10 mm", "100 mm", "1 m"]


def test_scales_are_the_same_for_all_moments(tunnel):
    limits = {bar_of(tunnel.plot(t, "displacement")).get_ylim() for t in ("excavated", 0.3, "after")}
    assert len(limits) == 1


def test_own_values(tunnel):
    values = np.arange(len(tunnel.blocks), dtype=float)
    ax = tunnel.plot(color=values, label="number", cmap="viridis")
    assert bar_of(ax).get_ylabel() == "number"
    with pytest.raises(ValueError, match="expected a number for each of"):
        tunnel.plot(color=np.zeros(3))


def test_words_that_are_not_known(tunnel):
    with pytest.raises(KeyError, match="blocks cannot be coloured by 'displacment'; did you mean 'displacement'"):
        tunnel.plot(color="displacment")
    with pytest.raises(TypeError, match="no option 'joint'; did you mean 'joints'"):
        tunnel.plot(joint="slip")
    with pytest.raises(ValueError, match="joints = 'sliding'; expected 'state', 'slip', 'opening', 'set'"):
        tunnel.plot(joints="sliding")
    with pytest.raises(ValueError, match="expected vmin below vmax"):
        tunnel.plot(vmin=2.0, vmax=1.0)


def test_joints(tunnel):
    contacts = tunnel.contact_snapshots.near(tunnel.frames.at())
    in_rock = (contacts.edge_kind != 4) & (contacts.length > 0.0)
    lines = collections(tunnel.plot(joints="state"), "LineCollection")[1:]
    assert sum(len(found.get_segments()) for found in lines) == in_rock.sum()
    legend = tunnel.plot(joints="set", legend=True).get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["steep", "flat"]
    ax = tunnel.plot(joints="slip")
    assert [bar.get_ylabel().replace("\n", " ") for bar in ax.child_axes] == ["Displacement of the blocks", "Slip of the joints"]
    assert tunnel.plot("in situ", joints="opening") is not None


def test_force_chains_carry_the_weight(tunnel):
    """Of a block that hangs nowhere, the forces that come in from above and below differ by its weight."""
    frame = tunnel.frames.at("in situ")
    look = section.Look.of(tunnel, frame, -1, 1.0, 10.0)
    chains, total = section.pair_forces(look, tunnel.contact_snapshots.near(frame))
    contacts = tunnel.contact_snapshots.near(frame)
    assert total.sum() == pytest.approx(contacts.normal_force[contacts.normal_force > 0.0].sum())
    assert np.isfinite(chains).all()
    # Where blocks touch the frame, the chain ends at the contact and not at the middle of the frame.
    assert np.abs(chains).max() <= 3.0 + 1e-3
    ax = tunnel.plot("in situ", "plain", forces=True)
    assert "force between blocks" in ax.get_legend().get_texts()[0].get_text()


def test_crosses_and_arrows(tunnel):
    ax = tunnel.plot(0.3, "plain", stress=True, arrows="velocity")
    quivers = collections(ax, "Quiver")
    assert len(quivers) == 3
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert names[:2] == ["compression", "tension"] and names[2].startswith("velocity, cut at")
    assert any(text.get_text().endswith(" kPa") for text in ax.texts)
    assert collections(tunnel.plot(0.3, arrows="displacement"), "Quiver")
    assert len(tunnel.plot(0.3, numbers=True).texts) == (tunnel.frames.at(0.3).is_there & ~tunnel.blocks.fixed).sum()


def test_displacement_counts_from_the_excavation(tunnel):
    excavation = tunnel.frames[fields.reference(tunnel)]
    assert excavation.stage == "excavated" and fields.reference(tunnel) == int(np.flatnonzero(tunnel.frames.stage == 1)[0])
    frame = tunnel.frames.at()
    since = fields.displacement_since(tunnel, frame, fields.reference(tunnel))
    np.testing.assert_allclose(since, frame.block_displacement - excavation.block_displacement, atol=1e-15)
    largest = np.hypot(*since[frame.is_there & ~tunnel.blocks.fixed].T).max()
    assert largest == pytest.approx(tunnel.stages[-1].damage.displacement_max_m, rel=1e-4)


def test_before_the_excavation_a_film_shows_no_displacement(tunnel):
    picture = plot.Picture(tunnel, tunnel.frames.at(), plot.Options(), film=True)
    picture.draw(matplotlib.pyplot.subplots()[1])
    picture.move_to(tunnel.frames[0])
    assert not picture.field.values.any()
    # A picture of its own shows what has moved since the start.
    assert plot.Picture(tunnel, tunnel.frames.at("in situ"), plot.Options()).field.values.any()


def test_exaggeration(tunnel):
    frame = tunnel.frames.at()
    plain, large = (section.Look.of(tunnel, frame, -1, e, 10.0) for e in (1.0, 5.0))
    np.testing.assert_allclose(large.at - tunnel.blocks.vertices, 5.0 * (plain.at - tunnel.blocks.vertices), atol=1e-9)


def test_a_scale_bar_in_the_place_of_axes(tunnel):
    ax = tunnel.plot(axes=False)
    assert not ax.axison
    assert "1 m" in [text.get_text() for text in ax.texts]


def test_axes_of_ones_own(tunnel):
    import matplotlib.pyplot as pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(8, 4))
    size = tuple(figure.get_size_inches())
    assert tunnel.plot("excavated", ax=left) is left and tunnel.plot("after", ax=right) is right
    assert tuple(figure.get_size_inches()) == size


def test_a_figure_has_the_width_that_was_asked_for(tunnel, tmp_path):
    PIL = pytest.importorskip("PIL.Image")
    tunnel.plot(save=tmp_path / "a.png", width=100.0, dpi=254.0)
    with PIL.open(tmp_path / "a.png") as image:
        assert image.size[0] == pytest.approx(1000, abs=20)


@pytest.mark.skipif(shutil.which("ffmpeg") is None and not os.environ.get("CI"), reason="ffmpeg is not installed")
def test_a_film_as_mp4(tunnel, tmp_path):
    seen = []
    path = tunnel.animate(tmp_path / "a.mp4", start="excavated", every=4, dpi=60, progress=lambda done, of: seen.append((done, of)))
    assert path.read_bytes()[4:8] == b"ftyp"
    count = len(range(tunnel.frames.at("excavated").index, len(tunnel.frames), 4))
    assert seen[-1] == (count, count)
    command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", path]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert int(said) == count


def test_a_film_as_gif(tunnel, tmp_path):
    PIL = pytest.importorskip("PIL.Image")
    path = tunnel.animate(tmp_path / "a.gif", "velocity", arrows="velocity", joints="state", stop=0.3, every=3, dpi=50)
    with PIL.open(path) as image:
        assert image.n_frames > 1


def test_films_that_cannot_be_made(tunnel, tmp_path):
    with pytest.raises(ValueError, match=r"found the ending '\.avi'; expected \.mp4 or \.gif"):
        tunnel.animate(tmp_path / "a.avi")
    with pytest.raises(ValueError, match="expected every of 1 or more, and start before stop"):
        tunnel.animate(tmp_path / "a.gif", start="after", stop="in situ")


def test_a_picture_moves_on(tunnel):
    """A film's pictures are those that are drawn one by one."""
    options = plot.Options.of("displacement", {"joints": "state"})
    moved = plot.Picture(tunnel, tunnel.frames.at(), options, film=True)
    figure, (left, right) = matplotlib.pyplot.subplots(1, 2)
    moved.draw(left)
    moved.move_to(tunnel.frames.at("excavated"))
    fresh = plot.Picture(tunnel, tunnel.frames.at("excavated"), options, film=True)
    fresh.draw(right)
    for kind in ("PathCollection", "LineCollection"):
        assert len(collections(left, kind)) == len(collections(right, kind))
    ours, theirs = collections(left, "PathCollection")[1], collections(right, "PathCollection")[1]
    np.testing.assert_array_equal(ours.get_facecolors(), theirs.get_facecolors())
    assert left.get_title(loc="left") == right.get_title(loc="left")


def test_the_resultant_lies_where_the_forces_balance():
    """A joint of 1 m with 3 N at its begin and 1 N at its end; another that is pressed at one end alone: a hinge."""
    contacts = SimpleNamespace(
        block_a=np.array([1, 0, 1, 1]),
        block_b=np.array([0, 1, 2, 2]),
        position=np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 2.0], [1.0, 2.0]]),
        normal=np.array([[0.0, 1.0], [0.0, -1.0], [0.0, 1.0], [0.0, 1.0]]),
        normal_force=np.array([3.0, 1.0, 5.0, 0.0]),
    )
    pairs, middle, eccentricity, total = section.eccentricities(contacts)
    assert pairs.tolist() == [[0, 1], [1, 2]]
    assert total.tolist() == [4.0, 5.0]
    assert middle.tolist() == [[0.25, 0.0], [0.0, 2.0]]
    assert np.abs(eccentricity).tolist() == [0.5, 1.0]


def test_the_line_of_thrust_and_the_outline_are_drawn(tunnel):
    ax = tunnel.plot("in situ", "plain", thrust=True, outline=True)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "as the blocks were" in labels
    assert any(label.startswith("line of thrust") for label in labels)
