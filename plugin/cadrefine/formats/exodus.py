"""Reads Exodus files: element blocks, and side sets as tagged cells of the boundary."""

from vtkmodules.vtkIOExodus import vtkExodusIIReader

from cadrefine.formats.blocks import LINE, TRIANGLE, joined
from cadrefine.formats.cells import REDUCED, SECOND_ORDER, TYPES
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
    correct_edges(reader.GetOutput())
    names = groups_in(reader.GetOutput())
    grid = joined(reader.GetOutput())
    grid.GetFieldData().Initialize()
    for name, pair in names.items():
        grid.GetFieldData().AddArray(to_vtk(name, [pair]))
    return grid


def correct_edges(data):
    """The reader takes edges of second order, sides of cells of area, for triangles, by their number of nodes."""
    if all(kind_of(grid)[1] < 3 for grid in grids_in(data, "Element Blocks")):
        for grid in grids_in(data, "Side Sets"):
            if grid.GetCellType(0) == TRIANGLE:
                grid.SetCells(SECOND_ORDER[LINE], grid.GetCells())


def grids_in(data, name):
    """The grids with cells in the part of the reader's output with this name; none of a file that could not be read."""
    parts = [data.GetBlock(index) for index in range(data.GetNumberOfBlocks())
             if data.GetMetaData(index).Get(data.NAME()) == name]
    grids = [part.GetBlock(index) for part in parts for index in range(part.GetNumberOfBlocks())]
    return [grid for grid in grids if grid is not None and grid.GetNumberOfCells() > 0]


def kind_of(block):
    """VTK's type of its cells, and their dimension."""
    kind = block.GetCellType(0)
    kind = REDUCED.get(kind, kind)
    return kind, TYPES[kind][1] if kind in TYPES else 3


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
            kind, dimension = kind_of(block)
            whole = next((other for other, (_, of_other) in names.items()
                          if of_other == dimension and kind in ELEMENTS and name == further(other, kind)), None)
            if whole:
                ids.Fill(names[whole][0])
            else:
                names[name] = int(ids.GetValue(0)), dimension
        iterator.GoToNextItem()
    return names
