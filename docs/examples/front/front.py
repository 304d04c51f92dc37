"""A front that moves through the mesh, in place of a solver: refined where it is, coarsened where it was.

    front.py MESH CAD OUTPUT [STEPS]

Tetrahedra of any file that ParaView reads as an unstructured grid (.vtu). Prints a row a step.
"""

import sys

import numpy as np
from cadrefine import vtkAdaptToCAD, vtkCADGeometricError, vtkCADReader, vtkProjectOntoCAD
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_TETRA
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

THRESHOLD = 0.3  # Of the indicator: cells are refined above,
FRACTION = 0.25  # coarsened below this part of it.
WIDTH = 0.35  # Of the front.
BEGIN, END = 0.45, 0.65  # Where it starts and ends, in parts of the mesh's length.
SETTLING = 16  # Steps before, until cells are as small as they have to be.


def indicator(grid, place):
    """Length of the longest edge, times a bell round the plane x = place; of each cell."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    values = np.zeros(grid.GetNumberOfCells())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    tetrahedra = np.flatnonzero(types == VTK_TETRA)
    corners = points[connectivity[offsets[tetrahedra][:, None] + np.arange(4)]]
    edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    lengths = np.max([np.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i, j in edges], axis=0)
    values[tetrahedra] = lengths * np.exp(-0.5 * ((corners[:, :, 0].mean(axis=1) - place) / WIDTH) ** 2)
    array = numpy_to_vtk(values, deep=True)
    array.SetName("Indicator")
    return array


def value(grid, name):
    return grid.GetFieldData().GetArray(name).GetTuple1(0)


def measured(cad, grid):
    measure = vtkCADGeometricError()
    measure.SetInputData(grid)
    measure.SetCADConnection(cad.GetOutputPort())
    measure.SetRecursionDepth(0)
    measure.Update()
    return value(measure.GetOutput(), "GlobalGeometricError")


def step(cad, grid, place, target):
    """The mesh for the front at this place."""
    grid.GetCellData().AddArray(indicator(grid, place))
    adapt = vtkAdaptToCAD()
    adapt.SetInputData(grid)
    adapt.SetCADConnection(cad.GetOutputPort())
    adapt.StartProjectedOn()
    adapt.SetMaximumSteps(1)
    adapt.SetErrorMarking(adapt.OFF)
    adapt.SetIndicatorArray("Indicator")
    adapt.SetIndicatorThreshold(THRESHOLD)
    adapt.CutFacetsOff()
    adapt.SetCoarseningFraction(FRACTION)
    adapt.SetTargetError(target)
    adapt.Update()
    return adapt.GetOutput()


def main(mesh, cad_file, output, steps):
    reader, cad, project = vtkXMLUnstructuredGridReader(), vtkCADReader(), vtkProjectOntoCAD()
    reader.SetFileName(mesh)
    cad.SetFileName(cad_file)
    project.SetInputConnection(reader.GetOutputPort())
    project.SetCADConnection(cad.GetOutputPort())
    project.Update()
    grid = project.GetOutput()
    target = measured(cad, grid)
    print(f"geometric error of the first mesh, which is the target: {target:.4g}")
    low, high = grid.GetBounds()[:2]
    begin, end = (low + (high - low) * part for part in (BEGIN, END))
    print("step  front   cells  geometric error  invalid")
    for number in range(-SETTLING, steps):
        place = begin + (end - begin) * number / steps
        grid = step(cad, grid, place, target)
        if number < 0:
            continue
        print(f"{number:4d} {place:6.2f} {value(grid, 'GlobalCells'):7.0f} {value(grid, 'GlobalGeometricError'):16.4g} "
              f"{value(grid, 'InvalidCells'):8.0f}", flush=True)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(output)
    writer.SetDataModeToBinary()
    writer.SetInputData(grid)
    if not writer.Write():
        sys.exit(f"{output} could not be written")


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    main(*sys.argv[1:4], int(sys.argv[4]) if len(sys.argv) == 5 else 20)
