#!/usr/bin/env python3
"""Files and names that somebody has made up: they destroy nothing of the user, and say what is wrong with them."""

import csv
import json
import os
import re
import unittest

from program import INCLINE, Scenario
from study_case import Study


class FolderOfARun(Scenario):
    def foreign(self, folder, name):
        (self.folder / folder).mkdir()
        return self.folder / folder / name

    def test_a_lock_of_the_user_stays(self):
        notes = self.foreign("a", "lock")
        notes.write_text("my notes")
        error = self.keyblock("run", "incline.toml", "-o", "a", expect=1).stderr
        self.assertIn("a/lock: found a file of somebody else", error)
        self.assertEqual(notes.read_text(), "my notes")

    def test_a_link_named_lock_is_not_followed(self):
        precious = self.write("precious.txt", "precious")
        for target in ("../precious.txt", "../gone.txt"):
            self.foreign(target[3:7], "lock").symlink_to(target)
            error = self.keyblock("run", "incline.toml", "-o", target[3:7], expect=1).stderr
            self.assertIn("lock: found a link", error)
        self.assertEqual(precious.read_text(), "precious")
        self.assertFalse((self.folder / "gone.txt").exists())

    def test_temporary_names_that_are_taken(self):
        mine = self.foreign("out", "result.h5.tmp")
        mine.write_text("mine")
        self.keyblock("run", "incline.toml", "-o", "out")
        self.assertEqual(mine.read_text(), "mine")
        self.assertEqual([p.name for p in mine.parent.glob("*.tmp")], ["result.h5.tmp"])

    def test_an_export_does_not_follow_a_link(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        (self.folder / "elsewhere").mkdir()
        (self.folder / "out/csv").symlink_to("../elsewhere")
        self.assertIn("found a link", self.keyblock("export", "out", "--format", "csv", expect=1).stderr)
        self.assertEqual(list((self.folder / "elsewhere").iterdir()), [])

    def test_a_pipe_in_the_place_of_an_input(self):
        os.mkfifo(self.folder / "pipe")
        for words in ("run pipe -o out", "check pipe", "check /dev/zero"):
            self.assertIn("found a device or pipe", self.keyblock(*words.split(), expect=1).stderr)
        out = self.foreign("out", "scenario.toml")
        os.mkfifo(out)
        self.assertIn("found a device or pipe", self.keyblock("run", "incline.toml", "-o", "out", expect=1).stderr)

    def test_trace_maps_that_are_no_files(self):
        os.mkfifo(self.folder / "pipe")
        (self.folder / "folder").mkdir()
        with open(self.folder / "huge", "w") as file:
            file.truncate(2**40)
        self.write("lines.csv", "x,y\n0,0\n1,1\n")
        text = INCLINE + '\n[domain]\nx = [0, 9]\ny = [0, 9]\n[[trace_map]]\nname = "m"\nfile = "FILE"\n'
        for name, found in (*((name, "expected a file that exists") for name in ("pipe", "folder", "gone")), ("huge", "at most 200 MB")):
            self.write("traces.toml", text.replace("FILE", name))
            for words in ("check traces.toml", "run traces.toml -o out", "cut traces.toml -o cut"):
                error = self.keyblock(*words.split(), expect=1).stderr
                self.assertIn(found, error)
                self.assertNotIn("internal error", error)


# A spreadsheet would run the first two, a browser the third, a terminal the last.
NAMES = """=cmd|' /C calc'!A0 +1+2 </script><script>alert(1)</script> \\u001B]0;owned\\u0007\\u001B[2J\\u009B31m"""
NAMED = INCLINE.replace('"A block on an incline"', f'"{NAMES}"').replace('"slider"', f'"{NAMES}"').replace('name = "s"', f'name = "{NAMES}"')
NAMED = NAMED.replace('name = "slide"', f'name = "{NAMES}"')


class Names(Study):
    def cells(self, path):
        with open(path, newline="") as file:
            return [cell for row in csv.reader(file) for cell in row]

    def assert_no_cell_runs(self, path):
        cells = self.cells(path)
        self.assertTrue(any(cell.startswith("'=cmd|") for cell in cells), path)
        for cell in cells:
            if cell[:1] in tuple("=+-@\t\r"):
                float(cell)

    def assert_harmless(self, done):
        self.assertRegex(done.stdout + done.stderr, r"\\(x1b|u001B)\]0;owned")
        for text in (done.stdout, done.stderr):
            self.assertEqual([c for c in text if (c < " " or "\x7f" <= c < "\xa0") and c not in "\n\t"], [])

    def test_spreadsheets_do_not_run_cells(self):
        self.write("named.toml", NAMED)
        self.keyblock("run", "named.toml", "-o", "run")
        self.keyblock("export", "run", "--format", "csv")
        for name in ("run/histories.csv", "run/csv/histories.csv", "run/csv/blocks.csv"):
            self.assert_no_cell_runs(self.folder / name)
        study = '[study]\n[[study.vary]]\nkeys = ["joints.friction", "gravity"]\nvalues = [[10, [0, -9.81]], [20, [0, -5.0]]]\n'
        self.write("study.toml", NAMED + study)
        self.run_study("study.toml")
        self.assert_no_cell_runs(self.out / "runs.csv")

    def test_terminals_do_not_obey_names(self):
        self.write("named.toml", NAMED)
        self.assert_harmless(self.keyblock("run", "named.toml", "-o", "run", "--set", "time.step=0.2"))
        self.write("wrong.toml", NAMED.replace("density = 2600.0", f'density = "{NAMES}"'))
        self.assert_harmless(self.keyblock("check", "wrong.toml", expect=1))
        (self.folder / "\x1b]0;owned\x07.toml").write_text(NAMED)
        self.assert_harmless(self.keyblock("check", "\x1b]0;owned\x07.toml"))

    def test_json_is_json_whatever_names_hold(self):
        text = (self.folder / "incline.toml").read_text()
        for code in [*range(0x7F, 0xA1), 0x1F, 0x200D, 0x2028, 0x2029, 0x202A, 0x202E, 0x2066, 0x2069, 0xFEFF, 0x10FFFF]:
            self.write("odd.toml", re.sub(r'^(title = ")', rf"\1\\U{code:08x}", text, flags=re.M) + '\n["a\\U%08x"]\n' % code)
            told = json.loads(self.keyblock("check", "odd.toml", "--json", expect=1).stdout)
            self.assertEqual(len(told["mistakes"]), 1, hex(code))
        self.write("odd.toml", re.sub(r'^title = "', '\\g<0>\\\\u2028', text, flags=re.M))
        self.assertIn("\\u2028", self.keyblock("cut", "odd.toml", "-o", "cut", "--json").stdout)


class FilesOfARunThatHasEnded(Scenario):
    def test_a_damaged_result_says_what_to_do(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        with open(self.folder / "out/result.h5", "r+") as file:
            file.truncate(5000)
        error = self.keyblock("run", "incline.toml", "-o", "out", "--resume", expect=1).stderr
        self.assertIn("result.h5", error)
        self.assertIn("to begin anew, run into another folder", error)
        self.keyblock("run", "incline.toml", "-o", "out")
        self.assertIn("has ended", self.keyblock("run", "incline.toml", "-o", "out", "--resume").stdout)

    def test_empty_files_are_written_again(self):
        self.keyblock("run", "incline.toml", "-o", "out")
        names = ("report.html", "histories.csv")
        before = [(self.folder / "out" / name).read_bytes() for name in names]
        for change in (lambda path: path.write_text(""), lambda path: path.unlink()):
            for name in names:
                change(self.folder / "out" / name)
            self.keyblock("run", "incline.toml", "-o", "out", "--resume")
            self.assertEqual([(self.folder / "out" / name).read_bytes() for name in names], before)


class FolderOfAStudy(Study):
    def forge(self, change):
        plan = self.plan()
        change(plan)
        (self.out / "plan.json").write_text(json.dumps(plan))

    def setUp(self):
        super().setUp()
        self.run_study("small.toml")
        self.victim = self.folder / "out/victim"
        (self.victim / "deep").mkdir(parents=True)
        (self.victim / "thesis.txt").write_text("precious")
        (self.victim / "deep/y").write_text("x")

    def assert_untouched(self):
        self.assertEqual(sorted(p.name for p in self.victim.rglob("*")), ["deep", "thesis.txt", "y"])
        self.assertEqual((self.victim / "thesis.txt").read_text(), "precious")

    def test_keys_of_runs_are_no_paths(self):
        key = self.keys()[0]
        for forged in ("../victim", "../../out/victim", str(self.victim), "..", ".", "", key + "/../../victim", key[:-1], key.upper(), key + "\n"):
            self.forge(lambda plan: plan["runs"][0].update(key=forged))
            for words in ("task out 0", "task out 1", "collect out"):
                self.assertIn("found the key", self.study(*words.split(), expect=1).stderr)
            self.assert_untouched()

    def test_plans_that_do_not_hold_together(self):
        good = self.plan()
        key = good["runs"][1]["key"]
        forgeries = (
            (lambda p: p["runs"][0].update(key=key), "twice"),
            (lambda p: p["runs"][0].update(realization=7), "as one of realization 7"),
            (lambda p: p["runs"][0].update(realization=-1), "as one of realization -1"),
            (lambda p: p["runs"][0].update(values=[]), "do not fit the axes"),
            (lambda p: p["runs"][0].update(values=[["0.5", "1"]]), "do not fit the axes"),
            (lambda p: p["runs"][0].update(variant="x"), 'the variant "x"'),
            (lambda p: p["map"].update(columns=10**9), "too many cells"),
            (lambda p: p["map"].update(rows=-3), "too many cells"),
            (lambda p: p["levels"][0].update(measure="x"), 'the unknown measure "x"'),
            (lambda p: p.update(confidence=1e9), "a confidence of"),
            (lambda p: p["axes"][0].update(keys=[]), "do not fit its keys"),
        )
        for change, found in forgeries:
            (self.out / "plan.json").write_text(json.dumps(good))
            self.forge(change)
            for words in ("task out 0", "collect out"):
                error = self.study(*words.split(), expect=1).stderr
                self.assertIn("plan.json: found ", error)
                self.assertIn(found, error)
                self.assertIn("run the study again", error)

    def test_links_in_the_place_of_folders_of_runs(self):
        key = self.keys()[0]
        folder = self.out / "runs" / key
        folder.rename(self.folder / "elsewhere")
        folder.symlink_to(self.victim)
        self.assertIn("found a link", self.study("task", "out", "0", expect=1).stderr)
        self.assertIn("found a link", self.run_study("small.toml", "--resume", expect=1).stderr)
        self.assert_untouched()
        folder.unlink()
        (self.out / "runs").rename(self.folder / "runs")
        (self.out / "runs").symlink_to(self.folder / "runs")
        self.assertIn("found a link", self.study("task", "out", "0", expect=1).stderr)

    def test_a_run_that_begins_anew_removes_only_what_runs_write(self):
        key = self.keys()[0]
        folder = self.out / "runs" / key
        (folder / "run.json").unlink()
        (folder / "notes.txt").write_text("mine")
        (folder / "more").mkdir()
        for name in ("result.h5", "log.txt"):
            (folder / name).unlink(missing_ok=True)
            (folder / name).symlink_to(self.victim / "thesis.txt")
        self.run_study("small.toml", "--resume")
        self.assertEqual((folder / "notes.txt").read_text(), "mine")
        self.assertTrue((folder / "more").is_dir())
        self.assertFalse((folder / "log.txt").is_symlink())
        self.assert_untouched()

    def test_files_of_the_user_in_the_folder_of_a_new_study(self):
        for name in ("study.toml", "runs.csv", "report.html", "study.json"):
            folder = self.folder / f"new-{name}"
            folder.mkdir()
            (folder / name).write_text("mine")
            self.assertIn("of no study", self.study("run", "small.toml", "-o", folder.name, expect=1).stderr)
            self.assertEqual((folder / name).read_text(), "mine")

    def test_a_plan_that_was_lost_is_made_again(self):
        (self.out / "plan.json").write_text("{")
        self.assertIn("run the study again", self.study("collect", "out", expect=1).stderr)
        (self.out / "plan.json").unlink()
        before = self.done()
        self.run_study("small.toml")
        self.assertEqual(self.done(), before)

    def test_options_of_sbatch_are_one_word(self):
        for option, value in (("--partition", "a\n#SBATCH --uid=0"), ("--time", "1:00 --uid=0"), ("--mem", "1G\rx"), ("--partition", "a#"), ("--account", "a b")):
            error = self.study("submit", "small.toml", "-o", "new", option, value, expect=1).stderr
            self.assertIn(f"{option}: found ", error)
            self.assertIn("one word", error)
            self.assertFalse((self.folder / "new").exists())
        self.study("submit", "small.toml", "-o", "new", "--partition", "long,short", "--time", "1-12:00:00", "--mem", "1.5G")
        self.assertIn("#SBATCH --partition=long,short\n", (self.folder / "new/array.sbatch").read_text())

    def test_more_options_of_sbatch(self):
        for line in ("gres=tmp:1G", "--gres=tmp:1G\n#SBATCH --uid=0"):
            error = self.study("submit", "small.toml", "-o", "new", f"--sbatch={line}", expect=1).stderr
            self.assertIn("--sbatch: found ", error)
            self.assertFalse((self.folder / "new").exists())
        said = self.study("submit", "small.toml", "-o", "new", "--account", "rock", "--qos", "low", "--constraint", "avx2", "--sbatch=--gres=tmp:1G")
        script = (self.folder / "new/array.sbatch").read_text()
        for line in ("--account=rock", "--qos=low", "--constraint=avx2", "--gres=tmp:1G"):
            self.assertIn(f"#SBATCH {line}\n", script)
        self.assertIn("no --time", said.stderr)
        self.assertIn("no --mem", said.stderr)

    def test_scripts_of_the_user_stay(self):
        for name in ("array.sbatch", "array-2.sbatch", "collect.sbatch"):
            (self.out / name).write_text("#!/bin/bash\nsrun mine\n")
            self.assertIn("no script of keyblock", self.study("submit", "small.toml", "-o", "out", "--resume", expect=1).stderr)
            self.assertEqual((self.out / name).read_text(), "#!/bin/bash\nsrun mine\n")
            (self.out / name).unlink()


if __name__ == "__main__":
    unittest.main()
