"""Meshes of second order: the filters take them by their corners, and make them quadratic again at the end."""

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController

from cadrefine.formats import grid as grids
from cadrefine.merge import take

# VTK's types of cells of second order: the linear type, and its corners, which come first.
LINEAR = {21: (3, 2), 22: (5, 3), 34: (5, 3), 23: (9, 4), 28: (9, 4), 24: (10, 4), 25: (12, 8), 29: (12, 8),
          26: (13, 6), 27: (14, 5)}

# Run on every rank, in the process of the driver on rank 0.
LOOK = """
from cadrefine import second_order
second_order.look(self.GetInputDataObject(0, 0))
"""
TAKE_CORNERS = """
from cadrefine import second_order
self.GetOutput().ShallowCopy(second_order.by_corners(self.GetInputDataObject(0, 0)))
"""
found = False  # After look(): whether any rank has such cells.


def with_corners_alone(proxy):
    """A filter that gives the mesh of `proxy` by its corners, or None where it is linear already."""
    looking = simple.ProgrammableFilter(Input=proxy, Script=LOOK, CopyArrays=0)
    looking.UpdatePipeline()
    simple.Delete(looking)
    if not found:
        return None
    return simple.ProgrammableFilter(Input=proxy, Script=TAKE_CORNERS, CopyArrays=0)


def look(data):
    global found
    mine, most = vtkIntArray(), vtkIntArray()
    for array in (mine, most):
        array.InsertNextValue(0)
    if data.IsA("vtkUnstructuredGrid") and data.GetNumberOfCells():
        mine.SetValue(0, int(np.isin(vtk_to_numpy(data.GetCellTypesArray()), list(LINEAR)).any()))
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is not None and controller.GetNumberOfProcesses() > 1:
        controller.AllReduce(mine, most, vtkCommunicator.MAX_OP)
        mine = most
    found = bool(mine.GetValue(0))


def by_corners(data):
    """The grid without mid nodes; points that no cell has for its corner go."""
    if data.GetNumberOfCells() == 0:
        return data
    linear, count = np.arange(256), np.full(256, np.iinfo(int).max)
    for kind, (of_corners, corners) in LINEAR.items():
        linear[kind], count[kind] = of_corners, corners
    types = vtk_to_numpy(data.GetCellTypesArray())
    offsets = vtk_to_numpy(data.GetCells().GetOffsetsArray())
    sizes = np.minimum(np.diff(offsets), count[types])
    new_offsets = np.concatenate([[0], np.cumsum(sizes)])
    within = np.arange(new_offsets[-1]) - np.repeat(new_offsets[:-1], sizes)
    corners = vtk_to_numpy(data.GetCells().GetConnectivityArray())[np.repeat(offsets[:-1], sizes) + within]
    kept, corners = np.unique(corners, return_inverse=True)

    result = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetData(grids.to_vtk("Points", vtk_to_numpy(data.GetPoints().GetData())[kept]))
    result.SetPoints(points)
    grids.set_cells(result, linear[types], new_offsets, corners)
    take(data.GetPointData(), result.GetPointData(), kept)
    result.GetCellData().ShallowCopy(data.GetCellData())
    result.SetFieldData(data.GetFieldData())
    return result
