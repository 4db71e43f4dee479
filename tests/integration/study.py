#!/usr/bin/env python3
"""Studies from end to end: many runs, runs that are killed, studies that go on, folders that hold something else."""

import contextlib
import csv
import json
import os
import resource
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ROOT, Scenario

GALLERY = (ROOT / "tests/data/study/gallery.toml").read_text().split("[study]")[0]
SCALES = '[[study.vary]]\nkey = "stage.shaken.scale"\nvalues = [0.5, 1.0]\n'
SMALL = '[study]\nrealizations = 3\nkeep = "measures"\n' + SCALES
# Of two runs of each realization, the second lasts some seconds.
LONG = '[study]\nrealizations = 2\nkeep = "measures"\n[[study.vary]]\nkey = "stage.after.duration"\nvalues = [0.1, 120.0]\n'


def checksum(text):
    """FNV-1a, 64 bit."""
    value = 14695981039346656037
    for byte in text.encode():
        value = ((value ^ byte) * 1099511628211) % 2**64
    return f"{value:016x}"


def process_of(words):
    """The id of a process whose command line contains these words, one after the other."""
    wanted = "\0".join(words) + "\0"
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        with contextlib.suppress(OSError), open(f"/proc/{entry}/cmdline") as file:
            if wanted in file.read():
                return int(entry)
    return None


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

    def done(self):
        """When the results of the runs that are done were written."""
        return {path.parent.name: path.stat().st_mtime_ns for path in (self.out / "runs").glob("*/run.json")}

    def files(self):
        return {path: path.read_bytes() for path in self.out.iterdir() if path.is_file() and path.name != "lock"}

    def hashes(self, folder="out"):
        paths = sorted((self.folder / folder / "runs").glob("*/run.json"))
        return {path.parent.name: json.loads(path.read_text())["state_hash"] for path in paths}

    def wait_for(self, condition, what, seconds=30.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = condition()
            if found:
                return found
            time.sleep(0.02)
        self.fail(f"waited in vain: {what}")


class Runs(Study):
    def test_all_combinations_of_all_realizations(self):
        done = self.run_study("small.toml")
        self.assertIn("6 of 6 runs done\n", done.stdout)
        plan = self.plan()
        self.assertEqual([(run["realization"], run["values"]) for run in plan["runs"]],
                         [(k, [[scale]]) for k in range(3) for scale in ("0.5", "1.0")])  # fmt: skip
        for run in plan["runs"]:
            result = self.result(run["key"])
            self.assertEqual((result["key"], result["realization"], result["values"]),
                             (run["key"], run["realization"], run["values"][0]))  # fmt: skip
            self.assertEqual([stage["name"] for stage in result["stages"]], ["in situ", "excavated", "shaken", "after"])
            self.assertEqual(sum(result["map"][1::2]), plan["map"]["columns"] * plan["map"]["rows"])
            shaken = result["stages"][2]
            self.assertAlmostEqual(shaken["pga_m_s2"], 3.0 * float(run["values"][0][0]))
            # A whole sine from rest: the velocity at its middle is 2 a / ω.
            self.assertAlmostEqual(shaken["pgv_m_s"], 2 * shaken["pga_m_s2"] / (8 * 3.141592653589793), places=5)
        with open(self.out / "runs.csv", newline="") as file:
            self.assertEqual([row["key"] for row in csv.DictReader(file)], self.keys())

    def test_a_run_is_that_of_the_run_command(self):
        self.run_study("small.toml")
        run = self.plan()["runs"][3]
        self.keyblock("run", "small.toml", "-o", "alone", "--realization", run["realization"],
                      "--set", f"stage.shaken.scale={run['values'][0][0]}")  # fmt: skip
        alone, result = self.summary("alone"), self.result(run["key"])
        for field in ("state_hash", "steps", "blocks", "max_overlap_m"):
            self.assertEqual(result[field], alone[field], field)
        for stage, expected in zip(result["stages"], alone["stages"]):
            self.assertEqual(stage["damage"], expected["damage"])

    def test_any_number_of_workers_gives_the_same_and_all_scales_the_same_joints(self):
        self.run_study("small.toml")
        self.study("run", "small.toml", "-o", "one", "--workers", "1")
        self.assertEqual(self.hashes(), self.hashes("one"))
        for k in range(3):
            self.assertEqual(len({self.result(key)["blocks"] for key in self.keys()[2 * k : 2 * k + 2]}), 1)

    def test_what_is_kept(self):
        files = {
            "measures": {"run.json", "thumbnail.svg", "log.txt"},
            "report": {"run.json", "thumbnail.svg", "log.txt", "report.html", "summary.json"},
            "all": {"run.json", "thumbnail.svg", "log.txt", "report.html", "summary.json", "result.h5"},
        }
        results = []
        for keep, expected in files.items():
            self.write("kept.toml", GALLERY + f'[study]\nkeep = "{keep}"\n')
            self.study("run", "kept.toml", "-o", keep)
            (folder,) = (self.folder / keep / "runs").iterdir()
            self.assertEqual({path.name for path in folder.iterdir()}, expected)
            result = json.loads((folder / "run.json").read_text())
            results.append({name: value for name, value in result.items() if name not in ("wall_time_s", "checksum")})
        self.assertEqual(results[0], results[1])
        self.assertEqual(results[0], results[2])
        # The report without a result file is the one with it.
        reports = [next((self.folder / keep / "runs").iterdir()) / "report.html" for keep in ("report", "all")]
        self.assertAlmostEqual(*(len(path.read_bytes()) for path in reports), delta=200)

    def test_keys_that_vary_together(self):
        self.write("linked.toml", GALLERY + '[study]\nkeep = "measures"\n[[study.vary]]\n'
                   'keys = ["stage.shaken.scale", "stage.after.duration"]\nvalues = [[0.5, 0.1], [1, 0.2]]\n')  # fmt: skip
        self.run_study("linked.toml")
        self.assertEqual([self.result(key)["values"] for key in self.keys()], [["0.5, 0.1"], ["1, 0.2"]])

    def test_variants_of_the_check_for_marginal_results(self):
        self.write("marginal.toml", GALLERY + '[study]\nkeep = "measures"\nmarginal = {}\n')
        self.run_study("marginal.toml")
        runs = [self.result(key) for key in self.keys()]
        self.assertEqual([run["variant"] for run in runs], ["", "friction-", "friction+", "released"])
        self.assertEqual([stage["name"] for stage in runs[3]["stages"]], ["in situ", "shaken", "after"])
        self.assertEqual(len({run["state_hash"] for run in runs}), 4)
        # The same by hand.
        self.keyblock("run", "marginal.toml", "-o", "by-hand", "--set", "joints.friction=27", "--set", "joint_set.flat.friction=22")
        self.assertEqual(self.summary("by-hand")["state_hash"], runs[1]["state_hash"])

    def test_until_an_interval_is_narrow(self):
        until = 'until = { measure = "slipped_length_m", half_width = 0.75, minimum = 3, maximum = 12 }\n'
        self.write("until.toml", GALLERY + '[study]\nkeep = "measures"\n' + until + SCALES)
        said = self.run_study("until.toml").stdout
        self.assertRegex(said, r"enough: \d+ realizations")
        enough = int(said.split("enough: ")[1].split()[0])
        self.assertTrue(3 <= enough < 12, said)
        self.assertIn(f"{2 * enough} of {2 * enough} runs done\n", said)
        alone = self.study("run", "until.toml", "-o", "one", "--workers", "1").stdout
        self.assertEqual(said.replace("out/", "one/"), alone)
        before = self.done()
        self.run_study("until.toml", "--resume")
        self.assertEqual(self.done(), before)
        self.assertIn("does not ask for it", self.study("task", "one", 2 * enough).stdout)
        self.write("until.toml", GALLERY + '[study]\nkeep = "measures"\n' + until.replace("0.75", "0.0001") + SCALES)
        self.assertIn("24 of 24 runs done\n", self.run_study("until.toml", "--resume").stdout)


class Interruptions(Study):
    def setUp(self):
        super().setUp()
        self.write("long.toml", GALLERY + LONG)

    def start(self):
        parent = subprocess.Popen([PROGRAM, "study", "run", "long.toml", "-o", "out", "--workers", "2"], cwd=self.folder,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # fmt: skip
        self.addCleanup(parent.stdout.close)
        self.addCleanup(parent.stderr.close)
        return parent

    def task(self, index):
        return self.wait_for(lambda: process_of(["study", "task", "out", str(index)]), f"run {index}")

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
        self.wait_for(lambda: len(self.done()) >= 1, "the first run to be done")
        before = self.done()
        parent.kill()
        parent.communicate()
        self.wait_for(lambda: process_of(["study", "task", "out"]) is None, "the children to end")
        self.assertIn("4 of 4 runs done\n", self.run_study("long.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)
        self.assertEqual(list(self.out.rglob("*.tmp")), [])

    def test_interrupted(self):
        parent = self.start()
        self.task(1)
        self.wait_for(lambda: len(self.done()) >= 1, "the first run to be done")
        parent.send_signal(signal.SIGINT)
        said, errors = parent.communicate(timeout=30)
        self.assertEqual(parent.returncode, 2, errors)
        self.assertIn("--resume", errors)
        self.assertIn("missing", said)
        self.assertNotIn("failed", said)
        self.assertIsNone(process_of(["study", "task", "out"]))
        self.assertIn("4 of 4 runs done\n", self.run_study("long.toml", "--resume").stdout)

    def test_two_in_one_folder(self):
        parent = self.start()
        self.task(0)
        refused = self.run_study("long.toml", "--resume", expect=1)
        self.assertIn(f"out: found a study that process {parent.pid} on ", refused.stderr)
        child = self.task(1)
        again = self.study("task", "out", "1", expect=2)
        self.assertIn(f"process {child} on ", again.stderr)
        parent.send_signal(signal.SIGINT)
        parent.communicate(timeout=30)


class GoingOn(Study):
    def test_more_realizations_and_more_values_use_the_runs_that_are_done(self):
        self.run_study("small.toml")
        before, keys = self.done(), self.keys()
        self.write("small.toml", GALLERY + SMALL.replace("= 3", "= 4").replace("[0.5, 1.0]", "[2.0, 1.0, 0.5]"))
        self.assertIn("12 of 12 runs done\n", self.run_study("small.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)
        self.assertEqual(self.keys()[:6], keys)  # an index stays that of its run

    def test_fewer_values_leave_runs_aside(self):
        self.run_study("small.toml")
        keys = self.keys()
        self.write("small.toml", GALLERY + SMALL.replace("[0.5, 1.0]", "[1.0]"))
        self.assertIn("3 of 3 runs done\n", self.run_study("small.toml", "--resume").stdout)
        self.assertEqual(self.keys(), keys)
        self.assertEqual(len(self.done()), 6)

    def test_comments_and_the_order_of_keys_do_not_matter(self):
        self.run_study("small.toml")
        before = self.done()
        text = (GALLERY + SMALL).replace("density = 2500.0\nyoung = 2.0e9\n", "young = 2e9  # soft\ndensity = 2500.0\n")
        self.write("small.toml", text)
        self.run_study("small.toml", "--resume")
        self.assertEqual(self.done(), before)

    def test_another_study_is_refused(self):
        self.run_study("small.toml")
        before = self.files()
        self.assertIn("--resume", self.run_study("small.toml", expect=1).stderr)
        other = self.run_study("small.toml", "--resume", "--set", "rock.young=3e9", expect=1).stderr
        self.assertIn("out: found another study: rock.young: 2000000000.0 there, 3000000000.0 here", other)
        self.write("small.toml", (GALLERY + SMALL).replace('name = "steep"\ndip = 75.0', 'name = "steep"\ndip = 70.0'))
        self.assertIn("joint_set[0].dip: 75.0 there, 70.0 here", self.run_study("small.toml", "--resume", expect=1).stderr)
        self.assertEqual(self.files(), before)
        self.keyblock("run", "incline.toml", "-o", "single")
        self.assertIn("the results of a run", self.study("run", "small.toml", "-o", "single", expect=1).stderr)

    def test_a_motion_file_that_changes(self):
        self.write("motion.csv", "# m/s2\n0.0,0.0\n0.1,1.0\n0.2,0.0\n")
        text = GALLERY.replace("x = { amplitude = 3.0, frequency = 4.0, cycles = 2.0 }",
                               'components = [{ file = "motion.csv", azimuth = 90.0 }]')  # fmt: skip
        self.write("file.toml", text + SMALL)
        self.run_study("file.toml")
        self.write("motion.csv", "# m/s2\n0.0,0.0\n0.1,2.0\n0.2,0.0\n")
        self.assertRegex(self.run_study("file.toml", "--resume", expect=1).stderr, r"the content of .*motion\.csv")
        self.run_file(self.keys()[2]).unlink()
        self.assertIn("has changed since the study was planned", self.study("task", "out", "2", expect=1).stderr)

    def test_a_study_can_be_moved_with_its_scenario(self):
        self.run_study("small.toml")
        self.run_file(self.keys()[0]).unlink()
        (self.folder / "moved").mkdir()
        self.out.rename(self.folder / "moved/out")
        self.scenario.with_name("small.toml").rename(self.folder / "moved/small.toml")
        self.study("task", "moved/out", "0")
        self.assertIn("6 of 6", self.study("collect", "moved/out").stdout)

    def test_a_study_can_be_moved_alone(self):
        self.run_study("small.toml")
        self.run_file(self.keys()[0]).unlink()
        (self.folder / "deep").mkdir()
        self.out.rename(self.folder / "deep/out")
        self.study("run", "small.toml", "-o", "deep/out", "--resume")

    def test_a_damaged_result_is_named_and_run_again(self):
        self.run_study("small.toml")
        keys, before = self.keys(), self.done()
        whole = [self.run_file(key).read_text() for key in keys]
        self.run_file(keys[1]).write_text(whole[1][: len(whole[1]) // 2])
        self.run_file(keys[2]).write_text("")
        self.run_file(keys[3]).write_text(whole[3].replace('"steps":', '"steps":1'))
        self.run_file(keys[4]).write_text(whole[5])
        said = self.study("collect", "out").stdout
        for key in keys[1:5]:
            self.assertRegex(said, rf"damaged: out/runs/{key}/run.json: found ")
        self.assertIn("2 of 6 runs done, 4 damaged\n", said)
        again = self.run_study("small.toml", "--resume")
        self.assertIn(f"out/runs/{keys[1]}/run.json: found a truncated file; it is run again", again.stderr)
        self.assertIn("6 of 6 runs done\n", again.stdout)
        self.assertEqual([self.result(key)["state_hash"] for key in keys], [json.loads(text)["state_hash"] for text in whole])
        self.assertEqual({key for key in keys if self.done()[key] == before[key]}, {keys[0], keys[5]})

    def test_a_damaged_plan(self):
        self.run_study("small.toml")
        path = self.out / "plan.json"
        path.write_text(path.read_text()[:200])
        self.assertIn("out/plan.json: found a damaged file", self.study("collect", "out", expect=1).stderr)


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
        # Two excavations at once are right, each alone; here the second is no value of its own that could be refused before.
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


class Large(Study):
    def many(self, realizations):
        """A study whose runs are all done: copies of one."""
        self.write("many.toml", GALLERY + SMALL.replace("= 3", f"= {realizations}"))
        self.study("submit", "many.toml", "-o", "out")
        self.study("task", "out", "0")
        runs = self.plan()["runs"]
        text = self.run_file(runs[0]["key"]).read_text()
        for run in runs[1:]:
            result = json.loads(text)
            result |= {"key": run["key"], "realization": run["realization"], "values": [row[0] for row in run["values"]]}
            del result["checksum"]
            line = json.dumps(result, separators=(",", ":"))[:-1]
            self.run_file(run["key"]).parent.mkdir()
            self.run_file(run["key"]).write_text(f'{line},"checksum":"{checksum(line)}"}}\n')
        return len(runs)

    def test_a_study_that_is_done_is_resumed_without_a_run(self):
        count = self.many(300)
        begin = time.monotonic()
        said = self.run_study("many.toml", "--resume").stdout
        print(f"resuming a study of {count} runs: {time.monotonic() - begin:.2f} s")
        self.assertIn(f"{count} of {count} runs done\n", said)
        self.assertEqual(list(self.out.rglob("log.txt")), [])


if __name__ == "__main__":
    unittest.main()
