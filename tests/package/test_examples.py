#!/usr/bin/python3
"""find_package(CADRefine): the C++ examples are built against an installation, and run."""

import os
import re
import unittest

import installed
import meshio
import numpy as np
from installed import Installation, loaded_libraries, run

EXAMPLES = os.path.join(installed.ROOT, "docs", "examples", "cxx")


def build(installation, name, *options):
    """Folder of the examples, built with these options of CMake."""
    folder = installation.scratch(name)
    run("cmake", "-S", EXAMPLES, "-B", folder, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={installation.prefix}", *options)
    run("cmake", "--build", folder, "--parallel", "2")
    return folder


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.installation = Installation()
        cls.addClassCleanup(cls.installation.cleanup)

    def test_core_needs_neither_vtk_nor_mpi(self):
        folder = build(self.installation, "geom", "-DWITH_FILTERS=OFF", "-DCMAKE_DISABLE_FIND_PACKAGE_ParaView=ON",
                       "-DCMAKE_DISABLE_FIND_PACKAGE_VTK=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON")
        program = os.path.join(folder, "closest_point")
        libraries = run("ldd", program)
        self.assertIsNone(re.search(r"libvtk|libmpi", libraries), libraries)
        # A point ahead of the leading edge, which is straight along y at x = z = 0.
        output = run(program, self.installation.data("naca0012_sharp.igs"), -1, 0.7, 0)
        self.assertIn("38 faces, 95 edges, 57 vertices, unit m", output)
        x, y, z, distance = map(float, re.search(r"nearest point (\S+) (\S+) (\S+), distance ([^,]+)", output).groups())
        self.assertLess(np.linalg.norm([x, y - 0.7, z]), 1e-6)
        self.assertAlmostEqual(distance, 1, delta=1e-9 * 3.5)

    def test_core_starts_the_installed_program_that_reads(self):
        folder = build(self.installation, "reading", "-DWITH_FILTERS=OFF")
        programs = loaded_libraries(os.path.join(folder, "closest_point"), self.installation.data("cylinder.brep"),
                                    0, 0, 0)
        self.assertEqual([path for path in programs if path.endswith("cadrefine-read-cad")],
                         [os.path.realpath(self.installation.path("lib", "cadrefine", "cadrefine-read-cad"))])

    def test_bad_file_is_one_line(self):
        folder = build(self.installation, "geom", "-DWITH_FILTERS=OFF")
        with self.assertRaisesRegex(AssertionError, r"exit status 1\nclosest_point: /no/such.igs: no such file\n$"):
            run(os.path.join(folder, "closest_point"), "/no/such.igs", 0, 0, 0)

    def test_filters(self):
        folder = build(self.installation, "filters")
        mesh, result = self.installation.data("cylinder_coarse.vtu"), self.installation.scratch("adapted.vtu")
        output = run(os.path.join(folder, "adapt"), mesh, self.installation.data("cylinder.brep"), 2, result)
        self.assertEqual(len(re.findall(r"^\| \d", output, re.MULTILINE)), 3, output)
        adapted = meshio.read(result)
        self.assertGreater(len(adapted.cells_dict["tetra"]), len(meshio.read(mesh).cells_dict["tetra"]))
        on_cad = adapted.point_data["CADDimension"] >= 0
        self.assertGreater(on_cad.sum(), 0)
        self.assertEqual(np.abs(adapted.point_data["CADDistance"][on_cad]).max(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
