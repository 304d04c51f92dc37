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
    "part_coarse.vtu": ["solid_mesh.py", "part"],
    "ball_coarse.vtu": ["solid_mesh.py", "ball"],
    "cylinder_coarse.vtu": ["solid_mesh.py", "cylinder"],
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


def parameters(path):
    """All numbers of the entities of an IGES file."""
    text = "".join(line[:64] for line in lines_of(path) if line[72] == "P")
    return np.array([float(value) for value in text.replace(";", ",").split(",") if value.strip()])


def entity_types(path):
    return [line[:8] for line in lines_of(path) if line[72] == "D"][::2]


class Aeroplane(unittest.TestCase):
    """Its programs may differ in last digits from processor to processor."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def make(self, *arguments):
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, timeout=driver.TIMEOUT)

    def test_program_makes_the_cad(self):
        made, kept = os.path.join(self.folder, "aeroplane.igs"), driver.data("aeroplane.igs")
        self.make(os.environ["CADREFINE_AEROPLANE"], made)
        self.assertEqual(entity_types(made), entity_types(kept))
        self.assertEqual({line[:8].strip(): entity_types(kept).count(line) for line in ("     128", "     144")},
                         {"128": 962, "144": 136})
        self.assertEqual(len(parameters(made)), len(parameters(kept)))
        self.assertTrue(np.allclose(parameters(made), parameters(kept), rtol=0, atol=1e-6))

    def test_programs_make_the_mesh(self):
        solid, made = (os.path.join(self.folder, name) for name in ("aeroplane.brep", "aeroplane.vtu"))
        self.make(os.environ["CADREFINE_AEROPLANE"], "--plain", solid)
        self.make("/usr/bin/python3", "-B", driver.data("aeroplane_mesh.py"), "--boundary-triangles", solid, made)
        made, kept = meshio.read(made), meshio.read(driver.data("aeroplane_coarse.vtu"))
        self.assertAlmostEqual(len(made.points) / len(kept.points), 1, delta=0.02)
        tags = made.cell_data_dict["gmsh:physical"]["triangle"]
        around = made.points[np.unique(made.cells_dict["triangle"][tags == 1])]
        low, high = np.array([[0.05, -0.25, -0.2], [0.2, 0.25, 0.2]])
        nose = ((around >= low) & (around <= high)).all(axis=1).sum()
        self.assertAlmostEqual(nose, 1269, delta=60)
        self.assertTrue(np.allclose(np.abs(around).max(axis=0), [2, 0.95, 0.45], rtol=0, atol=0.01))


if __name__ == "__main__":
    unittest.main()
