#!/usr/bin/python3
"""Full disks, killed processes, and two runs into one output: an end with one line, and no part of a result."""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import time
import unittest

import driver
import meshio

WING = [driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs"), "--method", "uniform"]
FULL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "full")
ENDLESS = ["--steps", "20"]
RELOADING = """
import os, shutil, sys
from paraview.simple import *
LoadPlugin(os.environ["CADREFINE_PLUGIN"], remote=True, ns=globals())
path = sys.argv[1]
for index, source in enumerate(sys.argv[2:]):
    shutil.copy(source, path)
    if index:
        ReloadFiles(cad)
    else:
        cad = CADReader(FileName=path)
    cad.UpdatePipeline()
    print(cad.GetDataInformation().GetNumberOfCells())
"""


class Faults(driver.Case):
    def start(self, ranks, *options, **environment):
        command = [*driver.launcher(ranks), driver.DRIVER, *WING, *options]
        process = subprocess.Popen(command, env={**os.environ, **driver.ENVIRONMENT, **environment}, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        """Its exit status and what the driver has said on standard error; mpirun and the shell have their own."""
        _, errors = process.communicate(timeout=driver.TIMEOUT)
        return process.returncode, [line for line in errors.splitlines() if line.startswith("cadrefine: ")]

    def run_to_end(self, ranks, *options, **environment):
        return self.end(self.start(ranks, *options, **environment))

    def assert_full(self, ranks, full_ranks, option, name, size):
        """No file can be longer than `size` bytes."""
        status, lines = self.run_to_end(ranks, "--steps", "3", option, self.path(name), PYTHONPATH=FULL,
                                        FULL_RANKS=full_ranks, FULL_BYTES=str(size))
        self.assertEqual((status, len(lines)), (1, 1), lines)
        self.assertRegex(lines[0], re.escape(self.path(name)) + ": (No space left on device|File too large)")
        self.assertEqual(os.listdir(self.folder), [])

    def test_full_disk(self):
        for name in ("out.vtu", "out.pvtu", "out.msh", "out.xdmf"):
            with self.subTest(name):
                self.assert_full(0, "0", "--output", name, 300000)
        self.assert_full(0, "0", "--report", "report.json", 1000)
        self.assert_full(0, "0", "--plot", "plot.png", 10000)

    def test_full_disk_on_one_rank(self):
        self.assert_full(2, "1", "--output", "out.pvtu", 300000)
        self.assert_full(2, "0", "--output", "out.vtu", 300000)

    def processes(self, text):
        """Numbers of the processes whose command line has `text` in it and this test's folder."""
        found = []
        for number in filter(str.isdigit, os.listdir("/proc")):
            with contextlib.suppress(OSError), open(f"/proc/{number}/cmdline", encoding="utf-8") as file:
                line = file.read()
                if self.folder in line and text in line.split("\0")[0]:
                    found.append(int(number))
        return sorted(found)

    def wait_for_step(self, process):
        for line in process.stdout:
            if line.split()[:1] == ["1"]:
                return

    def test_killed_rank(self):
        """The first and the last of three, in the middle of the work: the others leave the last whole step."""
        for index in (0, -1):
            process = self.start(3, *ENDLESS, "--output", self.path("out.pvtu"))
            self.wait_for_step(process)
            ranks = self.processes("pvbatch")
            self.assertEqual(len(ranks), 3)
            os.kill(ranks[index], signal.SIGKILL)
            status, lines = self.end(process)
            self.assertNotEqual(status, 0)
            self.assertLessEqual(len(lines), 1)
            deadline = time.monotonic() + driver.TIMEOUT
            while self.processes("") and time.monotonic() < deadline:
                time.sleep(0.1)
            self.assertEqual(self.processes(""), [])
            self.assertEqual(sorted(os.listdir(self.folder)), ["out", "out.pvtu"])
            shutil.rmtree(self.path("out"))
            os.remove(self.path("out.pvtu"))

    def test_killed_run(self):
        """What it leaves goes with the next run."""
        place = self.path("out.pvtu")
        process = self.start(0, *ENDLESS, "--output", place)
        self.wait_for_step(process)
        process.kill()
        process.wait()
        os.makedirs(place + ".part/out")
        shutil.copy(WING[0], place + ".part/out/out_5.vtu")
        self.assertEqual(self.run_to_end(0, "--steps", "0", "--output", place), (0, []))
        self.assertEqual(sorted(os.listdir(self.folder)), ["out", "out.pvtu"])
        self.assertEqual(os.listdir(self.path("out")), ["out_0.vtu"])

    def test_fewer_ranks_than_before(self):
        place = self.path("out.pvtu")
        for ranks in (3, 2):
            self.assertEqual(self.run_to_end(ranks, "--steps", "2", "--output", place), (0, []))
            with open(place, encoding="utf-8") as file:
                named = re.findall(r'Source="out/([^"]*)"', file.read())
            self.assertEqual(named, [f"out_{rank}.vtu" for rank in range(ranks)])
            self.assertEqual(sorted(os.listdir(self.path("out"))), named)
            cells = sum(len(meshio.read(self.path("out/" + name)).cells_dict["tetra"]) for name in named)
            self.assertEqual(cells, 64 * 228 + 240)  # Swaps of edges and faces make some more.

    def test_two_runs_at_once(self):
        """The one that comes second is refused before it does anything, and harms nothing."""
        place = self.path("out.pvtu")
        first = self.start(0, *ENDLESS, "--output", place)
        self.wait_for_step(first)
        first.send_signal(signal.SIGSTOP)  # Its mesh would become too large meanwhile.
        refused = (1, [f"cadrefine: {place}: another run is writing it"])
        self.assertEqual(self.run_to_end(0, "--output", place), refused)
        self.assertEqual(self.run_to_end(2, "--output", place), refused)
        self.assertIn("lock", os.listdir(place + ".part"))
        first.send_signal(signal.SIGTERM)
        first.send_signal(signal.SIGCONT)
        status, lines = self.end(first)
        self.assertEqual((status, len(lines)), (143, 1))
        self.assertIn(f"{place} holds the mesh after step", lines[0])
        self.assertEqual(self.run_to_end(0, "--steps", "0", "--output", place), (0, []))

    def test_two_results_of_one_name(self):
        same = self.path("x.png")
        status, lines = self.run_to_end(0, "--plot", same, "--screenshot", same)
        self.assertEqual((status, len(lines)), (1, 1))
        self.assertIn("x.png: is given twice, by --plot and --screenshot", lines[0])

    def test_changed_cad(self):
        script = self.path("reload.py")
        with open(script, "w", encoding="ascii") as file:
            file.write(RELOADING)
        cases = [driver.data(name) for name in ("naca0012_sharp.igs", "three_arcs.igs", "naca0012_sharp.igs")]
        for ranks in (0, 2):
            result = subprocess.run([*driver.launcher(ranks), script, self.path("cad.igs"), *cases], text=True,
                                    env={**os.environ, **driver.ENVIRONMENT}, capture_output=True,
                                    timeout=driver.TIMEOUT, check=False)
            self.assertEqual(result.returncode, 0, result.stderr)
            first, second, third = map(int, result.stdout.split()[-3:])
            self.assertGreater(first, second)
            self.assertEqual(first, third)


if __name__ == "__main__":
    unittest.main()
