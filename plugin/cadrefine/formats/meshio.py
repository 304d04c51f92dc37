"""Reads files of other programs through the Python package meshio."""

import numpy as np

from cadrefine.formats import BadFile, library
from cadrefine.formats.cells import REDUCED_NAMES, TYPE_OF_NAME, TYPES
from cadrefine.formats.grid import PHYSICAL, Mesh, tag_array

NOT_KEPT = {"medit:ref", "gmsh:dim_tags"}  # Tags of points, which could only be interpolated.


def read(path, module):
    """The Mesh that meshio's `module` makes of the file. Sets of cells become cell arrays of 0 and 1, and, where the
    file has no other tags, groups: a cell of several sets is in the first of them. Throws BadFile."""
    reader = library("meshio." + module)
    try:
        return converted(reader.read(path))
    except BadFile:
        raise
    except (Exception, SystemExit) as error:  # meshio lets through whatever went wrong, and arrays that do not fit.
        reason = str(error).strip() or type(error).__name__
        raise BadFile(f"meshio cannot read it as {module}: {reason}") from None


def converted(source):
    kinds = {**TYPE_OF_NAME, **REDUCED_NAMES}
    unknown = {block.type for block in source.cells} - set(kinds)
    if unknown:
        raise BadFile(f"it holds cells of the type {min(unknown)}")
    kinds = [kinds[block.type] for block in source.cells]
    blocks = [(kind, np.asarray(block.data)[:, :TYPES[kind][2]]) for kind, block in zip(kinds, source.cells)]
    cell_data = {name: np.concatenate(values) for name, values in source.cell_data.items()}
    for name, chosen in source.cell_sets.items():
        cell_data[name] = np.concatenate([members(part, len(corners)) for part, (_, corners) in zip(chosen, blocks)])
    point_data = {name: values for name, values in source.point_data.items() if name not in NOT_KEPT}
    groups = {name: (int(pair[0]), int(pair[1])) for name, pair in source.field_data.items() if len(pair) == 2}
    mesh = Mesh(source.points, blocks, only_numbers(point_data), only_numbers(cell_data), groups)
    if source.cell_sets and tag_array(mesh.cell_data) is None:
        add_groups(mesh, list(source.cell_sets))
    return mesh


def add_groups(mesh, set_names):
    """Tags from 1 on, in each dimension that a set has cells of; the name goes to the highest of them."""
    dimensions = mesh.cell_dimensions()
    tags = np.zeros(len(dimensions), dtype=np.int32)
    for tag, name in enumerate(set_names, 1):
        inside = mesh.cell_data[name] == 1
        tags[inside & (tags == 0)] = tag
        if inside.any():
            mesh.groups[name] = (tag, int(dimensions[inside].max()))
    mesh.cell_data[PHYSICAL] = tags


def members(chosen, count):
    """1 for the cells `chosen`, a list of numbers or None."""
    inside = np.zeros(count, dtype=np.int8)
    if chosen is not None:
        inside[np.asarray(chosen, dtype=int)] = 1
    return inside


def only_numbers(arrays):
    """Arrays of numbers, whole ones of 32 bits where they fit."""
    arrays = {name: np.asarray(values) for name, values in arrays.items() if np.asarray(values).dtype.kind in "iuf"}
    return {name: values.astype(np.int32) if fits(values) else values for name, values in arrays.items()}


def fits(values):
    return values.dtype.kind in "iu" and (values.size == 0 or np.abs(values.astype(np.int64)).max() < 2**31)
