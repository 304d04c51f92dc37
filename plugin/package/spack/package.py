# Recipe for Spack, which builds the folder that it is told (see docs/install.md): for a release, `git` and `version`
# want its address.
from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Cadrefine(CMakePackage):
    """ParaView plugin that makes finite element meshes follow their CAD geometry."""

    license("BSD-3-Clause")

    version("0.1.0")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")

    # The versions of Debian 12 and 13.
    depends_on("paraview@5.11:5.13+python+mpi+qt+shared+development_files")
    depends_on("opencascade@7.6:7.8+data_exchange")
    depends_on("trilinos+zoltan+mpi")
    depends_on("mpi")
    depends_on("cgal", type="build")
    depends_on("gmp")
    depends_on("xxhash", type="build")
    depends_on("py-numpy", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-meshio", type="run")

    extends("python")
    generator("ninja")

    def cmake_args(self):
        return [self.define("CADREFINE_BUILD_PLUGIN", True), self.define("CADREFINE_WARNINGS_AS_ERRORS", False)]

    def setup_run_environment(self, env):
        env.prepend_path("PV_PLUGIN_PATH", self.prefix.lib.cadrefine)
