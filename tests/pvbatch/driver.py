"""Runs plugin/cadrefine.py for the tests, as people do: under mpirun and pvbatch, or in pvpython."""

import itertools
import json
import os
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DRIVER = os.path.join(ROOT, "plugin", "cadrefine.py")
DATA = os.path.join(ROOT, "data")
TIMEOUT = 240  # Seconds after which a run counts as hanging.

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


def report_of(ranks, *arguments):
    """Report of a run that must succeed without a word on standard error."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "report.json")
        run = Run(ranks, *arguments, "--report", path)
        assert run.status == 0 and not any(run.statuses), (run.status, run.statuses, run.errors, run.output)
        assert not run.errors, run.errors
        with open(path, encoding="utf-8") as file:
            return json.load(file)


def launcher(ranks):
    """Command that starts ParaView's Python; `ranks` 0 stands for pvpython."""
    return ["mpirun", "-np", str(ranks), "pvbatch"] if ranks else ["pvpython"]


def many(ranks, folder, runs):
    """Makes all `runs`, as many_runs.py takes them, in one process. Returns the line of the failure of each, or None,
    and what was printed. `folder` is for files in between."""
    told, results = os.path.join(folder, "runs.json"), os.path.join(folder, "results.json")
    with open(told, "w", encoding="utf-8") as file:
        json.dump(runs, file)
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "many_runs.py")
    result = subprocess.run([*launcher(ranks), program, told, results], env={**os.environ, **ENVIRONMENT}, text=True,
                            capture_output=True, timeout=TIMEOUT, check=False)
    assert result.returncode == 0 and not result.stderr.strip(), (result.stdout, result.stderr)
    with open(results, encoding="utf-8") as file:
        failures = json.load(file)
    os.remove(told)
    os.remove(results)
    return failures, result.stdout


def reports_of(ranks, runs):
    """The reports of runs, each a list of arguments, that must succeed, in one process."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, f"report{number}.json") for number in range(len(runs))]
        told = [{"arguments": [*map(str, arguments), "--report", path]} for arguments, path in zip(runs, paths)]
        failures, _ = many(ranks, folder, told)
        assert not any(failures), failures
        reports = []
        for path in paths:
            with open(path, encoding="utf-8") as file:
                reports.append(json.load(file))
    return reports
