"""Opens a mesh file, of whatever program, as the first filter of the pipeline.

Files that ParaView reads in pieces are read so. Others are read by rank 0 alone, and the first filter that moves
cells shares them out.
"""

import os

from paraview import simple

from cadrefine import files, session
from cadrefine.parts import parts_of
from cadrefine.session import Failure

LARGE = 20_000_000  # Bytes of a file that takes some seconds to read.


def open_mesh(path, terminal):
    """The source of the pipeline whose output is the mesh: a grid or poly data with cells."""
    if os.path.getsize(path) > LARGE:
        terminal.say(f"  reading {path}, {os.path.getsize(path) / 1e6:.0f} MB")
    mesh = open_with_groups(path) if files.can_read(path) else open_in_paraview(path)
    data = local_output(mesh)
    if not (data.IsA("vtkUnstructuredGrid") or data.IsA("vtkPolyData")):
        raise Failure(f"{path}: contains a {data.GetClassName()}, not a mesh with cells")
    if mesh.GetDataInformation().GetNumberOfCells() == 0:
        raise Failure(f"{path}: the mesh has no cells")
    return mesh


def open_with_groups(path):
    mesh = simple.MeshReader(FileName=path)
    session.update(mesh, path)
    return mesh


def open_in_paraview(path):
    """The reader of a mesh file, its blocks merged to one grid."""
    try:
        return read_in_paraview(path)
    except Failure as failure:
        raise blame_part(path, failure) from None


def read_in_paraview(path):
    if path.lower().endswith(".p3d") and not files.start_of(path).startswith(b"{"):  # ParaView ends with a trace.
        raise Failure(f"{path}: ParaView reads .p3d files that name the files of a PLOT3D mesh in JSON, which this one "
                      "does not; save the mesh in another format")
    try:
        reader = simple.OpenDataFile(path)
    except RuntimeError:
        raise Failure(f"{path}: ParaView cannot read this as a mesh") from None
    if reader is None or isinstance(reader, list):
        raise Failure(f"{path}: ParaView cannot read this as a mesh")
    if reader.GetXMLName() == "CADReader":
        raise Failure(f"{path}: this is a CAD file, but a mesh is expected as MESH")
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
