#!/usr/bin/python3
"""Groups of cells, of the input and of the CAD's faces, are kept by what writes and reads files; without ParaView."""

import dataclasses
import os
import sys
import tempfile
import unittest

import driver
import gmsh
import meshes
import meshio
import numpy as np

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

from cadrefine import pieces
from cadrefine.formats import BadFile, abaqus, cgns, cgns_writing, exodus, exodus_writing, grid, med, msh, msh_writing
from cadrefine.formats import nastran, openfoam, openfoam_writing, su2, unv, unv_writing, xdmf
from cadrefine.formats.groups import grouped
from cadrefine.formats.sides import once, sides_of
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

EDGES = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]  # Of a tetrahedron, those of a triangle first.
NAMED = {2: "nose", 3: "nose", 4: "wall"}  # Faces of the boxes' CAD: two of the same name, and one of a group's.

NAMED_PROPERTY = """\
$HMNAME PROP                   3"blade"
BEGIN BULK
GRID           1              0.      0.      0.
GRID           2           1.5-1      0.      0.
GRID           3              0.      1.      0.
GRID           4              0.      0.    1.+0
CTETRA         9       3       1       2       3       4
ENDDATA
"""


def write_with_gmsh(source, paths, order):
    """Those of Nastran with long fields (.bdf) or free ones."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(source)
        gmsh.model.mesh.setOrder(order)
        gmsh.option.setNumber("Mesh.SaveElementTagType", 2)
        for path in paths:
            gmsh.option.setNumber("Mesh.BdfFieldFormat", 2 if path.endswith(".bdf") else 0)
            gmsh.write(path)
    finally:
        gmsh.finalize()


def on_cad(mesh):
    """The mesh as the filters leave it: facets beside the cells, with the faces of the CAD that they are part of."""
    dimensions = mesh.cell_dimensions()
    first, blocks, kept = 0, [], []
    for kind, corners in mesh.blocks:
        if grid.TYPES[kind][1] >= 2:
            blocks.append((kind, corners))
            kept.append(np.arange(first, first + len(corners)))
        first += len(corners)
    kept = np.concatenate(kept)
    facets = dimensions[kept] == 2
    data = {name: values[kept] for name, values in mesh.cell_data.items()}
    data["CADDimension"] = np.where(facets, 2, -1).astype(np.int8)
    data["CADEntity"] = np.where(facets, data[grid.GEOMETRICAL] - 1, -1).astype(np.int32)
    result = grid.to_grid(grid.Mesh(mesh.points, blocks, {}, data, mesh.groups))
    names = vtkStringArray()
    names.SetName("CADName")
    for entity in data["CADEntity"]:
        names.InsertNextValue(NAMED.get(int(entity), ""))
    result.GetCellData().AddArray(names)
    return grid.from_grid(result)


def groups_in_gmsh(path):
    """What gmsh finds in a file: {(name, dimension): number of cells}."""
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        return {(gmsh.model.getPhysicalName(dimension, tag), dimension): sum(
            sum(len(ids) for ids in gmsh.model.mesh.getElements(dimension, entity)[1])
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag))
            for dimension, tag in gmsh.model.getPhysicalGroups()}
    finally:
        gmsh.finalize()


class Groups(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        meshes.write_boxes(cls.path("boxes.msh"))
        cls.plain = msh.read(cls.path("boxes.msh"))
        cls.mesh = on_cad(cls.plain)
        cls.expected = meshes.counts(grouped(cls.mesh))

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def test_groups_of_cad_faces(self):
        """Each facet is in a group: its own, or that of its face."""
        mesh = grouped(self.mesh)
        names = {name for name, dimension in self.expected if dimension == 2}
        self.assertLessEqual({"wall", "contact", "low"}, names)
        for name, entity in (("nose Face 2", 2), ("wall Face 4", 4), ("Face 1", 1)):
            of_face = (self.mesh.cell_data["CADEntity"] == entity) & (self.mesh.cell_data[grid.PHYSICAL] == 0)
            self.assertGreater(of_face.sum(), 0)
            self.assertEqual(self.expected[name, 2], of_face.sum())
        self.assertTrue((mesh.cell_data[grid.PHYSICAL] > 0).all())
        self.assertEqual(self.expected["steel", 3] + self.expected["air", 3], len(mesh.blocks[-1][1]))
        tags = [tag for tag, _ in mesh.groups.values()]
        self.assertEqual(len(set(tags)), len(tags))

    def test_sides(self):
        """Of the tetrahedra: two facets a box side, each once; normals outwards."""
        sides = sides_of(self.mesh)
        outside = sides.neighbours < 0
        corners = self.mesh.points[sides.corners[:, :3]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        self.assertAlmostEqual(np.linalg.norm(normals[outside], axis=1).sum(), 10)
        self.assertAlmostEqual((normals[outside] * corners[outside].mean(axis=1)).sum() / 3, 2)
        self.assertTrue((sides.facets[outside] >= 0).all())
        self.assertEqual((sides.facets >= 0).sum(), (self.mesh.cell_dimensions() == 2).sum())

    def test_gmsh(self):
        """gmsh takes a cell of several groups for several cells in version 2.2, also in files of its own."""
        alone = dataclasses.replace(self.mesh, cell_data={
            name: values for name, values in self.mesh.cell_data.items() if name not in self.mesh.groups})
        for version, ascii in (("2.2", False), ("2.2", True), ("4.1", False), ("4.1", True)):
            path = self.path(f"out{version}{ascii}.msh")
            msh_writing.write(path, self.mesh, version, ascii)
            with self.subTest(path):
                if version == "4.1":
                    self.assertEqual(groups_in_gmsh(path), self.expected)
                back = msh.read(path)
                self.assertEqual(meshes.counts(grouped(back)), self.expected)
                np.testing.assert_array_equal(np.sort(back.points, axis=0), np.sort(self.mesh.points, axis=0))
                msh_writing.write(path, alone, version, ascii)
                self.assertEqual(groups_in_gmsh(path), meshes.counts(grouped(alone)))

    def facets(self):
        """{name: number of facets} of the groups on the boundary, each facet in one."""
        mesh = grouped(self.mesh)
        tags = mesh.cell_data[grid.PHYSICAL]
        counts = {name: int(((tags == tag) & (mesh.cell_dimensions() == dimension)).sum())
                  for name, (tag, dimension) in mesh.groups.items() if dimension == 2}
        return {name: count for name, count in counts.items() if count}

    def test_su2(self):
        su2.write(self.path("boxes.su2"), self.mesh)
        back = su2.read(self.path("boxes.su2"))
        expected = {(name.replace(" ", "_"), 2): count for name, count in self.facets().items() if name != "contact"}
        self.assertEqual(meshes.counts(grouped(back)), expected)
        np.testing.assert_array_equal(back.points, self.mesh.points)
        with self.assertRaisesRegex(BadFile, "SU2 has no meshes of surfaces in space"):
            su2.write(self.path("surface.su2"), grid.Mesh(np.eye(3), [(5, np.array([[0, 1, 2]]))]))

    def test_facets_in_no_group(self):
        """Also those that are no cells of the mesh are in a marker."""
        alone = grid.Mesh(self.mesh.points, [(1, np.array([[0]])), (3, np.array([[0, 1]])), *self.mesh.blocks[-1:]])
        su2.write(self.path("alone.su2"), alone)
        self.assertEqual(meshes.counts(grouped(su2.read(self.path("alone.su2")))), {("boundary", 2): 10 * 14})

    def test_abaqus(self):
        """Facets are sides of elements: in the file each is in all of its groups, and comes back once."""
        abaqus.write(self.path("boxes.inp"), self.mesh)
        back = once(abaqus.read(self.path("boxes.inp")))
        expected = {(name.replace(" ", "_"), dimension): count for (name, dimension), count in self.expected.items()}
        self.assertEqual(meshes.counts(grouped(back)), expected)
        np.testing.assert_array_equal(back.points, self.mesh.points)
        solids = meshio.abaqus.read(self.path("boxes.inp"))
        self.assertEqual(sum(len(cells) for cells in solids.cell_sets["steel"]), self.expected["steel", 3])
        self.assertEqual(set(solids.point_sets), {name for name, dimension in expected if dimension == 2})

    def test_files_of_gmsh(self):
        """Of first and of second order. Nastran's have numbers of properties for names, one for each cell."""
        named = meshes.counts(self.plain)
        wall, contact, steel, air = (named[pair] for pair in (("wall", 2), ("contact", 2), ("steel", 3), ("air", 3)))
        for order in (1, 2):
            write_with_gmsh(self.path("boxes.msh"), [self.path(f"gmsh{order}{ending}") for ending in
                                                     (".unv", ".inp", ".bdf", ".nas")], order)
            for ending, reader in ((".unv", unv), (".inp", abaqus)):
                found = meshes.counts(reader.read(self.path(f"gmsh{order}{ending}")))
                self.assertEqual({name: count for name, count in found.items() if name in named}, named)
            for ending in (".bdf", ".nas"):  # With long fields, and free ones.
                mesh = nastran.read(self.path(f"gmsh{order}{ending}"))
                tags, dimensions = mesh.cell_data["nastran:ref"], mesh.cell_dimensions()
                found = {(int(tag), dimension): int(((tags == tag) & (dimensions == dimension)).sum())
                         for dimension in (2, 3) for tag in np.unique(tags[dimensions == dimension])}
                self.assertEqual(found, {(1, 3): steel, (2, 3): air, (5, 2): wall, (6, 2): contact})
                for kind, corners in mesh.blocks if order == 2 else ():
                    edges = EDGES[:corners.shape[1] - {24: 4, 22: 3}[kind]]
                    middles = mesh.points[corners[:, edges]].mean(axis=2)
                    self.assertLess(np.abs(middles - mesh.points[corners[:, -len(edges):]]).max(), 1e-5)

    def test_names_in_nastran(self):
        """As HyperMesh and its like leave them; fields of 8 columns, numbers without an exponent."""
        with open(self.path("named.nas"), "w", encoding="ascii") as file:
            file.write(NAMED_PROPERTY)
        mesh = nastran.read(self.path("named.nas"))
        self.assertEqual(mesh.groups, {"blade": (3, 3)})
        self.assertEqual(mesh.points.max(axis=0).tolist(), [0.15, 1, 1])

    def test_med(self):
        med.write(self.path("boxes.med"), self.mesh)
        back = med.read(self.path("boxes.med"))
        self.assertEqual(meshes.counts(grouped(back)), self.expected)
        np.testing.assert_array_equal(back.points, self.mesh.points)
        self.assertEqual(len(back.blocks), len(self.mesh.blocks))
        for (kind, corners), (_, expected) in zip(sorted(back.blocks, key=lambda block: block[0]), self.mesh.blocks):
            np.testing.assert_array_equal(corners, expected, str(kind))

    def test_exodus(self):
        """A facet of two groups is in two side sets."""
        exodus_writing.write(self.path("boxes.exo"), self.mesh)
        grid_read = exodus.read(self.path("boxes.exo"))
        back = grid.from_grid(grid_read)
        self.assertEqual({name: pair[1] for name, pair in back.groups.items()},
                         {name: dimension for name, dimension in self.expected})
        for name, (tag, dimension) in back.groups.items():
            inside = (back.cell_data["ObjectId"] == tag) & (back.cell_dimensions() == dimension)
            self.assertEqual(inside.sum(), self.expected[name, dimension], name)
        np.testing.assert_array_equal(np.unique(back.points, axis=0), np.unique(self.mesh.points, axis=0))

    def test_second_order_in_the_plane(self):
        """Triangles and their edges, whose third node is no corner."""
        points = np.array([(x, y, 0) for y in (0, 0.5, 1) for x in (0, 0.5, 1)], float)
        mesh = grid.Mesh(points, [(21, np.array([[0, 2, 1]])), (22, np.array([[0, 2, 6, 1, 4, 3], [2, 8, 6, 5, 7, 4]]))],
                         {}, {grid.PHYSICAL: np.array([1, 2, 2], np.int32)}, {"wall": (1, 1), "air": (2, 2)})
        for module, reader, ending in ((xdmf, xdmf, ".xdmf"), (exodus_writing, exodus, ".exo"), (unv_writing, unv, ".unv"),
                                       (med, med, ".med"), (cgns_writing, cgns, ".cgns")):
            module.write(self.path("order2" + ending), mesh)
            back = reader.read(self.path("order2" + ending))
            back = grid.from_grid(back) if isinstance(back, vtkUnstructuredGrid) else back
            self.assertEqual({kind: back.points[corners].tolist() for kind, corners in back.blocks},
                             {kind: points[corners].tolist() for kind, corners in mesh.blocks}, ending)

    def test_xdmf(self):
        """Names are where meshio reads them, in each of the grids."""
        xdmf.write(self.path("boxes.xdmf"), self.mesh)
        back = grid.from_grid(xdmf.read(self.path("boxes.xdmf")))
        self.assertEqual(meshes.counts(grouped(back)), self.expected)
        alone = grid.Mesh(self.mesh.points, self.mesh.blocks[-1:], {},
                          {grid.PHYSICAL: self.mesh.cell_data[grid.PHYSICAL][self.mesh.cell_dimensions() == 3]},
                          {"steel": (1, 3), "air": (2, 3)})
        xdmf.write(self.path("alone.xdmf"), alone)
        names = meshio.xdmf.read(self.path("alone.xdmf")).field_data
        self.assertEqual({name: pair.tolist() for name, pair in names.items()}, {"steel": [1, 3], "air": [2, 3]})

    def test_xdmf_with_arrays_of_points_and_of_cells(self):
        """They may have one name, as those of the CAD entities do."""
        points = np.arange(len(self.mesh.points), dtype=np.int32)
        cells = np.arange(len(self.mesh.blocks[-1][1]), dtype=np.int32)
        mesh = grid.Mesh(self.mesh.points, self.mesh.blocks[-1:], {"CADEntity": points}, {"CADEntity": cells})
        xdmf.write(self.path("both.xdmf"), mesh)
        back = meshio.xdmf.read(self.path("both.xdmf"))
        np.testing.assert_array_equal(back.point_data["CADEntity"], points)
        np.testing.assert_array_equal(back.cell_data["CADEntity"][0], cells)

    def test_xdmf_with_numbers_of_64_bits(self):
        """NumPy's whole numbers, which VTK's writer does not know under their own types."""
        count = len(self.mesh.blocks[-1][1])
        arrays = {"signed": np.arange(count) - (1 << 40), "unsigned": np.arange(count, dtype=np.uint64),
                  "large": np.full(count, 1 << 63, dtype=np.uint64)}
        mesh = grid.Mesh(self.mesh.points, self.mesh.blocks[-1:], {"numbers": np.arange(len(self.mesh.points))}, arrays)
        xdmf.write(self.path("long.xdmf"), mesh)
        for back in (grid.from_grid(xdmf.read(self.path("long.xdmf"))).cell_data,
                     {name: values[0] for name, values in meshio.xdmf.read(self.path("long.xdmf")).cell_data.items()}):
            for name, values in arrays.items():
                np.testing.assert_array_equal(back[name], values.astype(float if name == "large" else np.int64))

    def test_openfoam(self):
        os.makedirs(self.path("case"))
        mesh = dataclasses.replace(self.mesh, patch_types={"wall": "wall", "Face_1": "cyclic"})
        openfoam_writing.write(self.path("case/boxes.foam"), mesh)
        back = grid.from_grid(grid.to_grid(openfoam.read(self.path("case"))))
        expected = {(name.replace(" ", "_"), 2): count for name, count in self.facets().items()}
        expected.update({(name, 3): self.expected[name, 3] for name in ("steel", "air")})
        self.assertEqual(meshes.counts(grouped(back)), expected)
        np.testing.assert_array_equal(back.points, self.mesh.points)
        self.assertEqual({back.patch_types["wall"], back.patch_types["Face_1"]}, {"wall", "patch"})
        pieces.write_grid(grid.to_grid(back), self.path("boxes.vtu"))
        self.assertIn("wall", meshio.read(self.path("boxes.vtu")).field_data)
        cells = back.blocks[-1][1]
        np.testing.assert_array_equal(np.sort(cells, axis=1), np.sort(self.mesh.blocks[-1][1], axis=1))
        corners = back.points[cells]
        self.assertGreater(np.linalg.det(corners[:, 1:] - corners[:, :1]).min(), 0)


if __name__ == "__main__":
    unittest.main()
