#!/usr/bin/env python3
"""Studies on a real Slurm: munged, slurmctld and slurmd are started on loopback, with all their files in a temporary folder.

Where they are not installed, or this is not root, the test is skipped (exit code 77). Where they are, but do not start, it is
skipped too, unless CI is set; what they said is printed.
"""

import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from program import PROGRAM, ROOT, process_of, wait_for

SKIPPED = 77
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/usr/local/sbin"])

SLURM_CONF = """
ClusterName=keyblock-test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=10000,defer
ReturnToService=2
MaxArraySize=1001
KillWait=2
MinJobAge=300
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=test Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """A Slurm of one node."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        folder.chmod(0o755)  # munge wants its socket in reach
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": PATH}
        for name in list(self.environment):
            if name.startswith(("SLURM_", "SBATCH_")) and name != "SLURM_CONF":
                del self.environment[name]

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        text = SLURM_CONF.format(
            host=socket.gethostname().split(".")[0], folder=self.folder, controller_port=free_port(), node_port=free_port()
        )
        (self.folder / "slurm.conf").write_text(text)
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        self.daemon("munged", "-F", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                    f"--seed-file={self.folder}/munged.seed")  # fmt: skip
        wait_for((self.folder / "munge.socket").exists, "the socket of munged", 10)
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D")
        wait_for(lambda: "idle" in self.run("sinfo", "-h", "-o", "%t", check=False), "the node to become idle")

    def daemon(self, name, *arguments):
        with open(self.folder / f"{name}.out", "w") as out:
            self.daemons.append(
                subprocess.Popen([shutil.which(name, path=PATH), *arguments], env=self.environment, stdin=subprocess.DEVNULL,
                                 stdout=out, stderr=subprocess.STDOUT)  # fmt: skip
            )

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(timeout=15)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def run(self, *command, check=True, cwd=None):
        done = subprocess.run(command, env=self.environment, cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=60)  # fmt: skip
        if check and done.returncode != 0:
            raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def said(self):
        return "\n".join(
            f"--- {path.name}\n{path.read_text(errors='replace')[-3000:]}"
            for path in sorted(self.folder.iterdir())
            if path.suffix in (".log", ".out")
        )


class Study(unittest.TestCase):
    cluster = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="keyblock-slurm-study-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name).resolve()
        # Run 1 of the two takes long enough to be killed.
        text = (ROOT / "tests/data/study/gallery.toml").read_text().split("[study]")[0]
        text += '[study]\nkeep = "measures"\n[[study.vary]]\nkey = "stage.after.duration"\nvalues = [0.1, 200.0, 0.2]\n'
        (self.folder / "gallery.toml").write_text(text)

    def keyblock(self, *arguments):
        return self.cluster.run(PROGRAM, "study", *arguments, cwd=self.folder)

    def jobs(self):
        return self.cluster.run("squeue", "-h", "-r", "-o", "%i %t").split("\n")[:-1]

    def keys(self):
        return [run["key"] for run in json.loads((self.folder / "out/plan.json").read_text())["runs"]]

    def results(self):
        paths = sorted((self.folder / "out/runs").glob("*/run.json"))
        return {path.parent.name: path.stat().st_mtime_ns for path in paths}

    def test_a_killed_task_is_named_and_run_again_alone(self):
        said = self.keyblock("submit", "gallery.toml", "-o", "out", "--now")
        self.assertRegex(said, r"job \d+: array 0-2\n")
        keys = self.keys()
        words = ["study", "task", str(self.folder / "out"), "1"]
        os.kill(wait_for(lambda: process_of(words), "the task to be killed"), signal.SIGKILL)
        wait_for(lambda: not self.jobs(), "the jobs to end", 60)
        # The job that collects ran after them, and named what is missing.
        collect = re.search(r"job (\d+): collects", said)[1]
        log = (self.folder / f"out/slurm/{collect}.log").read_text()
        self.assertIn(f"missing: {keys[1]}\n2 of 3 runs done, 1 missing\n", log)
        self.assertIn(f"missing: {keys[1]}\n", self.keyblock("collect", "out"))
        before = self.results()
        self.assertEqual(set(before), {keys[0], keys[2]})

        said = self.keyblock("submit", "gallery.toml", "-o", "out", "--now", "--resume")
        self.assertRegex(said, r"1 of 3 runs to be done\njob \d+: array 1\n")
        wait_for(lambda: not self.jobs(), "the jobs to end", 120)
        after = self.results()
        self.assertEqual(set(after), set(keys))
        self.assertEqual({key: after[key] for key in before}, before)
        self.assertIn("3 of 3 runs done\n", self.keyblock("collect", "out"))
        self.assertIn("all runs are done", self.keyblock("submit", "gallery.toml", "-o", "out", "--now", "--resume"))


def main():
    missing = [name for name in PROGRAMS if not shutil.which(name, path=PATH)]
    if missing or os.geteuid() != 0:
        print("SKIPPED: studies on Slurm:", f"not installed: {', '.join(missing)}" if missing else "not run as root")
        return SKIPPED
    with tempfile.TemporaryDirectory(prefix="keyblock-slurm-") as folder:
        cluster = Cluster(Path(folder).resolve())
        try:
            try:
                cluster.start()
            except (TimeoutError, OSError) as error:
                print(f"Slurm did not start: {error}\n{cluster.said()}")
                if os.environ.get("CI"):
                    return 1
                print("SKIPPED: studies on Slurm")
                return SKIPPED
            Study.cluster = cluster
            result = unittest.main(exit=False).result
            if not result.wasSuccessful():
                print(cluster.said())
            return 0 if result.wasSuccessful() else 1
        finally:
            cluster.stop()


if __name__ == "__main__":
    sys.exit(main())
