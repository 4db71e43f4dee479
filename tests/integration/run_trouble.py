#!/usr/bin/env python3
"""Runs that cannot write, and runs that are stopped: what is there is kept, and they go on from it."""

import json
import re
import resource
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ROOT, Scenario


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
        self.write("q.csv", "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,0.0\n")
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
    def start(self, folder, *options, **how):
        """A run that has begun to write its results."""
        run = subprocess.Popen(
            [PROGRAM, "run", "incline.toml", "-o", folder, *options],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how,
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

    def test_what_a_process_that_is_gone_was_writing_is_taken_away(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        gone = subprocess.Popen(["true"])
        gone.wait()
        for options in ((), ("--resume",)):
            names = {f"{name}.{gone.pid}.tmp" for name in ("report.html", "summary.json", "checkpoint.bin")}
            for name in names:
                self.write(f"out/{name}", "half")
            self.keyblock("run", "incline.toml", "-o", "out", *options)
            self.assertFalse(names & {path.name for path in (self.folder / "out").iterdir()}, options)

    def test_every_signal_to_end_stops_a_run_within_a_second(self):
        for signal_ in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal_.name):
                run = self.start(signal_.name, *lasting(1e5))
                run.send_signal(signal_)
                sent = time.monotonic()
                _, errors = run.communicate(timeout=30)
                self.assertEqual(run.returncode, 2, errors)
                self.assertIn("interrupted; --resume goes on", errors)
                self.assertLess(time.monotonic() - sent, 5.0)  # a second, and the report on a busy machine
                self.assertTrue((self.folder / signal_.name / "report.html").exists())

    def test_a_stop_within_a_static_stage(self):
        # Friction that does not hold, and a tolerance that is not reached: the stage does not end by itself.
        text = (self.folder / "incline.toml").read_text()
        text = text.replace('kind = "rest"\nduration = 0.5', 'kind = "settle"\nmax_steps = 10000000\ntolerance = 1e-300')
        self.write("incline.toml", text.replace("friction = 20.0", "friction = 45.0"))
        run = self.start("static")
        run.send_signal(signal.SIGHUP)
        sent = time.monotonic()
        _, errors = run.communicate(timeout=30)
        self.assertEqual(run.returncode, 2, errors)
        self.assertLess(time.monotonic() - sent, 5.0)
        self.assertEqual(self.summary("static")["stages"][0]["name"], "slide")

    def test_a_stop_while_joints_are_cut_ends_at_once(self):
        cut = subprocess.Popen(
            [PROGRAM, "cut", str(ROOT / "examples/01-tunnel.toml"), "-o", "cut", "--set", "domain.x=[-60.0, 60.0]", "--set", "domain.y=[-60.0, 60.0]"],
            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        time.sleep(0.3)
        self.assertIsNone(cut.poll())
        cut.send_signal(signal.SIGHUP)
        self.assertEqual(cut.wait(timeout=5), -signal.SIGHUP)
        self.assertEqual(list((self.folder / "cut").iterdir()), [])

    def test_a_hangup_that_is_ignored_stays_ignored(self):
        run = self.start("nohup", *lasting(1e5), preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        run.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        self.assertIsNone(run.poll())
        run.send_signal(signal.SIGTERM)
        _, errors = run.communicate(timeout=30)
        self.assertEqual(run.returncode, 2, errors)

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


class Balance(Scenario):
    """A run whose energies do not balance has failed; its results are kept."""

    SOURCE = ROOT / "tests/data/hard/made-energy.toml"
    REASON = re.compile(
        r"the balance of energies misses \d+\.?\d* % of its largest term, more than 5 %: forces and motion do not belong together, "
        r"and the results are not to be used; a smaller time.step may help"
    )

    MADE = r"(; the rule of time integration has made energy, .*, may help)?"  # of more than half of it

    def test_a_run(self):
        done = self.keyblock("run", self.SOURCE, "-o", "out", expect=2)
        self.assertRegex(
            done.stderr.splitlines()[-1], f"^keyblock: errors of the computation: {self.REASON.pattern}{self.MADE}; the results are kept$"
        )
        self.assertRegex(done.stdout, "note: " + self.REASON.pattern)
        summary = self.summary("out")
        self.assertGreater(summary["energy"]["residual_ratio"], 0.05)
        missed, made = summary["energy_warnings"]
        self.assertRegex(missed, self.REASON)
        self.assertIn("the rule of time integration has made energy", made)
        self.assertFalse(summary["interrupted"])
        before = {p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}
        self.assertIn("report.html", before)
        done = self.keyblock("run", self.SOURCE, "-o", "out", "--resume", expect=2)
        self.assertIn("this run has ended", done.stdout)
        self.assertRegex(done.stderr, self.REASON)
        self.assertEqual({p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}, before)
        self.keyblock("export", "out", "--format", "csv")

    def test_runs_of_a_study_and_of_a_limit(self):
        self.write("study.toml", self.SOURCE.read_text() + "[study]\nrealizations = 1\n")
        done = self.keyblock("study", "run", "study.toml", "-o", "study", expect=2)
        self.assertRegex(done.stdout, self.REASON)
        (folder,) = (self.folder / "study/runs").iterdir()
        self.assertRegex(json.loads((folder / "failed.json").read_text())["error"], self.REASON)
        words = ("--key", "joints.friction", "--from", "0.2", "--to", "0", "--until", "moved", "-o", "limit")
        done = self.keyblock("limit", self.SOURCE, *words, expect=2)
        self.assertRegex(done.stdout + done.stderr, self.REASON)

    def test_other_runs_balance(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        self.assertEqual(self.summary("out")["energy_warnings"], [])


if __name__ == "__main__":
    unittest.main()
