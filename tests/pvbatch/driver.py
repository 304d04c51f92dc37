"""Runs plugin/cadrefine.py for the tests, as people do: under mpirun and pvbatch, or in pvpython."""

import atexit
import collections
import contextlib
import functools
import itertools
import json
import os
import subprocess
import tempfile
import threading
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DRIVER = os.path.join(ROOT, "plugin", "cadrefine.py")
DATA = os.path.join(ROOT, "data")
TIMEOUT = 240  # Seconds after which a run counts as hanging.
END = "--- end of a run ---\n"  # What runs.py prints before the failure of a run.
Outcome = collections.namedtuple("Outcome", "failure output")  # The line of the failure, or None; what was printed.

with open(os.path.join(ROOT, "tests", "support", "open_mpi"), encoding="ascii") as settings:
    ENVIRONMENT = dict(line.strip().split("=", 1) for line in settings if not line.startswith("#"))


def data(name):
    return os.path.join(DATA, name)


DISPLAYS = itertools.count(100 + os.getpid() % 5000 * 10)  # With --auto-servernum two tests could get the same one.


def with_display():
    """What starts a command on an X server of its own. Without -noreset the server starts anew when one rank leaves,
    and the next one may come just then."""
    return ["xvfb-run", f"--server-num={next(DISPLAYS)}", "--server-args=-screen 0 1280x1024x24 -noreset"]


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)


class Run:
    """One run of the driver: exit statuses of all ranks, standard output and the lines of standard error."""

    def __init__(self, ranks, *arguments, without=(), display=False):
        """`ranks` 0 stands for pvpython; variables named in `without` are taken out of the environment; `display`
        gives the run an X server of its own."""
        environment = {**os.environ, **ENVIRONMENT}
        for name in without:
            environment.pop(name, None)
        with tempfile.TemporaryDirectory() as folder:
            command = (with_display() if display else []) + self.command(ranks, folder, arguments)
            result = subprocess.run(command, env=environment, capture_output=True,
                                    text=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL, check=False)
            self.statuses = [read_status(os.path.join(folder, name)) for name in sorted(os.listdir(folder))]
        self.status = result.returncode
        self.output = result.stdout
        self.errors = [line for line in result.stderr.splitlines() if line.strip()]

    @staticmethod
    def command(ranks, folder, arguments):
        arguments = [DRIVER, *map(str, arguments)]
        if ranks == 0:
            return [*launcher(0), *arguments]
        # Each rank leaves its exit status in a file; mpirun sees 0, and so ends none of them early.
        script = 'pvbatch "$@"; echo $? > "$0/$OMPI_COMM_WORLD_RANK"'
        return ["mpirun", "-np", str(ranks), "sh", "-c", script, folder, *arguments]


def read_status(path):
    with open(path, encoding="ascii") as file:
        return int(file.read())


def launcher(ranks):
    """Command that starts ParaView's Python; `ranks` 0 stands for pvpython."""
    return ["mpirun", "-np", str(ranks), "pvbatch"] if ranks else ["pvpython"]


class Runs:
    """A process that makes runs of the driver, one after the other (runs.py): ParaView starts once for all of them."""

    def __init__(self, ranks):
        self.errors = tempfile.TemporaryFile("w+", encoding="utf-8")
        program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "runs.py")
        self.process = subprocess.Popen([*launcher(ranks), program], env={**os.environ, **ENVIRONMENT}, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors)
        atexit.register(self.end)

    def run(self, told):
        timer = threading.Timer(TIMEOUT, self.process.terminate)
        timer.start()
        with contextlib.suppress(BrokenPipeError):
            print(json.dumps(told), file=self.process.stdin, flush=True)
        lines = list(itertools.takewhile(lambda line: line != END, iter(self.process.stdout.readline, "")))
        result = self.process.stdout.readline()
        timer.cancel()
        self.errors.seek(0)
        errors = self.errors.read().strip()
        assert result and not errors, (told, lines, errors)
        return Outcome(json.loads(result), "".join(lines))

    def end(self):
        self.process.communicate(timeout=TIMEOUT)
        self.errors.close()


runs = functools.cache(Runs)


def outcome(ranks, *arguments, **told):
    """Of a run for which no process of its own is started; `told` is what runs.py takes besides the arguments."""
    return runs(ranks).run({"arguments": [*map(str, arguments)], **told})


def report_of(ranks, *arguments):
    """Report of a run that must succeed."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "report.json")
        failure = outcome(ranks, *arguments, "--report", path).failure
        assert failure is None, failure
        with open(path, encoding="utf-8") as file:
            return json.load(file)
