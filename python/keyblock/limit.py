"""The result of a search for a limit: limit.json and the runs that it is made of."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import colors, figures, record, tables
from .errors import DamagedError, NoResultError, UnfinishedWarning
from .fragility import Estimate
from .study import check_plan

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .results import Result


def _estimate(found: Any) -> Estimate:
    """NaN for what is not known."""
    value, low, high = (math.nan if found.get(name) is None else float(found[name]) for name in ("value", "low", "high"))
    return Estimate(value, low, high)


class Limit:
    """The value of a key at which a criterion begins to hold, for one or more realizations of the rock."""

    def __init__(self, path: str | Path, *, warn: bool = True) -> None:
        """`path` is the folder of the search. Throws NoResultError, FormatError and DamagedError."""
        self.path = Path(path)
        if not (self.path / "limit.json").exists():
            raise NoResultError(f"{self.path}: no folder of keyblock limit: it has no limit.json")
        check_plan(self.path)
        self.summary: record.Record = record.read(self.path / "limit.json")
        missing = [name for name in ("key", "from", "to", "until", "complete", "median", "realizations") if name not in self.summary]
        if missing:
            raise DamagedError(f"{self.path / 'limit.json'} is damaged: it has no {', '.join(missing)}")
        if warn and not self.summary["complete"]:
            warnings.warn(f"{self.path}: the search goes on, or was stopped", UnfinishedWarning, stacklevel=2)

    @property
    def key(self) -> str:
        """The key that was varied."""
        return str(self.summary["key"])

    @property
    def value(self) -> float:
        """The limit, the median over the realizations; NaN where it is not known, or only as a bound: `bound` has that."""
        median = self.summary["median"]
        found = None if median.get("bound") else median["value"]
        return math.nan if found is None else float(found)

    @property
    def bound(self) -> str:
        """What is known where `value` is NaN: "at least 1.2", "at most 5", where limits lie beyond an end of the search; empty: nothing more."""
        median = self.summary["median"]
        if not median.get("bound") or median["value"] is None:
            return ""
        return f"{median['bound']} {median['value']:.6g}"

    @property
    def answer(self) -> str:
        """The limit in a sentence, with its unit and what happens just beyond it."""
        return str(self.summary.get("answer", ""))

    @property
    def unit(self) -> str:
        """The unit of the key; empty where it has none."""
        return str(self.summary.get("unit", ""))

    @property
    def limits(self) -> list[float]:
        """All limits of the first realization: where the criterion begins to hold and where it ceases to, from `from` on."""
        return [float(found["limit"]) for found in self.realizations[0].get("limits", [])]

    @property
    def interval(self) -> Estimate:
        """The limit with its interval by order statistics; its ends are NaN where realizations are too few (at 95 %: below six)."""
        low, high = self.summary["median"]["interval"] or (math.nan, math.nan)
        return Estimate(self.value, low, high)

    @property
    def quantiles(self) -> dict[float, Estimate]:
        """Limits over the realizations at 0.05, 0.25, 0.5, 0.75 and 0.95; ends of intervals that are not known are NaN.

        `summary["quantiles"]` says which are bounds, as limits beyond an end of the search have a part in them."""
        number = lambda value: math.nan if value is None else float(value)  # noqa: E731
        return {float(q["p"]): Estimate(number(q["value"]), number(q["low"]), number(q["high"])) for q in self.summary.get("quantiles", [])}

    @property
    def mean(self) -> Estimate:
        """The mean of the limits over the realizations with Student's interval; its ends are NaN where limits lie beyond an end of the search."""
        return _estimate(self.summary.get("mean") or {})

    @property
    def standard_deviation(self) -> float:
        """Of the limits over the realizations; NaN of one."""
        found = (self.summary.get("mean") or {}).get("standard_deviation")
        return math.nan if found is None else float(found)

    @property
    def probability_below_1(self) -> Estimate:
        """Of the factor of safety over realizations: the share below 1 with Wilson's interval; NaN of another key."""
        return _estimate(self.summary.get("probability_below_1") or {})

    @property
    def hangs_on(self) -> dict[str, dict[str, Estimate]]:
        """How the limit hangs on each strength that was drawn, by its name: its `rank_correlation` and its `first_order_index`."""
        return {
            str(one["strength"]): {name: _estimate(one[name]) for name in ("rank_correlation", "first_order_index")}
            for one in self.summary.get("hangs_on", [])
        }

    @property
    def realizations(self) -> list[record.Record]:
        """Of each realization: `status`, `bracket`, `limit`, `just_beyond`, `limits`, `error`, `trials`."""
        return list(self.summary["realizations"])

    def records(self) -> list[dict[str, Any]]:
        """All trials as dictionaries, in the order of the bisection."""
        return [{"realization": r["realization"]} | trial for r in self.realizations for trial in r["trials"]]

    def table(self) -> Any:
        """A row per trial, as pandas.DataFrame: realization, value, met, measure, standing, run, state_hash."""
        return tables.data_frame(self.records(), "trials")

    def run(self, realization: int = 0) -> Result:
        """The run just beyond the limit, which shows the mechanism. Throws NoResultError unless it was kept ([study] keep = "all")."""
        from .results import Result

        for found in self.realizations:
            if found["realization"] == realization:
                if not found["just_beyond"]:
                    raise NoResultError(f"{self.path}: no limit was found for realization {realization}: {found['status']}")
                return Result(self.path / found["just_beyond"])
        raise KeyError(f"no realization {realization}; there are {[found['realization'] for found in self.realizations]}")

    def plot(self, ax: Axes | None = None, *, save: str | Path | None = None) -> Axes:
        """The measure of all trials over the value of the key, with the limit."""
        with figures.chart(ax, save) as axes:
            self._draw(axes)
        return axes

    def _draw(self, ax: Axes) -> None:
        trials = [trial for trial in self.records() if trial["measure"] is not None]
        for met, color, name in ((False, colors.PALETTE[0], "not met"), (True, colors.PALETTE[1], "met")):
            of_kind = [trial for trial in trials if trial["met"] == met]
            ax.plot([t["value"] for t in of_kind], [t["measure"] for t in of_kind], "o", color=color, markersize=4, label=name)
        if not math.isnan(self.value):
            ax.axvline(self.value, color=colors.OUTLINE, linewidth=1.0, linestyle=(0, (5, 3)), label=f"limit {self.value:.4g}")
        if not math.isnan(self.interval.low):
            ax.axvspan(self.interval.low, self.interval.high, color=colors.OUTLINE, alpha=0.12, linewidth=0)
        ax.set_xlabel(f"{self.key} ({self.unit})" if self.unit else self.key)
        ax.set_ylabel(figures.measure_label(str(self.summary["measure"])))
        figures.legend_below(ax, columns=3)

    def __repr__(self) -> str:
        found = self.bound or (f"{self.value:.6g}" if math.isnan(self.interval.low) else repr(self.interval))
        return f"<keyblock limit {str(self.path)!r}: {self.key} until {self.summary['until']}, {found}>"
