#!/usr/bin/env python3
"""Studies from end to end: many runs, and studies that go on with what is there."""

import json
import time
import unittest

from program import INCLINE
from study_case import GALLERY, SCALES, SMALL, Study


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
        self.assertEqual([row["key"] for row in self.rows()], self.keys())

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

    def test_status_tells_what_is_there_and_changes_nothing(self):
        self.study("submit", "small.toml", "-o", "out")
        before = self.files()
        planned = json.loads(self.study("status", "out", "--json").stdout)
        self.assertEqual(planned["runs"], {"asked": 6, "done": 0, "failed": 0, "damaged": 0, "missing": 6, "begun": 0})
        self.assertEqual((planned["complete"], planned["missing"]), (False, self.keys()))
        self.study("task", "out", "0")
        first, second, third = self.keys()[:3]
        self.run_file(second).parent.mkdir()
        self.run_file(third).parent.mkdir()
        self.run_file(third).write_text("{")
        status = json.loads(self.study("status", "out", "--json").stdout)
        self.assertEqual(status["runs"], {"asked": 6, "done": 1, "failed": 0, "damaged": 1, "missing": 4, "begun": 1})
        self.assertEqual(status["begun"], [second])
        self.assertIn(third, status["damaged"][0])
        text = self.study("status", "out").stdout
        self.assertIn("1 of 6 runs done, 1 damaged, 4 missing\n", text)
        self.assertIn(f"begun: {second}\n", text)
        self.assertEqual(before, self.files())
        self.assertIn("plan.json", self.study("status", "nowhere", expect=1).stderr)

    def test_check_says_how_many_runs_it_is(self):
        self.assertIn("; a study of 6 runs: 3 realizations, 2 of each\n", self.keyblock("check", "small.toml").stdout)
        self.write("wrong.toml", GALLERY + SMALL.replace("[0.5, 1.0]", '[0.5, "strong"]'))
        self.assertIn('wrong.toml:', self.keyblock("check", "wrong.toml", expect=1).stderr)

    def test_a_combination_that_cannot_be_run_is_refused_before_any_is(self):
        self.write("short.toml", GALLERY + SMALL + '[[study.vary]]\nkey = "stage.after.duration"\nvalues = [0.2, 0.001]\n')
        line = (self.folder / "short.toml").read_text().splitlines().index("values = [0.2, 0.001]") + 1
        found = f"short.toml:{line}:16: stage.after.duration: found 0.001 s, 0.2 steps of 0.005 s; "
        for words in ("check short.toml", "study run short.toml -o out", "study submit short.toml -o out"):
            self.assertIn(found, self.keyblock(*words.split(), expect=1).stderr, words)
        self.assertFalse(self.out.exists())

    def test_realizations_of_nothing_random(self):
        self.write("two.toml", INCLINE.replace("duration = 0.5", "duration = 0.01") + '[study]\nrealizations = 2\nkeep = "measures"\n')
        for words in (("check", "two.toml"), ("study", "run", "two.toml", "-o", "out")):
            self.assertIn("two.toml: warning: study.realizations = 2: nothing is random", self.keyblock(*words).stderr)

    def test_control_runs_take_off_what_gravity_brings_down(self):
        self.write("control.toml", GALLERY + '[study]\ncontrol = true\nkeep = "measures"\n' + SCALES)
        self.run_study("control.toml")
        control, *shaken = [self.result(key) for key in self.keys()]
        self.assertEqual((control["variant"], control["values"]), ("unshaken", ["0"]))
        self.assertEqual(control["stages"][2]["pga_m_s2"], 0.0)
        area = lambda run: run["stages"][3]["damage"]["fallen_area_m2"] - run["stages"][1]["damage"]["fallen_area_m2"]
        study = json.loads((self.out / "study.json").read_text())
        for run, combination in zip(shaken, study["combinations"]):
            self.assertAlmostEqual(combination["measures"]["fallen_area_m2"]["mean"]["value"], area(run) - area(control), places=5)
        self.assertEqual(study["control"]["realizations"], 1)
        self.assertEqual([row["variant"] for row in self.rows()], ["", "", "unshaken"])
        before = self.done()
        self.run_study("control.toml", "--resume", "--set", "study.realizations=2")
        self.assertEqual({key: time for key, time in self.done().items() if key in before}, before)
        self.assertEqual(len(self.done()), 6)

    def test_records_in_rotation_and_their_risk(self):
        slow = '[[motion]]\nname = "slow"\nx = { amplitude = 3.0, frequency = 2.0, cycles = 1.0 }\n'
        self.write("rotated.toml", GALLERY + slow + '[study]\nrealizations = 2\nkeep = "measures"\n[[study.vary]]\n'
                   'key = "stage.shaken.motion"\nvalues = ["sine", "slow"]\nper_realization = 1\n')  # fmt: skip
        self.assertNotIn("no stage uses it", self.run_study("rotated.toml").stderr)
        self.assertEqual([self.result(key)["stages"][2]["record"] for key in self.keys()], ["sine", "slow"])
        self.write("pga.csv", "pga,rate\n0.5,1e-1\n2,1e-2\n5,1e-3\n20,1e-5\n")
        settings = '[[hazard]]\nfile = "pga.csv"\nintensity = "PGA"\nunit = "m/s2"\n'
        self.write("other.toml", settings)
        refused = self.keyblock("risk", "out", "--settings", "other.toml", expect=1).stderr
        self.assertIn("pga.csv: found a hazard of PGA, component rotd50; expected one of those that the study has", refused)
        self.write("risk.toml", settings + 'component = "section"\n')
        risk = json.loads(self.keyblock("risk", "out", "--settings", "risk.toml", "--json").stdout)
        self.assertEqual([level["level"] for level in risk["levels"]], ["light", "moderate", "severe"])
        self.assertEqual(risk, json.loads((self.out / "risk/risk.json").read_text()))
        self.assertEqual(len((self.out / "risk/risk.csv").read_text().splitlines()), 4)
        self.keyblock("risk", "out", expect=1)

    def test_variants_of_the_check_for_marginal_results(self):
        self.write("marginal.toml", GALLERY + '[study]\nkeep = "measures"\nsince = "start"\nmarginal = {}\n')
        self.run_study("marginal.toml")
        runs = [self.result(key) for key in self.keys()]
        self.assertEqual([run["variant"] for run in runs], ["", "friction-", "friction+", "released"])
        self.assertEqual([stage["name"] for stage in runs[3]["stages"]], ["in situ", "shaken", "after"])
        self.assertEqual(len({run["state_hash"] for run in runs}), 4)
        # The same by hand.
        self.keyblock("run", "marginal.toml", "-o", "by-hand", "--set", "joints.friction=27", "--set", "joint_set.flat.friction=22")
        self.assertEqual(self.summary("by-hand")["state_hash"], runs[1]["state_hash"])

    def test_gravity_is_not_the_earthquake(self):
        said = self.run_study("small.toml").stdout
        study = json.loads((self.out / "study.json").read_text())
        self.assertEqual((study["since"], study["before"], study["at_shaking"]), ("excavated", "excavated", True))
        added = study["combinations"][1]["measures"]["slip_max_m"]["max"]
        results = [self.result(key)["stages"] for key in self.keys()[1::2]]
        slips = [stages[3]["damage"]["slip_max_m"] - stages[1]["damage"]["slip_max_m"] for stages in results]
        self.assertAlmostEqual(added, max(slips), places=6)
        self.assertRegex(said, r"light: fallen_area_m2 > [\d.]+; stage\.shaken\.scale = 1\.0: \d of 3 .* before the shaking, \d of 3 ")
        self.assertRegex(said, r"curve of light over PGA: none, as ")
        # All of it, with the same runs, when it is asked for.
        before = self.done()
        self.write("small.toml", GALLERY + SMALL.replace("[study]", '[study]\nsince = "start"'))
        self.run_study("small.toml", "--resume")
        self.assertEqual(self.done(), before)
        study = json.loads((self.out / "study.json").read_text())
        self.assertEqual((study["since"], study["before"], study["at_shaking"]), (None, "excavated", True))
        self.assertAlmostEqual(study["combinations"][1]["measures"]["slip_max_m"]["max"],
                               max(stages[3]["damage"]["slip_max_m"] for stages in results), places=6)  # fmt: skip

    def test_until_an_interval_is_narrow(self):
        until = 'until = { measure = "slipped_length_m", width = 6.0, minimum = 3, maximum = 12 }\n'
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
        self.write("until.toml", GALLERY + '[study]\nkeep = "measures"\n' + until.replace("width = 6.0", "half_width = 0.0001") + SCALES)
        said = self.run_study("until.toml", "--resume").stdout
        self.assertIn("24 of 24 runs done\n", said)
        self.assertRegex(said, r"not narrow enough: 2 of 2 combinations; slipped_length_m at stage\.shaken\.scale = .*half_width = 0\.0001\)")


class GoingOn(Study):
    def test_more_realizations_and_more_values_use_the_runs_that_are_done(self):
        self.run_study("small.toml")
        before, keys = self.done(), self.keys()
        self.write("small.toml", GALLERY + SMALL.replace("= 3", "= 4").replace("[0.5, 1.0]", "[2.0, 1.0, 0.5]"))
        self.assertIn("12 of 12 runs done\n", self.run_study("small.toml", "--resume").stdout)
        self.assertEqual({key: self.done()[key] for key in before}, before)
        self.assertEqual(self.keys()[:6], keys)  # an index stays that of its run

    def test_axes_in_another_order_and_grouped_keep_runs_what_they_are(self):
        axes = [("rock.order", "[1, 2]"), ("stage.after.duration", "[0.1, 0.2]")]
        text = GALLERY + '[study]\nkeep = "measures"\n'

        def of(*axes):
            return text + "".join(f'[[study.vary]]\nkey = "{key}"\nvalues = {values}\n' for key, values in axes)

        self.write("axes.toml", of(*axes))
        self.run_study("axes.toml")
        names = [key for key, _ in axes]
        before, ended = {row["key"]: [row[name] for name in names] for row in self.rows()}, self.done()
        self.write("axes.toml", of(*reversed(axes)))
        self.run_study("axes.toml", "--resume")
        self.assertEqual({row["key"]: [row[name] for name in names] for row in self.rows()}, before)
        self.write("axes.toml", text + '[[study.vary]]\nkeys = ["stage.after.duration", "rock.order"]\nvalues = [[0.2, 1], [0.1, 2]]\n')
        self.run_study("axes.toml", "--resume")
        together = {row["key"]: row["stage.after.duration + rock.order"].split(", ")[::-1] for row in self.rows()}
        self.assertEqual(together, {key: values for key, values in before.items() if values in (["1", "0.2"], ["2", "0.1"])})
        self.assertEqual(self.done(), ended)

    def test_a_file_that_changes_while_its_value_is_left_out(self):
        for name in "ab":
            self.write(f"{name}.csv", "# m/s2\n0.0,0.0\n0.1,1.0\n0.2,0.0\n")
        text = GALLERY.replace("x = { amplitude = 3.0, frequency = 4.0, cycles = 2.0 }",
                               'components = [{ file = "a.csv", azimuth = 90.0 }]')  # fmt: skip
        both = '[[study.vary]]\nkey = "motion.sine.components[0].file"\nvalues = ["a.csv", "b.csv"]\n'
        self.write("both.toml", text + '[study]\nkeep = "measures"\n' + both)
        self.write("one.toml", text + '[study]\nkeep = "measures"\n')
        self.run_study("both.toml")
        self.run_study("one.toml", "--resume")
        self.write("b.csv", "# m/s2\n0.0,0.0\n0.1,2.0\n0.2,0.0\n")
        self.assertRegex(self.run_study("both.toml", "--resume", expect=1).stderr, r"the content of .*b\.csv")

    def test_other_cells_of_the_map_are_refused(self):
        self.run_study("small.toml")
        self.assertIn("study.map.cell: 0.05 there, 0.1 here",
                      self.run_study("small.toml", "--resume", "--set", "study.map.cell=0.1", expect=1).stderr)  # fmt: skip

    def test_an_edited_copy_of_the_scenario_is_refused(self):
        self.run_study("small.toml")
        copy = self.out / "study.toml"
        copy.write_text(copy.read_text().replace("young = 2.0e9", "young = 3.0e9"))
        for command in (("collect", "out"), ("task", "out", "0"), ("run", "small.toml", "-o", "out", "--resume")):
            said = self.study(*command, expect=1).stderr
            self.assertIn("out/study.toml: found a scenario other than that of plan.json", said)

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


class GoingOnUntil(Study):
    """[study.until] with two realizations that agree and a third that failed: enough, as long as it is left out."""

    def setUp(self):
        super().setUp()
        until = 'until = { measure = "slipped_length_m", width = 0.01, minimum = 3, maximum = 6 }\n'
        self.write("until.toml", GALLERY + '[study]\nkeep = "measures"\n' + until)
        self.study("submit", "until.toml", "-o", "out")
        self.study("task", "out", "0")
        first, second, third, *_ = self.plan()["runs"]
        result = self.result(first["key"])
        self.write_result(second, result)
        self.write_result(third, result, "failed.json", error="killed")
        self.assertIn("enough: 3 realizations\n2 of 3 runs done, 1 failed\n", self.study("collect", "out").stdout)
        self.assertTrue(json.loads((self.out / "study.json").read_text())["precision"]["reached"])

    def test_resuming_runs_what_the_failed_run_makes_necessary(self):
        for workers in ("1", "2"):
            said = self.study("run", "until.toml", "-o", "out", "--resume", "--workers", workers).stdout
            self.assertIn("6 of 6 runs done\n", said)
        self.assertFalse(json.loads((self.out / "study.json").read_text())["precision"]["reached"])

    def test_submitting_again_does_too(self):
        said = self.study("submit", "until.toml", "-o", "out", "--resume").stdout
        self.assertIn("4 of 6 runs to be done", said)
        for k in range(2, 6):
            self.assertIn(": done\n", self.study("task", "out", k).stdout)


class Large(Study):
    def many(self, realizations):
        """A study whose runs are all done: copies of one."""
        self.write("many.toml", GALLERY + SMALL.replace("= 3", f"= {realizations}"))
        self.study("submit", "many.toml", "-o", "out")
        self.study("task", "out", "0")
        runs = self.plan()["runs"]
        result = self.result(runs[0]["key"])
        for run in runs[1:]:
            self.write_result(run, result)
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
