"""Batch labeling on a Slurm of two nodes: a node dies in the middle, or slurmctld, and every shape is labeled exactly once.

Exit code 77 says that the test was skipped, and why."""

import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "apps"))

from batch import BatchTest
from cluster import SlurmCluster, marked_processes
from cluster_test import main
from program import PROGRAM

ALL_SECONDS = 840  # of the whole test, less than ctest's limit
TASKS = 4
SHAPES = 48
FEW = 4
LABELS = ("_labels.txt", ".seg", ".ply")

# squeue that says how it ended, and Slurm's programs as another site has them: a cluster far away that labels at once, and whose
# controller does not answer the first question.
TOLD_SQUEUE = """#!/bin/sh
{squeue} "$@"
code=$?
echo $code >>{folder}/squeue.codes
exit $code
"""
FAR_SBATCH = """#!/bin/sh
for script; do :; done
for task in 1 2; do SLURM_ARRAY_TASK_ID=$task sh "$script" >&2 || exit 1; done
echo "sbatch: the site says hello"
echo "7;far"
"""
FAR_SQUEUE = """#!/bin/sh
echo "$@" >>{folder}/asked
[ $(wc -l <{folder}/asked) = 1 ] && {{ echo "slurm_load_jobs error: Unable to contact slurm controller" >&2; exit 1; }}
echo "CLUSTER: far"
[ $(wc -l <{folder}/asked) = 2 ] && printf "COMPLETED\\nCOMPLETING\\n" || printf "COMPLETED\\nNODE_FAIL\\n"
"""


def write_program(path, text):
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


class Labeling(BatchTest):
    """Batch runs of shapes, some or all."""

    SHAPES = SHAPES
    FACES = 1500

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        few = cls.folder / "few"
        few.mkdir()
        for shape in sorted((cls.folder / "shapes").glob("*.off"))[:FEW]:
            shutil.copy(shape, few)

    def batch(self, out, *options, shapes="shapes", model="cup.safetensors"):
        """No features are remembered, so that each shape takes its time."""
        return ["label", "batch", shapes, "--model", model, "--out", out, "--cache", "", "--json", f"{out}.json", *options]

    def report(self, out):
        return json.loads((self.folder / f"{out}.json").read_text())


class LabelingOnTwoNodes(Labeling):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cluster = SlurmCluster(cpus=1)
        cls.enterClassContext(cls.cluster)
        tools = cls.folder / "tools"
        write_program(tools / "squeue", TOLD_SQUEUE.format(squeue=shutil.which("squeue"), folder=cls.folder))
        cls.environment.update(cls.cluster.environment, XDG_CACHE_HOME=cls.environment["XDG_CACHE_HOME"],
                               PATH=f"{tools}:{cls.cluster.environment['PATH']}")

    def setUp(self):
        self.seen = {}
        self.process = None

    def tearDown(self):
        if self.process:
            self.process.kill()
            self.process.communicate()
        for name in self.cluster.names:
            if name not in self.cluster.machines:
                self.cluster.start_node(name)
        self.cluster.run("scancel", "--user", str(os.getuid()))
        self.cluster.wait_until(lambda: not self.cluster.run("squeue", "--noheader").stdout, "no job", 60)
        self.cluster.wait_for_nodes("idle", *self.cluster.names)

    def submit(self, out, *options, **input):
        """Starts a batch run that waits for its tasks."""
        self.process = self.start(*self.batch(out, "--slurm", "--tasks", str(TASKS), "--wait", *options, **input))

    def watch(self, out):
        """Every result stays as it was when its record appeared."""
        for record in self.records(out):
            stem = str(record).removesuffix(".json")
            states = [os.stat(path) for path in (record, *(stem + ending for ending in LABELS))]
            found = [(state.st_ino, state.st_mtime_ns) for state in states]
            self.assertEqual(self.seen.setdefault(record, found), found, f"{stem} was made twice")
        return len(self.seen)

    def require_time(self, end, what):
        if time.monotonic() > end:
            self.fail(f"not in time: {what}\n{self.cluster.run('squeue', code=None).stdout}")

    def wait_for(self, out, condition, what, seconds=120):
        """What the condition says once it is not false, while the run goes on."""
        end = time.monotonic() + seconds
        while not (answer := condition()):
            self.watch(out)
            self.assertIsNone(self.process.poll(), f"the run ended before: {what}")
            self.require_time(end, what)
            time.sleep(0.05)
        return answer

    def finish(self, out, seconds=200):
        end = time.monotonic() + seconds
        while self.process.poll() is None:
            self.watch(out)
            self.require_time(end, "the end of the run")
            time.sleep(0.1)
        output, errors = self.process.communicate()
        self.assertEqual(self.process.returncode, 0, output + errors)
        self.watch(out)
        self.assert_all_labeled(out, SHAPES)

    # ---- tasks

    def shard(self, out, task):
        return self.folder / out / "shards" / "1" / f"{task}.shard"

    def records_of(self, out, task):
        """The records that there are of a task's shapes."""
        shapes = [json.loads(line) for line in self.shard(out, task).read_text().splitlines()[1:]]
        paths = [self.folder / out / "labeled" / (shape["name"] + ".json") for shape in shapes]
        return [path for path in paths if path.exists()], len(paths)

    def workers_of(self, out, task):
        return {self.assert_labeled(record)["worker"] for record in self.records_of(out, task)[0]}

    def copies(self, out, task):
        """The processes that label a task's shapes."""
        found = []
        for process in marked_processes(f"{self.shard(out, task)}\0"):
            with contextlib.suppress(OSError):
                if os.readlink(f"/proc/{process}/exe") == str(PROGRAM):
                    found.append(process)
        return found

    def a_task_in_the_middle(self, out):
        """A task that has labeled some of its shapes and has more than half of them left, and its node; nothing if there is none."""
        for name, job in self.cluster.jobs().items():
            task = name.partition("_")[2]
            if job.state == "RUNNING" and self.shard(out, task).exists():
                records, shapes = self.records_of(out, task)
                if 1 <= len(records) < shapes / 2:
                    return task, job.node
        return None

    def restarted(self, task):
        """Whether the task runs as its second copy."""
        return any(name.endswith(f"_{task}") and job.restarts and job.state == "RUNNING" for name, job in self.cluster.jobs().items())

    # ---- tests

    def test_a_machine_dies(self):
        out = "machine"
        self.submit(out)
        task, node = self.wait_for(out, lambda: self.a_task_in_the_middle(out), "a task in the middle")
        self.cluster.kill_node(node, tasks_too=True)
        first = self.workers_of(out, task)
        self.assertEqual(len(first), 1)
        self.finish(out)
        workers = self.workers_of(out, task)
        self.assertEqual(len(workers), 2)
        self.assertLess(first, workers)

    def test_only_slurmd_dies_and_two_copies_of_a_task_are_at_work(self):
        """The first copy stands still until the second has a result, so that both work on the rest, from both ends."""
        out = "daemon"
        self.submit(out)
        task, node = self.wait_for(out, lambda: self.a_task_in_the_middle(out), "a task in the middle")
        [first] = self.copies(out, task)
        os.kill(first, signal.SIGSTOP)
        before, _ = self.records_of(out, task)
        worker = self.workers_of(out, task)
        self.cluster.kill_node(node)
        self.wait_for(out, lambda: self.restarted(task), "the second copy")
        self.wait_for(out, lambda: len(self.records_of(out, task)[0]) > len(before), "a result of the second copy")
        self.assertEqual(len(self.copies(out, task)), 2)
        meanwhile, shapes = self.records_of(out, task)
        self.assertLess(len(meanwhile), shapes)
        os.kill(first, signal.SIGCONT)
        self.finish(out)
        later = [json.loads(record.read_text())["worker"] for record in self.records_of(out, task)[0] if record not in meanwhile]
        self.assertEqual(len(self.workers_of(out, task)), 2)
        self.assertTrue(worker <= set(later), "the first copy did nothing beside the second")

    def test_slurmctld_starts_again(self):
        """Meanwhile it is unknown how the job is; and it is no end of the job. The name of the folder is no word of a shell."""
        out = "it's away"
        codes = self.folder / "squeue.codes"
        self.submit(out)
        self.wait_for(out, lambda: self.watch(out), "a result")
        self.cluster.stop_controller()
        try:
            codes.write_text("")
            self.wait_for(out, lambda: "1" in codes.read_text().split(), "squeue without an answer")
        finally:
            self.cluster.start_controller()
        self.finish(out)

    def test_an_interrupted_wait_is_taken_up_again(self):
        """The job goes on; it is not submitted once more, but waited for."""
        out = "interrupted"
        for name in self.cluster.names:
            self.cluster.drain(name)
        self.submit(out, shapes="few")
        told = self.shard(out, 1).parent / "job.json"
        try:
            self.wait_for(out, told.exists, "the job")
            job = json.loads(told.read_text())["job"]
            self.process.send_signal(signal.SIGINT)
            _, errors = self.process.communicate(timeout=60)
            self.assertEqual(self.process.returncode, 130, errors)
            self.assertIn(f"job {job} goes on: the same command waits for it again, 'scancel {job}' ends it", errors)
            self.refused(*self.batch(out, "--slurm", "--tasks", str(TASKS), shapes="few"), code=1,
                         says=f"job {job} of an earlier call is still at work")
            self.submit(out, shapes="few")
        finally:
            for name in self.cluster.names:
                self.cluster.resume(name)
        output, errors = self.process.communicate(timeout=120)
        self.assertEqual(self.process.returncode, 0, output + errors)
        self.assertIn(f"job {job} of an earlier call is still at work\n", output)
        self.assert_all_labeled(out, FEW)
        self.assertEqual([folder.name for folder in (self.folder / out / "shards").iterdir()], ["1"])

    def test_all_tasks_fail(self):
        """Their model is gone once they start; that the job is over does not mean that all is well."""
        out = "gone"
        for name in self.cluster.names:
            self.cluster.drain(name)
        shutil.copy(self.folder / "cup.safetensors", self.folder / "gone.safetensors")
        self.submit(out, shapes="few", model="gone.safetensors")
        self.wait_for(out, lambda: any(job.state == "PENDING" for job in self.cluster.jobs().values()), "the job")
        (self.folder / "gone.safetensors").unlink()
        for name in self.cluster.names:
            self.cluster.resume(name)
        output, errors = self.process.communicate(timeout=120)
        self.assertEqual(self.process.returncode, 1, output + errors)
        job, logs = self.report(out)["job"], self.shard(out, 1).parent
        *_, error = errors.splitlines()
        self.assertEqual(error, f"error: all tasks of job {job} have ended and {FEW} shapes are left to label; {logs}/{job}_*.log "
                         "say why, and the same command again does what is left")
        self.assertIn("gone.safetensors", (logs / f"{job}_1.log").read_text())
        self.assertEqual([self.report(out)[state] for state in ("labeled", "failed", "open")], [0, 0, FEW])
        self.assertTrue((self.folder / out / "index.html").exists())
        shutil.copy(self.folder / "cup.safetensors", self.folder / "gone.safetensors")
        self.call(*self.batch(out, shapes="few", model="gone.safetensors"))
        self.assert_all_labeled(out, FEW)

    def test_a_job_that_slurm_refuses(self):
        self.refused(*self.batch("refused", "--slurm", "--tasks", "2", "--partition", "nowhere", shapes="few"), code=1,
                     says=["sbatch refused the job", "nowhere"])


class LabelingByHand(Labeling):
    """Shards that something else than a Slurm of this machine runs."""

    def test_the_same_shards_at_once(self):
        self.call(*self.batch("hand", "--tasks", "3"))
        shards = sorted((self.folder / "hand" / "shards" / "1").glob("*.shard"))
        self.assertEqual(len(shards), 3)
        both = [self.start("label", "batch", shard) for shard in shards]
        both.append(self.start("label", "batch", shards[0]))  # twice at once
        for process in both:
            output, errors = process.communicate(timeout=200)
            self.assertEqual(process.returncode, 0, output + errors)
        self.assertEqual(self.status("hand/catalog.db")["runs"][0]["done"], 0)
        merged = self.call("catalog", "merge", "hand/catalog.db").stdout
        self.assertIn(f"{SHAPES} results new", merged)
        self.assertIn("0 results new", self.call("catalog", "merge", "hand/catalog.db").stdout)
        self.assert_all_labeled("hand", SHAPES)

    def run_printed(self, out, begin):
        """Writes shards into a folder and runs one of the printed commands in a shell, elsewhere."""
        cache = self.folder / "cache"
        before = set(cache.rglob("*"))
        lines = self.call(*self.batch(out, "--tasks", "2", shapes="few")).stdout.splitlines()
        [command] = [line for line in lines if line.strip().startswith(begin)]
        result = subprocess.run(["sh", "-c", command], cwd="/", env=self.environment, stdin=subprocess.DEVNULL, capture_output=True,
                                text=True, timeout=200)
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        self.call("catalog", "merge", f"{out}/catalog.db")
        self.assert_all_labeled(out, FEW)
        self.assertEqual(set(cache.rglob("*")), before)  # --cache ''

    def test_the_printed_loop(self):
        self.run_printed("it's a loop", "for ")

    def test_the_printed_line_for_gnu_parallel(self):
        version = subprocess.run(["parallel", "--version"], capture_output=True, text=True) if shutil.which("parallel") else None
        if not version or "GNU parallel" not in version.stdout:
            self.skipTest("there is no GNU parallel")
        self.run_printed("it's parallel", "parallel ")

    def test_a_cluster_elsewhere(self):
        """A job on one of several clusters is asked for there. That squeue fails is no end, nor that one task still completes."""
        tools = self.folder / "far"
        write_program(tools / "sbatch", FAR_SBATCH)
        write_program(tools / "squeue", FAR_SQUEUE.format(folder=self.folder))
        far = {**self.environment, "PATH": f"{tools}:{self.environment['PATH']}"}
        result = subprocess.run([PROGRAM, *self.batch("far_out", "--slurm", "--tasks", "2", "--wait", shapes="few")], cwd=self.folder,
                                env=far, capture_output=True, text=True, timeout=200)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertEqual(self.report("far_out")["job"], "7")
        asked = (self.folder / "asked").read_text().splitlines()
        self.assertEqual(len(asked), 3)
        for words in asked:
            self.assertLessEqual({"--jobs=7", "--clusters=far"}, set(words.split()))
        self.assert_all_labeled("far_out", FEW)


class MemoryOfATask(Labeling):
    """What a task takes of the memory that Slurm says it has."""

    SHAPES = FEW
    FACES = 500

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.call("label", "batch", "shapes", "--model", "cup.safetensors", "--out", "memory", "--tasks", "1")
        cls.all = cls.memory()

    @classmethod
    def memory(cls, **variables):
        """GB."""
        environment = {name: value for name, value in cls.environment.items() if not name.startswith("SLURM_")}
        environment.update({f"SLURM_{name}": str(value) for name, value in variables.items()})
        subprocess.run([PROGRAM, "label", "batch", "memory/shards/1/1.shard", "--quiet", "--json", "memory.json"], cwd=cls.folder,
                       env=environment, stdout=subprocess.DEVNULL, check=True, timeout=100)
        return json.loads((cls.folder / "memory.json").read_text())["memory"]

    def test_half_of_what_the_job_asked_for(self):
        self.assertAlmostEqual(self.memory(MEM_PER_NODE=400, CPUS_ON_NODE=2), 0.2)
        self.assertAlmostEqual(self.memory(MEM_PER_CPU=150, CPUS_ON_NODE=2), 0.15)

    def test_never_more_than_half_of_what_there_is(self):
        self.assertAlmostEqual(self.memory(MEM_PER_NODE=10**9), self.all)

    def test_all_of_the_node(self):
        self.assertAlmostEqual(self.memory(MEM_PER_NODE=0, CPUS_ON_NODE=1), self.all)

    def test_the_share_of_its_processors(self):
        processors = os.sysconf("SC_NPROCESSORS_ONLN")
        self.assertAlmostEqual(self.memory(CPUS_ON_NODE=1), self.all / processors)
        self.assertAlmostEqual(self.memory(CPUS_ON_NODE=2 * processors), self.all)


if __name__ == "__main__":
    sys.exit(main(ALL_SECONDS))
