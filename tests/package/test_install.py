#!/usr/bin/python3
"""make install: plugin, command and Python package are found in the prefix, and go again."""

import json
import os
import re
import shutil
import tempfile
import unittest

import installed
import meshio
from installed import Installation, files_in, loaded_libraries, only_one, run

TRIANGLE = """$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes
$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n"""
READ = """from paraview import simple
mesh = simple.OpenDataFile({path!r})
mesh.UpdatePipeline()
import cadrefine.files
from cadrefine import vtkMeshReader
print(mesh.GetDataInformation().GetNumberOfCells(), cadrefine.files.__file__)"""
PYTHON_EXAMPLE = os.path.join(installed.ROOT, "docs", "examples", "python", "adapt.py")


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.installation = Installation()
        cls.addClassCleanup(cls.installation.cleanup)
        cls.plugin = os.path.join(cls.installation.plugin_folder(), "CADRefine", "CADRefine.so")

    def case(self):
        return self.installation.data("naca0012_coarse.vtu"), self.installation.data("naca0012_sharp.igs")

    def test_driver_and_paraview_have_links_to_the_one_plugin(self):
        for link in (("share", "cadrefine", "plugin", "CADRefine.so"), ("bin", "plugins", "CADRefine", "CADRefine.so")):
            self.assertEqual(os.path.realpath(self.installation.path(*link)), os.path.realpath(self.plugin))
        self.assertEqual(only_one(os.path.join(installed.BUILD, "**", "CADRefine.so")).count("/lib/cadrefine/"), 1)

    def test_command_runs_the_driver_with_the_installed_plugin(self):
        command = self.installation.path("bin", "cadrefine")
        for ranks, start in ((1, [command]), (2, [command, "-np", "2"]),
                             (1, ["mpirun", "-np", "1", "pvbatch", run(command, "--driver").strip()])):
            report = self.installation.scratch("report.json")
            libraries = loaded_libraries(*start, *self.case(), "--steps", "1", "--report", report)
            self.assertEqual([path for path in libraries if path.endswith("CADRefine.so")],
                             [os.path.realpath(self.plugin)])
            self.assertEqual([path for path in libraries if path.endswith("cadrefine-read-cad")],
                             [os.path.realpath(self.installation.path("lib", "cadrefine", "cadrefine-read-cad"))])
            self.assertEqual([path for path in libraries if "/libQt" in path], [], "only the window needs them")
            with open(report, encoding="utf-8") as file:
                written = json.load(file)
            self.assertEqual(written["ranks"], ranks)
            self.assertGreater(written["steps"][1]["cells"], written["steps"][0]["cells"])

    def test_installation_can_be_moved(self):
        command = self.installation.path("bin", "cadrefine")
        moved = self.installation.scratch("moved")
        shutil.copytree(self.installation.prefix, moved, symlinks=True)
        libraries = loaded_libraries(command.replace(self.installation.prefix, moved), *self.case(), "--steps", "0")
        for name in ("CADRefine.so", "libCADRefineFilters.so", "cadrefine-read-cad"):
            found = [path for path in libraries if path.endswith("/" + name)]
            self.assertEqual([path.startswith(os.path.realpath(moved)) for path in found], [True], found)

    def test_command_tells_where_things_are(self):
        command = self.installation.path("bin", "cadrefine")
        self.assertEqual(run(command, "--plugin").strip(), os.path.realpath(self.plugin))
        self.assertTrue(os.path.samefile(os.path.join(run(command, "--data").strip(), "naca0012_coarse.vtu"),
                                         self.case()[0]))
        help_text = run(command, "--help")
        self.assertIn("cadrefine -np N MESH CAD", help_text)
        self.assertIn("--threshold", help_text)

    def test_paraview_finds_the_plugin_by_folder_and_by_configuration(self):
        script = "from paraview import simple; print('CADReader', hasattr(simple, 'CADReader'))"
        configuration = os.path.join(os.path.dirname(self.plugin), "cadrefine.xml")
        self.assertIn("CADReader False", run("pvpython", "-c", script))
        for variable, value in (("PV_PLUGIN_PATH", self.installation.plugin_folder()),
                                ("PV_PLUGIN_PATH", self.installation.path("bin", "plugins")),
                                ("PV_PLUGIN_CONFIG_FILE", configuration)):
            self.assertIn("CADReader True", run("pvpython", "-c", script, **{variable: value}), (variable, value))

    def test_mesh_files_by_the_package_beside_the_library(self):
        """Also where the package of VTK's classes, which has the same name, is there already."""
        path = self.installation.scratch("one.msh")
        with open(path, "w", encoding="ascii") as file:
            file.write(TRIANGLE)
        for first in ("", "import cadrefine\n"):
            output = run("pvpython", "-c", first + READ.format(path=path),
                         PV_PLUGIN_PATH=self.installation.plugin_folder(), PYTHONPATH=self.installation.python_path())
            cells, place = output.split()[-2:]
            self.assertEqual(cells, "1")
            self.assertTrue(place.startswith(os.path.realpath(self.installation.path("share", "cadrefine"))), output)

    def test_python_example_in_pvpython_and_in_python(self):
        mesh, cad = self.installation.data("cylinder_coarse.vtu"), self.installation.data("cylinder.brep")
        result = self.installation.scratch("adapted.vtu")
        outputs = set()
        for python in ("pvpython", "/usr/bin/python3"):
            outputs.add(run(python, PYTHON_EXAMPLE, mesh, cad, result, PYTHONPATH=self.installation.python_path()))
        self.assertEqual(len(outputs), 1, outputs)
        vertices, cells, error = re.match(r"(\d+) vertices, (\d+) tetrahedra, geometric error (\S+),",
                                          outputs.pop()).groups()
        adapted = meshio.read(result)
        self.assertEqual(len(adapted.points), int(vertices))
        self.assertEqual(len(adapted.cells_dict["tetra"]), int(cells))
        self.assertGreater(int(cells), 2 * len(meshio.read(mesh).cells_dict["tetra"]))
        # 0.184 before; bulk marking cuts, in each of three steps, the cells with half of the error.
        self.assertLess(float(error), 0.065)
        self.assertAlmostEqual(float(error), adapted.cell_data_dict["GeometricError"]["tetra"].sum(), delta=1e-4)

    def test_uninstall_leaves_no_file(self):
        with tempfile.TemporaryDirectory() as folder:
            run("cmake", "--install", installed.BUILD, "--prefix", "/usr/local", DESTDIR=folder)
            before = files_in(folder)
            self.assertIn("usr/local/bin/cadrefine", before)
            other = os.path.join(folder, "usr/local/share/other")
            os.makedirs(os.path.dirname(other), exist_ok=True)
            with open(other, "w", encoding="ascii"):
                pass
            manifest = shutil.copy(os.path.join(installed.BUILD, "install_manifest.txt"),
                                   os.path.join(folder, "manifest"))
            run(os.path.join(installed.ROOT, "plugin", "package", "uninstall"), manifest, DESTDIR=folder)
            self.assertEqual(files_in(folder), ["usr/local/share/other"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
