"""A real Slurm of some nodes on this machine, with nothing but Python's own library: munged, slurmctld and a slurmd per node.

    with SlurmCluster() as cluster:
        job = cluster.submit("#!/bin/sh\\necho $SLURM_ARRAY_TASK_ID\\n", "--array=1-4")
        cluster.kill_node("n1", tasks_too=True)
        print(cluster.wait(job, 60))

All its files lie in a folder of its own, all its ports are free ones, and nothing of the machine's own Slurm or munge is read,
used or changed. It runs as root or as any user (jobs then run as that user), without systemd, D-Bus or control groups."""

import atexit
import collections
import contextlib
import os
import pathlib
import pwd
import random
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
START_SECONDS = 60
CALL_SECONDS = 60
DOWN_SECONDS = 5
SOCKET_PATH = 60   # of the 107 characters of a Unix socket's path, what the folder may take
ENDED = {"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE", "FAILED", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "TIMEOUT"}
JOB_FIELDS = {"ArrayJobID": 20, "ArrayTaskID": 20, "State": 24, "NodeList": 40, "RestartCnt": 12, "Reason": 80}

# One job, or one task of a job array: its state in Slurm's words, the node it runs or ran on, how often it was requeued, and why
# it waits.
Job = collections.namedtuple("Job", "state node restarts reason")

# Made short: the time until a dead node is seen as such, the wait before a requeued job starts again (cred_expire, else 120 s and
# never less than 5), and the intervals of scheduling, since a job whose wait is over starts at the next of them.
CONFIGURATION = """ClusterName=exemplar
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
MailProg=/bin/true
MpiDefault=none
SwitchType=switch/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
SlurmdTimeout={down}
MessageTimeout=5
KillWait=2
ReturnToService=2
JobRequeue=1
GresTypes=gpu
"""
# The configuration counts what it says, whatever the machine has (config_overrides).
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus} RealMemory=1024 Gres=gpu:{gpus}\n"
# Slurm wants a device of its own for each GPU, opens none of them, and numbers them in CUDA_VISIBLE_DEVICES.
DEVICES = ("null", "zero", "full", "random")
PARTITION = "PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"


class SlurmError(RuntimeError):
    """A daemon or a command failed, or something did not happen in time."""


def search_path():
    return os.environ.get("PATH", os.defpath) + ":/usr/sbin:/sbin"


def missing_programs():
    return [name for name in PROGRAMS if not shutil.which(name, path=search_path())]


def private_folder():
    """A new folder whose path leaves room for the names of sockets."""
    for base in (tempfile.gettempdir(), "/tmp", "/var/tmp"):
        if len(base) < SOCKET_PATH - 20 and os.access(base, os.W_OK | os.X_OK):
            return pathlib.Path(tempfile.mkdtemp(prefix="exemplar-slurm-", dir=base))
    raise SlurmError("no temporary folder with a short path")


def free_ports(count):
    """Free ports below those that the system gives to outgoing connections: a node that comes back still finds its own free."""
    low = int(pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    found = []
    for port in random.SystemRandom().sample(range(max(1024, low - 12000), low), 1000):
        with contextlib.suppress(OSError), socket.socket() as probe:
            probe.bind(("127.0.0.1", port))
            found.append(port)
        if len(found) == count:
            return found
    raise SlurmError(f"no {count} free ports below {low}")


def clean_environment(folder):
    """Without the settings of a surrounding Slurm, in whose job a test may run."""
    settings = re.compile(r"(SLURM|SBATCH|SALLOC|SRUN|SQUEUE|SINFO|SCANCEL|SCONTROL|SACCT|MUNGE)[A-Z]*_")
    kept = {name: value for name, value in os.environ.items() if not settings.match(name)}
    return dict(kept, PATH=search_path(), SLURM_CONF=str(folder / "slurm.conf"))


def marked_processes(mark):
    """The living processes with a text in their command line or environment, as all of a cluster have its folder."""
    mark, found = os.fsencode(mark), []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if mark in (entry / "cmdline").read_bytes() or mark in (entry / "environ").read_bytes():
                found.append(int(entry.name))
    return found


class Daemon:
    """A daemon with all that it starts (see machine.py)."""

    def __init__(self, name, log, environment, *command):
        self.name, self.log = name, log
        keeper = [sys.executable, "-B", str(pathlib.Path(__file__).with_name("machine.py")), str(log)]
        with open(log, "ab") as messages:
            self.keeper = subprocess.Popen([*keeper, *map(str, command)], env=environment, cwd=log.parent, start_new_session=True,
                                           stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=messages)
        self.said = ""

    def read(self):
        """The lines that machine.py has printed so far: the process id, then the exit code."""
        while select.select([self.keeper.stdout], [], [], 0)[0]:
            piece = os.read(self.keeper.stdout.fileno(), 4096)
            if not piece:
                break
            self.said += piece.decode()
        return [int(line) for line in self.said.split("\n")[:-1]]

    def pid(self):
        while not (said := self.read()):
            if self.keeper.poll() is not None:
                raise SlurmError(self.failure())
            select.select([self.keeper.stdout], [], [], 1)
        return said[0]

    def alive(self):
        return len(self.read()) < 2 and self.keeper.poll() is None

    def failure(self):
        """What is said of a daemon that should be alive and is not."""
        codes = self.read()[1:]
        ended = f"ended with exit code {codes[0]}" if codes else "did not start" if self.keeper.poll() is not None else "goes on"
        return f"{self.name} {ended}; the end of its log:\n{self.tail()}"

    def tail(self, lines=20):
        text = self.log.read_text(errors="replace") if self.log.exists() else ""
        return "\n".join(f"    {line}" for line in text.splitlines()[-lines:])

    def kill(self, number=signal.SIGKILL):
        """Ends the daemon alone, by a signal; what it has started goes on."""
        if self.alive():
            os.kill(self.pid(), number)
        while self.alive():
            time.sleep(0.01)

    def end(self):
        """Kills the daemon and everything that it has started, and returns when all of it is gone."""
        with contextlib.suppress(OSError):
            self.keeper.stdin.close()
        self.keeper.wait()
        self.keeper.stdout.close()


class SlurmCluster(contextlib.AbstractContextManager):
    """Nodes n1, n2, ... with so many CPUs and made-up GPUs each."""

    def __init__(self, nodes=2, cpus=1, gpus=0):
        self.names = [f"n{i + 1}" for i in range(nodes)]
        self.cpus, self.gpus = cpus, gpus
        self.folder, self.environment = None, None
        self.services, self.machines, self.dead = [], {}, []

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.stop()

    # ---- life

    def start(self):
        """Returns when all nodes are ready; a failure leaves nothing behind."""
        if missing := missing_programs():
            raise SlurmError(f"no {', no '.join(missing)} (Debian: slurm-wlm, munge)")
        atexit.register(self.stop)  # also when an interrupt ends the program
        try:
            self.folder = private_folder()
            self.environment = clean_environment(self.folder)
            self._configure()
            self._start_services()
            for name in self.names:
                self.start_node(name)
            self.wait_for_nodes("idle", *self.names, timeout=START_SECONDS)
        except BaseException:
            self.stop()
            raise

    def stop(self):
        """Kills every process of the cluster, running jobs included, and removes its folder."""
        atexit.unregister(self.stop)
        for daemon in [*self.machines.values(), *self.dead, *reversed(self.services)]:
            daemon.end()
        self.services, self.machines, self.dead = [], {}, []
        if self.folder:
            shutil.rmtree(self.folder, ignore_errors=True)

    def _configure(self):
        controller, *self.ports = free_ports(1 + len(self.names))
        host = socket.gethostname().partition(".")[0]
        try:
            user = pwd.getpwuid(os.getuid()).pw_name
        except KeyError:
            raise SlurmError(f"user {os.getuid()} has no name, and Slurm wants one") from None
        text = CONFIGURATION.format(host=host, port=controller, user=user, folder=self.folder, down=DOWN_SECONDS)
        for name, port in zip(self.names, self.ports):
            text += NODE.format(name=name, host=host, port=port, cpus=self.cpus, gpus=self.gpus)
        (self.folder / "slurm.conf").write_text(text + PARTITION)
        devices = "".join(f"Name=gpu File=/dev/{name}\n" for name in DEVICES[:self.gpus])
        (self.folder / "gres.conf").write_text(devices)
        for name in ["state", *(f"spool/{name}" for name in self.names)]:
            (self.folder / name).mkdir(parents=True)

    def _start_services(self):
        key, path = self.folder / "munge.key", self.folder / "munge.socket"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(128))
        # --force: munge dislikes a folder that no other user can enter, and parents that others can write.
        self._serve("munged", "--foreground", "--force", "--origin=127.0.0.1", f"--key-file={key}", f"--socket={path}",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.file.log",
                    f"--seed-file={self.folder}/munged.seed")
        self.wait_until(path.exists, "munged opens its socket", START_SECONDS)
        self.start_controller()

    def stop_controller(self):
        """Ends slurmctld as for an update; tasks go on. (Killed, it forgets what happened in the last five seconds or more, drains the
        nodes where tasks run of which it knows nothing, and holds those tasks.)"""
        controller = next(daemon for daemon in self.services if daemon.name == "slurmctld")
        self.services.remove(controller)
        self.dead.append(controller)
        controller.kill(signal.SIGTERM)

    def start_controller(self):
        self._serve("slurmctld", "-D")

    def _serve(self, name, *options):
        self.services.append(Daemon(name, self.folder / f"{name}.messages", self.environment, name, *options))

    # ---- nodes

    def nodes(self):
        """The state of each node in the words of sinfo, such as idle, mixed, allocated, down, drained, with * if it is silent."""
        lines = self.run("sinfo", "--noheader", "--Node", "--format=%N %T").stdout.splitlines()
        return dict(line.split() for line in lines)

    def kill_node(self, name, tasks_too=False):
        """Kills the node's slurmd, without warning. Its jobs go on as zombies, unless the whole machine dies (`tasks_too`)."""
        machine = self.machines.pop(name)
        self.dead.append(machine)
        machine.end() if tasks_too else machine.kill()

    def start_node(self, name):
        """Boots a node that was killed; wait_for_nodes says when Slurm uses it again."""
        if name in self.machines:
            raise SlurmError(f"{name} has been started already")
        log = self.folder / f"slurmd.{name}.messages"
        self.machines[name] = Daemon(f"slurmd of {name}", log, self.environment, "slurmd", "-D", "-N", name)

    def drain(self, name):
        """The node gets no new jobs until resume()."""
        self.run("scontrol", "update", f"NodeName={name}", "State=DRAIN", "Reason=test")

    def resume(self, name):
        self.run("scontrol", "update", f"NodeName={name}", "State=RESUME")

    def wait_for_nodes(self, state, *names, timeout=60):
        """`state` is one of nodes(), for "down" also "down*"."""
        self.wait_until(lambda: {self.nodes().get(name, "").rstrip("*") for name in names} == {state},
                        f"{', '.join(names)} {state}", timeout)

    # ---- jobs

    def run(self, *command, code=0, **options):
        """Runs a command in the cluster's environment; another exit code than `code` (None: any) is an error that shows what was
        said. `options` are those of subprocess.run."""
        options = {"env": self.environment, "timeout": CALL_SECONDS, "cwd": self.folder, **options}
        if "input" not in options:
            options["stdin"] = subprocess.DEVNULL
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
        if code is not None and result.returncode != code:
            raise SlurmError(f"{' '.join(map(str, command))} gave exit code {result.returncode}:\n"
                             f"{result.stdout}{result.stderr}")
        return result

    def submit(self, script, *options, arguments=()):
        """The number of the job of a script: a path, or its text, which begins with #!."""
        if str(script).startswith("#!"):
            path = self.folder / f"script-{time.monotonic_ns()}"
            path.write_text(script)
            script = path
        return int(self.run("sbatch", "--parsable", *options, script, *arguments).stdout.split(";")[0])

    def jobs(self, job=None):
        """All jobs, the ended ones included, or one with the tasks of its array: {"7": Job} or {"7_1": Job, "7_2": Job}."""
        shape = ",".join(f"{name}:{width}" for name, width in JOB_FIELDS.items())
        chosen = [f"--jobs={job}"] if job else []
        found = {}
        answer = self.run("squeue", "--noheader", "--array", "--states=all", f"--Format={shape}", *chosen)
        for line in answer.stdout.splitlines():
            values = []
            for width in JOB_FIELDS.values():
                values.append(line[:width].strip())
                line = line[width:]
            number, task, state, node, restarts, reason = values
            found[number if task == "N/A" else f"{number}_{task}"] = Job(state, node, int(restarts), reason)
        return found

    def wait(self, job, timeout):
        """Its jobs() once all of them have ended, however they did."""
        self.wait_until(lambda: all(one.state in ENDED for one in self.jobs(job).values()), f"the end of job {job}", timeout)
        return self.jobs(job)

    # ---- waiting

    def wait_until(self, condition, what, timeout):
        """Returns the seconds until the condition held. Meanwhile no daemon may end that nobody has killed."""
        begin = time.monotonic()
        while not self._holds(condition):
            for daemon in [*self.services, *self.machines.values()]:
                if not daemon.alive():
                    raise SlurmError(daemon.failure())
            if time.monotonic() - begin > timeout:
                raise SlurmError(f"not within {timeout} s: {what}\n{self._report()}")
            time.sleep(0.1)
        return time.monotonic() - begin

    def _holds(self, condition):
        """A command fails while slurmctld starts: no answer yet."""
        try:
            return condition()
        except SlurmError:
            return False

    def _report(self):
        daemons = {daemon.name: daemon for daemon in [*self.dead, *self.services, *self.machines.values()]}
        lines = [f"{name}:\n{daemon.tail()}" for name, daemon in daemons.items()]
        if "slurmctld" in daemons:
            lines += [self.run(command, code=None).stdout for command in ("sinfo", "squeue")]
        return "\n".join(lines)
