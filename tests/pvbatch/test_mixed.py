#!/usr/bin/python3
"""Meshes of hexahedra, wedges, pyramids, tetrahedra, quadrilaterals and triangles come in and go out with their groups,
the right way round in every format; without ParaView's programs. The judges are gmsh, VTK, meshio and, where they are
installed, OpenFOAM, CalculiX and the tools of CGNS and MED."""

import contextlib
import ctypes
import ctypes.util
import io
import itertools
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import cgns_files
import driver
import gmsh
import h5py
import meshes
import meshio
import numpy as np
from scipy.io import netcdf_file

sys.path.insert(0, os.path.join(driver.ROOT, "plugin"))

from cadrefine import files
from cadrefine.formats import BadFile, abaqus, cgns, grid, med, openfoam, openfoam_cells, openfoam_writing
from cadrefine.formats.groups import grouped
from cadrefine.formats.sides import turned_alike
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

VOLUMES = {"hexahedra": 1, "wedges": 1, "above": 2}
# Coordinate and its value of each group of facets, and its area.
FACETS = {"floor": (2, 0, 2), "contact": (2, 1, 2), "roof": (2, 2, 2), "left": (0, 0, 1), "right": (0, 2, 1),
          "front": (1, 0, 2), "back": (1, 1, 2)}
WEDGES = {13: [0, 2, 1, 3, 5, 4], 26: [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13]}  # The other way round.
SIZES = {10: 4, 12: 8, 13: 6, 14: 5}  # Of linear volume cells, by VTK's types.
# Of those of second order: corners, and ends of the edges that have the other nodes.
SECOND_ORDER = {
    22: (3, "01 12 20"), 23: (4, "01 12 23 30"), 24: (4, "01 12 20 03 13 23"),
    25: (8, "01 12 23 30 45 56 67 74 04 15 26 37"), 26: (6, "01 12 20 34 45 53 03 14 25"),
    27: (5, "01 12 23 30 04 14 24 34"),
}
CASE = {
    "controlDict": "application none; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; "
                   "writeControl timeStep; writeInterval 1;",
    "fvSchemes": "ddtSchemes {default Euler;} gradSchemes {default Gauss linear;} divSchemes {default none;} "
                 "laplacianSchemes {default none;} interpolationSchemes {default linear;} "
                 "snGradSchemes {default none;}",
    "fvSolution": "",
}
JOB = """*INCLUDE, INPUT={}
*ELSET, ELSET=all
hexahedra, wedges
*MATERIAL, NAME=soft
*ELASTIC
1.,0.
*SOLID SECTION, ELSET=all, MATERIAL=soft
*BOUNDARY
floor, 1, 3, 0
*STEP
*STATIC
*DSLOAD
contact, P, 3.
left, P, 5.
right, P, 7.
front, P, 11.
back, P, 13.
*EL PRINT, ELSET=hexahedra, TOTALS=ONLY
EVOL
*EL PRINT, ELSET=wedges, TOTALS=ONLY
EVOL
*NODE PRINT, NSET=floor, TOTALS=ONLY
RF
*END STEP
"""


def sizes_of(data, name):
    """Volumes or areas of all cells, as VTK computes them."""
    measure = vtkCellSizeFilter()
    measure.SetInputData(data)
    measure.Update()
    return vtk_to_numpy(measure.GetOutput().GetCellData().GetArray(name))


def read(path):
    data = vtkUnstructuredGrid()
    reason = files.read(path, data)
    assert not reason, reason
    return data


def wedges_turned(data, every=1):
    """A copy with every so many of its wedges the other way round."""
    copy = vtkUnstructuredGrid()
    copy.DeepCopy(data)
    nodes = vtk_to_numpy(copy.GetCells().GetConnectivityArray())
    offsets, types = vtk_to_numpy(copy.GetCells().GetOffsetsArray()), vtk_to_numpy(copy.GetCellTypesArray())
    for kind, order in WEDGES.items():
        for cell in np.flatnonzero(types == kind)[::every]:
            nodes[offsets[cell]:offsets[cell + 1]] = nodes[offsets[cell]:offsets[cell + 1]][order]
    return copy


def heights(points, nodes):
    """On which side of its first three corners the fourth corner beyond these is: 1 or -1 for each cell, of wedges as
    all volume cells."""
    corners = points[nodes[:, [0, 1, 2, -1]]]
    return np.sign(np.linalg.det(corners[:, 1:] - corners[:, :1]))


class Mixed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.counts = meshes.write_mixed(cls.path("mixed1.msh"), cls.path("mixed2.msh"))
        cls.layers = meshes.write_mixed(cls.path("layers1.msh"), cls.path("layers2.msh"), lid=False)
        meshes.write_mixed(cls.path("full1.msh"), cls.path("full2.msh"), lid=False, complete=True)
        cls.made = {name: read(cls.path(name + ".msh")) for name in ("mixed1", "mixed2", "layers1", "layers2")}

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def groups_of(self, name):
        return self.counts if name.startswith("mixed") else self.layers

    def number_of_solids(self):
        return sum(count for (_, dimension), count in self.counts.items() if dimension == 3)

    def check(self, data, groups, tolerance=1e-9):
        """Every volume cell is positive to VTK; `groups` have their numbers of cells, and volumes and areas as the body
        has them; mid nodes are in the middle of the edges that VTK has them on."""
        mesh = grouped(grid.from_grid(data))
        self.assertEqual({pair: count for pair, count in meshes.counts(mesh).items() if pair in groups}, groups)
        again = grid.to_grid(mesh)
        dimensions, points = mesh.cell_dimensions(), mesh.points
        for cells in (data, again):
            volumes = sizes_of(cells, "Volume")
            self.assertEqual((volumes > 0).sum(), (dimensions == 3).sum())
        areas = sizes_of(again, "Area")
        for name, dimension in groups:
            inside = meshes.members(mesh, name)
            if dimension == 3:
                self.assertAlmostEqual(volumes[inside].sum(), VOLUMES[name], delta=tolerance, msg=name)
            else:
                axis, place, area = FACETS[name]
                self.assertAlmostEqual(areas[inside].sum(), area, delta=tolerance, msg=name)
                first = np.concatenate([corners[:, 0] for _, corners in mesh.blocks])
                self.assertLess(np.abs(points[first[inside], axis] - place).max(), tolerance)
        for kind, nodes in mesh.blocks:
            corners, edges = SECOND_ORDER.get(kind, (0, ""))
            for place, edge in enumerate(edges.split(), corners):
                ends = points[nodes[:, [int(end) for end in edge]]]
                self.assertLess(np.abs(points[nodes[:, place]] - ends.mean(axis=1)).max(), tolerance, (kind, edge))

    def write_with_gmsh(self, name, endings):
        gmsh.initialize()
        try:
            for option, value in (("General.Terminal", 0), ("Mesh.SaveElementTagType", 2), ("Mesh.BdfFieldFormat", 2)):
                gmsh.option.setNumber(option, value)
            gmsh.open(self.path(name + ".msh"))
            for ending in endings:
                gmsh.write(self.path(name + ending))
            for version, binary in ((2.2, 0), (2.2, 1), (4.1, 0), (4.1, 1)):
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                gmsh.write(self.path(f"{name}_{version}_{binary}.msh"))
        finally:
            gmsh.finalize()

    def write(self, data, name, **how):
        """Path of the file that is written."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        reason = files.write(data, self.path(name), how.get("version", "2.2"), how.get("ascii", False))
        self.assertEqual(reason, "")
        return self.path(name)

    def test_of_gmsh(self):
        """All versions of its files; of second order also with nodes on sides and inside, which are left out."""
        for name in (*self.made, "full2"):
            self.write_with_gmsh(name, [])
            for version in ("2.2", "4.1"):
                for binary in range(2):
                    with self.subTest(f"{name} {version} {binary}"):
                        self.check(read(self.path(f"{name}_{version}_{binary}.msh")), self.groups_of(name))

    def test_others_of_gmsh(self):
        """gmsh 4.8 has no pyramids in files of Abaqus and universal ones, and their mid nodes in another order than
        Nastran."""
        self.write_with_gmsh("mixed1", [".su2", ".bdf"])
        self.check(read(self.path("mixed1.su2")), {pair: count for pair, count in self.counts.items() if pair[1] == 2})
        for name in ("layers1", "layers2"):
            self.write_with_gmsh(name, [".inp", ".unv", ".bdf"])
            for ending in (".inp", ".unv"):
                with self.subTest(name + ending):
                    self.check(read(self.path(name + ending)), self.layers)
        for name in ("mixed1", "layers1", "layers2"):
            with self.subTest(name):
                data = read(self.path(name + ".bdf"))
                expected = {(f"group {number}", dimension): count
                            for number, ((_, dimension), count) in enumerate(self.groups_of(name).items(), 1)}
                self.assertEqual(meshes.counts(grouped(grid.from_grid(data))), expected)
                self.assertAlmostEqual(sizes_of(data, "Volume").sum(), 4 if name == "mixed1" else 2, delta=1e-8)
                self.check(data, {}, 1e-7)

    def test_of_meshio(self):
        """Its files of MED and XDMF have the corners as gmsh numbers them."""
        mesh = meshio.read(self.path("mixed1.msh"))
        cells = mesh.cells_dict
        solids = {kind: cells[kind] for kind in ("tetra", "hexahedron", "wedge", "pyramid")}
        for name, module, blocks in (("a.vol", "netgen", cells), ("a.mesh", "medit", cells),
                                     ("a.meshb", "medit", cells), ("a.med", "med", cells),
                                     ("a.xdmf", "xdmf", solids)):
            with self.subTest(name):
                with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                    meshio.write(self.path(name), meshio.Mesh(mesh.points, blocks), file_format=module)
                data = read(self.path(name))
                self.check(data, {})
                self.assertAlmostEqual(sizes_of(data, "Volume").sum(), 4)

    def test_there_and_back(self):
        for name, data in self.made.items():
            linear = name.endswith("1")
            groups = self.groups_of(name)
            facets = {pair: count for pair, count in groups.items() if pair[1] == 2}
            outside = {pair: count for pair, count in facets.items() if pair != ("contact", 2) or "layers" in name}
            endings = {".msh": groups, ".xdmf": groups, ".med": groups, ".exo": groups, ".cgns": groups, ".bdf": groups}
            if linear:
                endings.update({".su2": outside, ".foam": groups})
            if name != "mixed2":
                endings[".inp"] = groups
            if name != "mixed1":
                endings[".unv"] = groups
            for ending, expected in endings.items():
                with self.subTest(name + ending):
                    self.check(read(self.write(data, f"{name}/back{ending}")), expected)
        back = read(self.write(self.made["mixed1"], "back.mesh"))
        self.check(back, {})
        self.assertEqual(sorted(meshes.counts(grouped(grid.from_grid(back))).values()), sorted(self.counts.values()))

    def test_surfaces(self):
        """A quadrilateral beside triangles, in the plane and in space."""
        plane = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
        blocks = [(3, np.array([[0, 1], [1, 2]])), (5, np.array([[1, 2, 5], [1, 5, 4]])), (9, np.array([[0, 1, 4, 3]]))]
        expected = {("rim", 1): 2, ("plate", 2): 3}
        for points in (plane, plane @ [[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]):
            mesh = grid.Mesh(points, blocks, {}, {grid.PHYSICAL: np.int32([2, 2, 1, 1, 1])},
                             {"plate": (1, 2), "rim": (2, 1)})
            endings = [".msh", ".xdmf", ".med", ".exo", ".inp", ".cgns", ".bdf", ".unv"]
            for ending in endings + ([".su2"] if points is plane else []):
                with self.subTest(ending):
                    data = read(self.write(grid.to_grid(mesh), "surface" + ending))
                    found = meshes.counts(grouped(grid.from_grid(data)))
                    self.assertLessEqual(({("rim", 1): 2} if ending == ".su2" else expected).items(), found.items())
                    self.assertAlmostEqual(sizes_of(data, "Area").sum(), 2)

    def test_surfaces_of_gmsh_either_way_round(self):
        """gmsh has the cells of each surface its own way round: two that do not agree, of quadrilaterals and of
        triangles; as they are where a cell is inverted."""
        meshes.write_two_ways(self.path("ways1.msh"), self.path("ways2.msh"))
        for name in ("ways1", "ways2"):
            mesh = grid.from_grid(read(self.path(name + ".msh")))
            for kind, nodes in mesh.blocks:
                if kind in (5, 9, 22, 23):
                    at = mesh.points[nodes]
                    count = 3 if kind in (5, 22) else 4
                    self.assertGreater(np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])[:, 2].min(), 0, (name, kind))
                    for node in range(count, at.shape[1]):
                        ends = at[:, [node - count, (node - count + 1) % count]]
                        self.assertTrue(np.allclose(at[:, node], ends.mean(axis=1)), (name, kind))
        others = np.array([[1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]], float)
        blocks = [(5, np.array([[0, 1, 2], [2, 1, 3]])), (9, np.array([[3, 5, 4, 1]]))]
        turned = np.array([[-0.36, 0.8, -0.48], [0.48, 0.6, 0.64], [0.8, 0, -0.6]])
        cases = itertools.product((((0, 0, 0), False), ((1.5, 1.5, 0), True)), (np.eye(3), turned))
        for (corner, is_inverted), turn in cases:
            mesh = turned_alike(grid.Mesh(np.vstack([corner, others]) @ turn, blocks))
            self.assertEqual(mesh.blocks[0][1].tolist(), blocks[0][1].tolist())
            self.assertEqual(mesh.blocks[1][1].tolist(), [[3, 5, 4, 1] if is_inverted else [3, 1, 4, 5]])

    def test_what_formats_lack(self):
        for name, ending, reason in (("mixed2", ".su2", "SU2 has no quadratic cells"),
                                     ("mixed2", ".foam", "OpenFOAM has no quadratic cells"),
                                     ("mixed2", ".mesh", "Medit has no quadratic cells"),
                                     ("mixed2", ".inp", "Abaqus has no quadratic pyramids"),
                                     ("mixed1", ".unv", "universal files can hold only quadratic pyramids")):
            path = self.path("lacks" + ending)
            self.assertEqual(files.write(self.made[name], path, "2.2", False), f"{path}: {reason}")
            self.assertFalse(os.path.exists(path))

    def test_wedges_either_way_round(self):
        """As VTK's documentation has them, as gmsh and Verdict have them, and both in one mesh."""
        for name in ("mixed1", "mixed2"):
            for every in (1, 2):
                turned = wedges_turned(self.made[name], every)
                self.assertLess(sizes_of(turned, "Volume").min(), 0)
                for ending in (".msh", ".exo", ".med", ".xdmf"):
                    with self.subTest(f"{name} {every} {ending}"):
                        self.check(read(self.write(turned, "turned" + ending)), self.counts)

    def test_volumes_in_gmsh(self):
        """Integrated by its own shape functions, whose Jacobians are positive. (gmsh 4.8 has wrong weights for
        pyramids.)"""
        types = {"Tetrahedron": (10, 24), "Hexahedron": (12, 25), "Prism": (13, 26), "Pyramid": (14, 27)}
        for name in ("mixed1", "mixed2"):
            for version in ("2.2", "4.1"):
                path = self.write(self.made[name], "for_gmsh.msh", version=version, ascii=version == "4.1")
                gmsh.initialize()
                try:
                    gmsh.option.setNumber("General.Terminal", 0)
                    gmsh.open(path)
                    volumes = sizes_of(self.made[name], "Volume")
                    for kind in gmsh.model.mesh.getElementTypes(3):
                        places, weights = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss4")
                        _, determinants, _ = gmsh.model.mesh.getJacobians(kind, places)
                        self.assertGreater(determinants.min(), 0)
                        total = (determinants.reshape(-1, len(weights)) * weights).sum()
                        shape = gmsh.model.mesh.getElementProperties(kind)[0].split()[0]
                        inside = np.isin(vtk_to_numpy(self.made[name].GetCellTypesArray()), types[shape])
                        self.assertEqual(len(determinants), inside.sum() * len(weights))
                        if shape != "Pyramid":
                            self.assertAlmostEqual(total, volumes[inside].sum())
                finally:
                    gmsh.finalize()

    def test_way_round_in_files(self):
        """By the files' numbers: of Exodus and Medit as gmsh has it, of MED the other way round, of SU2 as VTK does."""
        data = self.made["mixed1"]
        with netcdf_file(self.write(data, "round.exo"), mmap=False) as file:
            points = np.column_stack([file.variables["coord" + axis][:] for axis in "xyz"])
            names = {}
            for block in range(1, 1 + file.dimensions["num_el_blk"]):
                table = file.variables[f"connect{block}"]
                names[table.elem_type.decode()] = table.shape[1]
                self.assertEqual(set(heights(points, table[:].astype(int) - 1)), {1})
        self.assertEqual(names, {"TETRA4": 4, "HEX8": 8, "WEDGE": 6, "PYRAMID": 5})
        with contextlib.redirect_stderr(io.StringIO()):
            read_back = {name: module.read(self.write(data, name)) for name, module in (
                ("round.med", meshio.med), ("round.mesh", meshio.medit), ("round.su2", meshio.su2))}
        for name, way in (("round.med", -1), ("round.mesh", 1)):
            for kind in ("tetra", "hexahedron", "wedge", "pyramid"):
                nodes = read_back[name].cells_dict[kind]
                self.assertEqual(set(heights(read_back[name].points, nodes)), {way}, (name, kind))
        for kind, way in (("tetra", 1), ("hexahedron", 1), ("wedge", -1), ("pyramid", 1)):
            mesh = read_back["round.su2"]
            self.assertEqual(set(heights(mesh.points, mesh.cells_dict[kind])), {way}, kind)

    def test_su2_turned(self):
        """SU2 turns volume cells round itself."""
        path = self.write(self.made["mixed1"], "inverted.su2")
        with open(path, encoding="ascii") as file:
            lines = file.read().splitlines()
        start = next(place for place, line in enumerate(lines) if line.startswith("NPOIN=")) + 1
        for place in range(start, start + int(lines[start - 1].split()[1])):
            x, y, z = lines[place].split()
            lines[place] = f"{y} {x} {z}"  # The mirror image of the body.
        with open(path, "w", encoding="ascii") as file:
            file.write("\n".join(lines))
        volumes = sizes_of(read(path), "Volume")
        self.assertEqual((volumes > 0).sum(), self.number_of_solids())
        self.assertAlmostEqual(volumes.sum(), 4)

    def test_nodes_on_sides_and_inside(self):
        """A hexahedron of 27 nodes comes with the first 20."""
        corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
        upright, above = [(0, 4), (1, 5), (2, 6), (3, 7)], [(4, 5), (5, 6), (6, 7), (7, 4)]
        below = [(0, 1), (1, 2), (2, 3), (3, 0)]
        nodes = np.arange(27)[np.newaxis]

        def points(edges):
            return np.concatenate([corners, corners[edges].mean(axis=1), np.full((7, 3), 0.5)])

        with open(self.path("full.inp"), "w", encoding="ascii") as file:
            file.write("*NODE\n")
            np.savetxt(file, np.column_stack([1 + nodes[0], points(below + above + upright)]), "%d, %g, %g, %g")
            file.write("*ELEMENT, TYPE=C3D27\n1, " + ", ".join(map(str, 1 + nodes[0, :15])) + ",\n")
            file.write(", ".join(map(str, 1 + nodes[0, 15:])) + "\n")
        cgns_files.write_by_hand(self.path("full.cgns"), points(below + upright + above), [("cell", 19, nodes)])
        turned = corners[[0, 3, 2, 1, 4, 7, 6, 5]]
        mesh = grid.Mesh(np.concatenate([turned, turned[below + above + upright].mean(axis=1), np.full((7, 3), 0.5)]),
                         [(25, nodes[:, :20])])
        med.write(self.path("full.med"), mesh)
        with h5py.File(self.path("full.med"), "a") as file:
            cells = file[f"ENS_MAA/{med.MESH}/{med.STEP}/MAI"]
            cells.move("H20", "H27")
            del cells["H27/NOD"]
            cells["H27/NOD"] = 1 + nodes[0]
        for module, name in ((abaqus, "full.inp"), (cgns, "full.cgns"), (med, "full.med")):
            with self.subTest(name):
                (kind, found), = module.read(self.path(name)).blocks
                self.assertEqual((kind, found.shape), (25, (1, 20)))
                data = read(self.path(name))
                self.assertAlmostEqual(sizes_of(data, "Volume")[0], 1)
                self.check(data, {})

    def test_polyhedra(self):
        """They are refused by name; so are faces that enclose no cell."""
        around = np.linspace(0, 2 * np.pi, 6, endpoint=False)
        ring = np.column_stack([np.cos(around), np.sin(around), np.zeros(6)])
        below, above = np.arange(6), 6 + np.arange(6)
        sides = np.column_stack([below, np.roll(below, -1), np.roll(above, -1), above])
        faces = [f"6({' '.join(map(str, face))})" for face in (below[::-1], above)]
        faces += [f"4({' '.join(map(str, face))})" for face in sides]
        path = self.write(self.made["mixed1"], "prism/case.foam")
        folder = self.path("prism/constant/polyMesh")
        points = [f"({x} {y} {z})" for x, y, z in [*ring, *(ring + [0, 0, 1])]]
        for name, kind, rows in (("points", "vectorField", points),
                                 ("faces", "faceList", faces), ("owner", "labelList", ["0"] * 8),
                                 ("neighbour", "labelList", []),
                                 ("boundary", "polyBoundaryMesh", ["all { type wall; nFaces 8; startFace 0; }"])):
            with openfoam_writing.open_file(folder, name, kind) as file:
                file.write("\n".join([str(len(rows)), "(", *rows, ")\n"]))
        data = vtkUnstructuredGrid()
        self.assertEqual(files.read(path, data), f"{path}: constant/polyMesh/faces: cells that are not hexahedra, "
                                                 "wedges, pyramids or tetrahedra: 1, the first is cell 0, with 8 faces")

    def test_faces_that_do_not_fit(self):
        self.write(self.made["mixed1"], "broken/case.foam")
        folder = self.path("broken/constant/polyMesh")
        faces = openfoam.File(folder, "faces").faces()
        owner, neighbour = (openfoam.File(folder, name).list("label") for name in ("owner", "neighbour"))
        faces[0, :3] = faces[1, :3]
        with self.assertRaisesRegex(BadFile, r"^constant/polyMesh/faces: the faces of cell \d+ do not fit together$"):
            openfoam_cells.cells_of(faces, owner, neighbour)

    def run_tool(self, *command, **environment):
        """What an installed program prints."""
        if not shutil.which(command[0]):
            self.skipTest(f"{command[0]} is not installed")
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", cwd=self.folder, check=False,
                                env={**os.environ, **driver.ENVIRONMENT, **environment})
        return result.stdout + result.stderr

    def test_checkMesh(self):
        self.write(self.made["mixed1"], "foam/case.foam")
        os.makedirs(self.path("foam/system"))
        for name, content in CASE.items():
            with open(self.path("foam/system/" + name), "w", encoding="ascii") as file:
                file.write(f"FoamFile {{ version 2.0; format ascii; class dictionary; object {name}; }}\n{content}\n")
        output = self.run_tool("checkMesh", "-case", self.path("foam"), WM_PROJECT_DIR="/usr/share/openfoam")
        self.assertIn("Mesh OK.", output)
        for line in ("hexahedra: 18", "prisms: 52", "pyramids: 9", "polyhedra: 0", "face zones: 1", "cell zones: 3"):
            self.assertIn(line, " ".join(output.split()))
        self.assertRegex(output, "Total volume = 4\\.")

    def test_calculix(self):
        """Volumes, and the forces of pressures on surfaces, of linear and quadratic cells. Of what loads the sides, the
        floor's own nodes bear a part that is not in its reaction."""
        for order, part in ((1, 3 / 4), (2, 11 / 12)):
            self.write(self.made[f"layers{order}"], f"ccx{order}.mesh.inp")
            with open(self.path(f"job{order}.inp"), "w", encoding="ascii") as file:
                file.write(JOB.format(f"ccx{order}.mesh.inp"))
            output = self.run_tool("ccx", f"job{order}")
            self.assertNotIn("*ERROR", output)
            with open(self.path(f"job{order}.dat"), encoding="ascii") as file:
                numbers = re.findall(r"^ *(?:-?\d+\.\d+E[+-]\d+ *)+$", file.read(), re.MULTILINE)
            found = [float(word) for line in numbers for word in line.split()]
            np.testing.assert_allclose(found, [1, 1, part * (7 - 5), part * (13 - 11) * 2, 3 * 2], rtol=1e-5)

    def test_tools_of_cgns_and_med(self):
        for name in ("mixed1", "mixed2"):
            self.write(self.made[name], "tool.med")
            self.write(self.made[name], "tool.cgns")
            self.assertIn("conforme a la biblioth", self.run_tool("medconforme", "tool.med"))
            output = self.run_tool("cgnscheck", "tool.cgns")
            self.assertIn("checking complete", output)
            self.assertNotIn("ERROR", output)

    def test_cgns_by_its_library(self):
        """The sections, by the CGNS library's own reader."""
        path = self.write(self.made["mixed2"], "library.cgns")
        library = ctypes.CDLL(ctypes.util.find_library("cgns"))
        numbers = [ctypes.c_int() for _ in range(2)]
        self.assertEqual(library.cg_open(path.encode(), 0, ctypes.byref(numbers[0])), 0)
        self.assertEqual(library.cg_nsections(numbers[0], 1, 1, ctypes.byref(numbers[1])), 0)
        found = {}
        for section in range(1, 1 + numbers[1].value):
            name, values = ctypes.create_string_buffer(33), [ctypes.c_int() for _ in range(5)]
            self.assertEqual(library.cg_section_read(numbers[0], 1, 1, section, name, *map(ctypes.byref, values)), 0)
            kind, first, last, _, _ = (value.value for value in values)
            found[name.value.decode()] = kind, last - first + 1
        library.cg_close(numbers[0])
        self.assertEqual(found.pop("cells"), (20, self.number_of_solids()))
        self.assertEqual(found.pop("boundary")[0], 6)
        kinds = {"roof": 6, "left": 8, "right": 8, "front": 8, "back": 8}  # Else triangles and quadrilaterals.
        self.assertEqual(found, {name: (kinds.get(name, 20), count)
                                 for (name, dimension), count in self.counts.items() if dimension == 2})


if __name__ == "__main__":
    unittest.main()
