#!/usr/bin/python3
"""Ctrl-C and kill end all ranks at once, with one line, and leave nothing behind."""

import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

import driver

WING = [driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs"), "--method", "uniform"]
LINE = "cadrefine: interrupted, nothing was written"
ENDLESS = ["--steps", "20"]
OLD = "The result of an earlier run.\n"


class Signals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def start(self, ranks, output, *options):
        """A run whose result is there already, from an earlier run."""
        place = os.path.join(self.folder, output)
        with open(place, "w", encoding="utf-8") as file:
            file.write(OLD)
        command = [*driver.launcher(ranks), driver.DRIVER, *WING, *options, "--output", place]
        process = subprocess.Popen(command, env={**os.environ, **driver.ENVIRONMENT}, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        return process, place

    def assert_ends(self, process, place, number, status):
        process.send_signal(number)
        self.assert_nothing_written(process, place, status)

    def assert_nothing_written(self, process, place, status):
        _, errors = process.communicate(timeout=driver.TIMEOUT)
        self.assertEqual([line for line in errors.splitlines() if line.strip()], [LINE])
        self.assertEqual(process.returncode, status)
        self.assertEqual(os.listdir(self.folder), [os.path.basename(place)])
        with open(place, encoding="utf-8") as file:
            self.assertEqual(file.read(), OLD)
        self.assertEqual(self.left_over(), [])

    def left_over(self):
        """Processes, of any rank, that have this test's folder among their arguments."""
        found = []
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{process}/cmdline", encoding="utf-8", errors="replace") as file:
                    if self.folder in file.read():
                        found.append(process)
            except OSError:
                pass  # It has ended meanwhile.
        return found

    def test_in_the_middle_of_the_work(self):
        """Of mpirun the exit status is its own."""
        for ranks, number, status in ((2, signal.SIGINT, 1), (2, signal.SIGTERM, 1), (0, signal.SIGINT, 130),
                                      (0, signal.SIGTERM, 143)):
            with self.subTest(ranks=ranks, signal=number.name):
                process, place = self.start(ranks, "out.vtu", *ENDLESS)
                for line in process.stdout:
                    if line.split()[:1] == ["2"]:  # Row 2 of the table: the next step is under way.
                        break
                self.assert_ends(process, place, number, status)

    def test_while_results_are_written(self):
        """All or nothing: the signal may come when the results are being put in their places."""
        for ranks, output, status in ((2, "out.pvtu", 1), (0, "out.xdmf", 130)):
            with self.subTest(output):
                self.setUp()  # A folder for each.
                process, place = self.start(ranks, output, "--steps", "4")
                while not os.path.isdir(place + ".part") or set(os.listdir(place + ".part")) <= {"lock"}:
                    self.assertIsNone(process.poll())
                    time.sleep(0.001)
                process.send_signal(signal.SIGINT)
                process.wait(timeout=driver.TIMEOUT)
                with open(place, encoding="utf-8") as file:
                    text = file.read()
                if text == OLD:
                    self.assert_nothing_written(process, place, status)
                else:
                    named = re.findall(r'Source="([^"]*)"', text) or [output.replace(".xdmf", ".h5")]
                    self.assertEqual([name for name in named if not os.path.isfile(os.path.join(self.folder, name))], [])
                    self.assertFalse(os.path.exists(place + ".part"))


if __name__ == "__main__":
    unittest.main()
