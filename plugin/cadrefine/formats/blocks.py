"""Joins the blocks of a file, such as a mesh and its boundary, to one grid that has the arrays of all of them."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from cadrefine.formats.cells import TURNED, volumes
from cadrefine.formats.grid import WEDGES, arrays_of, corners_of, make_grid, to_vtk
from cadrefine.formats.sides import same_corners, same_rows

VERTEX, POLY_VERTEX, LINE, POLY_LINE, TRIANGLE, TETRAHEDRON, WEDGE = 1, 2, 3, 4, 5, 10, 13  # VTK's types of cells.


def joined(data):
    """One vtkUnstructuredGrid. Points of several blocks with the same coordinates become one, with the arrays of all.
    Where a block lacks an array, its points and cells have 0 there: no tag."""
    blocks = [block for block in leaves(data) if block.GetNumberOfCells() > 0]
    for attribute in (vtkDataObject.POINT, vtkDataObject.CELL):
        complete([(block.GetAttributes(attribute), block.GetNumberOfElements(attribute)) for block in blocks])
    append = vtkAppendFilter()
    for block in blocks:
        append.AddInputData(block)
    if not blocks:
        return vtkUnstructuredGrid()
    append.Update()
    grid = with_plain_cells(append.GetOutput())
    return merge_points(grid) if len(blocks) > 1 else grid


def merge_points(grid):
    points = vtk_to_numpy(grid.GetPoints().GetData())
    classes, first = in_order(same_rows(points))
    offsets, corners = corners_of(grid, np.arange(grid.GetNumberOfCells()))
    result = make_grid(points[first], vtk_to_numpy(grid.GetCellTypesArray()), offsets, classes[corners])
    combine(grid.GetPointData(), result.GetPointData(), classes)
    result.GetCellData().ShallowCopy(grid.GetCellData())
    return result


def merge_cells(grid):
    """Cells that are listed more than once become one, with the arrays of all."""
    offsets, corners = corners_of(grid, np.arange(grid.GetNumberOfCells()))
    rows = np.full((len(offsets) - 1, np.diff(offsets).max(initial=0)), -1)
    rows[np.arange(rows.shape[1]) < np.diff(offsets)[:, np.newaxis]] = corners
    classes, first = in_order(same_corners(rows))
    if len(first) == len(rows):
        return grid
    result = make_grid(vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetCellTypesArray())[first],
                       *corners_of(grid, first))
    result.GetPointData().ShallowCopy(grid.GetPointData())
    combine(grid.GetCellData(), result.GetCellData(), classes)
    return result


def in_order(found):
    """Classes by the order of their first members, and these."""
    classes, count = found
    first = np.full(count, len(classes))
    np.minimum.at(first, classes, np.arange(len(classes)))
    numbers = np.empty(count, dtype=int)
    numbers[np.argsort(first)] = np.arange(count)
    return numbers[classes], np.sort(first)


def combine(source, target, classes):
    """Gives `target` the arrays of `source`: of each class the first tuple that is not 0, if any is not."""
    for name, values in arrays_of(source).items():
        is_zero = (values.reshape(len(values), -1) == 0).all(axis=1)
        order = np.lexsort((is_zero, classes))
        target.AddArray(to_vtk(name, values[order[np.flatnonzero(np.diff(classes[order], prepend=-1))]]))


def with_plain_cells(grid):
    """Polylines of two points become lines, clouds of one point vertices: XDMF has no others beside other cells."""
    types = vtk_to_numpy(grid.GetCellTypesArray())
    sizes = np.diff(vtk_to_numpy(grid.GetCells().GetOffsetsArray()))
    types[(types == POLY_LINE) & (sizes == 2)] = LINE
    types[(types == POLY_VERTEX) & (sizes == 1)] = VERTEX
    return grid


def leaves(data):
    """The grids in `data`, shallow copies, that can be given arrays."""
    if not data.IsA("vtkCompositeDataSet"):
        return [copy_of(data)] if data.IsA("vtkPointSet") else []
    found = []
    iterator = data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        if iterator.GetCurrentDataObject().IsA("vtkPointSet"):
            found.append(copy_of(iterator.GetCurrentDataObject()))
        iterator.GoToNextItem()
    return found


def copy_of(data):
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    return copy


def complete(parts):
    """Gives each of `parts`, attributes and how many tuples they have, the arrays that only others have."""
    known = {}
    for attributes, _ in parts:
        for index in range(attributes.GetNumberOfArrays()):
            array = attributes.GetArray(index)
            if array is not None:
                known.setdefault(array.GetName(), array)
    for attributes, count in parts:
        for name, array in known.items():
            if attributes.GetArray(name) is None:
                kind = vtk_to_numpy(array).dtype
                width = array.GetNumberOfComponents()
                attributes.AddArray(to_vtk(name, np.zeros((count, width) if width > 1 else count, dtype=kind)))


def orient(grid):
    """Turns tetrahedra of negative volume round, wedges that are not as VTK defines them, and triangles of the plane
    z = 0."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    for kind, order in ((TRIANGLE, [0, 2, 1]), (TETRAHEDRON, [0, 1, 3, 2]), (WEDGE, TURNED[WEDGE])):
        places = offsets[:-1][types == kind][:, np.newaxis] + np.arange(len(order))
        nodes = corners[places]
        if kind == TRIANGLE:
            sizes = np.linalg.det(points[nodes[:, 1:], :2] - points[nodes[:, :1], :2]) * (not points[:, 2].any())
        else:
            sizes = volumes(points, kind, nodes if kind not in WEDGES else nodes[:, order])
        turned = sizes < 0
        corners[places[turned]] = nodes[turned][:, order]
