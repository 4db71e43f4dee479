#!/usr/bin/env python3
"""Runs from end to end: what is written, that it is the same again, that nothing is lost."""

import csv
import json
import unittest

from program import Scenario

SUMMARY_FIELDS = {
    "": "title version seed realization blocks vertices dof joints area merged_slivers steps step_size wall_time_s ms_per_step "
    "threads state_hash open_close max_overlap_m max_area_change energy stages",
    "area": "blocks excavated domain",
    "open_close": "mean_iterations max_iterations retried_steps unconverged_steps",
    "energy": "kinetic strain gravity contact friction input numerical residual_ratio",
}
STAGE_FIELDS = {
    "": "name kind steps duration pga_m_s2 pgv_m_s arias_m_s equilibrium standing largest_speed_m_s damage fallen",
    "equilibrium": "reached verdict worst_residual_ratio largest_way_m largest_way_share moving_blocks",
    "damage": "fallen_blocks hinges fallen_area_m2 fallen_weight_n_m largest_block_pressure_pa largest_fallen_area_m2 "
    "largest_fallen_weight_n_m fallen_depth_m fallen_depth_crown_m fallen_depth_left_m fallen_depth_right_m "
    "fallen_depth_invert_m opening_filled_ratio loosened_area_m2 displacement_max_m rotation_max_deg slip_max_m slip_max_ever_m "
    "slip_mean_m slipped_length_m slipped_length_ever_m opening_max_m opening_max_ever_m opened_length_m opened_length_ever_m "
    "closure_vertical_m closure_horizontal_m",
}


class Run(Scenario):
    def assert_fields(self, table, fields):
        for part, names in fields.items():
            self.assertLessEqual(set(names.split()), set(table[part] if part else table), part)

    def test_leaves_summary_result_histories_and_report(self):
        done = self.keyblock("run", "incline.toml", "-o", "out")
        out = self.folder / "out"
        summary = self.summary("out")
        self.assert_fields(summary, SUMMARY_FIELDS)
        self.assert_fields(summary["stages"][0], STAGE_FIELDS)
        self.assertEqual((summary["title"], summary["blocks"], summary["steps"]), ("A block on an incline", 2, 500))
        self.assertEqual(summary["open_close"]["unconverged_steps"], 0)
        self.assertEqual(summary["stages"][0]["standing"], "moves")  # it slides still
        self.assertEqual((out / "result.h5").read_bytes()[:4], b"\x89HDF")
        self.assertIn("A block on an incline", (out / "report.html").read_text())
        self.assertEqual([p.name for p in out.iterdir() if p.name.endswith(".tmp")], [])
        self.assertIn("report: out/report.html", done.stdout)

    def test_the_block_slides_as_it_must(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        with open(self.folder / "out/histories.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(
            list(rows[0]), ["time", *(f"s.{quantity}" for quantity in ("ux", "uy", "vx", "vy", "sxx", "syy", "sxy", "ax", "ay"))]
        )
        last = {key: float(value) for key, value in rows[-1].items()}
        self.assertAlmostEqual(last["time"], 0.5, places=9)
        # ½ g (sin 30° − cos 30° tan 20°) t²
        expected = 0.5 * 9.81 * (0.5 - 0.8660254037844386 * 0.36397023426620234) * 0.25
        self.assertAlmostEqual((last["s.ux"] ** 2 + last["s.uy"] ** 2) ** 0.5 / expected, 1.0, delta=0.002)
        self.assertGreater(last["s.ux"], 0.0)
        self.assertLess(last["s.uy"], 0.0)

    def test_a_history_ends_as_its_block_is_excavated(self):
        self.write("incline.toml", self.scenario.read_text() + """
[[excavation]]
name = "slider"
shape = "polygon"
outer = [[1.0, 5.196152422706632], [1.866025403784439, 4.696152422706632], [2.366025403784439, 5.562177826491071], [1.5, 6.062177826491071]]

[[stage]]
name = "bare"
kind = "rest"
excavate = ["slider"]
duration = 0.1
""")  # fmt: skip
        warning = "incline.toml: warning: history.s.point: lies in rock that the stage 'bare' excavates; the history ends there"
        self.assertIn(warning, self.keyblock("check", "incline.toml").stderr)
        self.assertIn(warning, self.keyblock("run", "incline.toml", "-o", "out").stderr)
        self.keyblock("export", "out", "--format", "csv")
        for path in ("out/histories.csv", "out/csv/histories.csv"):
            rows = (self.folder / path).read_text().splitlines()[1:]
            self.assertEqual(len(rows), 600, path)
            self.assertEqual([row.endswith(",,,,,,,") for row in rows], [False] * 500 + [True] * 100, path)

    def test_same_bits_again_and_for_two_threads(self):
        for folder, threads in (("a", 1), ("b", 1), ("c", 2)):
            self.keyblock("run", "incline.toml", "-o", folder, "--threads", threads)
        hashes = {self.summary(folder)["state_hash"] for folder in "abc"}
        self.assertEqual(len(hashes), 1)
        self.assertNotIn("", hashes)

    def test_more_threads_than_processors(self):
        self.assertIn("warning: --threads 1000", self.keyblock("run", "incline.toml", "-o", "many", "--threads", 1000).stderr)
        self.assertNotIn("--threads", self.keyblock("run", "incline.toml", "-o", "one").stderr)
        self.assertEqual(self.summary("many")["state_hash"], self.summary("one")["state_hash"])

    def test_an_override_changes_the_result(self):
        self.keyblock("run", "incline.toml", "-o", "a")
        self.keyblock("run", "incline.toml", "-o", "b", "--set", "joints.friction=10", "--set", "rock.order=2")
        a, b = self.summary("a"), self.summary("b")
        self.assertNotEqual(a["state_hash"], b["state_hash"])
        self.assertEqual((a["dof"], b["dof"]), (6, 12))

    def test_a_run_whose_numbers_are_none_fails_and_keeps_what_it_has(self):
        error = self.keyblock("run", "incline.toml", "-o", "stiff", "--set", "rock.young=1e308", expect=2).stderr
        self.assertRegex(error, r"the energies after step \d+ of stage 'slide' are no finite numbers; the results up to there are kept; odd input: rock.young")
        self.assertTrue(self.summary("stiff")["steps"] > 0)
        self.assertTrue((self.folder / "stiff/report.html").exists())

    def test_report_can_be_written_again(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        report = self.folder / "out/report.html"
        first = report.read_bytes()
        report.unlink()
        self.keyblock("report", "out")
        self.assertEqual(report.read_bytes(), first)

    def test_export(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        for kind in ("vtk", "csv", "geojson"):
            before = set((self.folder / "out").rglob("*"))
            self.keyblock("export", "out", "--format", kind)
            self.assertGreater(len(set((self.folder / "out").rglob("*")) - before), 0, kind)

    def test_exports_take_the_place_of_nothing_else(self):
        def content():
            return {p: p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}

        def export(*options, expect=0):
            return self.keyblock("export", "out", "--format", "csv", *options, expect=expect).stderr

        self.keyblock("run", "incline.toml", "-o", "out")
        self.keyblock("run", "incline.toml", "-o", "other", "--set", "joints.friction=10")
        (self.folder / "mine").mkdir()
        self.write("mine/steps.csv", "mine")
        (self.folder / "study").mkdir()
        self.write("study/plan.json", "{}")
        before = content()
        for folder in ("out", "other", "study"):
            self.assertIn("another folder", export("-o", folder, expect=1))
            export("-o", folder, "--force", expect=1)
        self.assertIn("steps.csv, which is of no export", export("-o", "mine", expect=1))
        self.assertEqual(content(), before)
        export("-o", "mine", "--force")
        self.assertNotEqual((self.folder / "mine/steps.csv").read_text(), "mine")
        for _ in range(2):
            export("-o", "new")
            export()
        self.assertEqual((self.folder / "new/steps.csv").read_text(), (self.folder / "out/csv/steps.csv").read_text())

    def test_log_in_a_pipe(self):
        log = self.keyblock("run", "incline.toml", "-o", "out").stderr
        self.assertNotIn("\x1b", log)
        self.assertNotIn("\r", log)
        self.assertRegex(log, r"(?m)^1/1 slide: 0\.50 s, 500 steps, ")


class Folder(Scenario):
    """The folder of results: what is there is not lost."""

    def setUp(self):
        super().setUp()
        self.keyblock("run", "incline.toml", "-o", "out")

    def content(self):
        return {p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}

    def test_the_same_run_again(self):
        self.keyblock("run", "incline.toml", "-o", "out")

    def test_other_input_is_refused_unless_forced(self):
        before = self.content()
        other = ("run", "incline.toml", "-o", "out", "--set", "joints.friction=10")
        self.assertIn("--force", self.keyblock(*other, expect=1).stderr)
        self.assertIn("out", self.keyblock("run", "incline.toml", "-o", "out", "--realization", "1", expect=1).stderr)
        self.assertIn("out", self.keyblock("cut", "incline.toml", "-o", "out", expect=1).stderr)
        self.assertEqual(self.content(), before)
        self.keyblock(*other, "--force")
        self.assertNotEqual(self.content()["summary.json"], before["summary.json"])

    def test_other_input_is_not_resumed(self):
        before = self.content()
        self.keyblock("run", "incline.toml", "-o", "out", "--resume", "--set", "joints.friction=10", expect=1)
        self.assertEqual(self.content(), before)

    def test_resuming_what_never_began_begins(self):
        log = self.keyblock("run", "incline.toml", "-o", "new", "--resume").stderr
        self.assertIn("new: nothing to go on from", log)
        self.assertEqual(self.summary("new")["state_hash"], self.summary("out")["state_hash"])

    def test_resuming_a_finished_run_changes_nothing(self):
        def resume():
            self.assertIn("out: this run has ended", self.keyblock("run", "incline.toml", "-o", "out", "--resume").stdout)

        before = self.content()
        resume()
        self.assertEqual(self.content(), before)
        (self.folder / "out/report.html").unlink()
        resume()
        self.assertEqual(self.content(), before)
        (self.folder / "out/checkpoint.bin").unlink()
        resume()

    def test_what_is_missing_of_a_finished_run_is_written_again(self):
        before = self.content()
        (self.folder / "out/summary.json").unlink()
        (self.folder / "out/histories.csv").unlink()
        (self.folder / "out/report.html").unlink()
        self.keyblock("run", "incline.toml", "-o", "out", "--resume")
        self.assertEqual(set(self.content()), set(before))
        self.assertEqual(self.content()["histories.csv"], before["histories.csv"])
        self.assertEqual(self.summary("out")["stages"], json.loads(before["summary.json"])["stages"])
        self.assertIn('"slide"', (self.folder / "out/report.html").read_text())


class OtherFiles(Scenario):
    """What is not of a run stays what it is."""

    def content(self, folder):
        return {p.name: p.read_bytes() for p in (self.folder / folder).iterdir()}

    def refused(self, folder, *options):
        before = self.content(folder)
        error = self.keyblock("run", "incline.toml", "-o", folder, *options, expect=1).stderr
        self.assertEqual(self.content(folder), before)
        return error

    def test_the_scenario_is_not_written_over(self):
        case = self.folder / "case"
        case.mkdir()
        scenario = self.scenario.rename(case / "scenario.toml")
        text = scenario.read_text()
        for options in ((), ("--force",), ("--resume",), ("--set", "joints.friction=10")):
            error = self.keyblock("run", "case/scenario.toml", "-o", "case", *options, expect=1).stderr
            self.assertIn("scenario.toml, input of the run", error)
            self.assertEqual(self.content("case"), {"scenario.toml": text.encode()})

    def test_files_of_the_user(self):
        for name in ("report.html", "summary.json", "histories.csv", "scenario.toml", "checkpoint.bin"):
            folder = self.folder / name.split(".")[0]
            folder.mkdir()
            (folder / name).write_text("mine")
            self.assertIn(f"a {name} that is not of this run", self.refused(folder.name))
            self.refused(folder.name, "--resume")
        self.keyblock("run", "incline.toml", "-o", "report", "--force")
        self.assertIn("A block on an incline", (self.folder / "report/report.html").read_text())

    def test_a_study(self):
        (self.folder / "study").mkdir()
        self.write("study/plan.json", "{}")
        self.assertIn("found a study", self.refused("study"))
        self.refused("study", "--force")
        self.keyblock("cut", "incline.toml", "-o", "study", expect=1)

    def test_files_that_the_scenario_names_are_input(self):
        motion = self.scenario.read_text().replace('kind = "rest"', 'kind = "shake"\nmotion = "q"')
        motion += '[section]\nazimuth = 0.0\n[[motion]]\nname = "q"\ncomponents = [{ file = "q.csv", azimuth = 0.0 }]\n'
        self.write("incline.toml", motion)
        self.write("q.csv", "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,0.0\n0.5,0.0\n")
        self.keyblock("run", "incline.toml", "-o", "out")
        self.keyblock("run", "incline.toml", "-o", "out")
        self.write("q.csv", "time,acceleration (m/s2)\n0.0,0.0\n0.1,-1.0\n0.2,0.0\n0.5,0.0\n")
        self.assertIn("results of other input", self.refused("out"))
        self.assertIn("the same files", self.refused("out", "--resume"))
        self.keyblock("run", "incline.toml", "-o", "out", "--force")

    def test_results_that_are_gone_are_not_resumed(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        (self.folder / "out/result.h5").unlink()
        self.assertIn("to begin anew, run into another folder", self.refused("out", "--resume"))
        self.keyblock("run", "incline.toml", "-o", "out")


if __name__ == "__main__":
    unittest.main()
