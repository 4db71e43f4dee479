"""What the tests of studies share: a gallery in blocky rock that is run in a moment, and the files of a study."""

import csv
import json

from program import ROOT, Scenario

GALLERY = (ROOT / "tests/data/study/gallery.toml").read_text().split("[study]")[0]
SCALES = '[[study.vary]]\nkey = "stage.shaken.scale"\nvalues = [0.5, 1.0]\n'
SMALL = '[study]\nrealizations = 3\nkeep = "measures"\n' + SCALES


def checksum(text):
    """FNV-1a, 64 bit."""
    value = 14695981039346656037
    for byte in text.encode():
        value = ((value ^ byte) * 1099511628211) % 2**64
    return f"{value:016x}"


class Study(Scenario):
    def setUp(self):
        super().setUp()
        self.write("small.toml", GALLERY + SMALL)
        self.out = self.folder / "out"

    def study(self, *arguments, expect=0):
        return self.keyblock("study", *arguments, expect=expect)

    def run_study(self, scenario, *more, expect=0):
        return self.study("run", scenario, "-o", "out", "--workers", "2", *more, expect=expect)

    def plan(self, folder="out"):
        return json.loads((self.folder / folder / "plan.json").read_text())

    def keys(self):
        return [run["key"] for run in self.plan()["runs"]]

    def run_file(self, key, folder="out"):
        return self.folder / folder / "runs" / key / "run.json"

    def result(self, key, folder="out"):
        return json.loads(self.run_file(key, folder).read_text())

    def write_result(self, run, result, file="run.json", folder="out", **changes):
        """Leaves the result of another run as that of this one of the plan."""
        values = [", ".join(row) for row in run["values"]]
        result = result | {"key": run["key"], "realization": run["realization"], "values": values} | changes
        result.pop("checksum")
        line = json.dumps(result, separators=(",", ":"))[:-1]
        path = self.run_file(run["key"], folder).with_name(file)
        path.parent.mkdir(exist_ok=True)
        path.write_text(f'{line},"checksum":"{checksum(line)}"}}\n')

    def rows(self, folder="out"):
        with open(self.folder / folder / "runs.csv", newline="") as file:
            return list(csv.DictReader(file))

    def done(self):
        """When the results of the runs that are done were written."""
        return {path.parent.name: path.stat().st_mtime_ns for path in (self.out / "runs").glob("*/run.json")}

    def files(self):
        return {path: path.read_bytes() for path in self.out.iterdir() if path.is_file() and path.name != "lock"}

    def hashes(self, folder="out"):
        paths = sorted((self.folder / folder / "runs").glob("*/run.json"))
        return {path.parent.name: json.loads(path.read_text())["state_hash"] for path in paths}
