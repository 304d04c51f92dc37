#!/usr/bin/python3
"""Ctrl-C and kill end all ranks at once, with one line, and leave the last whole step and nothing else."""

import contextlib
import json
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

import driver

WING = [driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs"), "--method", "uniform"]
NOTHING = "cadrefine: ended by a signal, nothing was written"
ENDLESS = ["--steps", "20"]
OLD = "The result of an earlier run.\n"


def passes_on_last_words():
    """Whether mpirun, where it is signalled itself, passes on what its ranks say then. That of Open MPI 5.0.7 (Debian
    13) ends without, and gives the signal to some of its ranks only before it kills them."""
    said = subprocess.run(["mpirun", "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    return int(re.search(r"\(Open MPI\) (\d+)", said)[1]) < 5


PASSES_ON = passes_on_last_words()


class Signals(driver.Case):
    whole_runs = {}  # Contents of the files that runs leave which nothing ends: by ranks, name and steps.

    def command(self, ranks, place, *options, case=WING):
        return [*driver.launcher(ranks), driver.DRIVER, *case, *options, "--output", place]

    def start(self, ranks, output, *options, case=WING):
        """A run whose result is there already, from an earlier run."""
        place = self.path(output)
        with open(place, "w", encoding="utf-8") as file:
            file.write(OLD)
        environment = {**os.environ, **driver.ENVIRONMENT, "TEST_FOLDER": self.folder}
        process = subprocess.Popen(self.command(ranks, place, *options, case=case), text=True, env=environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        return process, place

    def wait_for_line(self, process, first_word):
        for line in process.stdout:
            if line.split()[:1] == [first_word]:
                return
        self.fail(process.stderr.read())

    def end(self, process, told=True):
        """The one line of the driver on standard error, or None where it is not told; mpirun has its own."""
        _, errors = process.communicate(timeout=driver.TIMEOUT)
        lines = [line for line in errors.splitlines() if line.startswith("cadrefine: ")]
        self.assertIn(len(lines), (1,) if told else (0, 1),
                      (process.returncode, errors, sorted(self.files(self.folder))))
        self.assertEqual(self.left_over(), [])
        return lines[0] if lines else None

    def left_over(self):
        """Processes, of any rank, that have this test's folder among their arguments or variables."""
        found = []
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{process}/cmdline", encoding="utf-8", errors="replace") as file:
                    command = file.read()
                with open(f"/proc/{process}/environ", encoding="utf-8", errors="replace") as file:
                    variables = file.read()
            except OSError:
                continue  # It has ended meanwhile.
            if self.folder in command + variables:
                found.append((int(process), os.path.basename(command.split("\0")[0])))
        return sorted(found)

    def ranks(self):
        return [process for process, name in self.left_over() if name == "pvbatch"]

    def files(self, folder):
        """Contents by the path within the folder."""
        contents = {}
        for inside, _, names in os.walk(folder):
            for name in names:
                with open(os.path.join(inside, name), "rb") as file:
                    contents[os.path.relpath(os.path.join(inside, name), folder)] = file.read()
        return contents

    def step_left(self, ranks, place, steps):
        """That of `steps` whose whole run leaves what is in the test's folder."""
        found = [step for step in steps if self.files(self.folder) == self.whole_run(ranks, place, step)]
        self.assertEqual(len(found), 1, sorted(self.files(self.folder)))
        return found[0]

    def step_of(self, line, place):
        match = re.fullmatch(f"cadrefine: ended by a signal; {re.escape(place)} holds the mesh after step (\\d+)", line)
        self.assertTrue(match, line)
        return int(match[1])

    def whole_run(self, ranks, place, step):
        """What a run of so many steps leaves."""
        name = os.path.basename(place)
        if (ranks, name, step) not in self.whole_runs:
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run(self.command(ranks, os.path.join(folder, name), "--steps", str(step)), check=True,
                               env={**os.environ, **driver.ENVIRONMENT}, stdout=subprocess.DEVNULL)
                self.whole_runs[ranks, name, step] = self.files(folder)
        return self.whole_runs[ranks, name, step]

    def assert_same_as_whole_run(self, ranks, place, step):
        """What is in the test's folder is what a run of so many steps leaves there."""
        self.assertEqual(self.files(self.folder), self.whole_run(ranks, place, step))

    def test_in_a_later_step(self):
        """Of mpirun the exit status is its own."""
        for ranks, output, number, status in ((0, "out.vtu", signal.SIGINT, 130), (0, "out.pvtu", signal.SIGHUP, 129),
                                              (2, "out.vtu", signal.SIGTERM, 1), (2, "out.pvtu", signal.SIGINT, 1)):
            with self.subTest(ranks=ranks, output=output, signal=number.name):
                self.setUp()  # A folder for each.
                report = self.path("report.json")
                process, place = self.start(ranks, output, *ENDLESS, "--report", report)
                self.wait_for_line(process, "2")
                process.send_signal(number)
                line = self.end(process, told=not ranks or PASSES_ON)
                self.assertEqual(process.returncode, status)
                with open(report, encoding="utf-8") as file:
                    told = json.load(file)
                step = self.step_of(line, place) if line else told["steps"][-1]["step"]
                self.assertGreaterEqual(step, 2)
                self.assertEqual((told["steps"][-1]["step"], told["stopped"]), (step, "ended by a signal"))
                os.remove(report)
                self.assert_same_as_whole_run(ranks, place, step)

    def test_of_one_rank(self):
        """mpirun ends the others."""
        for index in (0, 1):
            with self.subTest(rank=index):
                self.setUp()
                process, place = self.start(2, "out.pvtu", *ENDLESS)
                self.wait_for_line(process, "2")
                os.kill(self.ranks()[index], signal.SIGTERM)
                step = self.step_of(self.end(process), place)
                self.assert_same_as_whole_run(2, place, step)

    def test_before_the_first_whole_step(self):
        """Of a mesh so large that it takes a while; what an earlier run has left stays."""
        fine = self.path("fine.vtu")
        subprocess.run(self.command(0, fine, "--steps", "4"), check=True, stdout=subprocess.DEVNULL)
        for ranks, status in ((0, 143), (2, 1)):
            with self.subTest(ranks=ranks):
                process, place = self.start(ranks, "out.vtu", *ENDLESS, case=[fine, *WING[1:]])
                self.wait_for_line(process, "CAD:")
                process.send_signal(signal.SIGTERM)
                told = not ranks or PASSES_ON
                self.assertIn(self.end(process, told), (NOTHING,) if told else (NOTHING, None))
                self.assertEqual(process.returncode, status)
                self.assertEqual(sorted(os.listdir(self.folder)), ["fine.vtu", "out.vtu"])
                with open(place, encoding="utf-8") as file:
                    self.assertEqual(file.read(), OLD)

    def test_while_a_step_is_written(self):
        """The step before is left, or this one, whole."""
        for ranks, output in ((2, "out.pvtu"), (0, "out.xdmf"), (2, "out.msh")):
            with self.subTest(output):
                self.setUp()
                process, place = self.start(ranks, output, *ENDLESS)
                while not os.path.isdir(place + ".part/3"):
                    self.assertIsNone(process.poll())
                    time.sleep(0.001)
                process.send_signal(signal.SIGINT)
                line = self.end(process, told=not ranks or PASSES_ON)
                step = self.step_of(line, place) if line else self.step_left(ranks, place, (2, 3))
                self.assertIn(step, (2, 3))
                if output != "out.xdmf":  # HDF5 files hold the time.
                    self.assert_same_as_whole_run(ranks, place, step)
                self.assertFalse(os.path.exists(place + ".part"))

    def test_where_the_result_cannot_be_replaced(self):
        process, place = self.start(0, "out.vtu", *ENDLESS)
        self.wait_for_line(process, "2")
        os.remove(place)
        os.mkdir(place)
        process.send_signal(signal.SIGTERM)
        line = self.end(process)
        match = re.search(r"could not be replaced; the mesh after step (\d+) is in (.*)", line)
        self.assertTrue(match, line)
        self.assertTrue(os.path.isfile(os.path.join(match[2], match[1], "out.vtu")))

    def test_when_all_is_done(self):
        """All or nothing: the signal may come when the results are being put in their places."""
        process, place = self.start(2, "out.pvtu", "--steps", "3", "--plot", self.path("plot.png"))
        while not os.path.isdir(self.path("plot.png.part/4")):
            self.assertIsNone(process.poll())
            time.sleep(0.001)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=driver.TIMEOUT)
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.path("plot.png"))
        self.assert_same_as_whole_run(2, place, 3)


if __name__ == "__main__":
    unittest.main()
