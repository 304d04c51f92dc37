"""Reads Exodus files: element blocks, and side sets as tagged cells of the boundary."""

from vtkmodules.vtkIOExodus import vtkExodusIIReader

from cadrefine.formats.blocks import joined
from cadrefine.formats.grid import TYPES, to_vtk

ID = "ObjectId"  # Cell array of the reader: the number of the block or side set.
OBJECTS = (vtkExodusIIReader.ELEM_BLOCK, vtkExodusIIReader.SIDE_SET)
RESULTS = (vtkExodusIIReader.NODAL, vtkExodusIIReader.ELEM_BLOCK, vtkExodusIIReader.SIDE_SET)


def read(path):
    """The first time step as one grid. Names of blocks and sets become field data: their number and dimension."""
    reader = vtkExodusIIReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.GenerateObjectIdCellArrayOn()
    reader.SetSqueezePoints(0)  # Squeezed points would be in single precision.
    for kind in OBJECTS:
        for index in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, index, 1)
    for kind in RESULTS:
        for index in range(reader.GetNumberOfObjectArrays(kind)):
            name = reader.GetObjectArrayName(kind, index)
            reader.SetObjectArrayStatus(kind, name, 1)
    reader.Update()
    grid = joined(reader.GetOutput())
    grid.GetFieldData().Initialize()
    add_names(grid, reader.GetOutput())
    return grid


def add_names(grid, data):
    iterator = data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        block = iterator.GetCurrentDataObject()
        name = iterator.GetCurrentMetaData().Get(data.NAME())
        ids = block.GetCellData().GetArray(ID)
        if name and ids is not None and block.GetNumberOfCells() > 0:
            dimension = TYPES[block.GetCellType(0)][1] if block.GetCellType(0) in TYPES else 3
            grid.GetFieldData().AddArray(to_vtk(name, [[int(ids.GetValue(0)), dimension]]))
        iterator.GoToNextItem()
