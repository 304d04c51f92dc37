#!/usr/bin/python3
"""OpenDataFile and SaveData of meshes in the formats of other programs, without the driver: groups come back, on any
number of ranks the same; what fails is one line, and leaves nothing behind."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import driver
import meshes
import meshio
import numpy as np

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "mesh_files.py")
AVS = "4 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n"
BAD = {"bad.msh": ("$MeshFormat\n2.2 0 8\nhello", "the section MeshFormat has no end"),
       "bad.su2": ("NDIME= 3\n", ""), "bad.e": ("hello", "Unable to open"),
       "bad.txt": ("hello", "is not in a format that can be read here")}


class MeshFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        meshes.write_gmsh(driver.data("cylinder.brep"), cls.folder)
        counts = meshes.write_mixed(cls.path("mixed.msh"), cls.path("mixed2.msh"))
        cls.solids = sum(count for (_, dimension), count in counts.items() if dimension == 3)
        for name, content in (("avs.inp", AVS), *((name, content) for name, (content, _) in BAD.items())):
            with open(cls.path(name), "w", encoding="ascii") as file:
                file.write(content)
        cls.before = set(os.listdir(cls.folder))
        result = subprocess.run([*driver.launcher(RANKS), SCRIPT, os.environ["CADREFINE_PLUGIN"], driver.DATA,
                                 cls.folder], env={**os.environ, **driver.ENVIRONMENT}, capture_output=True, text=True,
                                timeout=driver.TIMEOUT, check=False)
        assert os.path.exists(cls.path("found.json")), result.stdout + result.stderr
        with open(cls.path("found.json"), encoding="utf-8") as file:
            cls.found = json.load(file)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def test_opened(self):
        whole = meshio.gmsh.read(self.path("gmsh4binary.msh"))
        self.assertEqual(self.found["opened"], {
            "label": "Mesh Reader", "cells": sum(len(block) for block in whole.cells), "points": len(whole.points),
            "fields": sorted(meshes.GROUPS)})

    def test_saved(self):
        """All cells, each point once, groups by their names in the format."""
        points = meshio.gmsh.read(self.path("saved.msh")).points
        self.assertEqual(len(np.unique(points, axis=0)), len(points))
        for ending, described in self.found["files"].items():
            self.assertEqual(described["points"], len(points), ending)
            if ending in ("msh", "med", "xdmf"):  # The others have no edges.
                self.assertEqual(described["cells"], self.found["adapted"]["cells"], ending)
            body = "solid body" if ending in ("msh", "med", "xdmf") else "solid_body"
            expected = {"wall", "ends"} if ending == "su2" else {"wall", "ends", body}
            self.assertLessEqual(expected, set(described["fields"]), ending)

    def test_read_by_others(self):
        """Groups of the input, and those of the CAD faces of facets that are in none."""
        mesh = meshio.gmsh.read(self.path("saved.msh"))
        names = {name: tuple(pair) for name, pair in mesh.field_data.items()}
        for name, pair in meshes.GROUPS.items():
            self.assertEqual(names[name], pair)
        of_faces = {name for name in names if name.startswith("Face ")}
        self.assertTrue(of_faces, names)
        tags = mesh.cell_data_dict["gmsh:physical"]
        self.assertEqual(set(tags["tetra"]), {meshes.BODY})
        self.assertEqual(set(tags["triangle"]), {meshes.WALL, meshes.ENDS, *(names[name][0] for name in of_faces)})

    def test_version_and_text(self):
        with open(self.path("text.msh"), encoding="ascii") as file:
            self.assertEqual(file.readlines()[1], "4.1 0 8\n")
        self.assertEqual(len(meshio.gmsh.read(self.path("text.msh")).points), self.found["opened"]["points"])

    def test_pieces_without_ids(self):
        """Points that pieces share are one again."""
        self.assertEqual(self.found["spread"], self.found["opened"])

    def test_mixed_cells(self):
        """Hexahedra, wedges, pyramids and tetrahedra, in pieces, in all formats: four boxes of volume 1."""
        self.assertEqual({ending: cells for ending, (cells, _) in self.found["mixed"].items()},
                         dict.fromkeys(self.found["mixed"], self.solids))
        for ending, (_, volume) in self.found["mixed"].items():
            self.assertAlmostEqual(volume, 4, msg=ending)

    def test_the_reader_that_can_read_it_is_taken(self):
        self.assertEqual(self.found["abaqus"], "Mesh Reader")
        self.assertEqual(self.found["avs"], "AVS UCD Reader")

    def test_failures(self):
        for name, (_, reason) in BAD.items():
            with self.subTest(name):
                (line,) = self.found["bad"][name]
                self.assertIn(self.path(name), line)
                self.assertIn(reason, line)
                self.assertEqual(len(line.splitlines()), 1)
        for name, lines in self.found["unwritten"].items():
            with self.subTest(name):
                (line,) = lines
                self.assertIn(self.path(name), line)
        self.assertIsNotNone(meshio.gmsh.read(self.path("saved.msh")))  # As it was.
        saved = {"saved." + ending for ending in (*self.found["files"], "h5")}
        saved |= {"mixed_saved." + ending for ending in (*self.found["mixed"], "h5")}
        self.assertEqual(set(os.listdir(self.folder)) - self.before,
                         {*saved, "constant", "found.json", "text.msh", "spread.msh"})


if __name__ == "__main__":
    unittest.main()
