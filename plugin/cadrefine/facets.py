"""The facets of a mesh as arrays, to be drawn: the triangles of its boundary, or of a mesh in the plane all of them."""

import functools

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersExtraction import vtkExtractCellsByType
from vtkmodules.vtkFiltersGeometry import vtkUnstructuredGridGeometryFilter

from cadrefine.input import local_output
from cadrefine.merge import merged_grid
from cadrefine.output import gathered
from cadrefine.pipeline import field_values

# Of a mesh's dimension, VTK's types of cells, linear and quadratic.
CELL_TYPES = {2: (5, 9, 22, 23), 3: (10, 12, 13, 14, 24, 25, 26, 27)}
FACE = 2  # CADDimension of what lies on a CAD face.

# Runs on every rank.
TAKE_FACETS = """
from cadrefine import facets
self.GetOutputDataObject(0).ShallowCopy(facets.of_dimension({dimension}, self.GetInputDataObject(0, 0)))
"""


def of_dimension(dimension, mesh):
    """The facets of the cells of this dimension; quadratic ones stay quadratic. Cells of lower dimension, which carry
    tags, have no error and would hide them."""
    last = vtkExtractCellsByType()
    last.SetInputData(mesh)
    for cell_type in CELL_TYPES[dimension]:
        last.AddCellType(cell_type)
    if mesh.IsA("vtkUnstructuredGrid"):
        last, chosen = vtkUnstructuredGridGeometryFilter(), last
        last.SetInputConnection(chosen.GetOutputPort())
    last.Update()
    return last.GetOutput()


def is_flat(mesh):
    """Whether the mesh is one in the plane, whose error is an area."""
    dimension = mesh.FieldData["GeometricErrorDimension"]
    return dimension is not None and dimension.GetRange(0)[0] == 2


def gather(mesh, cad, quadratic):
    """The facets of all ranks, on rank 0. `quadratic`: whether cells are of second order."""
    flat, dimension = is_flat(mesh), field_values(local_output(mesh))["MeshDimension"]
    if flat or quadratic:
        source = simple.ProgrammableFilter(Input=mesh, Script=TAKE_FACETS.format(dimension=dimension))
    else:
        source = simple.CADBoundary(Input=mesh, CAD=cad)
    grid = merged_grid(gathered(source))
    simple.Delete(source)
    faces = field_values(local_output(cad))["CADCounts"][FACE]
    return Facets(grid, faces, flat, quadratic, of_volumes=dimension == 3)


class Facets:
    """`face`: the CAD face, of `faces`, that each lies on; -1: none, or not known. `error`, `distance`: of the cell
    that it is a side of. `flat`: the mesh is one in the plane; `of_volumes`: one of tetrahedra, say."""

    def __init__(self, grid, faces, flat, quadratic, of_volumes):
        self.grid = grid
        self.of_volumes = of_volumes
        self.faces = faces
        self.flat = flat
        self.count = grid.GetNumberOfCells()
        self.points = vtk_to_numpy(grid.GetPoints().GetData())
        self.nodes = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        self.starts = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
        self.error = self.array("GeometricError")
        self.distance = self.array("GeometricDistance")
        self.face = self.faces_of_nodes() if flat or quadratic else np.where(
            self.array("CADDimension") == FACE, self.array("CADEntity"), -1)

    def array(self, name):
        return vtk_to_numpy(self.grid.GetCellData().GetArray(name))

    def faces_of_nodes(self):
        """Of facets all of whose nodes are on the CAD, the face that some lie on inside; where none does, -1."""
        data = self.grid.GetPointData()
        dimension, entity = (vtk_to_numpy(data.GetArray(name))[self.nodes] for name in ("CADDimension", "CADEntity"))
        found = np.maximum.reduceat(np.where(dimension == FACE, entity, -1), self.starts[:-1])
        return np.where(np.minimum.reduceat(dimension, self.starts[:-1]) >= 0, found, -1)

    def on(self, faces):
        """Which lie on CAD faces of the mask `faces`, as a mask; in the plane all."""
        return np.ones(self.count, dtype=bool) if self.flat else (self.face >= 0) & np.append(faces, False)[self.face]

    def meets(self):
        """The CAD faces that facets lie on, as a mask."""
        return np.bincount(self.face[self.face >= 0], minlength=self.faces) > 0

    def points_of(self, chosen):
        """Their numbers."""
        return np.unique(self.nodes[np.repeat(chosen, np.diff(self.starts))])

    def points_and_faces(self):
        """Pairs of a point and a CAD face of which a facet has the point, ordered and without double ones."""
        pairs = np.column_stack([self.nodes, np.repeat(self.face, np.diff(self.starts))])
        return np.unique(pairs[pairs[:, 1] >= 0], axis=0)

    @functools.lru_cache
    def boxes(self):
        """Lower and upper corners of the facets of each CAD face."""
        lower, upper = np.full((self.faces, 3), np.inf), np.full((self.faces, 3), -np.inf)
        on_cad = self.face >= 0
        for function, result in ((np.minimum, lower), (np.maximum, upper)):
            own = function.reduceat(self.points[self.nodes], self.starts[:-1])
            function.at(result, self.face[on_cad], own[on_cad])
        return lower, upper

    def distances(self):
        """The smallest and the largest of the facets of each CAD face."""
        closest, farthest = np.full(self.faces, np.inf), np.zeros(self.faces)
        on_cad = self.face >= 0
        np.minimum.at(closest, self.face[on_cad], self.distance[on_cad])
        np.maximum.at(farthest, self.face[on_cad], self.distance[on_cad])
        return closest, farthest

    def thickness(self):
        """How far the points of each CAD face spread along its mean normal."""
        normal = np.zeros((self.faces, 3))
        on_cad = self.face >= 0
        np.add.at(normal, self.face[on_cad], self.normals()[on_cad])
        normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
        pairs = self.points_and_faces()
        heights = np.sum(self.points[pairs[:, 0]] * normal[pairs[:, 1]], axis=1)
        spread = np.full(self.faces, -np.inf), np.full(self.faces, -np.inf)
        for ends, values in zip(spread, (heights, -heights)):
            np.maximum.at(ends, pairs[:, 1], values)
        return spread[0] + spread[1]

    def inside(self, box):
        """Which points are, as a mask."""
        lower, upper = np.array(box).reshape(3, 2).T
        return ((self.points >= lower) & (self.points <= upper)).all(axis=1)

    def corner(self, number):
        return self.points[self.nodes[self.starts[:-1] + number]]

    def normals(self):
        """Out of the mesh, as long as the facet is large."""
        return np.cross(self.corner(1) - self.corner(0), self.corner(2) - self.corner(0)) / 2

    def middles(self):
        return (self.corner(0) + self.corner(1) + self.corner(2)) / 3
