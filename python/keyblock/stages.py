"""The stages of a run, as summary.json tells of them; of a run that did not reach its end, as far as it has come."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any, overload

import numpy as np

from . import record, tables
from ._hdf5 import ResultFile

# Names in result.h5 of earlier versions. `equilibrium` was not a table of its own there.
_EARLIER = {
    "pga": "pga_m_s2",
    "pgv": "pgv_m_s",
    "arias": "arias_m_s",
    "largest_speed": "largest_speed_m_s",
    "wall_time": "wall_time_s",
}
# What the oldest do not have.
_LATER = ("planned_duration", "pgv_m_s", "arias_m_s", "largest_speed_m_s", "standing", "movers", "still", "waits_for", "fallen")
# What the scenario says of a stage, and what has a place of its own in Stage.
_NOT_TOLD = ("motion_index", "given_duration", "max_steps", "tolerance", "motion_time", "motion")


class Stage(record.Record):
    """One stage: its fields are those of `stages[]` in summary.json, and `index`, `ended`, `planned_duration`, `excavate`."""

    def __init__(self, fields: dict[str, Any], motion: tuple[np.ndarray, np.ndarray]) -> None:
        super().__init__(fields)
        self.__dict__["_motion"] = motion

    @property
    def end_time(self) -> float:
        """s of simulated time."""
        return float(self["start_time"] + self["duration"])

    @property
    def motion(self) -> Any:
        """Acceleration of the ground as applied, m/s²: a table of `x` and `y` over the time of the run, thinned to what a plot needs."""
        time, acceleration = self.__dict__["_motion"]
        return tables.table(
            {"x": acceleration[:, 0], "y": acceleration[:, 1]}, time + self["start_time"], {"x": "m/s2", "y": "m/s2"}
        )

    def __repr__(self) -> str:
        return f"<stage {self['name']!r}: {self['kind']}, {self['steps']} steps{'' if self['ended'] else ', not ended'}>"


def read_stages(file: ResultFile, summary: record.Record | None, excavation_names: list[str]) -> list[Stage]:
    """All stages that have begun, in their order."""
    with record.damaged(f"stages of {file.path}"):
        return _read_stages(file, summary, excavation_names)


def _read_stages(file: ResultFile, summary: record.Record | None, excavation_names: list[str]) -> list[Stage]:
    lines: dict[int, record.Record] = {}
    text = file.bytes_as_text("stages")
    for row in text.split("\n")[:-1]:  # a line without its end is in the making
        found = record.parse_record(row, f"stages of {file.path}")
        lines[found["index"]] = found
    told = summary["stages"] if summary else []
    stages = []
    for k in sorted(lines):
        line = lines[k]
        fields = _as_in_summary(line, excavation_names) | (told[k] if k < len(told) else {})
        fields |= {"index": k, "ended": line["ended"], "excavate": [excavation_names[e] for e in line.get("excavate", [])]}
        motion = np.asarray(line.get("motion_time") or [], dtype=float), np.asarray(line.get("motion") or [], dtype=float)
        stages.append(Stage(fields, (motion[0], motion[1].reshape(-1, 2))))
    return stages


def _as_in_summary(line: record.Record, excavation_names: list[str]) -> dict[str, Any]:
    fields = dict.fromkeys(_LATER) | {_EARLIER.get(name, name): value for name, value in line.items() if name not in _NOT_TOLD}
    fields["release"] = [
        record.Record(point, excavation=excavation_names[point["excavation"]]) for point in line.get("release") or []
    ]
    fields["install"] = line.get("install") or []
    if line["kind"] != "settle":  # as in summary.json
        fields["equilibrium"] = record.Record(dict.fromkeys(line.get("equilibrium", ())))
    fields["blocks_by_order"] = record.Record({str(n): count for n, count in enumerate(line.get("blocks_by_order") or []) if count})
    return fields


class Stages(Sequence[Stage]):
    """By number or name: ``stages["first earthquake"].damage.fallen_area_m2``."""

    def __init__(self, stages: list[Stage], planned: list[str] | None = None) -> None:
        self._stages = stages
        self.planned = planned or self.names  #: names of all stages of the plan; a run that was stopped has begun fewer

    @property
    def names(self) -> list[str]:
        return [stage["name"] for stage in self._stages]

    def __len__(self) -> int:
        return len(self._stages)

    @overload
    def __getitem__(self, which: int | str) -> Stage: ...
    @overload
    def __getitem__(self, which: slice) -> list[Stage]: ...
    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, str):
            if which not in self.names:
                raise KeyError(f"no stage {which!r}{record.did_you_mean(which, self.names)}")
            return self._stages[self.names.index(which)]
        if not isinstance(which, slice) and not -len(self) <= which < len(self):
            raise IndexError(f"there are {len(self)} stages, and no stage {which}")
        return self._stages[which]

    def __iter__(self) -> Iterator[Stage]:
        return iter(self._stages)

    def __repr__(self) -> str:
        return f"<stages {json.dumps(self.names, ensure_ascii=False)}>"

    def table(self) -> Any:
        """One row per stage, with all measures of damage, as pandas.DataFrame."""
        rows = [
            {name: value for name, value in stage.items() if not isinstance(value, (dict, list))} | stage["damage"]
            for stage in self._stages
        ]
        return tables.data_frame(rows, "stages").set_index("name")
