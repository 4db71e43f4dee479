#!/usr/bin/env python3
"""Runs from end to end: what is written, that it is the same again, that nothing is lost, that Ctrl-C is survived."""

import csv
import json
import re
import resource
import signal
import subprocess
import time
import unittest

from program import PROGRAM, Scenario

SUMMARY_FIELDS = {
    "": "title version seed realization blocks vertices dof joints area merged_slivers steps step_size wall_time_s ms_per_step "
    "threads state_hash open_close max_overlap_m max_area_change energy stages",
    "area": "blocks excavated domain",
    "open_close": "mean_iterations max_iterations retried_steps unconverged_steps",
    "energy": "kinetic strain gravity contact friction input numerical residual_ratio",
}
STAGE_FIELDS = {
    "": "name kind steps duration pga_m_s2 pgv_m_s arias_m_s equilibrium damage",
    "equilibrium": "reached worst_residual_ratio moving_blocks",
    "damage": "fallen_blocks fallen_area_m2 opening_filled_ratio loosened_area_m2 slip_max_m slip_mean_m slipped_length_m "
    "opened_length_m closure_vertical_m closure_horizontal_m",
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
        self.assertEqual((out / "result.h5").read_bytes()[:4], b"\x89HDF")
        self.assertIn("A block on an incline", (out / "report.html").read_text())
        self.assertEqual([p.name for p in out.iterdir() if p.name.endswith(".tmp")], [])
        self.assertIn("report: out/report.html", done.stdout)

    def test_the_block_slides_as_it_must(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        with open(self.folder / "out/histories.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(
            list(rows[0]), ["time", *(f"s.{quantity}" for quantity in ("ux", "uy", "vx", "vy", "sxx", "syy", "sxy"))]
        )
        last = {key: float(value) for key, value in rows[-1].items()}
        self.assertAlmostEqual(last["time"], 0.5, places=9)
        # ½ g (sin 30° − cos 30° tan 20°) t²
        expected = 0.5 * 9.81 * (0.5 - 0.8660254037844386 * 0.36397023426620234) * 0.25
        self.assertAlmostEqual((last["s.ux"] ** 2 + last["s.uy"] ** 2) ** 0.5 / expected, 1.0, delta=0.002)
        self.assertGreater(last["s.ux"], 0.0)
        self.assertLess(last["s.uy"], 0.0)

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
        self.assertRegex(error, r"the energies after step \d+ of stage 'slide' are no finite numbers; the results up to it are kept\n$")
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
        self.write("q.csv", "time,acceleration\n0.0,0.0\n0.1,1.0\n0.2,0.0\n0.5,0.0\n")
        self.keyblock("run", "incline.toml", "-o", "out")
        self.keyblock("run", "incline.toml", "-o", "out")
        self.write("q.csv", "time,acceleration\n0.0,0.0\n0.1,-1.0\n0.2,0.0\n0.5,0.0\n")
        self.assertIn("results of other input", self.refused("out"))
        self.assertIn("the same files", self.refused("out", "--resume"))
        self.keyblock("run", "incline.toml", "-o", "out", "--force")

    def test_results_that_are_gone_are_not_resumed(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        (self.folder / "out/result.h5").unlink()
        self.assertIn("run without --resume to begin anew", self.refused("out", "--resume"))
        self.keyblock("run", "incline.toml", "-o", "out")


class LittleRoom(Scenario):
    def limited(self, size, *arguments):
        """The program where no file may be larger than so many bytes."""
        return subprocess.run(
            [PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
        )  # fmt: skip


class Trouble(LittleRoom):
    """Disks and folders that do not take what is written."""

    def test_files_too_large_for_the_disk(self):
        def limit(size):
            return self.limited(size, "run", "incline.toml", "-o", "out")

        self.keyblock("run", "incline.toml", "-o", "out")
        before = {p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}
        done = limit(4096)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertIn("File too large", done.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}, before)
        done = limit(len(before["result.h5"]) // 2)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("File too large", done.stderr)

    def test_an_export_or_a_cut_that_fails_leaves_nothing_behind(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        before = set(self.folder.rglob("*"))
        exports = (("export", "out", "--format", kind) for kind in ("vtk", "csv", "geojson"))
        for command in (*exports, ("cut", "incline.toml")):
            done = self.limited(500, *command, "-o", "new/folder")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("File too large", done.stderr)
            self.assertEqual(set(self.folder.rglob("*")), before, command)

    def test_places_that_cannot_be_read_or_written(self):
        (self.folder / "loop").symlink_to("loop")
        self.write("q.csv", "time,acceleration\n0.0,0.0\n0.1,1.0\n0.2,0.0\n")
        for words in (
            "run incline.toml -o loop", "run incline.toml -o incline.toml/out", "cut incline.toml -o loop", "report loop",
            "export loop --format csv", "study run incline.toml -o loop", "study collect loop",
            "motion q.csv --plot -o nowhere/q.svg", "verify -o nowhere/table.txt", "verify -o .",
        ):  # fmt: skip
            error = self.keyblock(*words.split(), expect=1).stderr
            self.assertNotIn("internal error", error, words)
            self.assertRegex(error, "loop|incline.toml/out|nowhere|found a folder", words)


def lasting(duration):
    return ("--set", f"stage.slide.duration={duration}")


class Background(Scenario):
    def start(self, folder, *options):
        """A run that has begun to write its results."""
        run = subprocess.Popen(
            [PROGRAM, "run", "incline.toml", "-o", folder, *options],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.stderr.close)
        end = time.monotonic() + 20.0
        while not (self.folder / folder / "result.h5").exists() and run.poll() is None and time.monotonic() < end:
            time.sleep(0.005)
        return run


class Interrupt(Background):
    def test_two_runs_in_one_folder(self):
        run = self.start("out", *lasting(1e5))
        error = self.keyblock("run", "incline.toml", "-o", "out", "--force", expect=1).stderr
        self.assertIn(f"out: found a run that process {run.pid} on ", error)
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=30)
        self.assertFalse((self.folder / "out/lock").exists())

    def interrupted(self, folder):
        """Interrupts a run in its middle; returns how long it would have lasted, in simulated seconds."""
        duration = 16.0  # the first checkpoint comes after 2000 steps, 2 s
        while duration < 1000.0:
            run = self.start(folder, *lasting(duration))
            run.send_signal(signal.SIGINT)
            _, errors = run.communicate(timeout=30)
            if run.returncode != 0:  # it had not ended by itself
                self.assertEqual(run.returncode, 2, errors)
                self.assertIn("--resume", errors)
                return duration
            for path in (self.folder / folder).iterdir():
                path.unlink()
            duration *= 2.0
        self.fail("no run lasted long enough to be interrupted")

    def test_results_so_far_are_readable_and_resuming_gives_the_same_bits(self):
        duration = self.interrupted("out")
        summary = self.summary("out")
        self.assertTrue(summary["interrupted"])
        self.assertLess(summary["steps"], duration * 1000)
        self.assertTrue((self.folder / "out/report.html").stat().st_size > 1000)
        self.keyblock("report", "out")

        length = lasting(duration)
        self.keyblock("run", "incline.toml", "-o", "out", "--resume", *length)
        self.keyblock("run", "incline.toml", "-o", "whole", *length)
        resumed, whole = self.summary("out"), self.summary("whole")
        self.assertFalse(resumed["interrupted"])
        for field in ("steps", "state_hash", "energy", "open_close", "max_overlap_m", "max_area_change"):
            self.assertEqual(resumed[field], whole[field], field)
        for field in ("steps", "duration", "damage"):
            self.assertEqual(resumed["stages"][0][field], whole["stages"][0][field], field)
        histories = [(self.folder / folder / "histories.csv").read_bytes() for folder in ("out", "whole")]
        self.assertEqual(*histories)

    def test_a_killed_run_has_a_report_and_exports_of_what_it_left(self):
        run = self.start("out", *lasting(1e5))
        time.sleep(2.5)  # what it has is written every two seconds
        run.kill()
        run.communicate(timeout=30)
        self.keyblock("report", "out")
        page = (self.folder / "out/report.html").read_text()
        header = json.loads(re.search(r'<script[^>]*id="header"[^>]*>(.*?)</script>', page, re.DOTALL).group(1))
        self.assertTrue(header["run"]["cut_off"])
        self.assertIsNone(header["run"]["wall_time_s"])
        self.assertEqual(header["run"]["dof"], 6)
        self.assertEqual(header["run"]["stages"][0]["planned_duration"], 1e5)
        self.assertIsNone(header["run"]["stages"][0]["damage"]["slip_max_m"])
        self.keyblock("export", "out", "--format", "geojson")
        files = [path.name for path in (self.folder / "out/geojson").glob("*.geojson")]
        self.assertEqual(files, ["stage_1_slide_unfinished.geojson"])

    def test_a_second_interrupt_ends_at_once(self):
        run = self.start("out", *lasting(1e5))
        run.send_signal(signal.SIGSTOP)  # both signals arrive before the next step
        run.send_signal(signal.SIGINT)
        run.send_signal(signal.SIGTERM)
        run.send_signal(signal.SIGCONT)
        run.communicate(timeout=30)
        self.assertIn(run.returncode, (-signal.SIGINT, -signal.SIGTERM))


class Killed(Background, LittleRoom):
    """A run that is killed, or whose disk is full, loses nothing that its checkpoint is beyond."""

    # 1000 steps a second, a checkpoint every 2000 of them.
    OPTIONS = (*lasting(40.0), "--set", "output.frame_interval=1.0")

    def tables(self, folder):
        """All rows of the result file, and the stages but for their wall time."""
        tables = {"histories.csv": (self.folder / folder / "histories.csv").read_bytes()}
        for kind in ("csv", "vtk"):
            self.keyblock("export", folder, "--format", kind)
            for path in (self.folder / folder / kind).iterdir():
                tables[f"{kind}/{path.name}"] = path.read_bytes()
        stages = self.summary(folder)["stages"]
        for stage in stages:
            del stage["wall_time_s"]
        return tables | {"stages": stages}

    def assert_same(self, folder, whole):
        tables, expected = self.tables(folder), self.tables(whole)
        self.assertEqual(set(tables), set(expected))
        for name, table in expected.items():
            self.assertEqual(tables[name], table, name)
        self.assertEqual(self.summary(folder)["state_hash"], self.summary(whole)["state_hash"])

    def inode(self, name):
        try:
            return (self.folder / "out" / name).stat().st_ino
        except FileNotFoundError:
            return None

    def kill_when_replaced(self, name, count, *options):
        """Kills a run right after it has given a file its place so many times; returns whether the run had not ended before."""
        run = self.start("out", *self.OPTIONS, *options)
        for _ in range(count):
            before = self.inode(name)
            while self.inode(name) == before and run.poll() is None:
                pass
        run.kill()
        run.communicate(timeout=30)
        return run.returncode == -signal.SIGKILL

    def test_resumes_to_the_tables_of_a_run_that_was_never_stopped(self):
        self.keyblock("run", "incline.toml", "-o", "whole", *self.OPTIONS)
        kills = self.kill_when_replaced("checkpoint.bin", 2)
        for name, count in (("result.h5", 1), ("checkpoint.bin", 1), ("result.h5", 1), ("checkpoint.bin", 3), ("result.h5", 1)):
            kills += self.kill_when_replaced(name, count, "--resume")
        self.assertGreaterEqual(kills, 3)
        self.keyblock("run", "incline.toml", "-o", "out", "--resume", *self.OPTIONS)
        self.assert_same("out", "whole")

    def test_what_was_written_to_a_full_disk_is_readable(self):
        self.keyblock("run", "incline.toml", "-o", "whole", *self.OPTIONS)
        size = (self.folder / "whole/result.h5").stat().st_size
        rows = self.tables("whole")["csv/steps.csv"]
        for share in (0.3, 0.5, 0.7, 0.9, 0.98):
            folder = f"out{share}"
            done = self.limited(int(share * size), "run", "incline.toml", "-o", folder, *self.OPTIONS)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("File too large", done.stderr)
            self.keyblock("export", folder, "--format", "csv")
            written = (self.folder / folder / "csv/steps.csv").read_bytes()
            self.assertGreater(len(written), 0.5 * share * len(rows))
            self.assertTrue(rows.startswith(written))
            self.keyblock("report", folder)
            self.keyblock("run", "incline.toml", "-o", folder, "--resume", *self.OPTIONS)
            self.assert_same(folder, "whole")


if __name__ == "__main__":
    unittest.main()
