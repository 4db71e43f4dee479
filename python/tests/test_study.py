"""Studies and limits as tables, curves and maps: against the files that the program has written."""

from __future__ import annotations

import csv
import json
import shutil

import numpy as np
import pytest
from conftest import optional

import keyblock as kb

SCALE = "stage.'first earthquake'.scale"


@pytest.fixture
def study(study_folder):
    return kb.open(study_folder)


@pytest.fixture
def limit(limit_folder):
    return kb.open(limit_folder)


def test_a_folder_is_recognized(study, limit):
    assert isinstance(study, kb.Study) and isinstance(limit, kb.Limit)
    assert "48 of 48 runs" in repr(study)
    assert "joints.friction until collapsed" in repr(limit)


def test_axes_have_numbers(study):
    assert study.axes == {SCALE: [0.25, 0.5, 1.0, 2.0], "joints.friction": [30.0, 50.0]}
    assert study.title == "A small gallery"
    assert study.failed == []


def test_the_wide_table_is_runs_csv(study, study_folder):
    pandas = optional("pandas")
    told = pandas.read_csv(study_folder / "runs.csv", keep_default_na=False, na_values=[""], float_precision="round_trip")
    found = study.table()
    assert list(found.columns) == list(told.columns)
    assert len(found) == 48
    for name in ("key", "after.fallen_area_m2", SCALE, "first earthquake.pga_m_s2"):
        assert found[name].tolist() == told[name].tolist()


def test_rows_by_stage_and_by_measure(study):
    optional("pandas")
    wide, stages, long = study.table(), study.table("stages"), study.table("long")
    assert len(stages) == 48 * 4
    of_last = stages[stages.stage == "after"]
    assert of_last.displacement_max_m.tolist() == wide["after.displacement_max_m"].tolist()
    measures = len(study.measures) + 3
    assert len(long) == 48 * 4 * measures
    chosen = long[(long.stage == "after") & (long.measure == "displacement_max_m")]
    assert chosen.value.tolist() == wide["after.displacement_max_m"].tolist()
    means = chosen.groupby([SCALE, "joints.friction"]).value.mean()
    assert means.shape == (8,)
    with pytest.raises(ValueError, match="form = 'tall'; expected 'wide', 'stages', 'long'"):
        study.table("tall")


def test_statistics_are_those_of_study_json(study):
    optional("pandas")
    table = study.statistics("displacement_max_m").set_index([SCALE, "joints.friction"])
    told = study.combination({SCALE: 2.0, "joints.friction": 50}).measures.displacement_max_m
    row = table.loc[(2.0, 50.0)]
    assert row["mean"] == told.mean.value and row["mean_high"] == told.mean.high and row["q50"] == told.quantiles[2].value
    probabilities = study.probabilities()
    assert len(probabilities) == 8 and set(probabilities.level) == {"moderate"}
    with pytest.raises(KeyError, match="did you mean 'displacement_max_m'"):
        study.statistics("displacement_max")
    with pytest.raises(KeyError, match="2 combinations have"):
        study.combination({SCALE: 2.0})
    with pytest.raises(KeyError, match="no axis 'friction'"):
        study.combination({"friction": 2.0})


def test_fragility(study):
    curves = study.fragility("moderate", "pga_m_s2")
    assert [curve.values for curve in curves] == [{"joints.friction": "30.0"}, {"joints.friction": "50.0"}]
    assert len(study.fragility()) == 6 and len(study.fragility(intensity="pgv_m_s")) == 2
    told = [f for f in study.summary.fragility if f.level == "moderate" and f.intensity == "pga_m_s2"]
    for curve, known in zip(curves, told):
        assert (curve.status, curve.why or None, curve.unit, curve.threshold) == (known.status, known.why, "m/s²", 0.0015)
        assert curve.points["exceeded"].tolist() == known.points.exceeded
        assert curve.is_fitted == (known.theta.value is not None)
    with pytest.raises(KeyError, match="no level or intensity 'pga'"):
        study.fragility("moderate", "pga")


def fitted(study, study_folder, tmp_path):
    """The study with a curve of its own in the place of the first one: θ = 2 m/s², β = 0.4."""
    folder = tmp_path / "fitted"
    shutil.copytree(study_folder, folder, ignore=shutil.ignore_patterns("runs"))
    told = json.loads((folder / "study.json").read_text())
    from statistics import NormalDist

    x = np.linspace(0.5, 6.0, 12)
    p = [NormalDist().cdf(np.log(v / 2.0) / 0.4) for v in x]
    told["fragility"][0] |= {"status": "fitted", "why": None, "theta": {"value": 2.0, "low": 1.5, "high": 2.5}}
    told["fragility"][0]["beta"] = {"value": 0.4, "low": 0.2, "high": None}
    told["fragility"][0]["curve"] = {"intensity": x.tolist(), "probability": p, "low": [0.8 * v for v in p], "high": p}
    (folder / "study.json").write_text(json.dumps(told))
    return kb.open(folder).fragility()[0]


def test_the_curve_of_a_fit(study, study_folder, tmp_path):
    curve = fitted(study, study_folder, tmp_path)
    assert curve.is_fitted and curve.theta.value == 2.0 and np.isnan(curve.beta.high)
    assert curve.probability(2.0) == pytest.approx(0.5)
    for x, p in zip(curve.curve["intensity"], curve.curve["probability"]):
        assert curve.probability(x) == pytest.approx(p, abs=1e-12)
    assert curve.probability(0.0) == 0.0
    optional("matplotlib")
    curve.plot(save=tmp_path / "curve.svg")
    assert b"<svg" in (tmp_path / "curve.svg").read_bytes()[:500]


def test_where_there_is_no_curve_the_reason_is_told(study, tmp_path):
    optional("matplotlib")
    for curve in study.fragility():
        if not curve.is_fitted:
            with pytest.raises(ValueError, match="there is no fragility curve of level 'moderate'"):
                curve.probability(1.0)
        ax = curve.plot(save=tmp_path / "points.pdf")
        assert ("no curve" in ax.get_legend().get_texts()[0].get_text()) != curve.is_fitted


def test_maps(study, tmp_path):
    assert len(study.maps) == 8
    found = study.map({SCALE: 2.0, "joints.friction": 30.0})
    told = study.combination({SCALE: 2.0, "joints.friction": 30.0})
    counts = np.array(told.map.fallen)
    assert found.fallen.shape == (study.summary.grid.rows, study.summary.grid.columns)
    assert np.nansum(found.fallen) * found.n == pytest.approx(counts[counts > 0].sum())
    assert np.isnan(found.fallen).sum() == (counts == -1).sum() > 0
    left, right, bottom, top = found.extent
    assert right - left == pytest.approx(found.cell * study.summary.grid.columns) and left <= -1.0 and top >= 1.0
    # The mean area that has fallen, to the cells of the raster.
    areas = [row["after.fallen_area_m2"] for row in study.records() if row[SCALE] == 2.0 and row["joints.friction"] == 30.0]
    assert found.fallen_area == pytest.approx(np.mean(areas), abs=0.1)
    optional("matplotlib")
    ax = found.plot(save=tmp_path / "map.png", loosened=True)
    assert ax.get_xlim() == (left, right)


def test_runs_of_a_study(study, limit):
    row = study.records()[5]
    with study.run(row["key"]) as run:
        assert run.summary.stages[-1].damage.fallen_area_m2 == row["after.fallen_area_m2"]
    with limit.run() as run:
        assert run.title == limit.summary.title
    with pytest.raises(kb.NoResultError):
        study.run("r0000-0000000000")


def test_what_is_missing_is_told(study_folder, tmp_path):
    folder = tmp_path / "study"
    shutil.copytree(study_folder, folder, ignore=shutil.ignore_patterns("runs"))
    told = json.loads((folder / "study.json").read_text())
    told["runs"]["done"] = 40
    (folder / "study.json").write_text(json.dumps(told))
    with pytest.warns(kb.UnfinishedWarning, match="8 of 48 runs are not done yet"):
        kb.open(folder)
    (folder / "study.json").unlink()
    with pytest.raises(kb.NoResultError, match="was not collected yet: keyblock study collect"):
        kb.open(folder)


def test_damaged_and_newer_studies(study_folder, tmp_path):
    folder = tmp_path / "study"
    shutil.copytree(study_folder, folder, ignore=shutil.ignore_patterns("runs"))
    whole = (folder / "study.json").read_text()
    (folder / "study.json").write_text(whole[: len(whole) // 2])
    with pytest.raises(kb.DamagedError, match=r"study\.json is damaged: it is no JSON"):
        kb.open(folder)
    (folder / "study.json").write_text('{"title": "x"}')
    with pytest.raises(kb.DamagedError, match="it has no runs, axes"):
        kb.open(folder)
    (folder / "study.json").write_text(whole)
    rows = (folder / "runs.csv").read_text()
    (folder / "runs.csv").write_text(rows[: len(rows) // 2])
    with pytest.raises(kb.DamagedError, match="a row has more or fewer cells"):
        kb.open(folder).records()
    plan = json.loads((folder / "plan.json").read_text()) | {"format": 7}
    (folder / "plan.json").write_text(json.dumps(plan))
    with pytest.raises(kb.FormatError, match="has format 7, and this package reads format 1"):
        kb.open(folder)


def test_variants_and_texts_of_spreadsheets(study_folder, tmp_path):
    folder = tmp_path / "study"
    shutil.copytree(study_folder, folder, ignore=shutil.ignore_patterns("runs"))
    with (folder / "runs.csv").open(newline="") as file:
        names, *rows = list(csv.reader(file))
    rows[1][names.index("variant")] = "friction-"
    rows[2][names.index("status")], rows[2][names.index("error")] = "failed", "'=SUM(A1)"
    with (folder / "runs.csv").open("w", newline="") as file:
        csv.writer(file).writerows([names, *rows])
    study = kb.open(folder)
    assert len(study.records()) == 47 and len(study.records(variants=True)) == 48
    assert study.records()[1]["error"] == "=SUM(A1)"


def test_a_limit(limit, limit_folder, tmp_path):
    assert limit.key == "joints.friction"
    assert limit.value == pytest.approx(30.0, rel=0.02)
    assert (limit.unit, limit.limits) == ("°", [limit.value])
    assert limit.answer.startswith("The friction angle that is needed is ") and limit.answer.endswith(" moves.")
    assert np.isnan(limit.interval.low)
    assert limit.mean.value == limit.value and np.isnan(limit.mean.low) and np.isnan(limit.standard_deviation)
    assert np.isnan(limit.probability_below_1.value) and limit.hangs_on == {}
    trials = limit.records()
    assert len(trials) == len(limit.realizations[0].trials)
    assert all(trial["met"] == (trial["value"] < limit.value) for trial in trials)
    with pytest.raises(KeyError, match="no realization 3"):
        limit.run(3)
    optional("pandas")
    assert limit.table().met.sum() == sum(trial["met"] for trial in trials)
    optional("matplotlib")
    limit.plot(save=tmp_path / "limit.png")
    assert (tmp_path / "limit.png").read_bytes()[:4] == b"\x89PNG"


def test_a_limit_that_is_still_searched_for(limit_folder, tmp_path):
    told = json.loads((limit_folder / "limit.json").read_text()) | {"complete": False}
    told["median"] = {"value": None, "confidence": 0.95, "interval": None}
    (tmp_path / "limit.json").write_text(json.dumps(told))
    with pytest.warns(kb.UnfinishedWarning, match="the search goes on, or was stopped"):
        assert np.isnan(kb.open(tmp_path).value)


def test_risk_is_that_of_the_command(study, tmp_path):
    with pytest.raises(kb.NoResultError, match="keyblock risk"):
        study.risk()
    (tmp_path / "risk.json").write_text('{"levels": [{"level": "light", "rate": {"value": 1e-3, "low": null, "high": null}}]}')
    assert study.risk(tmp_path)["levels"][0]["rate"]["value"] == 1e-3


def test_curves_tell_of_which_records_they_are(study):
    for curve in study.fragility():
        assert curve.records == 1 and set(curve.sigma) == {"rock", "record", "rest"}
