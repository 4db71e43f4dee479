"""Motions and traces of other libraries: what cannot be put together rightly is refused. Stand-ins have the attributes that are used."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from conftest import optional

kb = optional("keyblock")
optional("keyblock._core")


def trace(channel: str, data: Any, start: float | None = None, **stats: Any) -> SimpleNamespace:
    times = {} if start is None else {"starttime": start}
    return SimpleNamespace(data=data if isinstance(data, np.ma.MaskedArray) else np.array(data, float), stats=SimpleNamespace(**{"channel": channel, "delta": 0.01, **times, **stats}))


def test_records_that_start_apart_are_aligned() -> None:
    """The ground moves along 45°; the second instrument triggered 0.46 s later."""
    time = np.arange(0.0, 10.0, 0.01)
    ground = np.sin(2 * np.pi * 0.5 * time)
    for first, second in ((0, 46), (46, 0)):
        motion = kb.Motion.from_obspy(trace("HNE", ground[first:], first * 0.01), trace("HNN", ground[second:], second * 0.01), section=45.0)
        assert motion.x == pytest.approx(np.sqrt(2.0) * ground[46:], abs=1e-12)
    pulse = kb.Motion.from_obspy(trace("HNE", [0, 0, 1, 0, 0], 0.0), trace("HNN", [0, 1, 0, 0, 0], 0.01), section=45.0)
    assert pulse.x.max() == pytest.approx(np.sqrt(2.0))


@pytest.mark.parametrize(
    ("traces", "words"),
    [
        ([trace("HNE", [1, 2, 3], 0.0), trace("HNN", [1, 2, 3], 0.005)], "0.500 time steps after"),
        ([trace("HNE", [1, 2, 3], 0.0), trace("HNN", [1, 2, 3])], "no start time"),
        ([trace("HNE", [1, 2, 3], 0.0), trace("HNN", [1, 2, 3], 1.0)], "no time in common"),
        ([trace("HNE", np.ma.masked_array([1.0, 999.0, 3.0], [0, 1, 0]))], "a gap, 1 of 3 samples"),
        ([trace("HNE", [1.0, np.nan, 3.0])], "no finite numbers"),
        ([trace("HNE", [1, 2, 3]), trace("HNE", [1, 2, 3])], "of one component"),
        ([trace("HNE", [1, 2, 3]), trace("HNN", [1, 2, 3], delta=0.010001)], "different time steps"),
        ([trace("HNE", [1, 2, 3], calib=2.0)], "calib=True"),
        ([trace("HNE", [1, 2, 3], station="A"), trace("HNN", [1, 2, 3], station="B")], "several stations"),
        ([trace("HN1", [1, 2, 3])], "azimuths"),
    ],
)
def test_traces_that_do_not_fit_are_refused(traces: list[Any], words: str) -> None:
    with pytest.raises(kb.DataError, match=words):
        kb.Motion.from_obspy(*traces, section=45.0)


def test_traces_that_nearly_fit() -> None:
    assert kb.Motion.from_obspy(trace("HNE", [1, 2, 3], delta=0.01 * (1 + 1e-9)), trace("HNN", [1, 2, 3]), section=0.0).x == pytest.approx([1, 2, 3])
    assert kb.Motion.from_obspy(trace("HNE", [1, 2, 3], calib=2.0), section=90.0, calib=True).x == pytest.approx([2, 4, 6])
    assert kb.Motion.from_obspy(trace("HNE", [1, 2, 3], calib=2.0), section=90.0, calib=False).x == pytest.approx([1, 2, 3])
    unmasked = np.ma.masked_array([1.0, 2.0, 3.0], False)
    assert kb.Motion.from_obspy(trace("HNE", unmasked), section=90.0).x == pytest.approx([1, 2, 3])


class Line:
    geom_type = "LineString"
    is_empty = False

    def __init__(self, *coords: tuple[float, float]) -> None:
        self.coords = coords


class Frame(dict[str, Any]):
    """Columns by name, with a geometry and an index, as a GeoDataFrame has them."""

    def __init__(self, geometry: list[Any], **columns: Any) -> None:
        super().__init__(columns)
        self.geometry, self.index, self.columns = geometry, [10 * k for k in range(len(geometry))], list(columns)

    def __len__(self) -> int:
        return len(self.geometry)


LINES = [Line((-5, -4), (5, 3)), Line((-5, 2), (5, 3)), Line((-5, 4), (5, 4.5))]


def test_several_lines_of_one_set() -> None:
    traces = kb.TraceMap.from_geodataframe(Frame(LINES, set=["J1", "J1", "J2"], phi=[20.0, 20.0, 30.0]), name="set", properties={"friction": "phi"})
    scenario = kb.Scenario({"section": {"azimuth": 90.0}, "domain": {"x": [-5, 5], "y": [-5, 5]}, "rock": {"density": 2500.0, "young": 5e9, "poisson": 0.2}, "joints": {"friction": 35.0},
                            "time": {"step": 0.01}, "stage": [{"name": "s", "kind": "settle"}]})  # fmt: skip
    traces.add_to(scenario)
    sim = scenario.simulate()
    assert sim.strength["J1"].friction == pytest.approx(20.0) and sim.strength["J2"].friction == pytest.approx(30.0)


def test_rows_that_cannot_be_used() -> None:
    with pytest.raises(kb.DataError, match="row 0 without a geometry"):
        kb.TraceMap.from_geodataframe(Frame([None]))
    with pytest.warns(UserWarning, match="row 10 without a geometry: left out"):
        assert len(kb.TraceMap.from_geodataframe(Frame([LINES[0], None, LINES[1]]))) == 2
    with pytest.raises(kb.DataError, match="row 10.*column 'set'"):
        kb.TraceMap.from_geodataframe(Frame(LINES, set=["J1", None, "J2"]), name="set")
    with pytest.raises(kb.DataError, match="row 10.*column 'set'"):
        kb.TraceMap.from_geodataframe(Frame(LINES, set=["J1", float("nan"), "J2"]), name="set")
    with pytest.raises(kb.DataError, match="friction"):
        kb.TraceMap.from_geodataframe(Frame(LINES, set=["J1", "J1", "J2"], friction=[20.0, 21.0, 30.0]), name="set", properties=["friction"])
    with pytest.raises(kb.DataError, match="a Point, and traces are lines"):
        kb.TraceMap.from_geodataframe(Frame([SimpleNamespace(geom_type="Point", is_empty=False)]))
    with pytest.raises((kb.DataError, KeyError), match="sett"):
        kb.TraceMap.from_geodataframe(Frame(LINES, set=["J1", "J1", "J2"]), name="sett")
