"""The unit box in cubes, or in Kuhn's tetrahedra, six a cube, in layers of cubes along z: a rank's share of them."""

import itertools

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_TETRA, vtkCellArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController

RADIUS = 0.2


def fill(grid, edges, shape="tetrahedra"):
    """Fills `grid` with this rank's layers, without ids; cell array Marked is 1 near the axis."""
    controller = vtkMultiProcessController.GetGlobalController()
    rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
    first, last = edges * rank // ranks, edges * (rank + 1) // ranks
    points, cells = layers(edges, first, last, shape)
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(coordinates)
    array = vtkCellArray()
    array.SetData(numpy_to_vtkIdTypeArray(cells.shape[1] * np.arange(len(cells) + 1), deep=True),
                  numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    grid.SetCells({4: VTK_TETRA, 8: VTK_HEXAHEDRON}[cells.shape[1]], array)
    centres = points[cells].mean(axis=1) - 0.5
    marks = numpy_to_vtk((centres[:, 0] ** 2 + centres[:, 1] ** 2 < RADIUS**2).astype(np.int8), deep=True)
    marks.SetName("Marked")
    grid.GetCellData().AddArray(marks)


def layers(edges, first, last, shape):
    side = np.arange(edges + 1) / edges
    z, y, x = np.meshgrid(side[first : last + 1], side, side, indexing="ij")
    count = len(x.ravel())
    corner = np.arange(count).reshape(x.shape)[:-1, :-1, :-1].ravel()
    step = (1, edges + 1, (edges + 1) ** 2)
    if shape == "hexahedra":
        square = np.array([0, step[0], step[0] + step[1], step[1]])
        cube = np.concatenate([square, square + step[2]])
        return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), corner[:, None] + cube
    blocks = []
    for order in itertools.permutations(range(3)):
        path = np.cumsum([0] + [step[k] for k in order])
        blocks.append(corner[:, None] + (path[[0, 2, 1, 3]] if is_odd(order) else path))
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]), np.stack(blocks, axis=1).reshape(-1, 4)


def is_odd(order):
    return sum(a > b for a, b in itertools.combinations(order, 2)) % 2 == 1
