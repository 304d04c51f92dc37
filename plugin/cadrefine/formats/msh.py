"""Reads gmsh's .msh files, versions 2.2 and 4.1, text and binary, with physical groups and their names."""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import CORNERS, TYPES, reordered
from cadrefine.formats.grid import GEOMETRICAL, Mesh, positions
from cadrefine.formats.groups import set_groups
from cadrefine.formats.msh_sections import Reader
from cadrefine.formats.msh_types import REDUCED, VTK_ORDERS, VTK_TYPES

PRIMES = np.array([2654435761, 2246822519, 3266489917, 668265263, 374761393, 2147483647, 1181783497, 982451653],
                  dtype=np.uint64)


def read(path):
    """The file's Mesh. A cell of several physical groups has the first of them as its tag, and cell arrays of 0 and 1,
    named as the groups, tell all of them. Throws BadFile."""
    with open(path, "rb") as file:
        content = file.read()
    try:
        sections = Reader(content).read()
    except (ValueError, IndexError) as error:  # What is no number where one is due.
        raise BadFile(f"malformed: {error}") from None
    if not sections.blocks:
        raise BadFile("the mesh has no cells")
    return assemble(sections)


def assemble(sections):
    """A Mesh with each cell once; version 2.2 has it once for each of its groups."""
    mesh = Mesh(sections.points, [], groups=sections.names)
    numbers, entities, members, first = [], [], [], 0
    for kind, number in VTK_TYPES.items():
        runs = [run for run in sections.blocks if REDUCED.get(run[0], run[0]) == kind]
        if not runs:
            continue
        nodes = positions(np.concatenate([run[4][:, :TYPES[number][2]] for run in runs]), sections.tags)
        kept, cell_of = distinct(nodes[:, :CORNERS[number]])
        mesh.blocks.append((number, reordered(number, nodes[kept], VTK_ORDERS)))
        numbers.append(np.concatenate([run[1] for run in runs])[kept])
        entities.append(np.concatenate([run[2] for run in runs])[kept])
        rows, groups = memberships(runs)
        members.append(np.column_stack([first + cell_of[rows], groups]))
        first += len(kept)
    set_groups(mesh, np.concatenate(members))
    mesh.cell_data[GEOMETRICAL] = np.concatenate(entities).astype(np.int32)
    set_fields(mesh.point_data, sections.node_data, sections.tags)
    set_fields(mesh.cell_data, sections.element_data, np.concatenate(numbers))
    return mesh


def distinct(corners):
    """Rows that are the first with their corners, in whatever order these are; and for every row its place in them."""
    ordered = np.sort(corners, axis=1)
    sums = (ordered.astype(np.uint64) * PRIMES[:ordered.shape[1]]).sum(axis=1)
    if len(np.unique(sums)) == len(ordered):  # Different sums: different cells, and this is quick.
        return np.arange(len(ordered)), np.arange(len(ordered))
    _, first, place = np.unique(ordered, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[place.ravel()]


def memberships(runs):
    """Rows of the runs' cells, one after the other, and the physical groups that these are in."""
    rows, groups, first = [], [], 0
    for _, ids, _, of_cells, _ in runs:
        inside = np.nonzero(of_cells > 0)
        rows.append(first + inside[0])
        groups.append(of_cells[inside])
        first += len(ids)
    return np.concatenate(rows), np.concatenate(groups)


def set_fields(arrays, fields, all_tags):
    """Values by number of node or element; NaN where a field has none."""
    for name, (tags, values) in fields.items():
        array = np.full((len(all_tags), values.shape[1]), np.nan)
        array[positions(tags, all_tags)] = values
        arrays[name] = array[:, 0] if values.shape[1] == 1 else array
