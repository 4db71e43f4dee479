#!/usr/bin/env python3
"""What `export --format vtk` writes is what VTK, and so ParaView, draws. Read by Debian's python3-vtk9."""

import json
import subprocess
import unittest

from program import ROOT, Scenario

PYTHON = "/usr/bin/python3"

READ = """
import json, sys
import vtkmodules.all as vtk
folder = sys.argv[1]
def read(name):
    reader = vtk.vtkXMLUnstructuredGridReader() if name.endswith(".vtu") else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(f"{folder}/{name}")
    reader.Update()
    return reader.GetOutput()
def values(array):
    return [array.GetTuple(k) for k in range(array.GetNumberOfTuples())]
"""

# What the mapper makes of a polygon: a fan of triangles from its first vertex.
DRAWN = """
grid, areas = read("blocks_00001.vtu"), {}
for k in range(grid.GetNumberOfCells()):
    p = [grid.GetPoint(grid.GetCell(k).GetPointId(i)) for i in range(grid.GetCell(k).GetNumberOfPoints())]
    block = int(grid.GetCellData().GetArray("block").GetValue(k))
    for a, b in zip(p[1:], p[2:]):
        area = abs((a[0] - p[0][0]) * (b[1] - p[0][1]) - (a[1] - p[0][1]) * (b[0] - p[0][0])) / 2
        areas[block] = areas.get(block, 0.0) + area
print(json.dumps([round(areas[k], 6) for k in sorted(areas)]))
"""

FIELDS = """
last, block = int(sys.argv[2]), int(sys.argv[3])
centres, outlines = read(f"centres_{last:05}.vtp"), read(f"outlines_{last:05}.vtp")
data = centres.GetPointData()
print(json.dumps({
    "origin": values(centres.GetFieldData().GetArray("origin"))[0],
    "blocks": [int(v[0]) for v in values(data.GetArray("block"))],
    "velocity": values(data.GetArray("velocity"))[block],
    "time": values(centres.GetFieldData().GetArray("TimeValue"))[0][0],
    "place": centres.GetPoint(block),
    "tensors": data.GetTensors().GetName(),
    "stress": values(data.GetArray("stress"))[block],
    "principal": [values(data.GetArray(n))[block] for n in ("principal_1", "principal_2", "principal_1_vector", "principal_2_vector")],
    "lines": outlines.GetNumberOfLines(),
    "outline": outlines.GetCell(0).GetNumberOfPoints(),
    "closed": outlines.GetCell(0).GetPointId(0) == outlines.GetCell(0).GetPointId(outlines.GetCell(0).GetNumberOfPoints() - 1),
    "kinds": sorted({int(v[0]) for v in values(outlines.GetCellData().GetArray("edge_kind"))}),
}))
"""

FORCES = """
forces = read("forces_00000.vtp")
data = forces.GetPointData()
total = [sum(v[k] for v, b in zip(values(data.GetArray("force")), values(data.GetArray("block_a"))) if b[0] == 1) for k in range(3)]
against = [sum(v[k] for v, b in zip(values(data.GetArray("force")), values(data.GetArray("block_b"))) if b[0] == 1) for k in range(3)]
normals = values(data.GetArray("normal"))
print(json.dumps({"on_slider": [a - b for a, b in zip(total, against)],
                  "units": [round(n[0] ** 2 + n[1] ** 2, 9) for n in normals], "points": forces.GetNumberOfPoints()}))
"""

ELEMENTS = """
found = read("elements_%05d.vtp" % int(sys.argv[2]))
data = found.GetCellData()
print(json.dumps({n: [v[0] for v in values(data.GetArray(n))] for n in ("element", "force", "elongation", "utilization")}
                 | {"ends": [found.GetPoint(k)[:2] for k in range(found.GetNumberOfPoints())]}))
"""

VIEW = """
import runpy
sys.path.insert(0, sys.argv[2])
runpy.run_path(folder + "/view.py")
from paraview import simple
print(json.dumps([[r._source.registrationName, r._visible] for r in simple.shown]))
"""


def has_vtk():
    return subprocess.run([PYTHON, "-c", "import vtkmodules.all"], capture_output=True, check=False).returncode == 0


@unittest.skipUnless(has_vtk(), "python3-vtk9 is not installed")
class Vtk(Scenario):
    def read(self, script, *arguments):
        self.write("read.py", READ + script)
        done = subprocess.run([PYTHON, "read.py", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return json.loads(done.stdout.splitlines()[-1])

    def run_and_export(self, scenario, *overrides):
        self.keyblock("run", scenario, "-o", "out", *overrides)
        self.keyblock("export", "out", "--format", "vtk")

    def test_concave_blocks_are_drawn_as_they_are(self):
        self.run_and_export(ROOT / "tests/data/concave_blocks.toml")
        self.assertEqual(self.read(DRAWN, "out/vtk"), [1.33185, 1.0, 0.25])

    def test_fields_of_blocks(self):
        self.run_and_export(ROOT / "tests/data/concave_blocks.toml")
        last = len(list((self.folder / "out/vtk").glob("centres_*.vtp"))) - 1
        found = self.read(FIELDS, "out/vtk", last, 2)
        self.assertAlmostEqual(found["velocity"][1], -9.81 * found["time"], places=4)
        self.assertEqual(found["blocks"], [0, 1, 2])
        # In local coordinates, in which single precision has digits left.
        self.assertLess(max(abs(v) for v in found["place"]), 100.0)
        self.assertAlmostEqual(found["origin"][0] + found["place"][0], 466014.25, places=4)
        self.assertAlmostEqual(found["origin"][1] + found["place"][1], 6699999.25 - 9.81 / 2 * 0.1**2, delta=1e-3)
        self.assertEqual(found["tensors"], "stress")
        self.assertEqual([found["lines"], found["outline"], found["closed"], found["kinds"]], [3, 5, True, [0]])

    def test_forces_and_stress_of_a_block_at_rest(self):
        settle = ("--set", 'stage.slide.kind="settle"', "--set", "joints.friction=40.0")
        incline = self.scenario.read_text().replace("duration = 0.5", "").replace("plane-stress", "plane-strain")
        self.write("rest.toml", incline)
        self.run_and_export("rest.toml", *settle)
        weight = 2600.0 * 9.81
        forces = self.read(FORCES, "out/vtk")
        self.assertGreater(forces["points"], 0)
        self.assertEqual(set(forces["units"]), {1.0})
        self.assertAlmostEqual(forces["on_slider"][0] / weight, 0.0, delta=0.01)
        self.assertAlmostEqual(forces["on_slider"][1] / weight, 1.0, delta=0.01)
        last = len(list((self.folder / "out/vtk").glob("centres_*.vtp"))) - 1
        found = self.read(FIELDS, "out/vtk", last, 1)
        xx, yy, zz, xy, yz, xz = found["stress"]
        self.assertAlmostEqual(zz / (xx + yy), 0.2, places=5)
        self.assertEqual([yz, xz], [0.0, 0.0])
        (larger,), (smaller,), first, second = found["principal"]
        self.assertAlmostEqual(larger + smaller, xx + yy, delta=1.0)
        self.assertAlmostEqual(larger * smaller, xx * yy - xy * xy, delta=1e-4 * smaller**2)
        self.assertAlmostEqual(first[0] * second[0] + first[1] * second[1], 0.0, delta=1e-4 * smaller**2)
        self.assertAlmostEqual(first[0] ** 2 + first[1] ** 2, larger**2, delta=1e-4 * smaller**2)
        # The normal stress along the larger principal direction is that stress.
        self.assertAlmostEqual(
            xx * first[0] ** 2 + 2 * xy * first[0] * first[1] + yy * first[1] ** 2, larger**3, delta=1e-4 * abs(smaller) ** 3
        )

    def test_elements_are_lines_with_their_force(self):
        self.run_and_export(ROOT / "verification/scenarios/staged_support.toml", "--set", "spring.first.yield=1e5")
        last = len(list((self.folder / "out/vtk").glob("elements_*.vtp"))) - 1
        found = self.read(ELEMENTS, "out/vtk", last)
        weight = 2600.0 * 9.81
        self.assertEqual(found["element"], [0.0, 1.0])
        # The ballast of a fifth of the block is gone, and lifts both springs alike.
        self.assertAlmostEqual(found["force"][0] / weight, 1.1, delta=1e-3)
        self.assertAlmostEqual(found["force"][1] / weight, -0.1, delta=1e-3)
        self.assertAlmostEqual(found["elongation"][0] * 6.28319e7 / weight, 1.1, delta=1e-3)
        self.assertAlmostEqual(found["utilization"][0], 1.1 * weight / 1e5, delta=1e-3)
        self.assertNotEqual(found["utilization"][1], found["utilization"][1])  # no limit: not a number
        self.assertEqual([round(c, 2) for c in found["ends"][0]], [0.5, 3.0])
        before = self.read(ELEMENTS, "out/vtk", 0)
        self.assertEqual(before["element"], [0.0])  # the second is not installed yet
        shown = self.read(VIEW, "out/vtk", ROOT / "tests/integration/stand_ins")
        self.assertIn(["elements", True], shown)

    def test_the_view_opens(self):
        settle = ("--set", 'stage.slide.kind="settle"', "--set", "joints.friction=40.0")
        self.write("rest.toml", self.scenario.read_text().replace("duration = 0.5", ""))
        self.run_and_export("rest.toml", *settle)
        shown = self.read(VIEW, "out/vtk", ROOT / "tests/integration/stand_ins")
        self.assertEqual(
            shown,
            [["blocks", True], ["outlines", True], ["forces of contacts", False], ["principal stress 1", False], ["principal stress 2", False]],
        )


if __name__ == "__main__":
    unittest.main()
