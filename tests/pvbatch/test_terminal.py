#!/usr/bin/python3
"""What the driver prints: help, table, news of long steps, colours."""

import os
import pty
import subprocess
import sys
import unittest
import unittest.mock

import driver

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

import cadrefine.options
from cadrefine import table
from cadrefine.terminal import Terminal, shows_colours

ARCS = [driver.data("three_arcs_coarse.vtu"), driver.data("three_arcs.igs"), "--steps", "0"]
STEP = {"step": 12, "vertices": 12345678, "cells": 123456789, "cad_vertices": 1234567, "projected_points": 123456789,
        "global_error": 1.23456e-12, "maximum_distance": 1.2e-5, "invalid_cells": 0, "unprojected_vertices": 12,
        "minimum_quality": 0.1234, "seconds": {"project": 0.0, "error": 1.0, "refine": 2345.678},
        "method": "longest-edge"}
ESCAPE = "\033["


class Algorithm:
    """A vtkAlgorithm as far as its progress goes."""

    def __init__(self):
        self.observers = {}

    def AddObserver(self, event, call):
        self.observers[event] = call
        return event

    def RemoveObserver(self, tag):
        del self.observers[tag]

    def GetProgressText(self):
        return self.text

    def GetProgress(self):
        return self.fraction

    def progress(self, text, fraction):
        self.text, self.fraction = text, fraction
        self.observers["ProgressEvent"](self, "ProgressEvent")


class Output(unittest.TestCase):
    def news(self, events, quiet=False, **following):
        """Lines of a step whose events are (seconds, text, fraction)."""
        now, lines, algorithm = [100.0], [], Algorithm()
        terminal = Terminal(quiet, clock=lambda: now[0])
        with (unittest.mock.patch("builtins.print", lines.append),
              unittest.mock.patch("cadrefine.session.flush") as flush):
            with terminal.following(algorithm, **(following or {"title": "projecting"})):
                for seconds, text, fraction in events:
                    now[0] = 100.0 + seconds
                    if algorithm.observers:
                        algorithm.progress(text, fraction)
        self.assertEqual(algorithm.observers, {})
        self.assertEqual(flush.call_count, len(lines))  # Each goes out at once.
        return lines

    def test_news_of_long_steps(self):
        events = [(0.5, "reading", 0.1), (1.9, "reading", 0.2), (2.1, "1.2 of 4.0 million vertices", 0.31),
                  (3.0, "more", 0.4), (7.2, None, 0.5), (20.0, "done", 1.0)]
        self.assertEqual(self.news(events), ["  projecting, 2 s: 1.2 of 4.0 million vertices, 31%",
                                             "  projecting, 7 s: 50%"])
        self.assertEqual(self.news(events[:2]), [])
        self.assertEqual(self.news(events, quiet=True), [])
        self.assertEqual(len(self.news([(3.0, "x" * 200, 0.1)])[0]), 100)

    def test_news_of_the_steps_of_an_adaptation(self):
        """Each is told of as if it were alone."""
        events = [(0.0, "Projection", 0.0), (2.5, "Projection: finding the boundary", 0.1),
                  (3.0, "Step 1", 0.25), (4.9, "Step 1: marking cells", 0.3), (5.5, "Step 1: splitting cells", 0.375),
                  (6.0, "Step 2", 0.5), (9.0, "Step 2", 0.625), (9.5, "Quadratic cells", 0.75), (30.0, "done", 1.0)]
        self.assertEqual(self.news(events, parts=4), ["  projection, 2 s: finding the boundary, 40%",
                                                      "  step 1, 2 s: splitting cells, 50%", "  step 2, 3 s: 50%"])

    def test_table_fits(self):
        plain = lambda text, *_: text
        for line in [*table.headings(plain), table.row(STEP, plain)]:
            self.assertLessEqual(len(line), 100, line)
        first, second = table.headings(plain)
        row = table.row(STEP, plain)
        self.assertEqual(len(row.split()), 12)
        self.assertEqual(row.index("123456789") + len("123456789"), second.index("cells") + len("cells"))
        self.assertLessEqual(len(first), len(second))
        unknown = table.row({**STEP, "projected_points": None}, plain)
        self.assertEqual(unknown.split()[4], "-")

    def test_help(self):
        text = cadrefine.options.option_parser().format_help()
        self.assertLessEqual(max(map(len, text.splitlines())), 100)
        with open(os.path.join(driver.ROOT, "docs", "command-line.md"), encoding="utf-8") as file:
            guide = file.read()
        for action in cadrefine.options.option_parser()._actions:
            self.assertTrue(action.help and action.help.strip(), action.dest)
            for option in action.option_strings:
                self.assertIn(f"`{option}", guide)
        for ranks in (0, 2):
            run = driver.Run(ranks, "--help")
            self.assertEqual((run.status, run.output, run.errors), (0, text, []))
            self.assertEqual(run.statuses, [0] * ranks)

    def test_colours(self):
        for environment, coloured in (({"TERM": "xterm"}, True), ({"TERM": "xterm", "NO_COLOR": "1"}, False),
                                      ({"TERM": "dumb"}, False), ({}, False)):
            with self.subTest(environment), unittest.mock.patch.dict(os.environ, environment, clear=True):
                controller, terminal = pty.openpty()
                try:
                    self.assertEqual(shows_colours(terminal), coloured)
                finally:
                    os.close(terminal)
                    os.close(controller)
                self.assertFalse(shows_colours(os.open(os.devnull, os.O_WRONLY)))

    def test_a_terminal(self):
        """mpirun gives its ranks a terminal, even where its own output goes to a file."""
        environment = {**os.environ, **driver.ENVIRONMENT, "TERM": "xterm"}
        environment.pop("NO_COLOR", None)
        for shown, coloured in ((True, True), (False, False)):
            controller, terminal = pty.openpty()
            output = terminal if shown else subprocess.PIPE
            command = [*driver.launcher(1), driver.DRIVER, *ARCS]
            with subprocess.Popen(command, stdout=output, env=environment, stdin=subprocess.DEVNULL) as process:
                os.close(terminal)
                text = read_all(controller) if shown else process.stdout.read()
            os.close(controller)
            self.assertEqual(process.returncode, 0)
            self.assertIn(b"vertices", text)
            self.assertEqual(ESCAPE.encode() in text, coloured)


def read_all(controller):
    """What was written to the other end of a terminal until all have closed it."""
    text = b""
    while True:
        try:
            part = os.read(controller, 4096)
        except OSError:  # Linux's way to say that this is the end.
            return text
        if not part:
            return text
        text += part


if __name__ == "__main__":
    unittest.main()
