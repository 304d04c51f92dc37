#!/usr/bin/python3
"""Runs every case of docs/gallery.md as people do, with two adaptive steps at most, and that of the first page whole:
test_gallery.py FOLDER"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest

import meshio
from PIL import Image, ImageChops, ImageStat

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "docs", "gallery"))
sys.path.insert(0, os.path.join(ROOT, "tests", "pvbatch"))

import driver
import page

FOLDER = sys.argv.pop() if __name__ == "__main__" else None
TIMEOUT = 400  # Seconds after which a run of all cases counts as hanging.
CASES = page.cases()
WITH_PICTURES = ["tee", "ball"]
MEASURED = re.compile(r"^\| +0 \|.*\|\n\| +\d+ \|.*\|$", re.MULTILINE)


def gallery(*arguments, steps="2"):
    """Runs the gallery's script. Returns the commands that it says it runs."""
    command = ["/usr/bin/python3", "-B", os.path.join(ROOT, "docs", "gallery", "gallery.py"), "--output", FOLDER,
               *(["--steps", steps] if steps else []), *arguments]
    result = subprocess.run(command, env={**os.environ, **driver.ENVIRONMENT}, capture_output=True, text=True,
                            timeout=TIMEOUT, stdin=subprocess.DEVNULL, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return [line[2:] for line in result.stdout.splitlines() if line.startswith("$ ")]


def result(case, name):
    return os.path.join(FOLDER, case, name)


class Gallery(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        without = [name for name in CASES if name not in WITH_PICTURES]
        cls.commands = gallery("--no-pictures", *without) + gallery(*WITH_PICTURES)

    def test_the_commands_of_the_page_are_run(self):
        for case in CASES.values():
            self.assertTrue(any("plugin/cadrefine.py" in command for command in case.commands), case.name)
            for command in case.commands:
                words = shlex.split(command.replace("build/gallery", os.path.relpath(FOLDER, ROOT)))
                self.assertTrue(any(run.startswith(shlex.join(words)) for run in self.commands), command)

    def test_no_cell_is_invalid_and_the_error_falls(self):
        for name in CASES:
            with open(result(name, "report.json"), encoding="utf-8") as file:
                steps = json.load(file)["steps"]
            self.assertGreater(len(steps), 1, name)
            for step in steps:
                self.assertEqual((step["invalid_cells"], step["unprojected_vertices"]), (0, 0), (name, step))
            for before, after in zip(steps, steps[1:]):
                self.assertLess(after["global_error"], before["global_error"], name)

    def test_meshes_are_written(self):
        for name in CASES:
            self.assertGreater(len(meshio.read(result(name, "mesh.vtu")).points), 0, name)

    def test_groups_of_gmsh_are_kept(self):
        def groups_of(file):
            tags = meshio.read(result("tee", file)).cell_data_dict["gmsh:physical"]["triangle"].ravel()
            return {tag: sum(tags == tag) for tag in set(tags.tolist())}

        coarse, fine = groups_of("coarse.msh"), groups_of("mesh.vtu")
        self.assertEqual(set(coarse), {1, 2, 3, 4})
        self.assertEqual(set(fine), set(coarse))
        for tag in coarse:
            self.assertGreater(fine[tag], coarse[tag])

    def test_pictures_are_drawn(self):
        names = [(name, file) for name in WITH_PICTURES for file in ("first.png", "last.png")] + [("tee", "groups.png")]
        for name, file in names:
            self.assertGreater(os.path.getsize(result(name, file)), 10000, f"{name}: {file} is empty")

    def test_the_page_is_whole(self):
        text = page.read()
        self.assertEqual(len(MEASURED.findall(text)), len(CASES), "a case without figures: gallery.py --publish")
        pictures = re.findall(r"\]\((images/gallery_.*?\.png)\)", text)
        self.assertGreaterEqual(len(pictures), 2 * len(CASES))
        for picture in pictures:
            self.assertTrue(os.path.exists(os.path.join(ROOT, "docs", picture)), picture)

    def test_the_picture_of_the_first_page_is_what_the_case_draws(self):
        """Where gmsh meshes the case as that of the page did: another one makes other triangles."""
        gallery(page.FIRST_PAGE, steps=None)
        with open(result(page.FIRST_PAGE, "report.json"), encoding="utf-8") as file:
            steps = json.load(file)["steps"]
        measured = [[int(row.split("|")[3].replace(",", "")) for row in MEASURED.search(section["text"])[0].splitlines()]
                    for section in page.SECTION.finditer(page.read()) if section["name"] == page.FIRST_PAGE]
        if steps[0]["cells"] != measured[0][0]:
            self.skipTest("another mesh")
        page.shrink(result(page.FIRST_PAGE, "both.png"), result(page.FIRST_PAGE, "page.png"))
        with Image.open(result(page.FIRST_PAGE, "page.png")) as drawn, Image.open(page.BEFORE_AFTER) as shown:
            self.assertEqual(drawn.size, shown.size)
            self.assertLess(ImageStat.Stat(ImageChops.difference(drawn, shown)).mean, [2.0] * 3)


if __name__ == "__main__":
    unittest.main()
