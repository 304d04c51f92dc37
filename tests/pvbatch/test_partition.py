#!/usr/bin/python3
"""The result does not depend on the number of ranks: same cells, same coordinates to the last bit."""

import os
import subprocess
import sys
import tempfile
import unittest

import driver
import meshio

CRANK_ARM = "/usr/share/opencascade/data/occ/CrankArm.brep"  # Of the package occt-misc.
MESHER = """
import sys, gmsh
gmsh.initialize(["gmsh", "-v", "0"])
gmsh.model.occ.importShapes(sys.argv[1])
gmsh.model.occ.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMin", float(sys.argv[2]))
gmsh.option.setNumber("Mesh.MeshSizeMax", float(sys.argv[2]))
gmsh.model.mesh.generate(3)
gmsh.write(sys.argv[3])
"""
COUNTED = ("vertices", "cells", "cad_vertices", "projected_points", "global_error", "maximum_distance",
           "invalid_cells", "unprojected_vertices", "minimum_quality")


class Partition(unittest.TestCase):
    def result(self, ranks, arguments, steps=3):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "out.vtu")
            report = driver.report_of(ranks, *arguments, "--uniform-steps", "1", "--steps", steps,
                                      "--output", path)
            mesh = meshio.read(path)
        arrays = {**mesh.point_data, **{name: values[0] for name, values in mesh.cell_data.items()}}
        return mesh.points, mesh.cells[0].data, arrays, [[s[key] for key in COUNTED] for s in report["steps"]]

    def test_wing(self):
        self.compare((driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs"), "--threshold", "1e-6"))

    def test_blunt_wing(self):
        self.compare((driver.data("naca0012_blunt_coarse.vtu"), driver.data("naca0012_blunt.igs"), "--threshold", "1e-6"))

    def test_arcs(self):
        self.compare((driver.data("three_arcs_coarse.vtu"), driver.data("three_arcs.igs"), "--threshold", "1e-4"))

    def compare(self, arguments, several=(2, 3, 4), steps=3):
        """A run on one rank and on several; the counted numbers of its steps."""
        points, cells, arrays, counted = self.result(1, arguments, steps)
        for ranks in several:
            with self.subTest(ranks=ranks):
                other_points, other_cells, other_arrays, other_counted = self.result(ranks, arguments, steps)
                self.assertEqual(counted, other_counted)
                self.assertEqual(points.tobytes(), other_points.tobytes())
                self.assertEqual(cells.tolist(), other_cells.tolist())
                self.assertEqual(set(arrays), set(other_arrays))
                for array, values in arrays.items():
                    if array not in ("vtkProcessId", "vtkGhostType"):
                        self.assertEqual(values.tobytes(), other_arrays[array].tobytes(), array)
        return counted

    def test_operations(self):
        """A part meshed so coarsely that vertices do not reach it by moving alone."""
        with tempfile.TemporaryDirectory() as folder:
            mesh = os.path.join(folder, "coarse.msh")
            subprocess.run([sys.executable, "-c", MESHER, CRANK_ARM, "17.48", mesh], check=True)
            with_operations = self.compare((mesh, CRANK_ARM), (2, 3), steps=2)
            _, _, _, cut_only = self.result(1, (mesh, CRANK_ARM, "--operations", "cut-only"), steps=2)
        off, quality = COUNTED.index("unprojected_vertices"), COUNTED.index("minimum_quality")
        self.assertEqual([step[off] for step in with_operations], [0] * len(with_operations))
        self.assertGreater(max(step[off] for step in cut_only), 0)
        self.assertGreater(with_operations[-1][quality], 1.5 * cut_only[-1][quality])


if __name__ == "__main__":
    unittest.main()
