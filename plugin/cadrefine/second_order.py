"""Meshes of second order: the filters take them by their corners, and make them quadratic again at the end."""

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from cadrefine.formats import cells
from cadrefine.formats import grid as grids
from cadrefine.merge import take
from cadrefine.pieces import of_all_ranks

# VTK's types of cells of second order, and their linear types; corners come first.
LINEAR = {**cells.LINEAR, **{kind: cells.LINEAR[reduced] for kind, reduced in cells.REDUCED.items()}}

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
    here = data.IsA("vtkUnstructuredGrid") and data.GetNumberOfCells() \
        and np.isin(vtk_to_numpy(data.GetCellTypesArray()), list(LINEAR)).any()
    found = max(of_all_ranks(int(here))) == 1


def by_corners(data):
    """The grid without mid nodes; points that no cell has for its corner go."""
    if data.GetNumberOfCells() == 0:
        return data
    linear, count = np.arange(256), np.full(256, np.iinfo(int).max)
    for kind, of_corners in LINEAR.items():
        linear[kind], count[kind] = of_corners, cells.CORNERS[of_corners]
    types = vtk_to_numpy(data.GetCellTypesArray())
    sizes = np.minimum(np.diff(vtk_to_numpy(data.GetCells().GetOffsetsArray())), count[types])
    offsets, corners = grids.corners_of(data, np.arange(len(types)), sizes)
    kept, corners = np.unique(corners, return_inverse=True)

    result = grids.make_grid(vtk_to_numpy(data.GetPoints().GetData())[kept], linear[types], offsets, corners)
    take(data.GetPointData(), result.GetPointData(), kept)
    result.GetCellData().ShallowCopy(data.GetCellData())
    result.SetFieldData(data.GetFieldData())
    return result
