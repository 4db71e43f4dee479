#!/usr/bin/env python3
"""Runs on file systems that know no locks: as many cluster file systems, they say so in their own way."""

import errno
import os
import unittest
from unittest import mock

from program import Scenario


class NoLocks(Scenario):
    def without_locks(self, number):
        names = {"LD_PRELOAD": os.environ["NO_LOCKS_LIBRARY"], "NO_LOCKS": str(number)}
        return mock.patch.dict(os.environ, names)

    def test_a_run_its_report_and_its_exports(self):
        self.keyblock("run", self.scenario, "-o", "locks")
        for number in (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS):
            with self.subTest(errno.errorcode[number]), self.without_locks(number):
                self.keyblock("run", self.scenario, "-o", "out", "--force")
                self.keyblock("report", "out")
                self.keyblock("export", "out", "--format", "csv")
                self.assertEqual(
                    (self.folder / "out/histories.csv").read_text(), (self.folder / "locks/histories.csv").read_text()
                )

    def test_a_file_in_use_is_not_written(self):
        # That somebody else holds a lock is another answer.
        with self.without_locks(errno.EAGAIN), mock.patch.dict(os.environ, {"NO_LOCKS_FOR": "/result.h5."}):
            done = self.keyblock("run", self.scenario, "-o", "used", expect=2)
        self.assertIn("unable to lock file", done.stderr)


class LossOfPower(Scenario):
    """A new name of a file lasts once its folder is synced."""

    def test_folders_are_synced_after_files_get_their_names(self):
        self.keyblock("run", self.scenario, "-o", "out")
        for words in ("run incline.toml -o other", "report out", "export out --format csv", "export out --format vtk", "cut incline.toml -o cut"):
            log = self.folder / "log"
            log.write_text("")
            with mock.patch.dict(os.environ, {"LD_PRELOAD": os.environ["SYNC_LOG_LIBRARY"], "SYNC_LOG": str(log)}):
                self.keyblock(*words.split())
            waiting, renames, syncs = set(), 0, 0
            for line in log.read_text().splitlines():
                what, path = line.split(" ", 1)
                folder = os.path.realpath(self.folder / path if what == "sync" else (self.folder / path).parent)
                renames += what == "rename"
                syncs += what == "sync"
                waiting.add(folder) if what == "rename" else waiting.discard(folder)
            self.assertGreater(renames, 0, words)
            self.assertEqual(waiting, set(), words)
            if "vtk" in words:  # hundreds of files that appear together
                self.assertLess(syncs, renames / 4)


if __name__ == "__main__":
    unittest.main()
