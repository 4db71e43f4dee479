#!/usr/bin/env python3
"""How many sources an addition touches, counted from those that were made: the files that name it.

Each kind of addition has representatives, by the words that only their files use in code (comments and #include count as well: whoever changes
the thing reads them). A file that is not in the list of a representative fails the test: what is described once must not be written out again. So
does a list that is longer than the kind allows, or that names a file which does not have the words any more.

    reach.py            checks
    reach.py --list     prints the files of all representatives
"""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# All that is built, and the two packages that read results. Tests, documents and benchmarks do not count.
FOLDERS = ("src", "apps", "bindings", "include", "viewer/src", "python/keyblock")
SUFFIXES = {".cpp", ".h", ".ts", ".py", ".pyi"}

# What a person who adds one writes: the keys of the scenario and the way of their values to the model.
KEYS = {
    "src/scenario/read_loading.cpp",
    "src/scenario/read_openings.cpp",
    "src/scenario/read_joints.cpp",
    "src/scenario/read_run.cpp",
    "src/scenario/scenario.h",
    "src/scenario/sections.h",
    "src/scenario/build_setup.cpp",
    "src/scenario/properties.cpp",
    "src/scenario/joint_table.cpp",
    "src/rockmass/random_strength.h",
    "src/rockmass/random_strength.cpp",
    "src/simulation/setup.h",
    "src/simulation/bolt_springs.h",
    "src/loading/load.h",
}

# kind: (most sources beside keys, {representative: (words, its sources)})
ADDITIONS = {
    "a measure of damage": (
        3,
        {
            "largest opening of a joint": (
                r"opening_max",
                {"src/record/record.h", "src/record/damage_fields.h", "src/simulation/joint_gauge.cpp"},
            ),
            "largest utilization": (
                r"largest_utilization|yielded_elements",
                {"src/record/record.h", "src/record/damage_fields.h", "src/simulation/elements.cpp"},
            ),
        },
    ),
    "a column of a joint in the results, and of contacts of a running model": (
        6,
        {
            "shear displacement": (
                r"shear_displacement",
                {
                    "src/record/record.h",
                    "src/record/contact_fields.h",
                    "src/simulation/recorder.cpp",
                    "include/keyblock/simulation.h",  # of a running model
                    "python/keyblock/simulated_contacts.py",  # likewise
                    "python/keyblock/contacts.py",  # results of earlier versions have it by another name
                },
            ),
        },
    ),
    "a field of a stage in the results": (
        5,
        {
            "largest way out of balance, over the block size": (
                r"way = 0\.0, way_share|\.way_share|largest_way_share",
                {
                    "src/record/record.h",
                    "src/record/stage_fields.h",
                    "src/record/verdict.cpp",  # the verdict is judged by it
                    "src/simulation/runner.cpp",
                    "viewer/src/data.ts",
                },
            ),
        },
    ),
    "a coupling with all its outputs": (
        4,
        {
            "support": (
                r"GroundSprings|ground_springs|SupportedPlace",
                {"src/coupling/ground_springs.h", "src/coupling/ground_springs.cpp", "src/simulation/build_model.cpp"},
            ),
            "spring": (
                r"PointSprings|point_springs",
                {
                    "src/coupling/point_springs.h",
                    "src/coupling/point_springs.cpp",
                    "src/simulation/build_model.cpp",
                    "src/simulation/control_forces.cpp",  # programs change springs of a running model
                },
            ),
        },
    ),
    "a joint law with memory": (
        9,
        {
            "residual strength, and how it falls with slip": (
                r"JointLaw::Residual|struct Residual|residual_(friction|cohesion)|weakening_slip|law\.residual|has_residual",
                {
                    "src/contact/joint_law.h",
                    "src/contact/joint_properties.h",
                    "src/simulation/joint_laws.cpp",  # also where programs and stages change strengths of a running model
                    "src/scenario/ground_facts.cpp",
                    "src/scenario/strength_checks.cpp",
                    "src/scenario/synonyms.cpp",
                    "src/record/joint_records.h",
                    "src/simulation/joint_records.cpp",
                },
            ),
        },
    ),
    "a load on the faces of joints that stages change": (
        14,
        {
            "pressure on the wall of an opening, and its release": (
                r"\bWallLoads|WallPressure|SupportPressure|walls\.(pressure|released|forces|left)|wall_loads|\bWallState\b",
                {
                    "src/model/state.h",
                    "src/coupling/wall_loads.h",
                    "src/coupling/wall_loads.cpp",
                    "src/coupling/joint_water.cpp",  # water fills an opening as its forces are released
                    "src/simulation/build_model.cpp",
                    "src/simulation/checkpoint.cpp",
                    "src/simulation/checkpoint_checks.cpp",
                    "src/simulation/staged_opening.h",
                    "src/simulation/staged_opening.cpp",
                    "src/simulation/wall_faces.h",
                    "src/simulation/wall_faces.cpp",
                    "src/simulation/wall_movement.h",
                },
            ),
        },
    ),
}

# Tables that are written from src/record/damage_fields.h; they name no measure but those with a type of their own.
WITHOUT_MEASURES = ("viewer/src/damage_tables.ts", "viewer/src/study/quantities.ts", "src/study/measures.cpp")


def sources(root=ROOT):
    """Path from the root, and text, of each."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file() and "node_modules" not in path.parts:
                yield path.relative_to(root).as_posix(), path.read_text()


def named_in(words, texts):
    """The sources that have the words."""
    pattern = re.compile(words)
    return {path for path, text in texts if pattern.search(text)}


def problems(additions, texts):
    for kind, (most, representatives) in additions.items():
        for name, (words, known) in representatives.items():
            found = named_in(words, texts) - KEYS
            for path in sorted(found - known):
                yield f"{path} names {name} ({kind}), which is to be described elsewhere: {', '.join(sorted(known))}"
            for path in sorted(known - found):
                yield f"{path} does not name {name} ({kind}) any more: take it out of the list"
            if len(found) > most:
                yield f"{name}: {kind} may touch {most} sources, and touches {len(found)}"


class Reach(unittest.TestCase):
    texts = list(sources())

    def test_additions_touch_no_more_sources_than_they_may(self):
        self.assertEqual(list(problems(ADDITIONS, self.texts)), [])

    def test_a_further_source_is_found(self):
        more = [*self.texts, ("src/report/further.cpp", "double opening_max_ever;")]
        found = list(problems(ADDITIONS, more))
        self.assertTrue(any(line.startswith("src/report/further.cpp names largest opening") for line in found), found)
        self.assertTrue(any("touches 4" in line for line in found), found)

    def test_tables_of_measures_name_none(self):
        text = dict(self.texts)
        names = re.findall(r'\{"([a-z_0-9]+)",', text["src/record/damage_fields.h"])
        self.assertGreater(len(names), 25)
        for path in WITHOUT_MEASURES:
            self.assertEqual([name for name in names if re.search(rf"\b{name}\b", text[path])], [], path)

    def test_outputs_know_no_kind_of_element(self):
        """What couplings carry is written and drawn for all of them alike."""
        outputs = ("src/results/", "src/report/", "src/study/", "viewer/src/", "apps/")
        pattern = re.compile(r"""kind\s*[!=]==?\s*["'](spring|support|boundary|pressure)["']""")
        self.assertEqual([path for path, text in self.texts if path.startswith(outputs) and pattern.search(text)], [])

    def test_the_recorder_asks_no_coupling_what_it_is(self):
        self.assertNotIn("dynamic_cast", dict(self.texts)["src/simulation/recorder.cpp"])


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        for kind, (most, representatives) in ADDITIONS.items():
            for name, (words, _) in representatives.items():
                found = sorted(named_in(words, list(sources())) - KEYS)
                print(f"{kind}, {name}: {len(found)} of {most}", *found, sep="\n    ")
        sys.exit()
    unittest.main()
