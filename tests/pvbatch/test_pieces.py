#!/usr/bin/python3
"""Meshes in several files: all of them are read, on any number of ranks, or one line names the one that cannot be."""

import os
import re
import shutil
import sys
import unittest

import driver
import meshio
import numpy as np

RANKS = int(sys.argv.pop()) if sys.argv[-1].isdigit() else 1
MESH, CAD = driver.data("naca0012_coarse.vtu"), driver.data("naca0012_sharp.igs")
COUNT = 3
CELLS = 228

INDEX = {
    "mesh.pvtu": """<VTKFile type="PUnstructuredGrid" version="0.1"><PUnstructuredGrid GhostLevel="0">
<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>{pieces}
</PUnstructuredGrid></VTKFile>""",
    "mesh.pvtp": """<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0">
<PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>{pieces}</PPolyData></VTKFile>""",
    "mesh.vtm": """<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>{blocks}
</vtkMultiBlockDataSet></VTKFile>""",
    "mesh.vtpd": """<VTKFile type="vtkPartitionedDataSet" version="1.0"><vtkPartitionedDataSet>{blocks}
</vtkPartitionedDataSet></VTKFile>""",
    "mesh.vtpc": """<VTKFile type="vtkPartitionedDataSetCollection" version="1.0"><vtkPartitionedDataSetCollection>
<Partitions index="0">{blocks}</Partitions></vtkPartitionedDataSetCollection></VTKFile>""",
    "mesh.pvd": '<VTKFile type="Collection" version="0.1"><Collection>{steps}</Collection></VTKFile>',
}
POLY_DATA = """<VTKFile type="PolyData" version="1.0"><PolyData>
<Piece NumberOfPoints="{points}" NumberOfPolys="{cells}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{coordinates}</DataArray></Points>
<Polys><DataArray type="Int64" Name="connectivity" format="ascii">{corners}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">{offsets}</DataArray></Polys></Piece></PolyData></VTKFile>"""


def text_of(numbers):
    return " ".join(map(repr, np.asarray(numbers).ravel().tolist()))


def write_poly_data(path, points, triangles):
    write(path, POLY_DATA.format(points=len(points), cells=len(triangles), coordinates=text_of(points),
                                 corners=text_of(triangles), offsets=text_of(3 * np.arange(1, len(triangles) + 1))))


def write(path, text):
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def cut(path):
    os.truncate(path, os.path.getsize(path) // 2)


def garbage(path):
    write(path, "This is no mesh.\n")


def surface_of(tetrahedra):
    sides = np.concatenate([tetrahedra[:, side] for side in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, counts = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    return sides[first[counts == 1]]


def write_mesh(folder):
    """The wing's mesh and its surface in three pieces, and files of all kinds that name them."""
    mesh = meshio.read(MESH)
    tetrahedra = mesh.cells_dict["tetra"]
    surface = surface_of(tetrahedra)
    for piece in range(COUNT):
        used, corners = np.unique(tetrahedra[piece::COUNT], return_inverse=True)
        part = meshio.Mesh(mesh.points[used], {"tetra": corners.reshape(-1, 4)})
        part.write(os.path.join(folder, f"piece{piece}.vtu"))
        write_poly_data(os.path.join(folder, f"piece{piece}.vtp"), mesh.points, surface[piece::COUNT])
    for name, text in INDEX.items():
        ending = "vtp" if name == "mesh.pvtp" else "vtu"
        names = [f"piece{piece}.{ending}" for piece in range(COUNT)]
        lists = {"pieces": "".join(f'<Piece Source="{piece}"/>' for piece in names),
                 "blocks": "".join(f'<DataSet index="{i}" file="{piece}"/>' for i, piece in enumerate(names)),
                 "steps": "".join(f'<DataSet part="{i}" file="{piece}"/>' for i, piece in enumerate(names))}
        write(os.path.join(folder, name), text.format(**lists))
    return len(surface)


class Pieces(driver.Case):
    def setUp(self):
        super().setUp()
        self.surface_cells = write_mesh(self.folder)

    def copy(self, name, piece, spoil):
        """A copy of the mesh whose file `piece` is spoilt; the path of its file `name`."""
        folder = self.path(f"{name}-{piece}-{spoil.__name__}")
        shutil.copytree(self.folder, folder, ignore=lambda _, names: [n for n in names if "-" in n])
        spoil(os.path.join(folder, piece))
        return os.path.join(folder, name)

    def test_all_are_read_or_one_is_named(self):
        last = COUNT - 1
        spoilt = (("mesh.pvtu", "piece1.vtu", os.remove), ("mesh.pvtu", f"piece{last}.vtu", cut),
                  ("mesh.pvtp", f"piece{last}.vtp", os.remove), ("mesh.vtm", f"piece{last}.vtu", cut),
                  ("mesh.vtpd", f"piece{last}.vtu", garbage), ("mesh.vtpc", f"piece{last}.vtu", os.remove),
                  ("mesh.pvd", f"piece{last}.vtu", cut))
        paths = [self.copy(*case) for case in spoilt]
        lines = [re.escape(f"{path}: its part {os.path.join(os.path.dirname(path), piece)}: ") + ".+"
                 for path, (_, piece, _) in zip(paths, spoilt)]
        for name in ("mesh.pvtu", "mesh.vtm", "mesh.vtpc"):
            paths.append(self.path("no-pieces-" + name))
            write(paths[-1], INDEX[name].format(pieces="", blocks=""))
            lines.append(re.escape(f"{paths[-1]}: the mesh has no cells"))
        before = self.files()
        runs = [{"arguments": [path, CAD, "--output", self.path("out.vtu")]} for path in paths]
        runs += [{"arguments": [self.path(name), CAD, "--steps", "0"]} for name in INDEX]
        failures, output = driver.many(RANKS, self.folder, runs)
        for path, line, failure in zip(paths, lines, failures):
            self.assertRegex(failure or "no failure", f"^{line}$", path)
        self.assertEqual(self.files(), before)
        self.assertEqual(failures[len(paths):], [None] * len(INDEX))
        rows = [line.split() for line in output.splitlines() if line.split()[:1] == ["0"]]
        self.assertEqual([int(row[2]) for row in rows],
                         [self.surface_cells if name == "mesh.pvtp" else CELLS for name in INDEX])

    def files(self):
        return sorted(os.path.join(folder, name) for folder, _, names in os.walk(self.folder) for name in names)

    def test_every_rank_ends_with_an_error(self):
        os.remove(self.path(f"piece{COUNT - 1}.vtu"))
        run = driver.Run(RANKS, self.path("mesh.pvtu"), CAD, "--steps", "0", "--output", self.path("out.vtu"))
        self.assertEqual(len(run.errors), 1, run.errors)
        self.assertIn(f"piece{COUNT - 1}.vtu: no such file", run.errors[0])
        self.assertEqual(run.statuses if RANKS else [run.status], [1] * max(RANKS, 1))
        self.assertFalse(os.path.exists(self.path("out.vtu")))


if __name__ == "__main__":
    unittest.main()
