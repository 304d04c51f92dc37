#!/usr/bin/python3
"""Bad input ends in one line on standard error, exit status 1 on every rank, and no output."""

import os
import shutil
import sys
import unittest

import driver
import meshio

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1

PIECES = """<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0">
<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints><Piece Source="pieces/pieces_0.vtu"/>
</PUnstructuredGrid></VTKFile>
"""
GRID = """# vtk DataFile Version 3.0
bad input
ASCII
DATASET UNSTRUCTURED_GRID
POINTS {points} double
{coordinates}
CELLS {cells}
CELL_TYPES {types}
"""


class Case(driver.Case):
    def setUp(self):
        super().setUp()
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


class BadFiles(Case):
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

    def test_mesh_of_convex_point_sets(self):
        corners = "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1"
        text = GRID.format(points=8, coordinates=corners, cells="1 9\n8 0 1 2 3 4 5 6 7", types="1\n41")
        self.assert_fails(self.file("convex.vtk", text), self.cad, names="convex.vtk: ")

    def test_image(self):
        text = ("# vtk DataFile Version 3.0\nimage\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
                "ORIGIN 0 0 0\nSPACING 1 1 1\n")
        self.assert_fails(self.file("image.vtk", text), self.cad, names="image.vtk: contains a vtkImageData")


class BadOptions(Case):
    """Found before anything is read."""

    def test_values_out_of_range(self):
        """Are told before anything is read: there are no such files."""
        for option, values in (("--recursion-depth", ["9"]), ("--maximum-distance", ["-1"]), ("--threshold", ["nan"]),
                               ("--threshold", ["2", "--marking", "bulk"]), ("--normal-angle", ["-3"]),
                               ("--region", ["0", "1", "1", "0", "0", "1"])):
            with self.subTest(option, values=values):
                self.assert_fails("none.vtu", "none.igs", option, *values, names=option + ": ")

    def assert_refused(self, cases):
        """Each of `cases` is what follows MESH and CAD, or all arguments, and a text of its line. No file changes."""
        before = self.contents()
        arguments = [case if os.path.isfile(case[0]) else [self.mesh, self.cad, *case] for case, _ in cases]
        failures, _ = driver.many(RANKS, self.folder, [{"arguments": case} for case in arguments])
        for (case, text), line in zip(cases, failures):
            with self.subTest(case=case):
                self.assertIn(text, line or "no failure")
                self.assertEqual(len(line.splitlines()), 1)
        self.assertEqual(self.contents(), before)

    def contents(self):
        """Of all files below the folder."""
        found = {}
        for folder, _, names in os.walk(self.folder):
            for path in (os.path.join(folder, name) for name in names):
                with open(path, "rb") as file:
                    found[path] = os.path.islink(path), file.read()
        return found

    def test_numbers_that_are_no_values(self):
        """The line names the option and the range."""
        long = "1" + "0" * 5000
        steps, cells = "a whole number from 0 to 1000000", "a whole number from 0 to 9223372036854775807"
        ranges = {"--steps": (steps, "-1", "10000000000", long, "1.5", "nan", "inf", "1e3", ""),
                  "--uniform-steps": (steps, "-1", "10000000000", "x"),
                  "--maximum-cells": (cells, "-1", "1e6", "9223372036854775808"),
                  "--recursion-depth": ("a whole number from 0 to 8", "9", "-1", "1.5"),
                  "--target-error": ("a finite number of 0 or more", "-1", "nan", "inf", "-1e-3", "1e999"),
                  "--threshold": ("a finite number of 0 or more", "-1e-9", "nan", "inf"),
                  "--chord-tolerance": ("a finite number of 0 or more", "-1", "nan", "inf"),
                  "--normal-angle": ("a finite number from 0 to 180", "-1", "181", "nan", "inf"),
                  "--maximum-distance": ("a finite number of 0 or more", "-1", "-1e5", "nan", "inf", "1e309"),
                  "--indicator-threshold": ("a finite number", "nan", "-inf", "x")}
        cases = [([option, value], f"argument {option}: {value[:40]!r} is not {wanted}")
                 for option, (wanted, *values) in ranges.items() for value in values]
        cases += [(["--region", "0", "1", "0", bad, "0", "1"], f"argument --region: '{bad}' is not a finite number")
                  for bad in ("nan", "-inf", "1e999")]
        cases += [(["--region", "0", "1", "-1e-3", "-2e-3", "0", "1"], "--region: the box is empty"),
                  (["--focus", "0", "1", "0", "1", "0", "1e300"], "argument --focus: '1e300' is not a finite number"),
                  (["--marking", "threshold"], "--marking threshold needs a --threshold"),
                  (["--marking", "off", "--threshold", "1"], "--threshold cannot be combined with --marking off"),
                  (["--view", "0", "0", "nan"], "argument --view: 'nan' is not a finite number")]
        self.assert_refused(cases)

    def test_results_in_place_of_what_is_read(self):
        """By whatever name."""
        os.makedirs(os.path.join(self.folder, "pieces"))
        mesh, cad, piece = (os.path.join(self.folder, name) for name in ("mesh.vtu", "cad.igs", "pieces/pieces_0.vtu"))
        for path, source in ((mesh, self.mesh), (cad, self.cad), (piece, self.mesh)):
            shutil.copy(source, path)
        index = self.file("pieces.pvtu", PIECES)
        report = self.file("old.json", '{"steps": [{"vertices": 1, "global_error": 1}]}')
        for name, target in (("soft.vtu", mesh), ("soft.json", mesh), ("soft.png", cad), ("folder", self.folder)):
            os.symlink(target, os.path.join(self.folder, name))
        os.link(mesh, os.path.join(self.folder, "hard.vtu"))
        os.link(piece, os.path.join(self.folder, "hard_piece.vtu"))
        os.link(report, os.path.join(self.folder, "other.json"))

        def place(name):
            return os.path.join(self.folder, name)

        of_mesh, of_cad = f"would replace {mesh}, which MESH reads", f"would replace {cad}, which CAD reads"
        cases = [([mesh, cad, "--output", path], of_mesh) for path in (
            mesh, os.path.relpath(mesh), place("soft.vtu"), place("hard.vtu"), place("folder/mesh.vtu"),
            place("pieces/../mesh.vtu"))]
        cases += [([mesh, cad, "--report", place("soft.json")], of_mesh),
                  ([mesh, cad, "--plot", place("soft.png")], of_cad),
                  ([index, cad, "--output", index], f"would replace {index}, which MESH reads"),
                  ([index, cad, "--output", place("hard_piece.vtu")], f"would replace {piece}, which MESH reads"),
                  ([piece, cad, "--output", index], f"would replace {piece}, which MESH reads"),
                  ([mesh, cad, "--compare-report", report, "--report", place("other.json")],
                   f"would replace {report}, which --compare-report reads"),
                  ([mesh, cad, "--report", place("new.json"), "--compare-report", report, "--output",
                    place("folder/soft.vtu")], of_mesh),
                  ([mesh, cad, "--plot", place("a.png"), "--screenshot", place("folder/a.png")],
                   "a.png: is given twice, by --plot and --screenshot")]
        self.assert_refused(cases)

    def test_folder_of_output_is_missing(self):
        path = os.path.join(self.folder, "none", "out.vtu")
        self.assert_fails(self.mesh, self.cad, "--output", path, names="out.vtu: there is no folder")


class BadInput(Case):
    def test_options(self):
        self.assert_fails(self.mesh, self.cad, "--steps", "many", names="--steps")
        self.assert_fails(self.mesh, self.cad, "--indicator", "error", names="--indicator-threshold")
        self.assert_fails(self.mesh, self.cad, "--indicator-marking", "bulk", names="--indicator")
        self.assert_fails(self.mesh, self.cad, "--no-such-option", names="--no-such-option")

    def test_coordinates_that_are_too_large(self):
        """Where the ranges that VTK writes with them cannot be read."""
        text = """<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1e300 0 0 0 1 <InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="2">
<Value index="0">0</Value><Value index="1">inf</Value></InformationKey></DataArray></Points><Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"""
        self.assert_fails(self.file("large.vtu", text), self.cad,
                          names="large.vtu: the mesh has a coordinate that is beyond 1.5e51 (point 2); correct it")

    def test_mesh_that_was_not_projected(self):
        self.assert_fails(self.mesh, self.cad, "--projected",
                          names="naca0012_coarse.vtu: the mesh has no point array CADDimension")

    def test_quadratic_poly_data(self):
        mesh, path = meshio.read(driver.data("three_arcs_coarse.vtu")), os.path.join(self.folder, "arcs.ply")
        meshio.write(path, meshio.Mesh(mesh.points, {"triangle": mesh.cells_dict["triangle"].astype("int32")}),
                     binary=False)
        self.assert_fails(path, driver.data("three_arcs.igs"), "--quadratic", names="arcs.ply: poly data cannot hold")

    def test_region_beside_the_mesh(self):
        """What a filter says of its property is said of the option."""
        self.assert_fails(self.mesh, self.cad, "--region", "50", "51", "50", "51", "50", "51",
                          names="the region (--region) contains no boundary vertex")
        self.assert_fails(self.mesh, self.cad, "--region", "0", "0.01", "-1", "2", "-1", "1",
                          names="no boundary facet lies on the CAD with all of its vertices in the region (--region)")

    def test_missing_density(self):
        self.assert_fails(self.mesh, self.cad, "--conserve", "heat",
                          names="naca0012_coarse.vtu: the mesh has no cell array heat (--conserve); its cell arrays: ")

    def test_missing_indicator(self):
        self.assert_fails(self.mesh, self.cad, "--indicator", "velocity", "--indicator-threshold", "1",
                          names="naca0012_coarse.vtu: the mesh has no cell array velocity (--indicator); its cell ")

    def test_screenshot_without_display(self):
        path = os.path.join(self.folder, "picture.png")
        self.assert_fails(self.mesh, self.cad, "--screenshot", path, names="needs a display", without=["DISPLAY"])


if __name__ == "__main__":
    unittest.main()
