"""Types: the package is checked by mypy, and so is a script that uses it rightly and wrongly."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from conftest import ROOT, optional

optional("mypy")

RIGHT = """
import keyblock as kb
scenario = kb.Scenario.load("a.toml")
scenario.load.append(block="b")
summary = scenario.run("out", threads=2, resume=True)
sim: kb.Simulation = scenario.simulate()
force: float = sim.contacts.slip.max()
sim.apply_force("b", [0.0, 1.0])
try:
    scenario.check()
except kb.InputError as error:
    line: int = error.diagnostics[0].line
"""
WRONG = ["scenario.run('out', thread=2)", "sim.advnce()", "scenario.simulate(replce=True)", "kb.run_study(scenario, 'out', worker=2)"]


def mypy(*words: object, cwd: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--no-error-summary", "--cache-dir", str(cwd / "cache"), *map(str, words)],
        cwd=cwd,
        env={"MYPYPATH": str(ROOT / "python"), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    return done.stdout + done.stderr


def test_scripts_are_checked(tmp_path: Path) -> None:
    (tmp_path / "right.py").write_text(RIGHT)
    said = mypy("--ignore-missing-imports", "--follow-imports=silent", "right.py", cwd=tmp_path)
    assert "right.py" not in said, said
    (tmp_path / "wrong.py").write_text(RIGHT + "\n".join(WRONG) + "\n")
    said = mypy("--ignore-missing-imports", "--follow-imports=silent", "wrong.py", cwd=tmp_path)
    lines = len(RIGHT.splitlines())
    for k in range(len(WRONG)):
        assert f"wrong.py:{lines + k + 1}: error" in said, f"{WRONG[k]}\n{said}"
