#!/usr/bin/python3
"""CGNS files come in with the names of boundaries, families and zones as groups; without ParaView."""

import os
import shutil
import sys
import tempfile
import unittest

import driver
import h5py
import numpy as np

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

import cgns_files
import meshes
from cadrefine.formats import BadFile, cgns, grid, msh
from cadrefine.formats.groups import grouped, members
from cadrefine.formats.sides import once

ZONE = cgns_files.ZONE
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
CELL, SIDES = np.array([[0, 1, 2, 3]]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


class CGNS(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        meshes.write_boxes(cls.path("boxes.msh"))
        cls.mesh = msh.read(cls.path("boxes.msh"))
        cls.expected = meshes.counts(grouped(cls.mesh))

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def test_as_gmsh(self):
        """A facet that is in two groups comes in both."""
        cgns_files.write_as_gmsh(self.path("gmsh.cgns"), self.mesh)
        mesh = once(cgns.read(self.path("gmsh.cgns")))
        self.assertEqual(meshes.counts(grouped(mesh)), self.expected)
        self.assertIn(("low", 2), self.expected)
        np.testing.assert_array_equal(mesh.points, self.mesh.points)
        cells = np.concatenate([corners for kind, corners in mesh.blocks if kind == 10])
        np.testing.assert_array_equal(cells, self.mesh.blocks[-1][1])

    def test_gmsh_itself(self):
        """Where it was built with the CGNS library; Debian's is not."""
        if "Cgns" not in meshes.build_options():
            self.skipTest("this gmsh does not write CGNS")
        meshes.write_boxes(self.path("itself.cgns"))
        found = meshes.counts(grouped(once(cgns.read(self.path("itself.cgns")))))
        self.assertLessEqual(self.expected.items(), found.items())

    def write_zones(self, path):
        """The two boxes, each with its own points and a mixed section, its wall in a condition on elements."""
        tags, dimensions = self.mesh.cell_data[grid.PHYSICAL], self.mesh.cell_dimensions()
        wall = self.mesh.blocks[-2][1][members(self.mesh, "wall")[dimensions == 2]]
        with cgns_files.Library(path) as file:
            for name, tag in (("lower", 1), ("upper", 2)):
                cells = self.mesh.blocks[-1][1][tags[dimensions == 3] == tag]
                nodes = np.unique(cells)
                facets = wall[np.isin(wall, nodes).all(axis=1)]
                file.add_zone(name, self.mesh.points[nodes], len(cells))
                file.add_mixed("all", [(5, np.searchsorted(nodes, facets)), (10, np.searchsorted(nodes, cells))])
                file.add_condition(f"{name} wall", "FaceCenter", "PointList", 1 + np.arange(len(facets)), "wall")
                x, y, z = self.mesh.points[nodes].T
                file.add_solution("nodes", "Vertex", {"VelocityX": x, "VelocityY": y, "VelocityZ": z, "Height": z})
                file.add_solution("cells", "CellCenter", {"Middle": self.mesh.points[cells, 2].mean(axis=1)})
                if name == "lower":
                    file.add_zone_family("solid")
            file.add_family("wall", [])
            file.add_family("solid", [])

    def test_zones_and_families(self):
        self.write_zones(self.path("zones.cgns"))
        mesh = once(cgns.read(self.path("zones.cgns")))
        found = meshes.counts(grouped(mesh))
        wall = self.expected["wall", 2]
        self.assertEqual(found, {("wall", 2): wall, ("lower wall", 2): wall // 2, ("upper wall", 2): wall // 2,
                                 ("solid", 3): self.expected["steel", 3], ("upper", 3): self.expected["air", 3]})
        self.assertEqual(mesh.groups["wall"][0], mesh.cell_data[grid.PHYSICAL][mesh.cell_dimensions() == 2].max())
        np.testing.assert_array_equal(np.unique(mesh.points, axis=0), np.unique(self.mesh.points, axis=0))

    def test_solutions(self):
        """Of nodes and of cells, over all zones; components are one array."""
        self.write_zones(self.path("solved.cgns"))
        mesh = cgns.read(self.path("solved.cgns"))
        np.testing.assert_array_equal(mesh.point_data["Velocity"], mesh.points)
        np.testing.assert_array_equal(mesh.point_data["Height"], mesh.points[:, 2])
        middles = np.concatenate([mesh.points[corners, 2].mean(axis=1) for _, corners in mesh.blocks])
        volumes = mesh.cell_dimensions() == 3
        np.testing.assert_allclose(mesh.cell_data["Middle"], np.where(volumes, middles, 0))
        self.assertEqual(set(mesh.point_data), {"Velocity", "Height"})

    def test_names_of_sections(self):
        """As SU2 has them; those that conditions have elements of are none."""
        sections = [("Volume", 10, CELL), ("floor", 5, SIDES[:1]), ("others", 5, SIDES[1:])]
        cgns_files.write_by_hand(self.path("sections.cgns"), TETRAHEDRON, sections)
        mesh = cgns.read(self.path("sections.cgns"))
        self.assertEqual(meshes.counts(grouped(mesh)), {("floor", 2): 1, ("others", 2): 3})
        cgns_files.write_by_hand(self.path("listed.cgns"), TETRAHEDRON, sections, [("left", "FaceCenter", [3, 5])])
        mesh = cgns.read(self.path("listed.cgns"))
        self.assertEqual(meshes.counts(grouped(mesh)), {("floor", 2): 1, ("left", 2): 2})

    def test_conditions_on_nodes(self):
        """They have the facets between their nodes, whether these are in the file or not."""
        conditions = [("floor", None, [1, 2, 3]), ("edge", "Vertex", [1, 2])]
        for facets in ([], [("all", 5, SIDES)]):
            path = self.path("nodes.cgns")
            cgns_files.write_by_hand(path, TETRAHEDRON, [("Volume", 10, CELL), *facets], conditions)
            mesh = cgns.read(path)
            self.assertEqual(meshes.counts(grouped(mesh)), {("floor", 2): 1})
            self.assertEqual((mesh.cell_dimensions() == 2).sum(), 4)
            facets = np.concatenate([corners for kind, corners in mesh.blocks if kind == 5])
            self.assertEqual(set(facets[members(mesh, "floor")[mesh.cell_dimensions() == 2]].ravel()), {0, 1, 2})

    def test_a_name_of_cells_and_of_facets(self):
        cgns_files.write_by_hand(self.path("same.cgns"), TETRAHEDRON, [("Volume", 10, CELL), ("all", 5, SIDES)],
                                 [("body", "CellCenter", [1, 2, 3])])
        mesh = cgns.read(self.path("same.cgns"))
        self.assertEqual(meshes.counts(grouped(mesh)), {("body", 3): 1, ("body of dimension 2", 2): 2})

    def test_in_the_plane(self):
        cgns_files.write_by_hand(self.path("plane.cgns"), TETRAHEDRON[:3, :2],
                                 [("Elements", 5, SIDES[:1]), ("rim", 3, np.array([[0, 1], [1, 2]]))])
        mesh = cgns.read(self.path("plane.cgns"))
        self.assertEqual(meshes.counts(grouped(mesh)), {("rim", 1): 2})
        np.testing.assert_array_equal(mesh.points, TETRAHEDRON[:3])

    def test_links(self):
        """The coordinates may be in another file."""
        cgns_files.write_by_hand(self.path("whole.cgns"), TETRAHEDRON, [("Volume", 10, CELL)])
        shutil.copy(self.path("whole.cgns"), self.path("linked.cgns"))
        with h5py.File(self.path("linked.cgns"), "a") as file:
            del file[f"{ZONE}/GridCoordinates"]
            node = cgns_files.add_node(file[ZONE], "GridCoordinates", "")
            node.attrs["type"] = np.bytes_("LK")
            node[" link"] = h5py.ExternalLink("whole.cgns", f"/{ZONE}/GridCoordinates")
        np.testing.assert_array_equal(cgns.read(self.path("linked.cgns")).points, TETRAHEDRON)
        os.remove(self.path("whole.cgns"))
        with self.assertRaisesRegex(BadFile, "^GridCoordinates is a link to a place or a file that does not"):
            cgns.read(self.path("linked.cgns"))

    def test_bad_files(self):
        def replaced(path, data):
            def change(file):
                del file[f"{ZONE}/{path}/ data"]
                file[f"{ZONE}/{path}/ data"] = np.frombuffer(data.encode(), np.int8) if isinstance(data, str) else data
            return change

        def removed(path):
            return lambda file: file.pop(path)

        cases = [
            (removed("Base"), "it holds no base"),
            (lambda file: file.copy("Base", "Second"), r"it holds 2 bases \(Base, Second\); save one alone"),
            (removed(ZONE), "the mesh has no cells"),
            (lambda file: file[ZONE].create_dataset("Numbers", data=[1]), "Numbers is not a node"),
            (lambda file: file[ZONE].update(gone=h5py.SoftLink("/Base/nowhere")), "malformed: .*"),
            (removed(f"{ZONE}/ZoneType"), "Zone has no ZoneType"),
            (removed(f"{ZONE}/GridCoordinates"), "the zone Zone has no nodes"),
            (removed(f"{ZONE}/GridCoordinates/CoordinateX"), "GridCoordinates has no CoordinateX"),
            (removed(f"{ZONE}/Volume/ElementConnectivity/ data"), "ElementConnectivity is empty"),
            (removed(f"{ZONE}/ZoneBC/wall/PointList"), "wall has no PointList"),
            (replaced("ZoneType", "Structured"), "the zone Zone is structured; save it as an unstructured one"),
            (replaced("Volume", np.int32([22, 0])), "Volume holds elements of CGNS's type NGON_n"),
            (replaced("Volume", np.int32([34, 0])), "Volume holds elements of CGNS's type 34"),
            (replaced("Volume", np.int32([20, 0])), "Volume holds elements of CGNS's type 1"),
            (replaced("Volume/ElementRange", np.int32([1, 2])), "Volume does not hold the elements 1 to 2"),
            (replaced("Volume/ElementRange", np.int32([1])), "malformed: .*"),
            (replaced("Volume/ElementConnectivity", np.int32([1, 2, 3])), "Volume does not hold the elements 1 to 1"),
            (replaced("Volume/ElementConnectivity", np.int32([1, 2, 3, 5])),
             "an element of Volume has a node that is not in the file"),
            (replaced("Volume/ElementConnectivity", np.int32([1, 2, 3, 0])),
             "an element of Volume has a node that is not in the file"),
            (replaced("GridCoordinates/CoordinateY", np.zeros(3)), "malformed: .*"),
            (replaced("ZoneBC/wall/PointList", np.int32([9])),
             "the boundary condition wall lists nodes or elements that are not in the file"),
        ]
        cgns_files.write_by_hand(self.path("good.cgns"), TETRAHEDRON, [("Volume", 10, CELL), ("facets", 5, SIDES)],
                                 [("wall", "FaceCenter", [2, 3])])
        self.assertEqual(meshes.counts(grouped(cgns.read(self.path("good.cgns")))), {("wall", 2): 2})
        for number, (change, reason) in enumerate(cases):
            path = shutil.copy(self.path("good.cgns"), self.path(f"bad{number}.cgns"))
            with h5py.File(path, "a") as file:
                change(file)
            with self.subTest(reason), self.assertRaisesRegex(BadFile, f"^{reason}$"):
                cgns.read(path)

    def test_wrong_number_of_values(self):
        cgns_files.write_by_hand(self.path("values.cgns"), TETRAHEDRON, [("Volume", 10, CELL)])
        with h5py.File(self.path("values.cgns"), "a") as file:
            solution = cgns_files.add_node(file[ZONE], "Solution", "FlowSolution_t")
            cgns_files.add_node(solution, "Pressure", "DataArray_t", np.zeros(3))
        with self.assertRaisesRegex(BadFile, "^Pressure has 3 values in Zone, but needs 4$"):
            cgns.read(self.path("values.cgns"))

    def test_cut_anywhere(self):
        """Each cut of a file is read, or is a BadFile."""
        cgns_files.write_as_gmsh(self.path("whole.cgns"), self.mesh)
        with open(self.path("whole.cgns"), "rb") as file:
            content = file.read()
        for size in np.linspace(8, len(content) - 1, 40, dtype=int):
            with open(self.path("cut.cgns"), "wb") as file:
                file.write(content[:size])
            with self.subTest(size), self.assertRaisesRegex(BadFile, "^malformed: "):
                cgns.read(self.path("cut.cgns"))


if __name__ == "__main__":
    unittest.main()
