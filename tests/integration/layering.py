#!/usr/bin/env python3
"""Includes go downwards only: the order of the modules, and what each may use, is src/CMakeLists.txt."""

import re
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Heavy third-party headers stay inside a module: its users must not pay for them.
HEAVY = re.compile(r"^(toml\+\+/|nlohmann/(?!json_fwd\.hpp)|geos|hdf5|H5|CLI/|amd\.h)")

MODULE = re.compile(r"^keyblock_module\((?P<words>[^)]*)\)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*(?P<quote>["<])(?P<header>[^">]+)[">]', re.MULTILINE)


def declared_modules(root):
    """{module: modules it names after DEPENDS}, in the order of src/CMakeLists.txt."""
    modules = {}
    for match in MODULE.finditer((root / "src/CMakeLists.txt").read_text()):
        name, *words = match["words"].split()
        depends = words[words.index("DEPENDS") + 1 :] if "DEPENDS" in words else []
        modules[name] = depends[: depends.index("LINK")] if "LINK" in depends else depends
    return modules


def may_use(modules, name):
    """The module itself and all it depends on, directly or not."""
    reached = set()
    pending = [name]
    while pending:
        module = pending.pop()
        if module not in reached:
            reached.add(module)
            pending += modules.get(module, [])
    return reached


def declaration_problems(root, modules):
    order = list(modules)
    for name, depends in modules.items():
        for other in depends:
            if other not in modules:
                yield f"src/CMakeLists.txt: {name} depends on {other}, which is no module"
            elif order.index(other) > order.index(name):
                yield f"src/CMakeLists.txt: {name} depends on {other}, which comes after it"
    for folder in sorted(p.name for p in (root / "src").iterdir() if p.is_dir()):
        if folder not in modules:
            yield f"src/{folder}: not listed in src/CMakeLists.txt"


# Stands for nlohmann/json.hpp everywhere: a program must have one conversion of numbers.
CHECKED_JSON = "core/checked_json.h"


def heavy_header(root, header):
    """The heavy third-party header that a header of ours includes, directly or not; None if there is none."""
    reached = set()
    pending = [header]
    while pending:
        path = root / "src" / pending.pop()
        if path in reached or not path.is_file():
            continue
        reached.add(path)
        for match in INCLUDE.finditer(path.read_text()):
            if match["quote"] == "<" and HEAVY.match(match["header"]):
                return match["header"]
            pending.append(match["header"])
    return None


def include_problems(root, modules):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        where = path.relative_to(root)
        module = where.parts[1]
        allowed = may_use(modules, module)
        for match in INCLUDE.finditer(path.read_text()):
            header = match["header"]
            used = header.split("/")[0]
            if header == "nlohmann/json.hpp" and str(where) != f"src/{CHECKED_JSON}":
                yield f"{where}: includes nlohmann/json.hpp in place of {CHECKED_JSON}"
            if match["quote"] == "<" or used not in modules:
                continue
            if used not in allowed:
                yield f"{where}: includes {header}, but {module} does not depend on {used}"
            elif not (root / "src" / header).is_file():
                yield f"{where}: includes {header}, which does not exist"
            elif header != CHECKED_JSON and used != module and (heavy := heavy_header(root, header)):
                yield f"{where}: includes {header}, which brings {heavy} along"


NAMESPACE = re.compile(r"^namespace (?P<name>keyblock(?:::\w+)*) \{", re.MULTILINE)

# Namespaces that are not called like their folder: words that every module uses, the folders that make a step together, and the
# parts of what programs include (include/).
SHARED_NAMESPACES = {
    "api": "keyblock",
    "core": "keyblock",
    "geometry": "keyblock",
    "model": "keyblock::dynamics",
    "coupling": "keyblock::dynamics",
    "solve": "keyblock::dynamics",
}


def namespace_problems(root, modules):
    """A header opens the namespace of its folder, last; before it, it may declare names of others."""
    for name in modules:
        wanted = SHARED_NAMESPACES.get(name, f"keyblock::{name}")
        for path in sorted((root / "src" / name).rglob("*.h")):
            found = NAMESPACE.findall(path.read_text())
            if found and found[-1] != wanted and not found[-1].startswith(f"{wanted}::"):
                yield f"{path.relative_to(root)}: opens namespace {found[-1]}, not {wanted}"


def page_problems(root, modules):
    page = root / "docs/architecture.md"
    text = page.read_text() if page.is_file() else ""
    for name in modules:
        if f"`{name}/`" not in text:
            yield f"docs/architecture.md: does not name `{name}/`"


def problems(root):
    modules = declared_modules(root)
    return [
        *declaration_problems(root, modules),
        *include_problems(root, modules),
        *namespace_problems(root, modules),
        *page_problems(root, modules),
    ]


class Repository(unittest.TestCase):
    def test_includes_go_downwards(self):
        self.assertGreater(len(declared_modules(ROOT)), 10)
        self.assertEqual(problems(ROOT), [])


class Checker(unittest.TestCase):
    """The check itself, on a tree of three modules."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("src/CMakeLists.txt", "keyblock_module(a LINK fmt::fmt)\nkeyblock_module(b DEPENDS a)\nkeyblock_module(c\n  DEPENDS b LINK x)\n")
        self.write("docs/architecture.md", "`a/` `b/` `c/`")
        for name in "abc":
            self.write(f"src/{name}/{name}.h", "#pragma once\n#include <vector>\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def assert_problem(self, pattern):
        found = problems(self.root)
        self.assertEqual(len(found), 1, found)
        self.assertRegex(found[0], pattern)

    def test_a_clean_tree_passes(self):
        self.write("src/c/c.cpp", '#include "c/c.h"\n#include "b/b.h"\n#include "a/a.h"\n#include <toml++/toml.h>\n')
        self.assertEqual(problems(self.root), [])

    def test_upward_include(self):
        self.write("src/a/a.cpp", '#include "a/a.h"\n#  include "b/b.h"\n')
        self.assert_problem(r"^src/a/a\.cpp: includes b/b\.h")

    def test_include_beside_the_dependencies(self):
        self.write("src/CMakeLists.txt", "keyblock_module(a)\nkeyblock_module(b DEPENDS a)\nkeyblock_module(c DEPENDS a)\n")
        self.write("src/c/c.cpp", '#include "b/b.h"\n')
        self.assert_problem(r"c does not depend on b")

    def test_dependency_on_a_later_module(self):
        self.write("src/CMakeLists.txt", "keyblock_module(a DEPENDS b)\nkeyblock_module(b)\nkeyblock_module(c)\n")
        self.assert_problem(r"a depends on b, which comes after it")

    def test_missing_header(self):
        self.write("src/b/b.cpp", '#include "a/gone.h"\n')
        self.assert_problem(r"a/gone\.h, which does not exist")

    def test_folder_that_is_no_module(self):
        self.write("src/d/d.h", "")
        self.assert_problem(r"src/d: not listed")

    def test_heavy_header(self):
        self.write("src/b/private.h", "#include <H5Cpp.h>\n")
        self.write("src/b/b.cpp", '#include "b/private.h"\n')
        self.assertEqual(problems(self.root), [])
        self.write("src/b/b.h", '#include "b/private.h"\n')
        self.write("src/c/c.cpp", '#include "b/b.h"\n')
        self.assert_problem(r"src/c/c\.cpp: includes b/b\.h, which brings H5Cpp\.h along")
        self.write("src/b/private.h", "#include <nlohmann/json_fwd.hpp>\n")
        self.assertEqual(problems(self.root), [])

    def test_json_without_checks(self):
        self.write("src/b/b.cpp", "#include <nlohmann/json.hpp>\n")
        self.assert_problem(r"src/b/b\.cpp: includes nlohmann/json\.hpp in place of core/checked_json\.h")

    def test_namespace_of_another_folder(self):
        self.write("src/b/b.h", "namespace keyblock::a {\nstruct Of;\n}\nnamespace keyblock::b {\n}\nnamespace keyblock::b::numbers {\n}\n")
        self.assertEqual(problems(self.root), [])
        self.write("src/b/b.h", "namespace keyblock::a {\n}\n")
        self.assert_problem(r"src/b/b\.h: opens namespace keyblock::a, not keyblock::b")

    def test_page_without_a_module(self):
        self.write("docs/architecture.md", "`a/` `c/`")
        self.assert_problem(r"does not name `b/`")


if __name__ == "__main__":
    unittest.main()
