#!/usr/bin/python3
"""The Debian packages: what is in them, what they depend on, and that the driver runs from what they unpack. Installing
and removing them for real is done by try_package, on demand."""

import json
import os
import re
import subprocess
import tempfile
import unittest

import installed
from installed import files_in, loaded_libraries, only_one, run


class Debian(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        run(os.path.join(installed.ROOT, "plugin", "package", "debian"), installed.BUILD, cls.folder)
        cls.runtime = only_one(os.path.join(cls.folder, "cadrefine_*.deb"))
        cls.development = only_one(os.path.join(cls.folder, "cadrefine-dev_*.deb"))

    def unpack(self, package):
        folder = os.path.join(self.folder, os.path.basename(package) + ".files")
        run("dpkg-deb", "-x", package, folder)
        return os.path.realpath(folder)

    def dependencies(self, package):
        return re.findall(r"[^ ,]+(?= \(|,|$)", run("dpkg-deb", "-f", package, "Depends").strip())

    def test_dependencies(self):
        runtime = self.dependencies(self.runtime)
        for start in ("paraview", "python3-paraview", "openmpi-bin", "libocct-data-exchange-", "libgmp10"):
            self.assertTrue(any(name.startswith(start) for name in runtime), (start, runtime))
        self.assertFalse([name for name in runtime if name.endswith("-dev")])
        # Of the version of ParaView that is here: the plugin fits no other.
        version = subprocess.check_output(["dpkg-query", "-Wf", "${Version}", "paraview"], text=True)
        minor = ".".join(version.split(".")[:2])
        self.assertIn(f"paraview (>= {minor}", run("dpkg-deb", "-f", self.runtime, "Depends"))
        self.assertIn("paraview (<<", run("dpkg-deb", "-f", self.runtime, "Depends"))
        self.assertIn("cadrefine", self.dependencies(self.development))

    def test_content(self):
        runtime, development = files_in(self.unpack(self.runtime)), files_in(self.unpack(self.development))
        self.assertEqual(set(runtime) & set(development), set())
        for name in ("usr/bin/cadrefine", "usr/share/cadrefine/plugin/cadrefine.py", "usr/lib/libCADRefineFilters.so",
                     "usr/lib/cadrefine/cadrefine-read-cad", "usr/lib/cadrefine/python",
                     "usr/lib/cadrefine/CADRefine/CADRefineWindow/CADRefineWindow.so",
                     "usr/share/doc/cadrefine/copyright"):
            self.assertIn(name, runtime)
        for name in ("usr/include/cadrefine/cad/model/CADModel.h", "usr/lib/cmake/CADRefine/CADRefineConfig.cmake"):
            self.assertIn(name, development)
        self.assertFalse([name for name in runtime if name.endswith((".h", ".a", ".cmake", ".pyc"))])
        self.assertTrue(all(name.startswith("usr/") for name in runtime + development))

    def test_driver_runs_from_what_is_unpacked(self):
        root = self.unpack(self.runtime)
        report = os.path.join(self.folder, "report.json")
        data = os.path.join(root, "usr/share/cadrefine/data")
        libraries = loaded_libraries(
            os.path.join(root, "usr/bin/cadrefine"), "-np", "2", os.path.join(data, "naca0012_coarse.vtu"),
            os.path.join(data, "naca0012_sharp.igs"), "--steps", "1", "--report", report)
        for name in ("CADRefine.so", "libCADRefineFilters.so", "cadrefine-read-cad"):
            self.assertTrue(any(path.startswith(root) and path.endswith(name) for path in libraries), name)
        with open(report, encoding="utf-8") as file:
            self.assertEqual(json.load(file)["ranks"], 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
