"""What Slurm does with the tasks of nodes that die, on a cluster of two nodes; and that such a cluster leaves nothing behind.

Exit code 77 says that the test was skipped, and why."""

import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

from cluster import SlurmCluster, SlurmError, marked_processes, missing_programs

SKIPPED = 77
ALL_SECONDS = 560   # of the whole test, less than ctest's limit, so that all is cleared away
DOWN_SECONDS = 60   # until a dead node is seen as such (measured: 16)
AGAIN_SECONDS = 60  # until a requeued task runs again (measured: 6)

# A script that says what it is: its copy (0, then 1 when it has been requeued), its node and its process.
COPY = """#!/bin/sh
cd {folder} || exit 1
copy=${{SLURM_RESTART_COUNT:-0}}
echo "$copy $SLURMD_NODENAME $$" >>begun
wait_for() {{ while [ ! -e "$1" ]; do sleep 0.1; done; }}
"""
# A job whose processes resist, and a program that starts it on a cluster, says the cluster's folder, and waits.
STUBBORN = """#!/bin/sh
trap '' TERM INT HUP
setsid sh -c 'trap "" TERM INT HUP; while :; do sleep 1000; done' &
touch {folder}/works
while :; do sleep 1000; done
"""
PROGRAM = """
import pathlib, signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what it starts in the background with SIGINT ignored
sys.path.insert(0, {here!r})
from cluster import SlurmCluster
with SlurmCluster() as cluster:
    cluster.submit({script!r})
    cluster.wait_until(pathlib.Path({folder!r}, "works").exists, "a working job", 60)
    print(cluster.folder, flush=True)
    time.sleep(1000)
"""


class TestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="exemplar-slurm-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def lines(self, name):
        path = self.folder / name
        return [line.split() for line in path.read_text().splitlines()] if path.exists() else []

    def assert_gone(self, mark, seconds=0):
        end = time.monotonic() + seconds
        while (left := marked_processes(mark)) and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(left, [])


class Nodes(TestCase):
    """One cluster for all; every test leaves it with two idle nodes."""

    @classmethod
    def setUpClass(cls):
        cls.cluster = SlurmCluster(cpus=2)
        cls.enterClassContext(cls.cluster)

    def tearDown(self):
        for name in self.cluster.names:
            if name not in self.cluster.machines:
                self.cluster.start_node(name)
        self.cluster.run("scancel", "--user", str(os.getuid()))
        self.cluster.wait_for_nodes("idle", *self.cluster.names)

    def submit(self, script, *options):
        return self.cluster.submit(COPY.format(folder=self.folder) + script, *options)

    def wait_for_lines(self, name, count, timeout):
        self.cluster.wait_until(lambda: len(self.lines(name)) == count, f"{count} lines in {name}", timeout)
        return self.lines(name)

    def alive(self, process):
        """Whether a process of a job lives, which it does not in the moment between its death and its parent's notice."""
        with contextlib.suppress(OSError):
            return "State:\tZ" not in pathlib.Path(f"/proc/{process}/status").read_text()
        return False

    def test_an_array_uses_both_nodes(self):
        job = self.submit("sleep 1\n", "--array=1-6")
        ended = self.cluster.wait(job, 60)
        self.assertEqual(sorted(ended), [f"{job}_{task}" for task in range(1, 7)])
        self.assertEqual({(task.state, task.restarts) for task in ended.values()}, {("COMPLETED", 0)})
        self.assertEqual({task.node for task in ended.values()}, {"n1", "n2"})
        self.assertEqual({node for _, node, _ in self.lines("begun")}, {"n1", "n2"})

    def test_tasks_of_a_dead_machine_run_again_on_the_other(self):
        """Both tasks of n1 die with it and run again on n2 as the same tasks; those of n2 go on as if nothing had happened. A
        machine that comes back is used again."""
        job = self.submit("[ $copy = 1 ] || wait_for second\necho $SLURM_ARRAY_TASK_ID $copy $SLURMD_NODENAME >>done\n",
                          "--array=1-4")
        begun = self.wait_for_lines("begun", 4, 60)
        lost = [int(process) for _, node, process in begun if node == "n1"]
        self.assertEqual(len(lost), 2)
        self.cluster.kill_node("n1", tasks_too=True)
        self.assertEqual([process for process in lost if self.alive(process)], [])
        self.cluster.wait_for_nodes("down", "n1", timeout=DOWN_SECONDS)
        (self.folder / "second").touch()
        ended = self.cluster.wait(job, AGAIN_SECONDS)
        self.assertEqual({(task.state, task.node) for task in ended.values()}, {("COMPLETED", "n2")})
        self.assertEqual(sorted(task.restarts for task in ended.values()), [0, 0, 1, 1])
        self.assertEqual(sorted(self.lines("done")),
                         sorted([key.split("_")[1], str(task.restarts), "n2"] for key, task in ended.items()))
        self.cluster.start_node("n1")
        back = self.submit("", "--nodelist=n1")
        self.assertEqual(self.cluster.wait(back, 60)[str(back)][:2], ("COMPLETED", "n1"))

    def test_two_copies_of_a_task_run_at_once_when_only_slurmd_dies(self):
        """slurmctld cannot tell a machine that is gone from one that has only fallen silent: after SlurmdTimeout it requeues the
        tasks of either, and those of the silent one go on all the same, on the same files, for as long as they like. Three things
        are seen here: a first copy that ends on its own, even in failure, does not end the job, whose second copy decides; the
        node that comes back kills a first copy that still runs; the second copy notices nothing."""
        self.cluster.drain("n2")
        ends = self.submit("if [ $copy = 0 ]; then wait_for second; touch first_ended; exit 7; fi\n"
                           "touch second; wait_for first_ended; sleep 2\n")
        stays = self.submit("[ $copy = 1 ] || sleep 1000\nwait_for may_end\n")
        begun = self.wait_for_lines("begun", 2, 60)
        self.cluster.kill_node("n1")
        self.cluster.resume("n2")
        begun = self.wait_for_lines("begun", 4, DOWN_SECONDS + AGAIN_SECONDS)
        self.assertEqual([line[:2] for line in begun], 2 * [["0", "n1"]] + 2 * [["1", "n2"]])
        ended = self.cluster.wait(ends, 60)[str(ends)]
        self.assertEqual(ended[:3], ("COMPLETED", "n2", 1))
        first, second = (int(process) for _, _, process in [line for line in begun if self.alive(line[2])])
        self.cluster.start_node("n1")
        self.cluster.wait_until(lambda: not self.alive(first), "the end of the first copy", 60)
        self.assertTrue(self.alive(second))
        (self.folder / "may_end").touch()
        self.assertEqual(self.cluster.wait(stays, 60)[str(stays)][:3], ("COMPLETED", "n2", 1))


class Life(TestCase):
    """Nothing of a cluster outlives it, whatever its end is and whatever its jobs do against theirs."""

    def stubborn(self):
        return STUBBORN.format(folder=self.folder)

    def start_program(self):
        """A program with a cluster that has a stubborn job, and the folder of the cluster."""
        here = str(pathlib.Path(__file__).parent)
        text = PROGRAM.format(here=here, folder=str(self.folder), script=self.stubborn())
        program = subprocess.Popen([sys.executable, "-B", "-c", text], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.addCleanup(program.stdout.close)
        self.addCleanup(program.wait)
        self.addCleanup(program.kill)
        cluster = program.stdout.readline().decode().strip()
        self.assertNotEqual(cluster, "")
        self.addCleanup(shutil.rmtree, cluster, ignore_errors=True)
        self.assertGreaterEqual(len(marked_processes(cluster)), 10)
        return program, cluster

    def test_stop_leaves_nothing(self):
        with SlurmCluster() as cluster:
            cluster.submit(self.stubborn())
            cluster.wait_until((self.folder / "works").exists, "a working job", 60)
            for name in cluster.names:
                cluster.kill_node(name)
            self.assertGreater(len(marked_processes(cluster.folder)), 5)  # the job goes on
        self.assert_gone(cluster.folder)
        self.assertFalse(cluster.folder.exists())

    def test_an_interrupted_program_leaves_nothing(self):
        program, cluster = self.start_program()
        program.send_signal(signal.SIGINT)
        program.wait(60)
        self.assert_gone(cluster)
        self.assertFalse(pathlib.Path(cluster).exists())

    def test_a_killed_program_leaves_no_process(self):
        program, cluster = self.start_program()
        program.kill()
        self.assert_gone(cluster, seconds=30)

    def test_a_failing_start_says_why_and_leaves_nothing(self):
        broken = self.folder / "slurmd"
        broken.write_text("#!/bin/sh\necho out of order >&2\nexit 3\n")
        broken.chmod(0o755)
        cluster = SlurmCluster()
        with mock.patch.dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}"):
            with self.assertRaisesRegex(SlurmError, r"(?s)^slurmd of n1 ended with exit code 3.*out of order"):
                cluster.start()
        self.assert_gone(cluster.folder)
        self.assertFalse(cluster.folder.exists())


def interrupt(number, _):
    """Ends the program by the one exception that unittest lets through; clusters stop at exit."""
    raise KeyboardInterrupt("terminated" if number == signal.SIGTERM else "not done in time")


def main(seconds=ALL_SECONDS):
    if not os.environ.get("EXEMPLAR_SLURM"):
        print("skipped: a Slurm of two nodes is asked for with 'tests/run.sh --slurm'")
        return SKIPPED
    if missing := missing_programs():
        print(f"error: no {' and no '.join(missing)}; 'tests/run.sh --slurm' installs them on Debian")
        return 1
    signal.signal(signal.SIGTERM, interrupt)
    signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(seconds)
    result = unittest.main(exit=False, verbosity=2).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
