"""Writes Exodus files (netCDF, 64-bit offsets): element blocks, side sets and node sets, with names. (VTK's writer
takes sets from what its reader has read alone; meshio's writes no side sets.)"""

import numpy as np

from cadrefine.formats import library
from cadrefine.formats.cells import LAYERED, TYPES, reordered
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import grouped, members, unused
from cadrefine.formats.sides import sides_of

ELEMENTS = {1: "SPHERE", 3: "BAR2", 21: "BAR3", 5: "TRI3", 22: "TRI6", 9: "QUAD4", 23: "QUAD8", 10: "TETRA4",
            24: "TETRA10", 12: "HEX8", 25: "HEX20", 13: "WEDGE", 26: "WEDGE15", 14: "PYRAMID", 27: "PYRAMID13"}
SHELLS = {"TRI3": "TRISHELL3", "TRI6": "TRISHELL6", "QUAD4": "SHELL4", "QUAD8": "SHELL8"}  # The same in space.
SHELL_SIDES = 2  # Of a shell, above and below, come before its edges.
NAME = 32  # Most bytes of a name that every reader takes.
LONG_NAME = 255
REST = "cells"  # The block of the cells in no group.


def write(path, mesh):
    """A block for each group and type of cells; facets' groups are side sets, those of lower dimensions node sets."""
    netcdf = library("scipy.io").netcdf_file
    mesh = grouped(mesh)
    dimension = int(mesh.cell_dimensions().max(initial=0))
    flat = dimension < 3 and not np.any(mesh.points[:, 2])
    blocks, place = blocks_of(mesh, dimension, flat)
    side_sets = side_sets_of(mesh, dimension, place, SHELL_SIDES if dimension == 2 and not flat else 0)
    node_sets = node_sets_of(mesh, dimension)
    names = [name for name, *_ in (*blocks, *side_sets, *node_sets)]
    length = NAME if max(len(name.encode()) for name in names) <= NAME else LONG_NAME
    with netcdf(path, "w", version=2) as file:
        file.api_version = file.version = np.float32(5.1)
        file.floating_point_word_size, file.file_size = np.int32(8), np.int32(1)
        file.maximum_name_length, file.title = np.int32(length), "CADRefine"
        for name, size in (("time_step", None), ("len_string", 33), ("len_line", 81), ("len_name", length + 1),
                           ("four", 4), ("num_dim", 2 if flat else 3), ("num_nodes", len(mesh.points)),
                           ("num_elem", sum(len(corners) for _, _, _, corners in blocks))):
            file.createDimension(name, size)
        file.createVariable("time_whole", "d", ("time_step",))
        for axis, values in zip("xy" if flat else "xyz", mesh.points.T):
            file.createVariable("coord" + axis, "d", ("num_nodes",))[:] = values
        write_blocks(file, blocks)
        write_sets(file, "ss", "num_side_sets", "num_side_ss", ("elem_ss", "side_ss"), side_sets)
        write_sets(file, "ns", "num_node_sets", "num_nod_ns", ("node_ns",), node_sets)


def blocks_of(mesh, dimension, flat):
    """Name, number, type and corners of each block; and for each cell its number in the file."""
    names = {tag: name for name, (tag, of_dimension) in mesh.groups.items() if of_dimension == dimension}
    blocks, first, written = [], 0, 0
    place = np.full(len(mesh.cell_dimensions()), -1)
    for kind, corners in mesh.blocks:
        tags = mesh.cell_data[PHYSICAL][first:first + len(corners)]
        for tag in np.unique(tags) if TYPES[kind][1] == dimension else ():
            inside = np.flatnonzero(tags == tag)
            place[first + inside] = np.arange(written, written + len(inside))
            written += len(inside)
            taken = [name for name, *_ in blocks]
            element = ELEMENTS[kind] if flat or dimension < 2 else SHELLS.get(ELEMENTS[kind], ELEMENTS[kind])
            name = names.get(int(tag), REST)
            blocks.append((unused(further(name, kind) if name in taken else name, taken), int(tag), element,
                           reordered(kind, corners[inside], LAYERED)))
        first += len(corners)
    return with_numbers(blocks), place


def further(name, kind):
    """Name of a group's block of further cells, of another type."""
    return f"{name} {ELEMENTS[kind]}"


def with_numbers(items):
    """Name and number come first; where there is no number, or it is taken, the next one."""
    taken, result = {number for _, number, *_ in items}, []
    for name, number, *rest in items:
        if number < 1 or any(number == other[1] for other in result):
            number = max(taken) + 1
            taken.add(number)
        result.append((name, number, *rest))
    return result


def side_sets_of(mesh, dimension, place, offset):
    """Name, number, and rows of cell and side of each; both count from 1."""
    sides, sets = sides_of(mesh), []
    for name, (tag, of_dimension) in mesh.groups.items():
        if of_dimension == dimension - 1:
            chosen = (sides.facets >= 0) & members(mesh, name)[sides.facets]
            sets.append((name, tag, np.column_stack([place[sides.cells[chosen]], sides.numbers[chosen] + offset]) + 1))
    return with_numbers([item for item in sets if len(item[2])])


def node_sets_of(mesh, dimension):
    sets = []
    for name, (tag, of_dimension) in mesh.groups.items():
        if of_dimension < dimension - 1:
            inside, first, nodes = members(mesh, name), 0, [np.zeros(0, int)]
            for _, corners in mesh.blocks:
                nodes.append(corners[inside[first:first + len(corners)]].ravel())
                first += len(corners)
            sets.append((name, tag, np.unique(np.concatenate(nodes))[:, np.newaxis] + 1))
    return with_numbers([item for item in sets if len(item[2])])


def write_blocks(file, blocks):
    write_names(file, "eb", "num_el_blk", blocks)
    for index, (_, _, element, corners) in enumerate(blocks, 1):
        file.createDimension(f"num_el_in_blk{index}", len(corners))
        file.createDimension(f"num_nod_per_el{index}", corners.shape[1])
        table = file.createVariable(f"connect{index}", "i", (f"num_el_in_blk{index}", f"num_nod_per_el{index}"))
        table[:] = corners + 1
        table.elem_type = element


def write_sets(file, kind, dimension, size, columns, sets):
    if not sets:
        return
    write_names(file, kind, dimension, sets)
    for index, (_, _, rows) in enumerate(sets, 1):
        file.createDimension(f"{size}{index}", len(rows))
        for name, values in zip(columns, rows.T):
            file.createVariable(f"{name}{index}", "i", (f"{size}{index}",))[:] = values


def write_names(file, kind, dimension, items):
    file.createDimension(dimension, len(items))
    file.createVariable(kind + "_status", "i", (dimension,))[:] = 1
    numbers = file.createVariable(kind + "_prop1", "i", (dimension,))
    numbers[:] = [number for _, number, *_ in items]
    numbers.name = "ID"
    table = file.createVariable(kind + "_names", "c", (dimension, "len_name"))
    width = table.shape[1]
    for row, (name, *_) in enumerate(items):
        text = name.encode()[:width - 1].ljust(width, b"\0")
        table[row] = np.frombuffer(text, "S1")
