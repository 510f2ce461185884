"""Runs one daemon like a machine of its own: whatever it starts belongs to it, and all of it ends at once.

    machine.py LOG COMMAND [ARGUMENT...]

What a daemon starts leaves its process group and its session (slurmstepd does), so neither can say what belongs to it. This
process adopts all its orphaned descendants instead (prctl PR_SET_CHILD_SUBREAPER). It kills every one when its standard input
ends, which happens however the program ends that holds the other side. On standard output stand the process id of the daemon and,
once it has ended, how (as subprocess.Popen.returncode). It outlives the daemon as long as any descendant does."""

import ctypes
import os
import pathlib
import select
import signal
import subprocess
import sys

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36


def prctl(option, value):
    if ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "prctl")


def children():
    """The children of each process; a name in /proc/PID/stat may hold any character, so that fields count from its end."""
    found = {}
    for entry in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(entry.read_text(errors="replace").rpartition(")")[2].split()[1])
        except OSError:
            continue  # it has just ended
        found.setdefault(parent, []).append(int(entry.parent.name))
    return found


def descendants(root):
    """All processes below one, parents before their children, the dead that nobody has waited for included."""
    below, found = children(), [root]
    for process in found:
        found += below.get(process, [])
    return found[1:]


def wait_for_any(options):
    """The (process id, exit code) of one that ended; (0, 0) if none has and `options` say not to wait; None without children."""
    try:
        process, status = os.waitpid(-1, options)
    except ChildProcessError:
        return None
    return process, os.waitstatus_to_exitcode(status) if process else 0


def kill_all():
    """Each killed process leaves its children to this one, so that none can get away, however fast they multiply. Parents die
    first: as in a machine that loses its power, no slurmstepd may live to report that its task was killed."""
    while wait_for_any(os.WNOHANG) is not None:
        for process in descendants(os.getpid()):
            try:
                os.kill(process, signal.SIGKILL)
            except OSError:
                pass  # it has just ended
        wait_for_any(0)


def keep(daemon):
    """Returns when standard input ends or no descendant is left."""
    wake, wakened = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    signal.set_wakeup_fd(wakened, warn_on_full_buffer=False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    while True:
        while (ended := wait_for_any(os.WNOHANG)) and ended[0]:
            if ended[0] == daemon:
                print(ended[1], flush=True)
        if ended is None:
            return
        ready = select.select([0, wake], [], [])[0]
        if 0 in ready and not os.read(0, 1):
            return
        if wake in ready:
            os.read(wake, 4096)


def main():
    log, *command = sys.argv[1:]
    prctl(PR_SET_CHILD_SUBREAPER, 1)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: sys.exit(1))
    try:
        with open(log, "ab") as messages:
            daemon = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=messages, stderr=messages,
                                      preexec_fn=lambda: prctl(PR_SET_PDEATHSIG, signal.SIGKILL))
        print(daemon.pid, flush=True)
        keep(daemon.pid)
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        kill_all()


if __name__ == "__main__":
    main()
