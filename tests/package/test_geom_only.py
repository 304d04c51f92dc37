#!/usr/bin/python3
"""CADREFINE_BUILD_PLUGIN=OFF: the core alone is built, installed and found, without ParaView."""

import os
import tempfile
import unittest

import installed
from installed import Installation, files_in, run

USER = """
cmake_minimum_required(VERSION 3.25)
project(User LANGUAGES CXX)
find_package(CADRefine 0.1 REQUIRED COMPONENTS Geom)
if (NOT TARGET CADRefine::Geom)
  message(FATAL_ERROR "CADRefine::Geom is missing")
endif ()
find_package(CADRefine QUIET COMPONENTS Filters)
message("Filters: ${CADRefine_FOUND} ${CADRefine_NOT_FOUND_MESSAGE}")
"""


class GeomOnly(unittest.TestCase):
    def test_core_alone(self):
        same = {name: installed.cache_entry(name) for name in
                ("CMAKE_CXX_COMPILER", "CMAKE_CXX_COMPILER_LAUNCHER", "CMAKE_BUILD_TYPE")}
        if "ccache" not in same["CMAKE_CXX_COMPILER_LAUNCHER"]:
            self.skipTest("without ccache, building the core a second time takes minutes")
        with tempfile.TemporaryDirectory() as folder:
            build, user = os.path.join(folder, "build"), os.path.join(folder, "user")
            # The same files by the same paths as in the build: ccache has what they give.
            includes = os.path.join(installed.BUILD, "include")
            run("cmake", "-S", installed.ROOT, "-B", build, "-G", "Ninja", "-DCADREFINE_BUILD_PLUGIN=OFF",
                "-DCADREFINE_BUILD_TESTS=OFF", "-DCMAKE_DISABLE_FIND_PACKAGE_ParaView=ON",
                f"-DCADREFINE_GEOM_INCLUDE_DIR={includes}", *(f"-D{name}={value}" for name, value in same.items()))
            run("cmake", "--build", build, "--parallel", "2", timeout=550, CCACHE_BASEDIR="")
            installation = Installation(build)
            self.addCleanup(installation.cleanup)
            files = files_in(installation.prefix)
            self.assertIn("lib/libCADRefineError.a", files)
            self.assertIn("lib/cadrefine/cadrefine-read-cad", files)
            self.assertIn("include/cadrefine/cad/model/CADModel.h", files)
            self.assertFalse([file for file in files if "vtk" in file or "plugin" in file or file.endswith(".so")])
            os.mkdir(user)
            with open(os.path.join(user, "CMakeLists.txt"), "w", encoding="ascii") as file:
                file.write(USER)
            output = run("cmake", "-S", user, "-B", os.path.join(user, "build"),
                         f"-DCMAKE_PREFIX_PATH={installation.prefix}")
            self.assertIn("Filters: 0 CADRefine was installed without its filters", output)


if __name__ == "__main__":
    unittest.main(verbosity=2)
