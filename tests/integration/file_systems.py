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


if __name__ == "__main__":
    unittest.main()
