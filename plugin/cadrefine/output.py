"""Writes the last mesh, in the format that the file's name tells."""

import os

from paraview import servermanager, simple

from cadrefine import pieces, session
from cadrefine.formats.grid import SERIAL, from_grid
from cadrefine.input import local_output, silence
from cadrefine.merge import merged_grid
from cadrefine.parts import parts_of
from cadrefine.session import Failure

NOT_KEPT = {
    ".xdmf": "names of groups, global ids, field data",
    ".msh": "cell arrays but for tags, global ids, field data but for names of groups",
}
FORMATS = (".vtu", ".pvtu", *NOT_KEPT)


def companions(path):
    """Names of the other files that a result in this format consists of, or is made from."""
    name = path.replace("\\", "/").rpartition("/")[2]
    if path.endswith(".xdmf"):
        return [name[: -len(".xdmf")] + ".h5", SERIAL + name]
    if path.endswith(".pvtu"):
        folder = name[: -len(".pvtu")]
        return [f"{folder}/{folder}_{rank}.vtu" for rank in range(session.ranks())]
    return []


def files_of(place):
    """Paths of all files that the result at `place`, of any kind, will consist of, or takes away."""
    folder = os.path.dirname(place)
    files = [place, *(os.path.join(folder, name) for name in companions(place))]
    return files + (parts_of(place) if place.endswith(".pvtu") and os.path.isfile(place) else [])


def write(proxy, path, place):
    """Writes the output of `proxy` to `path`, which will later be `place`. Failures name `place`."""
    session.messages.take()
    try:
        if path.endswith(".pvtu"):
            pieces.write_pieces(proxy, path)
        else:
            grid = gathered(proxy)
            if session.speaks():
                write_grid(merged_grid(grid), path)
    except OSError as error:
        raise Failure(f"{place}: {error.strerror or error}") from None
    except RuntimeError as error:
        session.messages.errors.append(str(error))
    session.raise_errors(place)


def write_grid(grid, path):
    if path.endswith(".vtu"):
        pieces.write_grid(grid, path)
        return
    mesh = from_grid(grid)
    if path.endswith(".msh"):
        from cadrefine.formats import msh

        msh.write(path, mesh)
    else:
        from cadrefine.formats import xdmf

        with silence():
            xdmf.write(path, mesh)


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
