#!/usr/bin/env python3
"""Lines as other programs write them, and blocks that overlap: what `check`, `cut` and `run` say."""

import json
import math
import random
import shutil
import unittest

from program import ROOT, Scenario

DATA = ROOT / "tests/data/lines"

DOMAIN = """
[domain]
x = {x}
y = {y}
boundary = "{boundary}"
[rock]
density = 2650.0
young = 2.0e10
poisson = 0.25
[joints]
friction = 35.0
"""

MAP = """
[[trace_map]]
name = "map"
file = "{file}"
"""


class Lines(Scenario):
    def lines(self, more, x="[0.0, 10.0]", y="[0.0, 10.0]", boundary="free"):
        (self.folder / "lines.toml").write_text(DOMAIN.format(x=x, y=y, boundary=boundary) + more)
        return "lines.toml"

    def mapped(self, file, **domain):
        shutil.copy(DATA / file, self.folder)
        return self.lines(MAP.format(file=file), **domain)

    def test_tables_of_spreadsheets(self):
        for file in ("tabs.csv", "capitals.csv"):
            self.assertIn("4 blocks from 2 of 2 traces", self.keyblock("cut", self.mapped(file), "-o", "cut").stdout)

    def test_degrees_are_refused_with_advice(self):
        scenario = self.mapped("degrees.geojson", x="[26.39, 26.391]", y="[60.3549, 60.3556]")
        done = self.keyblock("check", scenario, expect=1)
        self.assertRegex(done.stderr, r"degrees\.geojson:6:12: .* in degrees; .*ogr2ogr")

    def test_drawings(self):
        for file in ("lines.dxf", "../drawings/lines.shp"):
            scenario = self.mapped(file)
            (self.folder / scenario).write_text((self.folder / scenario).read_text().replace("../drawings/", ""))
            self.assertIn("4 blocks from 2 of 2 traces", self.keyblock("cut", scenario, "-o", "cut").stdout)

    def test_a_drawn_face_map_is_its_geojson(self):
        """The same traces, as GeoJSON in metres and as a drawing in millimetres about another origin, give the same blocks."""
        x0, y0 = 466000.0, 6691570.0
        draw = random.Random(7)
        lines = []
        for _ in range(700):
            x, y, angle, length = x0 + draw.uniform(0, 20), y0 + draw.uniform(0, 20), draw.choice((0.3, 1.2, 2.2)) + draw.gauss(0, 0.1), draw.uniform(1, 6)
            bend = angle + draw.gauss(0, 0.1)
            middle = (x + length * math.cos(angle), y + length * math.sin(angle))
            lines.append([(x, y), middle, (middle[0] + length * math.cos(bend), middle[1] + length * math.sin(bend))])
        entities = "".join(
            "0\nPOLYLINE\n8\nJOINTS\n" + "".join(f"0\nVERTEX\n10\n{1000 * (x - x0)!r}\n20\n{1000 * (y - y0)!r}\n" for x, y in line) + "0\nSEQEND\n" for line in lines
        )
        drawing = f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
        (self.folder / "face.dxf").write_text(drawing)
        (self.folder / "face.geojson").write_text(json.dumps({"type": "MultiLineString", "coordinates": lines}))
        extent = dict(x="[5.0, 15.0]", y="[5.0, 15.0]")
        cuts = []
        for name, more in ("face.dxf", ""), ("face.geojson", f"origin = [{x0}, {y0}]\n"):
            self.keyblock("cut", self.lines(MAP.format(file=name) + more, **extent), "-o", "cut")
            cuts.append([json.loads((self.folder / "cut/summary.json").read_text())[key] for key in ("blocks", "vertices", "joints")])
        self.assertGreater(cuts[0][0], 1000)
        self.assertEqual(cuts[0], cuts[1])

    def test_points(self):
        scenario = self.lines("""
[[trace_map]]
name = "fault"
points = [[0.0, 5.0], [10.0, 5.0]]
[[trace_map]]
name = "bend"
points = [[5.0, 0.0], [5.0, 5.0], [6.0, 10.0]]
""")
        self.assertIn("4 blocks", self.keyblock("check", scenario).stdout)
        moved = self.keyblock("check", scenario, "--set", "trace_map.fault.points=[[0.0, 6.0], [10.0, 6.0]]")
        self.assertIn("4 blocks", moved.stdout)

    def test_a_patch_of_small_blocks_keeps_them(self):
        scenario = self.mapped("patch.csv", x="[0.0, 200.0]", y="[0.0, 200.0]")
        done = self.keyblock("cut", scenario, "-o", "cut")
        self.assertIn("362 blocks from 40 of 40 traces", done.stdout)
        self.assertNotIn("are slivers", done.stdout)
        self.assertEqual(json.loads((self.folder / "cut/summary.json").read_text())["merged_slivers"], 0)

    def test_many_merged_blocks_are_told(self):
        scenario = self.mapped("patch.csv", x="[0.0, 200.0]", y="[0.0, 200.0]")
        wide = ("--set", "cutting.sliver_area=0.1")
        said = "241 of 362 blocks are slivers and part of their neighbours, 21.7 m2 of 40000 m2 in all"
        self.assertIn(said, self.keyblock("check", scenario, *wide).stdout)
        self.assertIn(said, self.keyblock("cut", scenario, "-o", "cut", *wide).stdout)
        stage = "[time]\nstep = 0.01\n[[stage]]\nname = \"rest\"\nkind = \"rest\"\nduration = 0.01\n"
        with (self.folder / "lines.toml").open("a") as file:
            file.write(stage)
        self.assertIn(said, self.keyblock("run", scenario, "-o", "run", *wide).stdout)

    def crossing(self, friction="20.0"):
        """A plane that passes the crossing of two joints by centimetres."""
        joint = '[[trace_map]]\nname = "{}"\npoints = {}\nfriction = {}\n'
        return self.lines(
            joint.format("level", "[[0.0, 5.0], [10.0, 5.0]]", "40.0")
            + joint.format("upright", "[[5.0, 0.0], [5.0, 10.0]]", "40.0")
            + joint.format("plane", "[[0.0, 6.84], [10.0, 3.19]]", friction)
        )

    def test_a_sliver_is_not_merged_across_the_weak_plane(self):
        cut = self.keyblock("cut", self.crossing(), "-o", "cut", "--set", "cutting.sliver_area=0.001")
        self.assertRegex(cut.stdout, r"1 sliver merged, 1 of them across a joint that runs through, .*: '(level|upright)' at \((4|5)\.\d\d, 5\.0\d\)")
        summary = json.loads((self.folder / "cut/summary.json").read_text())
        self.assertEqual(summary["cutting"]["merged_across_joints"], 1)
        [tooth] = summary["teeth"]
        self.assertAlmostEqual(tooth["height_m"], summary["cutting"]["highest_tooth_m"])
        self.assertNotEqual(tooth["joint"], "plane")

    def test_which_plane_is_locked_and_by_what_is_told(self):
        scenario = self.crossing(friction="40.0")
        checked = self.keyblock("check", scenario, "--set", "cutting.sliver_area=0.001").stdout
        self.assertRegex(checked, r"which is held there by a tooth of rock: 'plane' at \(5\.0\d, 5\.0\d\), \d+ mm high\n")

    def test_slivers_that_are_left_are_told(self):
        none = [word for key in ("sliver_area", "sliver_thickness", "cluster") for word in ("--set", f"cutting.{key}=0.0")]
        scenario = self.lines((self.folder / self.crossing()).read_text().replace(DOMAIN.format(x="[0.0, 10.0]", y="[0.0, 10.0]", boundary="free"), "").replace("6.84", "6.827").replace("3.19", "3.177"))
        said = r"1 sliver left, as \[cutting\] asks for; their corners can hold the joints beside them: 'plane' at \(\d\.\d\d, \d\.\d\d\)"
        self.assertRegex(self.keyblock("check", scenario, *none).stdout, said)
        notes = json.loads(self.keyblock("check", scenario, "--json", *none).stdout)["notes"]
        self.assertRegex("\n".join(notes), said)
        self.assertNotIn("left", self.keyblock("check", scenario).stdout)

    def test_blocks_in_the_frame_and_in_the_domain_are_told(self):
        block = "[[block]]\nname = \"b\"\nouter = [[-1.0, {0}], [1.0, {0}], [1.0, {1}], [-1.0, {1}]]\n"
        sets = {"x": "[-5.0, 5.0]", "y": "[-5.0, 5.0]", "boundary": "frame"}
        done = self.keyblock("check", self.lines(block.format(5.0, 7.0), **sets))
        self.assertIn("block.b and the frame around the domain overlap by 0.5 m at [0, 5.25]", done.stderr)
        done = self.keyblock("check", self.lines(block.format(4.0, 5.0), **sets))
        self.assertIn("a block of the domain and block.b overlap by 1 m", done.stderr)
        done = self.keyblock("check", self.lines(block.format(6.0, 7.0), **sets))
        self.assertNotIn("overlap", done.stderr)
        sets["boundary"] = "free"
        self.assertNotIn("overlap", self.keyblock("check", self.lines(block.format(5.0, 7.0), **sets)).stderr)


if __name__ == "__main__":
    unittest.main()
