#!/usr/bin/env python3
"""Studies by other schedulers: the files of packaging/ do what `keyblock study run` does. HTCondor is stood in for by a reader of its
files that knows what these files use; Snakemake is tried where it is installed."""

import json
import re
import shlex
import shutil
import subprocess
import unittest

from program import PROGRAM, ROOT
from study_case import Study

HTCONDOR = ROOT / "packaging/htcondor"

# Commands of a submit description, as its manual has them.
COMMANDS = {"universe", "executable", "arguments", "should_transfer_files", "transfer_executable", "getenv", "output", "error", "log",
            "request_cpus", "request_memory"}  # fmt: skip


def expanded(text, macros):
    while match := re.search(r"\$\((\w+)\)", text):
        text = text.replace(match[0], macros[match[1].lower()])
    return text


def words_of(arguments):
    """Of the form in double quotes: words between blanks; single quotes keep blanks."""
    assert arguments.startswith('"') and arguments.endswith('"'), arguments
    return shlex.split(arguments[1:-1])


def submit(file, folder, **given):
    """What condor_submit does, one job after the other; the exit codes."""
    macros, codes = {}, []
    for line in file.read_text().split("\n"):
        if not line.strip() or line.startswith("#"):
            continue
        if queue := re.fullmatch(r"queue\b\s*(.*)", line):
            macros |= {name.lower(): value for name, value in given.items()}
            for process in range(int(expanded(queue[1], macros) or 1)):
                values = macros | {"process": str(process)}
                job = {name: expanded(macros[name], values) for name in COMMANDS}
                with open(folder / job["output"], "w") as out, open(folder / job["error"], "w") as err:
                    done = subprocess.run([job["executable"], *words_of(job["arguments"])], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err)  # fmt: skip
                codes.append(done.returncode)
            continue
        name, _, value = line.partition("=")
        macros[name.strip().lower()] = value.strip()
    return codes


def dag(file):
    """Nodes by name: their file, values, and whether it is the last one."""
    nodes = {}
    for line in file.read_text().split("\n"):
        words = shlex.split(line, comments=True)
        if words[:1] in (["JOB"], ["FINAL"]):
            nodes[words[1]] = {"file": words[2], "values": {}, "last": words[0] == "FINAL"}
        elif words[:1] == ["VARS"]:
            nodes[words[1]]["values"] = dict(word.split("=", 1) for word in words[2:])
        elif words:
            raise AssertionError(f"{file}: {line}")
    return nodes


class HTCondor(Study):
    def test_the_files_of_a_study(self):
        self.study("submit", "small.toml", "-o", "out")
        nodes = dag(HTCONDOR / "study.dag")
        self.assertEqual([(name, node["last"]) for name, node in nodes.items()], [("runs", False), ("collect", True)])
        for node in nodes.values():
            values = node["values"] | {"out": "out", "keyblock": PROGRAM}
            if "runs" in values:
                values["runs"] = "6"
            codes = submit(HTCONDOR / node["file"], self.folder, **values)
            self.assertEqual(codes, [0] * len(codes))
        status = json.loads(self.study("status", "out", "--json").stdout)
        self.assertTrue(status["complete"])
        self.assertEqual(len(self.rows()), 6)
        self.study("run", "small.toml", "-o", "alone", "--workers", "2")
        self.assertEqual(self.hashes(), self.hashes("alone"))


class Snakemake(Study):
    @unittest.skipIf(shutil.which("snakemake") is None, "snakemake is not installed")
    def test_the_file_of_a_study(self):
        config = ["scenario=small.toml", "out=out", f"keyblock={PROGRAM}"]
        words = ["snakemake", "--cores", "2", "-q", "-s", str(ROOT / "packaging/Snakefile"), "--config", *config]
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(len(self.rows()), 6)


if __name__ == "__main__":
    unittest.main()
