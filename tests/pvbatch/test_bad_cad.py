#!/usr/bin/python3
"""Bad CAD files in ParaView: the reader says why, the filter that it feeds gives nothing, and the session goes on."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import driver

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bad_cad_reads.py")
MESH = driver.data("naca0012_coarse.vtu")
CAD = driver.data("naca0012_sharp.igs")

SAMPLE = "/usr/share/opencascade/data/step/screw.step"


def bad_files(folder):
    """Paths, and the reason that is given of each."""
    texts = {"empty.igs": "", "other.step": "This is no CAD.\n" * 10}
    with open(SAMPLE, encoding="ascii") as file:  # control points that are none: Open CASCADE crashes
        texts["crash.step"] = re.sub(r"(B_SPLINE_CURVE_WITH_KNOTS\('',\d+,\()#\d+", r"\1#1", file.read())
    for name, text in texts.items():
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(text)
    os.mkdir(os.path.join(folder, "folder.igs"))
    reasons = {"empty.igs": "the file is empty", "other.step": "does not begin like a file in STEP format",
               "crash.step": "the file is damaged: Open CASCADE crashes on it", "folder.igs": "is a directory",
               "missing.igs": "no such file"}
    return {os.path.join(folder, name): reason for name, reason in reasons.items()}


class BadCAD(unittest.TestCase):
    def test_session_goes_on(self):
        with tempfile.TemporaryDirectory() as folder:
            bad = bad_files(folder)
            result = os.path.join(folder, "result.json")
            run = subprocess.run(driver.launcher(RANKS) + [SCRIPT, os.environ["CADREFINE_PLUGIN"], result, MESH, *bad,
                                                           CAD],
                                 env={**os.environ, **driver.ENVIRONMENT}, capture_output=True, text=True,
                                 timeout=driver.TIMEOUT, stdin=subprocess.DEVNULL, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            with open(result, encoding="ascii") as file:
                *found, (good, told) = json.load(file)
        self.assertEqual(told, [])
        self.assertGreater(good[0], 0)
        self.assertEqual(good[1], 228)
        self.assertEqual(len(found), len(bad))
        for (path, reason), (counts, told) in zip(bad.items(), found):
            with self.subTest(path):
                self.assertEqual(counts, [0, 0])
                self.assertEqual(len(told), 1, told)
                self.assertIn(f"{path}: {reason}", told[0])


if __name__ == "__main__":
    unittest.main()
