"""Opens a mesh file, of whatever program, as the first filter of the pipeline.

Files that ParaView reads in pieces are read so. Others are read by rank 0 alone, and the first filter that moves
cells shares them out.
"""

import contextlib
import functools
import importlib
import io
import os

from paraview import simple

from cadrefine import session
from cadrefine.formats import BadFile, library
from cadrefine.formats.grid import check, from_grid, to_grid
from cadrefine.formats.sides import once
from cadrefine.parts import parts_of
from cadrefine.session import Failure

EXODUS = (".e", ".ex2", ".exo", ".exii", ".g")
XDMF = (".xdmf", ".xmf")
MESHIO = {".mesh": "medit", ".meshb": "medit", ".vol": "netgen"}  # Its modules by extension.
# Modules of cadrefine.formats.
OWN = {".su2": "su2", ".med": "med", ".foam": "openfoam", ".unv": "unv", ".bdf": "nastran", ".nas": "nastran",
       ".fem": "nastran"}

HDF5 = b"\x89HDF"  # How such files begin.

# Runs on every rank, in the process of the driver on rank 0, whose grid it hands over.
HAND_OVER = f"""
import sys
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
if controller is None or controller.GetLocalProcessId() == 0:
    self.GetOutput().ShallowCopy(sys.modules[{__name__!r}].handed_over)
"""
handed_over = None
LARGE = 20_000_000  # Bytes of a file that takes some seconds to read.


def open_mesh(path, terminal):
    """The source of the pipeline whose output is the mesh: a grid or poly data with cells."""
    read = own_reader(path)
    if os.path.getsize(path) > LARGE:
        terminal.say(f"  reading {path}, {os.path.getsize(path) / 1e6:.0f} MB")
    mesh = open_in_paraview(path) if read is None else hand_over(read_grid(read, path), path)
    data = local_output(mesh)
    if not (data.IsA("vtkUnstructuredGrid") or data.IsA("vtkPolyData")):
        raise Failure(f"{path}: holds a {data.GetClassName()}, not a mesh of triangles or tetrahedra")
    if mesh.GetDataInformation().GetNumberOfCells() == 0:
        raise Failure(f"{path}: the mesh has no cells")
    return mesh


def own_reader(path):
    """A function that makes a vtkUnstructuredGrid of the file, or None where ParaView reads it."""
    ending = os.path.splitext(path)[1].lower()
    ending = ".foam" if os.path.isdir(path) else ending
    start = b"" if os.path.isdir(path) else start_of(path)
    formats = functools.partial(importlib.import_module, package="cadrefine.formats")

    def grid_of(module, *arguments):
        def read():
            mesh = formats("." + module).read(path, *arguments)
            check(mesh)
            return to_grid(once(mesh))
        return read

    if ending == ".msh" and (start.startswith(b"$") or b"$MeshFormat" in start):  # Else it is one of Fluent.
        return grid_of("msh")
    if ending == ".inp" and start.startswith(b"*"):  # Else it is one of AVS UCD.
        return grid_of("abaqus")
    if ending == ".cgns" and start.startswith(HDF5) and not has_labels(path):  # meshio's, which is none to others.
        return grid_of("meshio", "cgns")
    if ending in OWN:
        return grid_of(OWN[ending])
    if ending in MESHIO:
        return grid_of("meshio", MESHIO[ending])
    if ending in XDMF:
        return lambda: formats(".xdmf").read(path)
    if ending in EXODUS:
        return lambda: with_cells_once(formats(".exodus").read(path))
    return None


def with_cells_once(grid):
    return to_grid(once(from_grid(grid))) if grid.GetNumberOfCells() else grid


def start_of(path):
    with open(path, "rb") as file:
        return file.read(1000).lstrip()


def has_labels(path):
    """Whether a CGNS file in HDF5 has the labels by which other programs know what is in it."""
    with contextlib.suppress(BadFile, OSError), library("h5py").File(path, "r") as file:
        return "label" in file.attrs
    return True


def read_grid(read, path):
    session.messages.take()
    try:
        with silence():
            grid = read()
    except BadFile as error:
        raise Failure(f"{path}: {error}") from None
    session.raise_errors(path)
    return grid


@contextlib.contextmanager
def silence():
    """Libraries write their own warnings and errors, from Python and from C; ours is one line."""
    session.flush()
    kept = {number: os.dup(number) for number in (1, 2)}
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in kept:
            os.dup2(nowhere, number)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            yield
    finally:
        for number, copy in kept.items():
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)


def hand_over(grid, path):
    """A source whose output is `grid` on rank 0, and empty on the others."""
    global handed_over
    handed_over = grid
    source = simple.ProgrammableSource(Script=HAND_OVER, OutputDataSetType="vtkUnstructuredGrid")
    session.update(source, path)
    return source


def open_in_paraview(path):
    """The reader of a mesh file, its blocks merged to one grid."""
    try:
        return read_in_paraview(path)
    except Failure as failure:
        raise blame_part(path, failure) from None


def read_in_paraview(path):
    try:
        reader = simple.OpenDataFile(path)
    except RuntimeError:
        raise Failure(f"{path}: ParaView cannot read this as a mesh") from None
    if reader is None or isinstance(reader, list):
        raise Failure(f"{path}: ParaView cannot read this as a mesh")
    if reader.GetXMLName() == "CADReader":
        raise Failure(f"{path}: this is a CAD file where a mesh is due")
    session.update_reader(reader, path)
    if reader.GetXMLName() == "FLUENTReader" and reader.GetDataInformation().GetNumberOfDataSets() == 0:
        raise Failure(f"{path}: ParaView cannot read this as a mesh")  # This reader finds no fault with any text.
    if not local_output(reader).IsA("vtkCompositeDataSet"):
        return reader
    mesh = simple.MergeBlocks(Input=reader)
    session.update_reader(mesh, path)
    return mesh


def blame_part(path, failure):
    """The failure to read a file that consists of several, with the name of the one that cannot be read."""
    for part in parts_of(path):
        try:
            session.check_readable(part)
            open_in_paraview(part)
        except Failure as reason:
            return Failure(f"{path}: its part {reason}")
    return failure


def local_output(proxy):
    """This rank's piece of the output: the driver and the pipeline share a process."""
    return proxy.GetClientSideObject().GetOutputDataObject(0)
