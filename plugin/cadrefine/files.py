"""Meshes in files of other programs: what the proxies Mesh Reader and Mesh Writer call, on one rank, in whatever
process of ParaView. Nothing here knows of ParaView's client, or of the driver."""

import contextlib
import functools
import importlib
import os
import tempfile

from cadrefine import messages
from cadrefine.exchange import carry_out, exchange
from cadrefine.formats import BadFile, library
from cadrefine.formats.grid import check, from_grid, to_grid
from cadrefine.formats.sides import check_pyramids, once, turned_alike
from cadrefine.merge import merged_grid

EXODUS = (".e", ".ex2", ".exo", ".exii", ".g")
XDMF = (".xdmf", ".xmf")
MESHIO = {".mesh": "medit", ".meshb": "medit", ".vol": "netgen"}  # Its modules by extension.
# Modules of cadrefine.formats.
OWN = {".su2": "su2", ".med": "med", ".foam": "openfoam", ".unv": "unv", ".bdf": "nastran", ".nas": "nastran",
       ".fem": "nastran"}
WRITERS = {".msh": "msh_writing", ".xdmf": "xdmf", ".med": "med", ".exo": "exodus_writing", ".e": "exodus_writing",
           ".inp": "abaqus", ".su2": "su2", ".cgns": "cgns_writing", ".bdf": "nastran_writing", ".unv": "unv_writing",
           ".mesh": "medit_writing", ".foam": "openfoam_writing"}

HDF5 = b"\x89HDF"  # How such files begin.


def can_read(path):
    try:
        return reader_of(path) is not None
    except OSError:
        return False


def read(path, grid):
    """Reads the file into `grid`; returns why that failed, or an empty text."""
    return failure(path, lambda: grid.ShallowCopy(quietly(reader_of(path) or unknown)))


def write(grid, path, version, ascii):
    """Writes the file, whole or not at all; returns why that failed, or an empty text."""

    def write_beside():
        """Made in a folder beside its place, and put there at the end."""
        folder, name = os.path.split(os.path.abspath(path))
        with tempfile.TemporaryDirectory(prefix=name + ".", suffix=".part", dir=folder) as made:
            write_grid(merged_grid(grid), os.path.join(made, name), version, ascii)
            carry_out(exchange(made, path))

    return failure(path, write_beside)


def write_grid(grid, path, version, ascii):
    """Throws BadFile, OSError."""
    ending = os.path.splitext(path)[1]
    if ending not in WRITERS:
        raise BadFile(f"the name must end in {', '.join(WRITERS)}")
    if not grid.GetNumberOfCells():
        raise BadFile("there are no cells to write")
    module = importlib.import_module("cadrefine.formats." + WRITERS[ending])
    how = {"version": version, "ascii": bool(ascii)} if ending == ".msh" else {}
    quietly(lambda: module.write(path, from_grid(grid), **how))


def failure(path, work):
    """Why `work` failed, in a line that names the file; an empty text where it did not."""
    try:
        work()
        return ""
    except BadFile as error:
        reason = str(error)
    except OSError as error:
        reason = error.strerror or str(error)
    except Exception as error:  # Of a library, or a fault: the window and all ranks go on.
        reason = f"{type(error).__name__}: {error}"
    return " ".join((reason if path in reason else f"{path}: {reason}").split())


def quietly(work):
    """What libraries say themselves is not printed; what VTK says is wrong is a BadFile."""
    with messages.silence() as said:
        result = work()
    for reason in messages.reasons(said):
        raise BadFile(reason)
    return result


def unknown():
    raise BadFile("is not in a format that can be read here")


def reader_of(path):
    """A function that makes a vtkUnstructuredGrid of the file, or None where ParaView reads it."""
    ending = os.path.splitext(path)[1].lower()
    ending = ".foam" if os.path.isdir(path) else ending
    start = b"" if os.path.isdir(path) else start_of(path)
    formats = functools.partial(importlib.import_module, package="cadrefine.formats")

    def grid_of(module, *arguments):
        def read_mesh():
            mesh = formats("." + module).read(path, *arguments)
            check(mesh)
            check_pyramids(mesh)
            return to_grid(turned_alike(once(mesh)))
        return read_mesh

    if ending == ".msh" and (start.startswith(b"$") or b"$MeshFormat" in start):  # Else it is one of Fluent.
        return grid_of("msh")
    if ending == ".inp" and start.startswith(b"*"):  # Else it is one of AVS UCD.
        return grid_of("abaqus")
    if ending == ".cgns" and start.startswith(HDF5):  # Else it is an old one (ADF). meshio's is none to others.
        return grid_of("cgns") if has_labels(path) else grid_of("meshio", "cgns")
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
    return to_grid(turned_alike(once(from_grid(grid)))) if grid.GetNumberOfCells() else grid


def start_of(path):
    with open(path, "rb") as file:
        return file.read(1000).lstrip()


def has_labels(path):
    """Whether a CGNS file in HDF5 has the labels by which other programs know what is in it."""
    with contextlib.suppress(BadFile, OSError), library("h5py").File(path, "r") as file:
        return "label" in file.attrs
    return True
