"""Joins the pieces of a mesh, as they come from the ranks, to one grid without double points."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from cadrefine.formats import grid as grids

# What ParaView adds where a rank reads its part of a file.
ADDED_BY_READERS = {"vtkOriginalCellIds", "vtkOriginalPointIds"}


def merged_grid(data):
    """`data` with each global id's point once, points and cells in the order of their global ids: the same grid
    from any number of ranks. Data without global ids are left in the order that they have."""
    grid = as_grid(data)
    point_ids = grid.GetPointData().GetGlobalIds()
    if point_ids is None:
        return grid
    _, kept, new_number = np.unique(vtk_to_numpy(point_ids), return_index=True, return_inverse=True)
    cell_ids = grid.GetCellData().GetGlobalIds()
    count = grid.GetNumberOfCells()
    order = np.unique(vtk_to_numpy(cell_ids), return_index=True)[1] if cell_ids else np.arange(count)

    offsets, corners = grids.corners_of(grid, order)
    result = grids.make_grid(vtk_to_numpy(grid.GetPoints().GetData())[kept],
                             vtk_to_numpy(grid.GetCellTypesArray())[order], offsets, new_number[corners])
    take(grid.GetPointData(), result.GetPointData(), kept)
    take(grid.GetCellData(), result.GetCellData(), order)
    result.SetFieldData(grid.GetFieldData())
    return result


def as_grid(data):
    if data.IsA("vtkUnstructuredGrid"):
        return data
    append = vtkAppendFilter()
    append.SetInputData(data)
    append.Update()
    return append.GetOutput()


def take(source, target, chosen):
    """Copies the tuples `chosen` of every array bit for bit, the arrays in the order of their names."""
    origin, goal = vtkIdList(), vtkIdList()
    for ids, values in ((origin, chosen), (goal, range(len(chosen)))):
        ids.SetNumberOfIds(len(chosen))
        for position, value in enumerate(values):
            ids.SetId(position, int(value))
    names = {source.GetArrayName(index) for index in range(source.GetNumberOfArrays())}
    for name in sorted(names - ADDED_BY_READERS):
        array = source.GetAbstractArray(name)
        copy = array.NewInstance()
        copy.SetName(name)
        copy.SetNumberOfComponents(array.GetNumberOfComponents())
        copy.SetNumberOfTuples(len(chosen))
        copy.InsertTuples(goal, origin, array)
        target.AddArray(copy)
    target.SetActiveGlobalIds(source.GetGlobalIds().GetName() if source.GetGlobalIds() else None)
