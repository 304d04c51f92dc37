#!/usr/bin/python3
"""Meshes of other programs are read with their tags, and are written so that other programs read them."""

import contextlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest

import driver
import gmsh
import meshes
import meshio
import numpy as np

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
CAD = driver.data("cylinder.brep")
CHILDREN = {"tetra": 8, "triangle": 4, "line": 2}  # Of each cell in a uniform step.
TAGS = {**{f"gmsh{kind}.msh": "gmsh:physical" for kind in ("2text", "2binary", "4text", "4binary")},
        "text.xdmf": "gmsh:physical", "mixed.xdmf": "gmsh:physical", "gmsh.vtk": "CellEntityIds"}
READ_XDMF = """
import json, sys
import dolfin as df
mesh, found = df.Mesh(), {}
with df.XDMFFile(sys.argv[1]) as file:
    file.read(mesh)
    dimension = mesh.topology().dim()
    for name, of in (("gmsh:physical", dimension), ("facet_tags", dimension - 1)):
        tags = df.MeshValueCollection("size_t", mesh, of)
        file.read(tags, name)
        values = list(tags.values().values())
        found[name] = {value: values.count(value) for value in set(values)}
print(json.dumps([mesh.geometry().dim(), dimension, mesh.num_cells(), found]))
"""


def counted(mesh, name):
    """How many cells of each type have each tag: {type: {tag: count}}."""
    found = {}
    for block, values in zip(mesh.cells, mesh.cell_data[name]):
        for tag in np.unique(values):
            of_type = found.setdefault(block.type, {})
            of_type[int(tag)] = of_type.get(int(tag), 0) + int((values == tag).sum())
    return found


def children(counts):
    return {kind: {tag: CHILDREN[kind] * count for tag, count in tags.items()} for kind, tags in counts.items()}


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        meshes.write_gmsh(CAD, cls.folder)
        meshes.write_meshio(cls.folder)
        meshes.write_dolfin(cls.folder)
        meshes.write_dolfinx(cls.folder)
        meshes.write_plane(cls.folder)
        cls.exodus = meshes.write_exodus(cls.folder)
        meshes.write_cgns(cls.folder)
        cls.coarse = meshio.gmsh.read(cls.path("gmsh2text.msh"))
        alone = "--no-boundary-cells"  # With them, .vtu files have names, which meshio cannot read.
        same = ["--operations", "cut-only"]  # Cells can be counted.
        step = ["--steps", "1", "--method", "uniform", *same, alone]
        names = [*TAGS, "all.msh", "gmsh.mesh", "gmsh.inp", "gmsh.su2", "meshio.vol", "dolfin.xdmf",
                 "exodus.ex2"]
        runs = [[cls.path(name), CAD, *step, "--output", cls.path(name + ".vtu")] for name in names]
        runs += [[cls.path("gmsh4binary.msh"), CAD, *step, "--output", cls.path("out" + ending)]
                 for ending in (".msh", ".xdmf")]
        runs += [[cls.path("exodus.ex2"), CAD, *step, "--output", cls.path("exodus.msh")],
                 [cls.path("disc.msh"), cls.path("disc.brep"), *step, "--output", cls.path("disc_out.xdmf")],
                 [cls.path("disc.msh"), cls.path("disc.brep"), *step, "--output", cls.path("disc_out.msh")],
                 [cls.path("all.msh"), CAD, *step, "--output", cls.path("all_out.msh"), "--msh-version", "4.1",
                  "--ascii"]]
        cls.output = cls.make(runs)
        os.makedirs(cls.path("case"))
        pairs = [("gmsh4binary.msh", "back.med"), ("back.med", "back.med.msh"), ("gmsh4binary.msh", "case"),
                 ("case", "case.msh"), ("gmsh.cgns", "cgns.msh"), ("order2.msh", "order2_out.msh"),
                 ("order2.unv", "order2.unv.vtu"), ("order2.unv.vtu", "order1.su2")]
        runs = [[cls.path(mesh), CAD, "--steps", "0", *same, "--output", cls.path(result)] for mesh, result in pairs]
        runs = [run if "case" in run[-1] else [*run, alone] for run in runs]
        runs += [[cls.path("out.xdmf"), CAD, "--steps", "0", "--quadratic", *same, "--output", cls.path("curved.msh"),
                  alone]]
        cls.output += cls.make(runs)

    @classmethod
    def make(cls, runs):
        """What is printed by runs that must succeed."""
        failures, output = driver.many(RANKS, cls.folder, [{"arguments": run} for run in runs])
        assert not any(failures), failures
        return output

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def result(self, name):
        """The mesh as it was refined: checks that it has the right number of tetrahedra, of the right volume."""
        mesh = meshio.read(self.path(name + ".vtu"))
        cells = mesh.cells_dict["tetra"]
        self.assertEqual(len(cells), 8 * len(self.coarse.cells_dict["tetra"]))
        corners = mesh.points[cells]
        volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        self.assertGreater(volumes.min(), 0.0)
        self.assertTrue(5.7 < volumes.sum() < 6.3, volumes.sum())
        return mesh

    def test_tags(self):
        """Every cell of every dimension has the tag of its parent, whatever the file."""
        expected = children(counted(self.coarse, "gmsh:physical"))
        self.assertEqual(set(expected), {"line", "triangle", "tetra"})
        for name, tags in TAGS.items():
            with self.subTest(name):
                self.assertEqual(counted(self.result(name), tags), expected)

    def test_names_of_groups(self):
        for name in ("gmsh2text.msh", "gmsh4binary.msh"):
            data = meshio.read(self.path(name + ".vtu")).field_data
            for group, pair in meshes.GROUPS.items():
                self.assertEqual(np.ravel(data[group]).tolist(), list(pair))

    def test_cells_in_no_group_and_in_two(self):
        """meshio refuses such a file."""
        mesh = self.result("all.msh")
        walls = children(counted(self.coarse, "gmsh:physical"))["triangle"]
        tags = counted(mesh, "gmsh:physical")["triangle"]
        self.assertGreater(tags[0], 0)
        self.assertEqual(tags[meshes.WALL], walls[meshes.WALL])
        self.assertEqual(counted(mesh, "wall")["triangle"][1], walls[meshes.WALL])
        first = counted(mesh, "first wall")["triangle"][1]
        self.assertTrue(0 < first < walls[meshes.WALL])

    def test_cells_in_two_groups_for_gmsh(self):
        with open(self.path("all_out.msh"), encoding="ascii") as file:
            self.assertEqual(file.read(19), "$MeshFormat\n4.1 0 8")
        coarse, fine = self.groups_in_gmsh("all.msh"), self.groups_in_gmsh("all_out.msh")
        self.assertIn((2, 22), coarse)
        factors = {3: 8, 2: 4, 1: 2}
        self.assertEqual(fine, {(dimension, tag): (name, factors[dimension] * count)
                                for (dimension, tag), (name, count) in coarse.items()})

    def test_medit(self):
        tags = children(counted(meshio.medit.read(self.path("gmsh.mesh")), "medit:ref"))
        self.assertEqual(counted(self.result("gmsh.mesh"), "medit:ref"), tags)

    def test_abaqus(self):
        """Sets of elements are cell arrays of 0 and 1, and groups."""
        mesh = self.result("gmsh.inp")
        expected = children(counted(self.coarse, "gmsh:physical"))
        self.assertEqual(counted(mesh, "wall")["triangle"][1], expected["triangle"][meshes.WALL])
        self.assertEqual(counted(mesh, "solid_body")["tetra"], {1: expected["tetra"][meshes.BODY]})
        self.assertEqual(counted(mesh, "rim")["line"][1], expected["line"][meshes.RIM])
        tag, dimension = np.ravel(mesh.field_data["wall"])
        self.assertEqual(dimension, 2)
        self.assertEqual(counted(mesh, "gmsh:physical")["triangle"][tag], expected["triangle"][meshes.WALL])

    def test_others(self):
        with contextlib.redirect_stderr(io.StringIO()):  # It warns that tags have no names.
            tags = counted(meshio.su2.read(self.path("gmsh.su2")), "su2:tag")
        self.assertEqual(counted(self.result("gmsh.su2"), "su2:tag"), children(tags))
        self.result("meshio.vol")

    def test_two_grids_of_dolfin(self):
        """Its triangles are all of the mesh, also inside. Coordinates are read in double precision."""
        mesh = self.result("dolfin.xdmf")
        tags = counted(mesh, "tags")["triangle"]
        self.assertEqual(set(tags), {0, 5})
        self.assertGreater(tags[5], 0)
        fine, coarse = mesh.points[:, 2], self.coarse.points[:, 2]
        self.assertEqual(fine.min(), coarse.min())
        self.assertEqual(fine.max(), coarse.max())

    def read_xdmf(self, name):
        program = os.path.join(driver.ROOT, "plugin")
        sys.path.insert(0, program)
        self.addCleanup(sys.path.remove, program)
        from cadrefine.formats import grid, xdmf

        return grid.from_grid(xdmf.read(self.path(name)))

    def test_tags_and_functions_of_dolfinx(self):
        """Tags of the same cells are in grids of their own, and most elements point to those of the first grid."""
        mesh = self.read_xdmf("dolfinx.xdmf")
        self.assertEqual([(kind, len(corners)) for kind, corners in mesh.blocks], [(5, 16), (10, 48)])
        tags, others = mesh.cell_data["gmsh:physical"], mesh.cell_data["above"]
        heights = [mesh.points[corners, 2].mean(axis=1) for _, corners in mesh.blocks]
        np.testing.assert_array_equal(tags[:16], np.where(heights[0] == 0, 1, 0))
        np.testing.assert_array_equal(others[:16], np.where(heights[0] == 1, 2, 0))
        np.testing.assert_array_equal(tags[16:], np.where(heights[1] < 0.5, 3, 4))
        np.testing.assert_allclose(mesh.point_data["height"].ravel(), mesh.points[:, 2], atol=1e-12)
        np.testing.assert_allclose(mesh.cell_data["volume"].ravel()[16:], 1 / 48)

    def test_triangles_of_dolfin(self):
        """DOLFIN orders the corners by number, so half of them go round the wrong way."""
        mesh = self.read_xdmf("square.xdmf")
        (kind, corners), = mesh.blocks
        self.assertEqual((kind, len(corners)), (5, 18))
        sides = mesh.points[corners[:, 1:], :2] - mesh.points[corners[:, :1], :2]
        np.testing.assert_allclose(np.linalg.det(sides), 1 / 9)

    def test_exodus(self):
        tags = counted(self.result("exodus.ex2"), "ObjectId")
        self.assertEqual(tags["tetra"], {block: 8 * self.exodus[block] for block in (1, 2)})
        self.assertEqual(tags["triangle"], {7: 4 * self.exodus[7]})

    def groups_in_gmsh(self, name):
        """What gmsh finds in a file: {(dimension, tag): (name, number of cells)}."""
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.open(self.path(name))
            return {(dimension, tag): (gmsh.model.getPhysicalName(dimension, tag), sum(
                sum(len(ids) for ids in gmsh.model.mesh.getElements(dimension, entity)[1])
                for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)))
                for dimension, tag in gmsh.model.getPhysicalGroups()}
        finally:
            gmsh.finalize()

    def test_gmsh_reads_the_groups_back(self):
        expected = children(counted(self.coarse, "gmsh:physical"))
        kinds = {3: "tetra", 2: "triangle", 1: "line"}
        groups = {(dimension, tag): (name, expected[kinds[dimension]][tag])
                  for name, (tag, dimension) in meshes.GROUPS.items()}
        self.assertEqual(self.groups_in_gmsh("out.msh"), groups)
        self.assertEqual(set(self.groups_in_gmsh("exodus.msh").values()),
                         {("steel", 8 * self.exodus[1]), ("air", 8 * self.exodus[2]), ("wall", 4 * self.exodus[7])})
        self.assertEqual(self.groups_in_gmsh("disc_out.msh")[1, 4][0], "rim")

    def test_there_and_back(self):
        """Written in the format of a solver, and read again: the same groups. In an OpenFOAM case names have no spaces,
        there are none of edges, and the other facets of the boundary are those of their CAD face."""
        expected = counted(self.coarse, "gmsh:physical")
        kinds = {3: "tetra", 2: "triangle", 1: "line"}
        groups = {name: expected[kinds[dimension]][tag] for name, (tag, dimension) in meshes.GROUPS.items()}
        for name in ("back.med.msh", "cgns.msh"):
            self.assertEqual(dict(self.groups_in_gmsh(name).values()), groups)
        del groups["rim"]
        groups["Face_2"] = self.boundary_facets() - groups["wall"] - groups["ends"]
        groups["solid_body"] = groups.pop("solid body")
        self.assertEqual(dict(self.groups_in_gmsh("case.msh").values()), groups)

    def boundary_facets(self):
        facets = np.sort(self.coarse.cells_dict["tetra"][:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]], axis=2)
        _, counts = np.unique(facets.reshape(-1, 3), axis=0, return_counts=True)
        return int((counts == 1).sum())

    def test_quadratic_cells_for_gmsh(self):
        """meshio and this driver agree on the order of the nodes: the middles of inner edges are where they belong."""
        mesh = meshio.gmsh.read(self.path("curved.msh"))
        cells = mesh.cells_dict["tetra10"]
        middles = mesh.points[cells[:, [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]]].mean(axis=2)
        inside = mesh.point_data["CADDimension"][cells[:, 4:]] < 0
        self.assertGreater(inside.sum(), 100)
        self.assertLess(np.abs(mesh.points[cells[:, 4:]] - middles)[inside].max(), 1e-14)

    def test_second_order(self):
        """Mid nodes of the wall are put on the CAD, but for those that would invert a cell."""
        mesh = meshio.gmsh.read(self.path("order2_out.msh"))
        expected, found = counted(self.coarse, "gmsh:physical"), counted(mesh, "gmsh:physical")
        self.assertEqual(found["tetra10"], expected["tetra"])
        self.assertEqual(found["triangle6"], expected["triangle"])
        self.assertEqual(set(mesh.field_data), set(meshes.GROUPS))
        wall = mesh.cells_dict["triangle6"][mesh.get_cell_data("gmsh:physical", "triangle6") == meshes.WALL]
        on_cad = mesh.point_data["CADDistance"][wall] < 1e-9
        self.assertGreater(on_cad.mean(), 0.9)
        self.assertIn(f"{self.path('order2.msh')}: quadratic cells are read as linear ones, and made quadratic",
                      self.output)

    def test_second_order_of_others(self):
        cells = len(self.coarse.cells_dict["tetra"])
        self.assertEqual(sum(len(block.data) for block in meshio.read(self.path("order2.unv.vtu")).cells
                             if block.type == "tetra10"), cells)
        with contextlib.redirect_stderr(io.StringIO()):
            linear = meshio.su2.read(self.path("order1.su2"))
        self.assertEqual(len(linear.cells_dict["tetra"]), cells)
        self.assertIn("stay linear in", self.output)

    def test_dolfin_reads_what_is_written(self):
        expected = children(counted(self.coarse, "gmsh:physical"))
        for name, space, dimension, kinds in (("out.xdmf", 3, 3, ("tetra", "triangle")),
                                              ("disc_out.xdmf", 2, 2, ("triangle", "line"))):
            read = subprocess.run([sys.executable, "-c", READ_XDMF, self.path(name)], check=True, capture_output=True,
                                  text=True)
            found = json.loads(read.stdout)
            self.assertEqual(found[:2], [space, dimension])
            if dimension == 2:
                expected = children(counted(meshio.gmsh.read(self.path("disc.msh")), "gmsh:physical"))
            self.assertEqual(found[2], sum(expected[kinds[0]].values()))
            for array, kind in zip(("gmsh:physical", "facet_tags"), kinds):
                self.assertEqual({int(tag): count for tag, count in found[3][array].items()}, expected[kind])

    def test_nothing_else_is_written(self):
        left = [name for name in os.listdir(self.folder) if name.endswith(".part")]
        self.assertEqual(left, [])
        self.assertIn(f"Not kept in {self.path('out.msh')}: ", self.output)


if __name__ == "__main__":
    unittest.main()
