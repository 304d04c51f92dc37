#!/usr/bin/python3
"""Files that cannot be read or written end in one line that names them, and leave nothing behind."""

import os
import sys
import tempfile
import unittest

import driver
import meshes
import meshio

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
WING = [driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs"), "--quiet"]
HEXAHEDRON = """$MeshFormat\n2.2 0 8\n$EndMeshFormat
$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes
$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements
"""
TETRAHEDRON = """*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, type=C3D4\n1, 1, 2, 3, 4\n"""
# A cube, over whose upper side a pyramid is missing between four tetrahedra.
CAVITY = """*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1
9, 0.5, 0.5, 1.5\n10, 0.5, -1, 1.5\n11, 2, 0.5, 1.5\n12, 0.5, 2, 1.5\n13, -1, 0.5, 1.5
*ELEMENT, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, type=C3D4\n2, 5, 6, 9, 10\n3, 6, 7, 9, 11\n4, 7, 8, 9, 12\n5, 8, 5, 9, 13
"""
OLD = "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n"
PARTS = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PartitionedEntities\n0\n"
NO_NODE = HEXAHEDRON.replace("1 5 2 1 1 1 2 3 4 5 6 7 8", "1 4 2 1 1 1 2 3 9")
LINE3_OF_ORDER_3 = HEXAHEDRON.replace("1 5 2 1 1 1 2 3 4 5 6 7 8", "1 26 2 1 1 1 2 3 4")


class BadFormats(driver.Case):
    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def cases(self):
        """Name of the file, content, and what the line must say."""
        whole = tempfile.TemporaryDirectory()
        self.addCleanup(whole.cleanup)
        meshes.write_gmsh(driver.data("cylinder.brep"), whole.name)
        meshes.write_exodus(whole.name)
        meshes.write_cgns(whole.name)
        mesh = meshio.gmsh.read(os.path.join(whole.name, "gmsh2text.msh"))
        meshio.write(os.path.join(whole.name, "meshio.meshb"), meshio.Mesh(mesh.points, mesh.cells))

        def part(name, size):
            with open(os.path.join(whole.name, name), "rb") as file:
                return file.read()[:size]

        return (
            ("text.msh", "This is no mesh.\n", "ParaView cannot read this as a mesh"),
            ("grid.p3d", "1\n2 2 2\n0 1 0 1\n", "name the files of a PLOT3D mesh in JSON, which this one does not"),
            ("old.msh", OLD, "version 4.0 of the format; save it as version 4.1 or 2.2"),
            ("parts.msh", PARTS, "the mesh is partitioned; save it in one part"),
            ("empty.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "the mesh has no cells"),
            ("no_node.msh", NO_NODE, "a cell or a value belongs to a node or element that is not in the file"),
            ("order.msh", LINE3_OF_ORDER_3, "holds cells of gmsh's type 26"),
            ("cut2.msh", part("gmsh2text.msh", 9000), "the section Elements has no end"),
            ("cut2b.msh", part("gmsh2binary.msh", 9000), "the section Elements is cut short"),
            ("cut4.msh", part("gmsh4text.msh", 9000), "the section Elements has no end"),
            ("cut4b.msh", part("gmsh4binary.msh", 9000), "the section Elements is cut short"),
            ("words.msh", part("gmsh2text.msh", None).replace(b"$Nodes\n", b"$Nodes\nmany "), "malformed: "),
            ("letters.msh", part("gmsh4text.msh", None).replace(b"$EndElements", b"x y\n$EndElements"),
             "the section Elements contains something other than numbers"),
            ("cut.mesh", part("gmsh.mesh", 3000), "meshio cannot read it as medit: "),
            ("cut.inp", TETRAHEDRON[:-4], "holds elements C3D4 of 3 nodes"),
            ("cavity.inp", CAVITY, "no pyramids, but cavities where they should be, between quadrilaterals and "
             "tetrahedra: 1"),
            ("type.inp", TETRAHEDRON.replace("C3D4", "U4"), "holds elements of the type U4"),
            ("cut.meshb", part("meshio.meshb", 1500), "meshio cannot read it as medit: "),
            ("cut.su2", part("gmsh.su2", 3000), "it is cut short"),
            ("cut.unv", part("order2.unv", 9000), "it is cut short: the last dataset has no end"),
            ("cut.bdf", part("order2.bdf", 9000), "the mesh has no cells"),
            ("text.med", "This is no mesh.\n", "malformed: Unable to"),
            ("cut.cgns", part("gmsh.cgns", 9000), "malformed: Unable to"),
            ("lonely.foam", "", "there is no folder constant/polyMesh beside it"),
            ("broken.xdmf", "<Xdmf><Domain>", "malformed: "),
            ("lonely.xdmf", '<Xdmf><Domain><Grid><Topology TopologyType="Triangle"><DataItem Format="HDF">'
             'gone.h5:/cells</DataItem></Topology><Geometry/></Grid></Domain></Xdmf>',
             "its data file gone.h5 does not exist"),
            ("nothing.xdmf", "<Xdmf><Domain/></Xdmf>", "it holds no grid of cells"),
            ("text.ex2", "This is no mesh.\n", "Unable to open"),
            ("cut.ex2", part("exodus.ex2", 500), "Unable to open"),
        )

    def test_reading(self):
        cases = self.cases()
        paths = [self.write(name, content) for name, content, _ in cases]
        before = sorted(os.listdir(self.folder))
        failures, _ = driver.many(RANKS, self.folder, [
            {"arguments": [path, WING[1], "--quiet", "--output", self.path("out.vtu")]} for path in paths])
        for (name, _, reason), path, line in zip(cases, paths, failures):
            with self.subTest(name):
                self.assertIsNotNone(line)
                self.assertIn(path, line)
                self.assertIn(reason, line)
                self.assertEqual(len(line.splitlines()), 1)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_without_meshio(self):
        mesh = self.write("tetrahedron.mesh", "MeshVersionFormatted 2\n")
        (line,), _ = driver.many(RANKS, self.folder, [
            {"arguments": [mesh, WING[1], "--quiet", "--steps", "0"], "without": "meshio"}])
        self.assertEqual(line, f"{mesh}: the Python package meshio is needed for this format (Debian: python3-meshio)")

    def test_writing(self):
        """Whatever fails, the results of the run before stay as they were, and there is nothing beside them."""
        results = {ending: self.path("out" + ending) for ending in (".vtu", ".pvtu", ".msh", ".xdmf", ".foam")}
        steps = [*WING, "--steps", "0", "--output"]
        made, _ = driver.many(RANKS, self.folder, [{"arguments": [*steps, path]} for path in results.values()])
        self.assertEqual(made, [None] * len(results))
        before = self.contents()
        self.assertLessEqual({"out.vtu", "out.pvtu", "out/out_0.vtu", "out.msh", "out.xdmf", "out.h5", "out.foam"},
                             set(before))
        self.assertIn("constant/polyMesh/boundary", before)
        steps[-2] = "1"
        broken = {".vtu": "cadrefine.pieces.write_grid", ".msh": "cadrefine.formats.msh_writing.write",
                  ".xdmf": "cadrefine.formats.xdmf.arrange",
                  ".foam": "cadrefine.formats.openfoam_writing.write_patches"}
        runs = [{"arguments": [*steps, results[ending]], "fails": function} for ending, function in broken.items()]
        late = ["--plot", self.path("plot.png")]
        runs += [{"arguments": [*steps, path, *late], "fails": "cadrefine.plot.plot"} for path in results.values()]
        failures, _ = driver.many(RANKS, self.folder, runs)
        for run, line in zip(runs, failures):
            self.assertIn("No space left on device", line)
            self.assertIn(run["arguments"][-1], line)
        self.assertEqual(self.contents(), before)

    def contents(self):
        """Bytes of all files below the folder."""
        names = [os.path.relpath(os.path.join(folder, name), self.folder)
                 for folder, _, found in os.walk(self.folder) for name in found]
        return {name: self.read(name) for name in names}


if __name__ == "__main__":
    unittest.main()
