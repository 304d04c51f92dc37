"""Reads Exodus files: element blocks, and side sets as tagged cells of the boundary."""

from vtkmodules.vtkIOExodus import vtkExodusIIReader

from cadrefine.formats.blocks import joined
from cadrefine.formats.cells import REDUCED, TYPES
from cadrefine.formats.exodus_writing import ELEMENTS, further
from cadrefine.formats.grid import to_vtk

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
    names = groups_in(reader.GetOutput())
    grid = joined(reader.GetOutput())
    grid.GetFieldData().Initialize()
    for name, pair in names.items():
        grid.GetFieldData().AddArray(to_vtk(name, [pair]))
    return grid


def groups_in(data):
    """{name: number and dimension} of the blocks and sets. The blocks of one group, which this writer makes of cells of
    several types, get one number."""
    names = {}
    iterator = data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        block = iterator.GetCurrentDataObject()
        name = iterator.GetCurrentMetaData().Get(data.NAME())
        ids = block.GetCellData().GetArray(ID)
        if name and ids is not None and block.GetNumberOfCells() > 0:
            kind = block.GetCellType(0)
            kind = REDUCED.get(kind, kind)
            dimension = TYPES[kind][1] if kind in TYPES else 3
            whole = next((other for other, (_, of_other) in names.items()
                          if of_other == dimension and kind in ELEMENTS and name == further(other, kind)), None)
            if whole:
                ids.Fill(names[whole][0])
            else:
                names[name] = int(ids.GetValue(0)), dimension
        iterator.GoToNextItem()
    return names
