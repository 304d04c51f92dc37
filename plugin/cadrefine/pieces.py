"""Writes VTK's XML files of unstructured grids, whole or a piece a rank, and tells where the disk is full.

ParaView's own way cannot: where it is, vtkXMLUnstructuredGridWriter of VTK 9.2 frees pointers that it has never set,
unless it has written appended data before. Appended data themselves VTK 9.2 cannot read back where libexpat has the
corrections of 2024; that of ParaView 5.13 can, so that this may go with Debian 12.
"""

import errno
import os
import sys
import xml.etree.ElementTree as ElementTree

from paraview import simple
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from cadrefine.merge import as_grid

# Runs on every rank, in the process of the driver on rank 0.
WRITE_PIECE = """
from cadrefine import pieces
pieces.write_piece(self.GetInputDataObject(0, 0), {path!r})
"""
NOTHING, WRITTEN, FAILED = 0, 1, 2  # What becomes of a piece; FAILED + n: with the system's error n.
OUT_OF_DISK_SPACE = 20007  # Of vtkErrorCode.
states = []  # Of all ranks' pieces, after write_piece.


def write_pieces(proxy, path):
    """The output of `proxy` as `path`, a .pvtu file, and the piece of each rank. Throws OSError."""
    script = WRITE_PIECE.format(path=os.path.abspath(path))
    writer = simple.ProgrammableFilter(Input=proxy, Script=script, CopyArrays=0)
    try:
        writer.UpdatePipeline()
        raise_failure(max(sys.modules[__name__].states))
        data = as_grid(proxy.GetClientSideObject().GetOutputDataObject(0))
        ranks = [rank for rank, state in enumerate(states) if state == WRITTEN]
        index_of(data, [f"{stem}/{os.path.basename(piece)}" for stem, piece in
                        ((stem_of(path), piece_path(path, rank)) for rank in ranks)]).write(path)
    finally:
        simple.Delete(writer)


def stem_of(path):
    return os.path.splitext(os.path.basename(path))[0]


def piece_path(path, rank):
    return os.path.join(os.path.dirname(path), stem_of(path), f"{stem_of(path)}_{rank}.vtu")


def write_piece(data, path):
    """This rank's, unless it is empty. All ranks do so together, and know then of each other's."""
    controller = vtkMultiProcessController.GetGlobalController()
    rank = controller.GetLocalProcessId() if controller else 0
    states[:] = of_all_ranks(state_of_piece(data, piece_path(path, rank)))


def of_all_ranks(value):
    """The integers that the ranks gave, on each of them. Collective."""
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is None or controller.GetNumberOfProcesses() == 1:
        return [value]
    mine, all_values = vtkIntArray(), vtkIntArray()
    mine.InsertNextValue(value)
    controller.AllGather(mine, all_values)
    return [all_values.GetValue(rank) for rank in range(all_values.GetNumberOfValues())]


def state_of_piece(data, path):
    """What becomes of it. No exception may end one rank alone."""
    if not data.GetNumberOfPoints():
        return NOTHING
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        write_grid(as_grid(data), path)
        return WRITTEN
    except OSError as error:
        return FAILED + (error.errno or 0)
    except Exception:  # Such as too little memory.
        return FAILED


def write_grid(grid, path):
    """A whole .vtu file. Throws OSError."""
    writer = safe_writer(grid)
    writer.SetHeaderTypeToUInt64()
    writer.SetFileName(path)
    if writer.Write() and not writer.GetErrorCode():
        return
    number = errno.ENOSPC if writer.GetErrorCode() == OUT_OF_DISK_SPACE else writer.GetErrorCode()
    raise_failure(FAILED + (number if number in errno.errorcode else 0))


def raise_failure(state):
    if state == FAILED:
        raise OSError("could not be written")
    if state > FAILED:
        raise OSError(state - FAILED, os.strerror(state - FAILED))


def safe_writer(grid):
    writer = vtkXMLUnstructuredGridWriter()
    writer.WriteToOutputStringOn()
    writer.SetInputData(vtkUnstructuredGrid())
    writer.SetDataModeToAppended()
    writer.Write()
    writer.WriteToOutputStringOff()
    writer.SetInputData(without_names(grid))
    writer.SetDataModeToBinary()
    return writer


def without_names(grid):
    """Without the names of the CAD's faces: meshio reads no file with an array of text."""
    result = grid.NewInstance()
    result.ShallowCopy(grid)
    result.GetCellData().RemoveArray("CADName")
    return result


def index_of(grid, pieces):
    """The tree of a .pvtu file of pieces that have the arrays of `grid`."""
    writer = safe_writer(without_values(grid))
    writer.WriteToOutputStringOn()
    writer.Write()
    root = ElementTree.fromstring(writer.GetOutputString())
    inside = root.find("UnstructuredGrid")
    piece = inside.find("Piece")
    inside.remove(piece)
    root.set("type", "PUnstructuredGrid")
    inside.tag = "PUnstructuredGrid"
    inside.set("GhostLevel", "0")
    for name in ("PointData", "CellData", "Points"):
        inside.append(declaration_of(piece.find(name)))
    for source in pieces:
        ElementTree.SubElement(inside, "Piece", Source=source)
    ElementTree.indent(root)
    return ElementTree.ElementTree(root)


def without_values(grid):
    """Points, cells: none; the same arrays, of no length, but for field data."""
    result = vtkUnstructuredGrid()
    points = vtkPoints()
    points.SetDataType(grid.GetPoints().GetDataType())
    result.SetPoints(points)
    for source, target in ((grid.GetPointData(), result.GetPointData()), (grid.GetCellData(), result.GetCellData())):
        target.CopyAllOn()
        target.CopyAllocate(source, 0)
    result.SetFieldData(grid.GetFieldData())
    return result


def declaration_of(section):
    """<PointData> becomes <PPointData>, and so on, without values."""
    result = ElementTree.Element("P" + section.tag, section.attrib)
    for array in section:
        kept = {key: value for key, value in array.attrib.items()
                if key in ("type", "IdType", "Name", "NumberOfComponents") or key.startswith("ComponentName")}
        ElementTree.SubElement(result, "P" + array.tag, kept)
    return result
