#!/usr/bin/env python3
"""Studies in trouble: runs and studies that are killed, wrong input, folders that another process has, full disks."""

import contextlib
import os
import resource
import signal
import subprocess
import unittest

from program import PROGRAM, process_of, wait_for
from study_case import GALLERY, SMALL, Study


def with_durations(short, long):
    """Two realizations, two runs of each; 100 s of simulated time take about a second."""
    return GALLERY + f'[study]\nrealizations = 2\nkeep = "measures"\n[[study.vary]]\nkey = "stage.after.duration"\nvalues = [{short}, {long}]\n'


class Interruptions(Study):
    def setUp(self):
        super().setUp()
        self.write("long.toml", with_durations(0.1, 120.0))

    def start(self):
        parent = subprocess.Popen([PROGRAM, "study", "run", "long.toml", "-o", "out", "--workers", "2"], cwd=self.folder,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # fmt: skip
        self.addCleanup(parent.stdout.close)
        self.addCleanup(parent.stderr.close)
        return parent

    def child(self, *index):
        return process_of(["study", "task", "out", *map(str, index)], self.folder)

    def task(self, index):
        """The process that is at this run, once it holds the run's lock."""

        def holder():
            child = self.child(index)
            with contextlib.suppress(FileNotFoundError):
                text = self.run_file(self.keys()[index]).with_name("lock").read_text()
                return child if text.startswith(f"process {child} on ") else None

        return wait_for(holder, f"a process at run {index}")

    def test_a_run_that_is_killed_costs_that_run_alone(self):
        parent = self.start()
        os.kill(self.task(1), signal.SIGKILL)
        _, errors = parent.communicate(timeout=60)
        keys = self.keys()
        self.assertEqual(parent.returncode, 2)
        self.assertRegex(errors, rf"{keys[1]} failed: killed by signal 9 \(SIGKILL\)")
        self.assertEqual(set(self.done()), {keys[0], keys[2], keys[3]})
        said = self.study("collect", "out").stdout
        self.assertIn(f"failed: {keys[1]}: killed by signal 9", said)
        self.assertIn("3 of 4 runs done, 1 failed\n", said)
        before = self.done()
        self.assertIn("4 of 4 runs done\n", self.run_study("long.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)
        self.assertFalse((self.out / "runs" / keys[1] / "failed.json").exists())

    def test_killing_the_parent_ends_its_children_and_loses_nothing_done(self):
        parent = self.start()
        self.task(1)
        wait_for(lambda: len(self.done()) >= 1, "the first run to be done")
        before = self.done()
        parent.kill()
        parent.communicate()
        wait_for(lambda: self.child() is None, "the children to end")
        self.assertIn("4 of 4 runs done\n", self.run_study("long.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)
        self.assertEqual(list(self.out.rglob("*.tmp")), [])

    def test_a_run_whose_numbers_are_none_has_failed(self):
        self.write("stiff.toml", GALLERY + '[study]\nkeep = "measures"\n[[study.vary]]\nkey = "rock.young"\nvalues = [5e9, 1e308]\n')
        said = self.run_study("stiff.toml", expect=2).stdout
        self.assertRegex(said, rf"failed: {self.keys()[1]}: the energies after step \d+ of stage 'in situ' are no finite numbers")
        self.assertIn("1 of 2 runs done, 1 failed\n", said)

    def test_interrupted(self):
        parent = self.start()
        self.task(1)
        wait_for(lambda: len(self.done()) >= 1, "the first run to be done")
        parent.send_signal(signal.SIGINT)
        said, errors = parent.communicate(timeout=30)
        self.assertEqual(parent.returncode, 2, errors)
        self.assertIn("--resume", errors)
        self.assertIn("missing", said)
        self.assertNotIn("failed", said)
        self.assertIsNone(self.child())
        self.assertIn("4 of 4 runs done\n", self.run_study("long.toml", "--resume").stdout)

    def test_two_in_one_folder(self):
        self.write("long.toml", with_durations(0.1, 1e5))  # still at it when the others come
        parent = self.start()
        child = self.task(1)
        refused = self.run_study("long.toml", "--resume", expect=1)
        self.assertIn(f"out: found a study that process {parent.pid} on ", refused.stderr)
        again = self.study("task", "out", "1", expect=2)
        self.assertIn(f"process {child} on ", again.stderr)
        parent.send_signal(signal.SIGINT)
        parent.communicate(timeout=30)


class WrongInput(Study):
    def test_an_unknown_key_in_the_grid(self):
        self.write("wrong.toml", GALLERY + SMALL.replace("stage.shaken.scale", "stage.shaken.scales"))
        line = (GALLERY + SMALL).split("\n").index('key = "stage.shaken.scale"') + 2
        errors = self.run_study("wrong.toml", expect=1).stderr
        self.assertRegex(errors, rf"wrong\.toml:{line}:\d+: stage\.shaken\.scales: found an unknown key; .*'scale'")
        self.assertFalse(self.out.exists())

    def test_no_study_there(self):
        self.assertIn("no plan.json", self.study("collect", ".", expect=1).stderr)
        self.assertIn("no plan.json", self.study("task", "gone", "0", expect=1).stderr)

    def test_indices_of_tasks(self):
        self.study("submit", "small.toml", "-o", "out")
        self.assertIn("from 0 to 5", self.study("task", "out", "6", expect=1).stderr)
        self.assertIn("SLURM_ARRAY_TASK_ID", self.study("task", "out", expect=1).stderr)
        for variable, value, more, index in (
            ("SLURM_ARRAY_TASK_ID", "1", (), 1), ("SGE_TASK_ID", "3", ("--first", "1"), 2), ("PBS_ARRAY_INDEX", "3", (), 3),
            ("PBS_ARRAYID", "4", (), 4), ("LSB_JOBINDEX", "6", ("--first", "1"), 5), ("JOB_COMPLETION_INDEX", "0", (), 0),
        ):  # fmt: skip
            environment = {**os.environ, variable: value}
            done = subprocess.run([PROGRAM, "study", "task", "out", *more], cwd=self.folder, env=environment,
                                  capture_output=True, text=True, timeout=60)  # fmt: skip
            self.assertEqual(done.stdout, f"{self.keys()[index]}: done\n", done.stderr)
        self.assertIn("done before", self.study("task", "out", "1").stdout)
        self.assertIn("6 of 6 runs done\n", self.study("collect", "out").stdout)

    def test_a_run_that_fails_says_why(self):
        # That a point lies outside all blocks is seen when they are cut, not when the plan is made.
        self.write("far.toml", GALLERY + '[[history]]\nname = "p"\npoint = [2.0, 2.0]\n[study]\nkeep = "report"\n'
                   '[[study.vary]]\nkey = "history.p.point"\nvalues = [[2.0, 2.0], [20.0, 2.0]]\n')  # fmt: skip
        done = self.run_study("far.toml", expect=2)
        keys = self.keys()
        self.assertRegex(done.stderr, rf"{keys[1]} failed: .*history.p.point: found \[20, 2\], outside")
        self.assertEqual(set(self.done()), {keys[0]})

    def test_submit_writes_scripts(self):
        said = self.study("submit", "small.toml", "-o", "out", "--time", "10:00", "--mem", "1G", "--max-running", "4").stdout
        self.assertIn("6 of 6 runs to be done", said)
        script = (self.out / "array.sbatch").read_text()
        for line in ("--array=0-5%4", "--time=10:00", "--mem=1G"):
            self.assertIn(f"#SBATCH {line}\n", script)
        # The script does what a task does.
        subprocess.run(["bash", self.out / "array.sbatch"], env={**os.environ, "SLURM_ARRAY_TASK_ID": "3"}, check=True,
                       capture_output=True, timeout=60)  # fmt: skip
        self.assertEqual(set(self.done()), {self.keys()[3]})
        self.study("submit", "small.toml", "-o", "out", "--resume", "--per-task", "4")
        script = (self.out / "array.sbatch").read_text()
        self.assertIn("#SBATCH --array=0-1\n", script)
        subprocess.run(["bash", self.out / "array.sbatch"], env={**os.environ, "SLURM_ARRAY_TASK_ID": "1"}, check=True,
                       capture_output=True, timeout=60)  # fmt: skip
        self.assertEqual(set(self.done()), {self.keys()[k] for k in (3, 4, 5)})


    def test_scripts_of_an_earlier_submission_go(self):
        self.slurm("MaxArraySize = 2")
        self.submit()
        self.assertEqual(self.scripts(), ["array-2.sbatch", "array-3.sbatch", "array.sbatch"])
        self.study("task", "out", "0")
        self.study("task", "out", "1")
        self.submit("--resume")
        self.assertEqual(self.scripts(), ["array-2.sbatch", "array.sbatch"])
        self.run_study("small.toml", "--resume")
        self.submit("--resume")
        self.assertEqual(self.scripts(), [])

    def test_a_cluster_without_arrays(self):
        self.slurm("MaxArraySize = 0")
        self.assertIn("MaxArraySize = 0", self.submit(expect=1))
        self.assertFalse(self.out.exists())

    def slurm(self, config):
        """A `scontrol` that says this."""
        (self.folder / "bin").mkdir()
        tool = self.folder / "bin/scontrol"
        tool.write_text(f"#!/bin/sh\necho '{config}'\n")
        tool.chmod(0o755)

    def submit(self, *more, expect=0):
        environment = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}
        done = subprocess.run([PROGRAM, "study", "submit", "small.toml", "-o", "out", *more], cwd=self.folder, env=environment,
                              capture_output=True, text=True, timeout=60)  # fmt: skip
        self.assertEqual(done.returncode, expect, done.stderr)
        return done.stdout + done.stderr

    def scripts(self):
        return sorted(path.name for path in self.out.glob("array*"))


class FullDisk(Study):
    def no_space(self, size):
        """The study's folder becomes a small file system of its own, where that is allowed."""
        self.out.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", self.out], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("no file system can be mounted here")
        self.addCleanup(subprocess.run, ["umount", self.out], check=True)

    def test_no_space_left(self):
        self.no_space("800k")
        self.write("kept.toml", GALLERY + SMALL.replace("measures", "report"))
        errors = self.run_study("kept.toml", expect=2).stderr
        self.assertIn("No space left on device", errors)
        before = self.done()
        self.assertGreater(len(before), 0)
        subprocess.run(["mount", "-o", "remount,size=50m", self.out], check=True)
        self.assertIn("6 of 6 runs done\n", self.run_study("kept.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)

    def test_files_that_may_not_grow(self):
        self.write("kept.toml", GALLERY + SMALL.replace("measures", "report"))

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))

        done = subprocess.run([PROGRAM, "study", "run", "kept.toml", "-o", "out"], cwd=self.folder, capture_output=True,
                              text=True, timeout=60, preexec_fn=limit)  # fmt: skip
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, r"failed: .*report\.html: cannot write: File too large")
        self.assertEqual(list(self.out.rglob("*.tmp")), [])
        self.assertIn("6 of 6 runs done\n", self.run_study("kept.toml", "--resume").stdout)


if __name__ == "__main__":
    unittest.main()
