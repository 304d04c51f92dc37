"""Writes the last mesh, in the format that the file's name tells."""

import itertools
import os

from paraview import servermanager, simple

from cadrefine import files, pieces, session
from cadrefine.formats import BadFile, library, openfoam_writing
from cadrefine.formats.grid import SERIAL
from cadrefine.input import local_output
from cadrefine.merge import merged_grid
from cadrefine.parts import parts_of
from cadrefine.session import Failure

NOT_KEPT = {
    ".xdmf": "global ids, field data but for names of groups",
    ".msh": "cell arrays but for groups, global ids, field data but for names of groups",
    ".med": "arrays, but for groups",
    ".exo": "arrays, but for groups",
    ".e": "arrays, but for groups",
    ".inp": "arrays, but for groups",
    ".cgns": "arrays, but for groups of cells, facets and edges",
    ".bdf": "arrays, but for the first group of each cell; edges of second order",
    ".unv": "arrays, but for groups of cells, facets and edges",
    ".mesh": "arrays, but for the number of the first group of each cell",
    ".su2": "arrays, but for groups of facets on the boundary",
    ".foam": "arrays, but for groups",
}
FORMATS = (".vtu", ".pvtu", *NOT_KEPT)
NEEDED = {".med": "h5py", ".cgns": "h5py", ".exo": "scipy", ".e": "scipy"}  # Python packages.
LINEAR_ONLY = {".su2": "SU2", ".foam": "OpenFOAM", ".mesh": "Medit"}


def ending(path):
    return os.path.splitext(path)[1]


def check(place, quadratic):
    """Finds what would keep the last mesh from being written."""
    try:
        if ending(place) in NEEDED:
            library(NEEDED[ending(place)])
    except BadFile as error:
        raise Failure(f"{place}: {error}") from None
    if quadratic and not takes_quadratic(place):
        raise Failure(f"{place}: {LINEAR_ONLY[ending(place)]} has no quadratic cells; leave out --quadratic")


def takes_quadratic(place):
    return not place or ending(place) not in LINEAR_ONLY


def place_of(path):
    """A folder stands for the OpenFOAM case in it."""
    return os.path.join(path, os.path.basename(os.path.abspath(path)) + ".foam") if os.path.isdir(path) else path


def companions(path):
    """Names of the other files that a result in this format consists of, or is made from."""
    name = path.replace("\\", "/").rpartition("/")[2]
    if path.endswith(".xdmf"):
        return [name[: -len(".xdmf")] + ".h5", SERIAL + name]
    if path.endswith(".foam"):
        return [f"{openfoam_writing.FOLDER}/{file}" for file in openfoam_writing.FILES]
    if path.endswith(".pvtu"):
        folder = name[: -len(".pvtu")]
        return [f"{folder}/{folder}_{rank}.vtu" for rank in range(session.ranks())]
    return []


def files_of(place):
    """Paths of all files that the result at `place`, of any kind, will consist of, or takes away."""
    folder = os.path.dirname(place)
    files = [place, *(os.path.join(folder, name) for name in companions(place))]
    return files + (parts_of(place) if place.endswith(".pvtu") and os.path.isfile(place) else [])


def write(proxy, path, options):
    """Writes the output of `proxy` to `path`, which will later be `options.output`. Failures name that. A mesh that the
    format cannot hold is kept in a .vtu file beside it."""
    place = options.output
    session.messages.take()
    try:
        if path.endswith(".pvtu"):
            pieces.write_pieces(proxy, path)
        else:
            grid = gathered(proxy)
            if session.speaks():
                grid = merged_grid(grid)
                try:
                    write_grid(grid, path, options)
                except BadFile as error:
                    kept = free_name(os.path.splitext(place)[0], ".vtu")
                    pieces.write_grid(grid, kept)
                    raise Failure(f"{place}: {error}; the mesh is in {kept}") from None
    except OSError as error:
        raise Failure(f"{place}: {error.strerror or error}") from None
    except RuntimeError as error:
        session.messages.errors.append(str(error))
    session.raise_errors(place)


def free_name(stem, ending):
    names = itertools.chain([stem + ending], (f"{stem}_{number}{ending}" for number in itertools.count(1)))
    return next(name for name in names if not os.path.exists(name))


def write_grid(grid, path, options):
    if path.endswith(".vtu"):
        pieces.write_grid(grid, path)
    else:
        files.write_grid(grid, path, options.msh_version, options.ascii)


def gathered(proxy):
    """All pieces of the output, appended, on rank 0; the other ranks get nothing of use. (servermanager.Fetch would
    do, but ParaView 5.11 cuts what it gathered into pieces again and returns the first.)"""
    reducer = servermanager.filters.ReductionFilter(Input=proxy)
    reducer.PostGatherHelperName = "vtkAppendFilter"
    reducer.UpdatePipeline()
    data = local_output(reducer)
    result = data.NewInstance()
    result.ShallowCopy(data)
    simple.Delete(reducer)
    return result


def remarks(place):
    """What the reader of the file should know."""
    for ending, what in NOT_KEPT.items():
        if place and place.endswith(ending):
            yield f"Not kept in {place}: {what}"
