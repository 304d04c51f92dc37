#!/usr/bin/python3
"""The files of data/ are what the programs beside them make, and what they say they are."""

import os
import subprocess
import sys
import tempfile
import unittest

import driver
import meshio
import numpy as np

PROGRAMS = {
    "naca0012_sharp.igs": ["naca0012.py"],
    "naca0012_blunt.igs": ["naca0012.py", "--trailing-edge", "blunt"],
    "naca0012_coarse.vtu": ["naca0012_mesh.py"],
    "naca0012_blunt_coarse.vtu": ["naca0012_mesh.py", "--trailing-edge", "blunt"],
    "three_arcs.igs": ["three_arcs.py"],
    "three_arcs_nurbs.igs": ["three_arcs.py", "--nurbs"],
    "three_arcs_coarse.vtu": ["three_arcs.py"],
}


def lines_of(path):
    with open(path, encoding="ascii") as file:
        return file.read().splitlines()


def make(name, path, *options):
    program, *arguments = PROGRAMS[name]
    subprocess.run(["/usr/bin/python3", "-B", driver.data(program), *arguments, *options, path], check=True,
                   stdout=subprocess.DEVNULL, timeout=driver.TIMEOUT)


class Data(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_programs_make_the_files(self):
        for name in PROGRAMS:
            with self.subTest(name):
                path = os.path.join(self.folder, name)
                make(name, path)
                if name.endswith(".igs"):
                    self.assertEqual(lines_of(path), lines_of(driver.data(name)))
                else:  # The mesh generator's last digits are its own business.
                    made, kept = meshio.read(path), meshio.read(driver.data(name))
                    self.assertTrue(np.allclose(made.points, kept.points, rtol=0, atol=1e-9))
                    self.assertTrue((made.cells[0].data == kept.cells[0].data).all())

    def test_iges_records(self):
        for name in PROGRAMS:
            if not name.endswith(".igs"):
                continue
            with self.subTest(name):
                lines = lines_of(driver.data(name))
                self.assertEqual({len(line) for line in lines}, {80})
                sections = "".join(line[72] for line in lines)
                counts = {letter: sections.count(letter) for letter in "SGDP"}
                self.assertEqual(lines[-1][:32], "".join(f"{key}{counts[key]:7d}" for key in "SGDP"))
                self.assertEqual(sections, "".join(key * counts[key] for key in "SGDP") + "T")

    def test_wing_is_38_surfaces_and_their_borders(self):
        for name in ("naca0012_sharp.igs", "naca0012_blunt.igs"):
            kinds = [line[:8].strip() for line in lines_of(driver.data(name)) if line[72] == "D"][::2]
            self.assertEqual((kinds.count("128"), kinds.count("126"), len(kinds)), (38, 95, 133))

    def test_wing_meshes(self):
        sys.path.insert(0, driver.DATA)
        from naca0012 import CHORD, half_thickness
        from vtu import mean_ratio

        for around in (22, 41, 60):
            with self.subTest(around=around):
                path = os.path.join(self.folder, "mesh.vtu")
                make("naca0012_coarse.vtu", path, "--around", str(around), "--boundary-triangles")
                mesh = meshio.read(path)
                self.assertGreater(mean_ratio(mesh.points, mesh.cells_dict["tetra"]).min(), 0.02)
                triangles = mesh.cells_dict["triangle"]
                tags = mesh.cell_data_dict["gmsh:physical"]["triangle"]
                wing = mesh.points[np.unique(triangles[tags == 1])] / CHORD
                self.assertEqual(len(wing), 3 * around)
                inside = wing[(wing[:, 0] > 0.02) & (wing[:, 0] < 0.95)]
                offset = np.abs(inside[:, 2]) - [half_thickness(x) for x in inside[:, 0]]
                self.assertGreater(np.abs(offset).min(), 1e-5)
                self.assertLess(np.abs(offset).max(), 0.01)


if __name__ == "__main__":
    unittest.main()
