#!/usr/bin/env python3
"""The command line: help, exit codes, messages about wrong input."""

import json
import os
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, Scenario

COMMANDS = ("run", "check", "cut", "report", "export", "motion", "study", "bolt")


class Help(Scenario):
    def test_help_names_every_command(self):
        text = self.keyblock("--help").stdout
        for command in COMMANDS:
            self.assertRegex(text, rf"\n  {command} +[A-Z]")
            self.assertIn("Example", self.keyblock(command, "--help").stdout)

    def test_version(self):
        self.assertRegex(self.keyblock("--version").stdout, r"^keyblock \d+\.\d+\.\d+\n$")
        for words in (("--version", "--verbose"), ("--verbose", "--version")):
            text = self.keyblock(*words).stdout
            self.assertRegex(text, r"^keyblock \d+\.\d+\.\d+\nprocessor: .+\nregisters: [1248] numbers .*\ncompiler: +\S.*\n$")


class WrongCommandLine(Scenario):
    def test_no_command(self):
        self.assertIn("keyblock --help", self.keyblock(expect=1).stderr)

    def test_mistyped_command(self):
        self.assertIn("did you mean 'check'?", self.keyblock("chekc", "incline.toml", expect=1).stderr)

    def test_unknown_option(self):
        self.assertIn("--thread", self.keyblock("run", "incline.toml", "-o", "out", "--thread", "2", expect=1).stderr)

    def test_missing_folder(self):
        self.assertIn("--output", self.keyblock("run", "incline.toml", expect=1).stderr)

    def test_numbers_out_of_range(self):
        self.assertIn("--threads", self.keyblock("run", "incline.toml", "-o", "out", "--threads", "0", expect=1).stderr)
        self.assertIn("--realization", self.keyblock("cut", "incline.toml", "-o", "out", "--realization", "-1", expect=1).stderr)


class Check(Scenario):
    def test_a_good_scenario(self):
        self.assertIn("incline.toml: ok", self.keyblock("check", "incline.toml").stdout)

    def test_every_mistake_with_its_place(self):
        text = self.scenario.read_text().replace("young = 1.0e9", "yuong = 1.0e9").replace("friction = 20.0", 'friction = "rough"')
        self.write("bad.toml", text)
        lines = self.keyblock("check", "bad.toml", expect=1).stderr.splitlines()
        where = [re.match(r"bad\.toml:\d+:\d+: ([\w.]+): ", line) for line in lines]
        self.assertTrue(all(where), lines)
        self.assertLessEqual({"rock.yuong", "joints.friction"}, {match[1] for match in where})
        self.assertIn("did you mean 'young'?", "\n".join(lines))

    def test_values_that_seem_odd(self):
        self.write("odd.toml", self.scenario.read_text().replace("density = 2600.0", "density = 2.6"))
        warning = "odd.toml: warning: rock.density = 2.6 kg/m3 (line 5): usual is 1000 to 4000 kg/m3; was it in t/m3"
        for words in (("check",), ("run", "-o", "out"), ("study", "run", "-o", "study")):
            at = 2 if words[0] == "study" else 1
            self.assertIn(warning, self.keyblock(*words[:at], "odd.toml", *words[at:]).stderr, words)
        self.assertEqual(len(self.summary("out")["warnings"]), 1)
        self.assertIn("rock.density = 2.6 kg/m3", (self.folder / "out/report.html").read_text())
        self.write("other.toml", 'units = "other"\n' + (self.folder / "odd.toml").read_text())
        self.assertEqual(self.keyblock("check", "other.toml").stderr, "")

    def test_rock_that_is_too_soft(self):
        soft = ("incline.toml", "--set", "rock.young=8")
        checked = self.keyblock("check", *soft).stderr
        self.assertIn("was it in GPa? That is 8e+09 Pa", checked)
        self.assertIn("the rock is too soft to be computed: young = 8 Pa", checked)
        ended = self.keyblock("run", *soft, "-o", "out", expect=2).stderr
        self.assertRegex(ended, r"\nkeyblock: the rock is too soft to be computed: young = 8 Pa of block 'slider', and .* deform it by")

    def test_a_file_that_is_not_there(self):
        self.assertIn("gone.toml", self.keyblock("check", "gone.toml", expect=1).stderr)

    def test_an_override_that_is_wrong(self):
        self.assertIn("--set rock.young=-1", self.keyblock("check", "incline.toml", "--set", "rock.young=-1", expect=1).stderr)

    def test_options_take_no_empty_value(self):
        for words in (("run", "incline.toml"), ("cut", "incline.toml"), ("study", "run", "incline.toml"), ("verify",)):
            self.assertIn("--output: found nothing; expected a value", self.keyblock(*words, "-o", "", expect=1).stderr)
        self.assertIn("SCENARIO: found nothing", self.keyblock("check", "", expect=1).stderr)
        self.assertIn("--set: found nothing", self.keyblock("check", "incline.toml", "--set", "", expect=1).stderr)

    def test_the_same_mistake_stops_a_run(self):
        self.write("bad.toml", "title = 3\n")
        checked = self.keyblock("check", "bad.toml", expect=1).stderr
        self.assertEqual(self.keyblock("run", "bad.toml", "-o", "out", expect=1).stderr, checked)
        self.assertFalse((self.folder / "out").exists())


class Support(Scenario):
    def test_every_kind_of_new_scenario_is_right(self):
        kinds = ("arch", "beam", "column", "slope", "study", "tunnel", "wall")
        self.assertIn(" ".join(["|".join(kinds)]), self.keyblock("new", "--help").stdout)
        for kind in kinds:
            with self.subTest(kind=kind):
                self.assertIn("keyblock check", self.keyblock("new", kind).stdout)
                checked = self.keyblock("check", f"{kind}.toml")
                self.assertIn("ok:", checked.stdout)
                self.assertEqual(checked.stderr, "")

    def test_a_file_that_is_there_stays(self):
        (self.folder / "column.toml").write_text("mine")
        self.assertIn("a file that is there", self.keyblock("new", "column", expect=1).stderr)
        self.assertEqual((self.folder / "column.toml").read_text(), "mine")
        self.keyblock("new", "column", "--force")
        self.keyblock("new", "column", "-o", "other.toml")
        self.assertEqual((self.folder / "other.toml").read_text(), self.keyblock("new", "column", "-o", "-").stdout)

    def test_check_for_other_programs(self):
        right = json.loads(self.keyblock("check", "incline.toml", "--json").stdout)
        self.assertEqual((right["ok"], right["mistakes"], right["blocks"]), (True, [], 2))
        wrong = json.loads(self.keyblock("check", "incline.toml", "--json", "--set", "rock.young=-1", expect=1).stdout)
        self.assertFalse(wrong["ok"])
        self.assertEqual(wrong["mistakes"][0]["key"], "rock.young")

    def test_motion_for_other_programs(self):
        self.write("a.csv", "time,N-S (m/s2)\n0,0\n0.01,1.5\n0.03,0\n")
        self.write("b.csv", "time,N-S (m/s2)\n0,0\n0.01,strong\n")
        right = json.loads(self.keyblock("motion", "a.csv", "--json", "--plot", "-o", "a.svg").stdout)
        self.assertEqual((right["ok"], right["mistakes"], right["plot"]), (True, [], "a.svg"))
        (component,) = right["components"]
        self.assertEqual((component["file"], component["azimuth"], component["vertical"]), ("a.csv", 0.0, False))
        self.assertEqual((component["samples"], component["step_s"], component["duration_s"]), (3, None, 0.03))
        self.assertEqual((component["peak_m_s2"], component["peak_time_s"], component["unit"]), (1.5, 0.01, "m/s2"))
        self.assertAlmostEqual(component["peak_velocity_m_s"], 0.5 * 0.03 * 1.5)
        # ∫a² dt of a triangle is a third of its box.
        self.assertAlmostEqual(component["arias_m_s"], 3.141592653589793 / (2 * 9.80665) * 0.03 * 1.5**2 / 3)
        text = self.keyblock("motion", "a.csv").stdout
        for note in component["notes"]:
            self.assertIn(note, text)
        wrong = json.loads(self.keyblock("motion", "a.csv", "b.csv", "--json", expect=1).stdout)
        self.assertFalse(wrong["ok"])
        self.assertEqual([c["file"] for c in wrong["components"]], ["a.csv"])
        self.assertEqual((wrong["mistakes"][0]["file"], wrong["mistakes"][0]["line"]), ("b.csv", 3))

    def test_completion(self):
        script = self.keyblock("completion", "bash").stdout
        (self.folder / "complete").write_text(script)

        def complete(*words):
            line = " ".join(words)
            code = f"source complete; COMP_WORDS=({line}); [[ '{line}' == *' ' ]] && COMP_WORDS+=(''); "
            code += "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); compopt() { :; }; _keyblock; printf '%s\\n' \"${COMPREPLY[@]}\""
            done = subprocess.run(["bash", "-c", code], cwd=self.folder, capture_output=True, text=True, check=True)
            return done.stdout.split()

        self.assertIn("check", complete("keyblock", "ch"))
        self.assertIn("--realization", complete("keyblock", "run", "--re"))
        self.assertIn("submit", complete("keyblock", "study", "su"))
        self.assertIn("--account", complete("keyblock", "study", "submit", "--acc"))
        self.assertIn("rock.young=", complete("keyblock", "run", "--set", "rock.y"))
        self.assertIn("vtk", complete("keyblock", "export", "out", "--format", "v"))
        self.assertIn("incline.toml", complete("keyblock", "check", "inc"))
        for shell in ("fish", "zsh"):
            self.assertIn("realization", self.keyblock("completion", shell).stdout)

    def test_manual_page(self):
        page = self.keyblock("manual-page").stdout
        self.assertIn(".TH KEYBLOCK 1", page)
        for command in ("run", "study submit", "limit"):
            self.assertIn(f".SS keyblock {command}\n", page)


class Cut(Scenario):
    def test_writes_blocks_and_a_picture(self):
        out = self.folder / "cut"
        self.keyblock("cut", ROOT / "examples/01-tunnel.toml", "-o", out)
        summary = self.summary("cut")
        blocks = json.loads((out / "blocks.geojson").read_text())
        self.assertEqual(len(blocks["features"]), summary["blocks"])
        self.assertGreater(summary["blocks"], 500)
        self.assertAlmostEqual(summary["area"]["blocks"] + summary["area"]["excavated"], 400.0, places=6)
        self.assertTrue((out / "blocks.svg").read_text().startswith("<svg"))

    def test_realizations_differ_and_repeat(self):
        for folder, realization in (("a", 0), ("b", 1), ("c", 1)):
            self.keyblock("cut", ROOT / "examples/01-tunnel.toml", "-o", folder, "--realization", realization)
        a, b, c = ((self.folder / name / "blocks.geojson").read_bytes() for name in "abc")
        self.assertNotEqual(a, b)
        self.assertEqual(b, c)

    def test_warns_of_what_cutting_shows(self):
        tunnel = (ROOT / "examples/01-tunnel.toml").read_text().split("[[motion]]")[0]
        self.write("far.toml", tunnel + '[[trace_map]]\nname = "map"\nfile = "far.csv"\n')
        self.write("far.csv", "trace,x,y\n1,7.1,46.2\n1,7.2,46.3\n")
        text = self.keyblock("cut", "far.toml", "-o", "out", "--set", "excavation.tunnel.diameter=50").stderr
        self.assertIn("warning: trace_map.map: no trace meets the domain", text)
        self.assertIn("warning: excavation.tunnel: holds every block", text)
        self.assertNotIn("[[stage]]", text)

    def test_a_folder_that_cannot_be_made(self):
        self.assertIn("incline.toml/out", self.keyblock("cut", "incline.toml", "-o", "incline.toml/out", expect=1).stderr)


class FullDisk(Scenario):
    def test_output_that_is_lost_is_a_failure(self):
        self.write("a.csv", "time,acceleration (m/s2)\n0,0\n0.01,1.5\n")
        for words in (["check", "incline.toml"], ["motion", "a.csv"], ["--help"]):
            with open("/dev/full", "w") as full:
                ended = subprocess.run([PROGRAM, *words], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(ended.returncode, 2, words)
            self.assertIn("standard output could not be written", ended.stderr)


class Motion(Scenario):
    def test_says_what_a_record_holds(self):
        self.write("a.csv", "time,acceleration (m/s2)\n0,0\n0.01,1.5\n0.02,-2.5\n")
        text = self.keyblock("motion", "a.csv", "--plot", "-o", "a.svg").stdout
        self.assertRegex(text, r"2\.5\b")
        self.assertIn("0.01", text)
        self.assertIn("<svg", (self.folder / "a.svg").read_text())

    def test_a_plot_takes_the_place_of_nothing_but_a_plot(self):
        record = self.write("a.csv", "time,acceleration (m/s2)\n0,0\n0.01,1.5\n0.02,-2.5\n")
        text = record.read_text()
        (self.folder / "link.svg").symlink_to("a.csv")
        for output in ("a.csv", "link.svg"):
            for options in ((), ("--force",)):
                error = self.keyblock("motion", "a.csv", "--plot", "-o", output, *options, expect=1).stderr
                self.assertIn("a record that is to be read", error)
        self.write("mine.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>")
        self.assertIn("--force", self.keyblock("motion", "a.csv", "--plot", "-o", "mine.svg", expect=1).stderr)
        self.assertNotIn("1.5", (self.folder / "mine.svg").read_text())
        for options in (("--force",), ()):
            self.keyblock("motion", "a.csv", "--plot", "-o", "mine.svg", *options)
        self.assertIn("time, s", (self.folder / "mine.svg").read_text())
        self.assertEqual(record.read_text(), text)

    def test_reads_plain_numbers_as_it_is_told(self):
        self.write("plain.txt", "a title\n0.1 0.2 -0.3\n0.0 0.1\n")
        self.assertIn("skip, column, dt and unit", self.keyblock("motion", "plain.txt", expect=1).stderr)
        text = self.keyblock("motion", "plain.txt", "--dt", "0.01", "--unit", "g", "--window", "0.01", "0.04").stdout
        self.assertRegex(text, r"samples +4, dt 0\.01 s")
        self.assertIn("-0.3 g", text)
        self.assertIn("unit", self.keyblock("motion", "plain.txt", "--dt", "0.01", expect=1).stderr)

    def test_neither_waits_for_pipes_nor_reads_devices(self):
        os.mkfifo(self.folder / "pipe")
        for name in ("pipe", "/dev/zero"):
            self.assertIn("a device or pipe", self.keyblock("motion", name, expect=1).stderr)

    def test_names_every_file_that_is_no_record(self):
        error = self.keyblock("motion", "gone.smc", "incline.toml", expect=1).stderr
        self.assertIn("gone.smc", error)
        self.assertIn("incline.toml", error)


class Bolt(Scenario):
    def test_pulls_and_shears_beside_what_was_measured(self):
        tunnel = str(ROOT / "examples/12-bolted-tunnel.toml")
        for model in ("joints", "nodes"):
            given = ("bolt", tunnel, "crown", "--set", f'bolt.crown.model="{model}"', "--way", "5", "-o", "out")
            self.assertRegex(self.keyblock(*given).stdout, r"pull +245 kN at the most")
            curve = (self.folder / "out/pull.csv").read_text()
            self.assertEqual(curve.splitlines()[:2], ["displacement_mm,force_kn", "0,0"])
            # Its own curve as a measured one.
            self.write("test.csv", curve)
            text = self.keyblock(*given, "--pull", "test.csv").stdout
            self.assertRegex(text, r"the program is \S+e-\d+ kN off|the program is 0 kN off")
            self.assertIn("measured", (self.folder / "out/bolt.svg").read_text())
            self.assertGreater(max(float(row.split(",")[1]) for row in
                                   (self.folder / "out/shear.csv").read_text().splitlines()[1:]), 100.0)

    def test_says_what_is_wrong(self):
        tunnel = str(ROOT / "examples/12-bolted-tunnel.toml")
        self.assertIn("crown", self.keyblock("bolt", tunnel, "floor", "-o", "out", expect=1).stderr)
        self.assertIn("[[bolt]]", self.keyblock("bolt", "incline.toml", "floor", "-o", "out", expect=1).stderr)
        self.assertIn("from its head", self.keyblock("bolt", tunnel, "crown", "--at", "9", "-o", "out", expect=1).stderr)
        self.write("test.csv", "mm,kN\n0,0\n2,10\n1,20\n")
        error = self.keyblock("bolt", tunnel, "crown", "--pull", "test.csv", "-o", "out", expect=1).stderr
        self.assertIn("test.csv:4", error)
        self.write("test.csv", "mm,kN,s\n0,0,0\n2,10,1\n")
        error = self.keyblock("bolt", tunnel, "crown", "--pull", "test.csv", "-o", "out", expect=1).stderr
        self.assertIn("two columns", error)


class Results(Scenario):
    def test_report_and_export_need_results(self):
        (self.folder / "empty").mkdir()
        self.assertIn("empty", self.keyblock("report", "empty", expect=1).stderr)
        self.assertIn("gone", self.keyblock("report", "gone", expect=1).stderr)
        self.assertIn("empty", self.keyblock("export", "empty", "--format", "csv", expect=1).stderr)
        self.assertIn("--format", self.keyblock("export", "empty", "--format", "xls", expect=1).stderr)


if __name__ == "__main__":
    unittest.main()
