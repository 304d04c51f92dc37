#!/usr/bin/python3
"""Bad input ends in one line on standard error, exit status 1 on every rank, and no output."""

import os
import sys
import tempfile
import unittest

import driver
import meshio

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1

GRID = """# vtk DataFile Version 3.0
bad input
ASCII
DATASET UNSTRUCTURED_GRID
POINTS {points} double
{coordinates}
CELLS {cells}
CELL_TYPES {types}
"""


class BadInput(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.mesh = driver.data("naca0012_coarse.vtu")
        self.cad = driver.data("naca0012_sharp.igs")

    def file(self, name, text=""):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        return path

    def assert_fails(self, mesh, cad, *options, names, without=()):
        """`names` is a text of the one error line."""
        results = [os.path.join(self.folder, name) for name in ("out.vtu", "out.json", "out.png")]
        before = sorted(os.listdir(self.folder))
        run = driver.Run(RANKS, mesh, cad, "--output", results[0], "--report", results[1], "--plot", results[2],
                         *options, without=without)
        self.assertEqual(len(run.errors), 1, run.errors)
        self.assertIn(names, run.errors[0])
        self.assertNotIn("Traceback", run.errors[0])
        self.assertEqual(sorted(os.listdir(self.folder)), before, "something was written")
        if RANKS:
            self.assertEqual(run.statuses, [1] * RANKS)
        else:
            self.assertEqual(run.status, 1)

    def test_no_file(self):
        missing = os.path.join(self.folder, "missing")
        self.assert_fails(missing + ".vtu", self.cad, names="missing.vtu: no such file")
        self.assert_fails(self.mesh, missing + ".igs", names="missing.igs: no such file")

    def test_empty_file(self):
        self.assert_fails(self.file("empty.vtu"), self.cad, names="empty.vtu: ")
        self.assert_fails(self.mesh, self.file("empty.igs"), names="empty.igs: ")

    def test_folder(self):
        self.assert_fails(self.mesh, self.folder, names=self.folder + ": ")

    def test_text_that_is_no_cad(self):
        for ending in ("igs", "step", "brep"):
            with self.subTest(ending):
                path = self.file("text." + ending, "This is no CAD.\n" * 10)
                self.assert_fails(self.mesh, path, names=f"text.{ending}: ")
                os.remove(path)

    def test_mesh_where_cad_is_due(self):
        self.assert_fails(self.mesh, self.mesh, names="naca0012_coarse.vtu: ")

    def test_cad_where_mesh_is_due(self):
        self.assert_fails(self.cad, self.cad, names="naca0012_sharp.igs: ")

    def test_text_that_is_no_mesh(self):
        self.assert_fails(self.file("text.vtu", "This is no mesh.\n"), self.cad, names="text.vtu: ")

    def test_truncated_mesh(self):
        with open(self.mesh, encoding="ascii") as file:
            self.assert_fails(self.file("cut.vtu", file.read()[:3000]), self.cad, names="cut.vtu: ")

    def test_mesh_without_cells(self):
        text = GRID.format(points=1, coordinates="0 0 0", cells="0 0", types="0")
        self.assert_fails(self.file("points.vtk", text), self.cad, names="points.vtk: the mesh has no cells")

    def test_mesh_of_hexahedra(self):
        corners = "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1"
        text = GRID.format(points=8, coordinates=corners, cells="1 9\n8 0 1 2 3 4 5 6 7", types="1\n12")
        self.assert_fails(self.file("hexahedra.vtk", text), self.cad, names="hexahedra.vtk: ")

    def test_image(self):
        text = ("# vtk DataFile Version 3.0\nimage\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
                "ORIGIN 0 0 0\nSPACING 1 1 1\n")
        self.assert_fails(self.file("image.vtk", text), self.cad, names="image.vtk: holds a vtkImageData")

    def test_options(self):
        self.assert_fails(self.mesh, self.cad, "--steps", "many", names="--steps")
        self.assert_fails(self.mesh, self.cad, "--indicator", "error", names="--indicator-threshold")
        self.assert_fails(self.mesh, self.cad, "--indicator-marking", "bulk", names="--indicator")
        self.assert_fails(self.mesh, self.cad, "--no-such-option", names="--no-such-option")

    def test_values_out_of_range(self):
        """Are told before anything is read: there are no such files."""
        for option, values in (("--recursion-depth", ["9"]), ("--maximum-distance", ["-1"]), ("--threshold", ["nan"]),
                               ("--threshold", ["2", "--marking", "bulk"]), ("--normal-angle", ["-3"]),
                               ("--region", ["0", "1", "1", "0", "0", "1"])):
            with self.subTest(option, values=values):
                self.assert_fails("none.vtu", "none.igs", option, *values, names=option + ": ")

    def test_mesh_that_was_not_projected(self):
        self.assert_fails(self.mesh, self.cad, "--projected",
                          names="naca0012_coarse.vtu: there is no point array CADDimension")

    def test_quadratic_poly_data(self):
        mesh, path = meshio.read(driver.data("three_arcs_coarse.vtu")), os.path.join(self.folder, "arcs.ply")
        meshio.write(path, meshio.Mesh(mesh.points, {"triangle": mesh.cells_dict["triangle"].astype("int32")}),
                     binary=False)
        self.assert_fails(path, driver.data("three_arcs.igs"), "--quadratic", names="arcs.ply: poly data cannot hold")

    def test_folder_of_output_is_missing(self):
        path = os.path.join(self.folder, "none", "out.vtu")
        self.assert_fails(self.mesh, self.cad, "--output", path, names="out.vtu: there is no folder")

    def test_missing_indicator(self):
        self.assert_fails(self.mesh, self.cad, "--indicator", "velocity", "--indicator-threshold", "1",
                          names="naca0012_coarse.vtu: there is no cell array velocity")

    def test_screenshot_without_display(self):
        path = os.path.join(self.folder, "picture.png")
        self.assert_fails(self.mesh, self.cad, "--screenshot", path, names="needs a display", without=["DISPLAY"])


if __name__ == "__main__":
    unittest.main()
