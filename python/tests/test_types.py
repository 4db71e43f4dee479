"""Types: the package is checked by mypy, and so is a script that uses it rightly and wrongly."""

from __future__ import annotations

import ast
import re
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


def test_the_package_is_checked(tmp_path: Path) -> None:
    said = mypy("--ignore-missing-imports", str(ROOT / "python/keyblock"), cwd=tmp_path)
    assert said == "", said


def test_stubs_are_those_of_the_module() -> None:
    """_core.pyi has the classes, functions and arguments that the compiled module has, and no others."""
    core = optional("keyblock._core")
    stub = ast.parse((ROOT / "python/keyblock/_core.pyi").read_text())

    def arguments(function: ast.FunctionDef) -> list[str]:
        each = function.args
        return [a.arg for a in (*each.posonlyargs, *each.args, *each.kwonlyargs) if a.arg != "self"]

    def check(where: str, thing: object, functions: dict[str, ast.FunctionDef], others: set[str]) -> None:
        public = {name for name in dir(thing) if not name.startswith("_")} - set(dir(Exception))
        assert public == (set(functions) | others) - set(dir(Exception)), where
        for name, function in functions.items():
            said = (getattr(thing, name).__doc__ or "").splitlines()[:1]
            told = re.findall(r"[(,] *(\w+):", said[0]) if said and said[0].startswith(f"{name}(") else []
            if told and not any(re.fullmatch(r"arg\d+|self", each) for each in told[1:]):
                assert [each for each in told if each not in ("self", "arg0")] == arguments(function), f"{where}.{name}"

    functions = {each.name: each for each in stub.body if isinstance(each, ast.FunctionDef)}
    classes = {each.name: each for each in stub.body if isinstance(each, ast.ClassDef)}
    values = {each.target.id for each in stub.body if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)}
    check("_core", core, {name: each for name, each in functions.items() if not name.startswith("_")}, set(classes) | {v for v in values if not v.startswith("_")})
    for name, of in classes.items():
        if issubclass(getattr(core, name), Exception):  # what they have, each object gets
            continue
        parts = [each for each in of.body if isinstance(each, ast.FunctionDef) and not each.name.startswith("_")]
        properties = {each.name for each in parts if any("property" in ast.dump(d) or "setter" in ast.dump(d) for d in each.decorator_list)}
        methods = {each.name: each for each in parts if each.name not in properties}
        fields = {each.target.id for each in of.body if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)}
        check(name, getattr(core, name), methods, properties | fields)


def test_scripts_are_checked(tmp_path: Path) -> None:
    (tmp_path / "right.py").write_text(RIGHT)
    said = mypy("--ignore-missing-imports", "--follow-imports=silent", "right.py", cwd=tmp_path)
    assert "right.py" not in said, said
    (tmp_path / "wrong.py").write_text(RIGHT + "\n".join(WRONG) + "\n")
    said = mypy("--ignore-missing-imports", "--follow-imports=silent", "wrong.py", cwd=tmp_path)
    lines = len(RIGHT.splitlines())
    for k in range(len(WRONG)):
        assert f"wrong.py:{lines + k + 1}: error" in said, f"{WRONG[k]}\n{said}"
