"""Adapts a mesh of numpy arrays to its CAD, without ParaView's window or pipeline: adapt.py MESH CAD OUTPUT.

Tetrahedra of any file that meshio reads. Runs in pvpython, and in python3 where it finds ParaView's vtkmodules.
"""

import sys

import meshio
import numpy as np
from cadrefine import vtkAdaptToCAD, vtkCADReader
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid


def grid_of(points, tetrahedra):
    """numpy arrays (vertices x 3, tetrahedra x 4) as VTK's mesh."""
    grid, coordinates, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    coordinates.SetData(numpy_to_vtk(np.asarray(points, dtype=float), deep=True))
    cells.SetData(4, numpy_to_vtkIdTypeArray(np.asarray(tetrahedra, dtype=np.int64).ravel(), deep=True))
    grid.SetPoints(coordinates)
    grid.SetCells(VTK_TETRA, cells)
    return grid


if len(sys.argv) != 4:
    sys.exit("usage: adapt.py MESH CAD OUTPUT")
mesh = meshio.read(sys.argv[1])
cad = vtkCADReader()
cad.SetFileName(sys.argv[2])

adapt = vtkAdaptToCAD()
adapt.SetInputData(grid_of(mesh.points, mesh.cells_dict["tetra"]))
adapt.SetCADConnection(cad.GetOutputPort())
adapt.SetMaximumSteps(3)
adapt.SetErrorMarking(adapt.BULK)
adapt.Update()

grid = adapt.GetOutput()
points = vtk_to_numpy(grid.GetPoints().GetData())
tetrahedra = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
error = vtk_to_numpy(grid.GetCellData().GetArray("GeometricError"))
distance = vtk_to_numpy(grid.GetPointData().GetArray("CADDistance"))
print(f"{len(points)} vertices, {len(tetrahedra)} tetrahedra, geometric error {error.sum():.4g}, "
      f"farthest vertex {np.nanmax(distance):.2g} from the CAD")
meshio.write(sys.argv[3], meshio.Mesh(points, {"tetra": tetrahedra}, cell_data={"GeometricError": [error]}))
