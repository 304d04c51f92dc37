"""Reads and writes gmsh's .msh files, with physical groups and their names.

Read are versions 2.2 and 4.1, text and binary; written is version 2.2 in binary, which every gmsh reads.
"""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.grid import GEOMETRICAL, PHYSICAL, Mesh, tag_array
from cadrefine.formats.msh_sections import Reader

VTK_TYPES = {15: 1, 1: 3, 8: 21, 2: 5, 9: 22, 3: 9, 4: 10, 11: 24, 5: 12, 6: 13, 7: 14}  # By gmsh's types.
GMSH_TYPES = {vtk: gmsh for gmsh, vtk in VTK_TYPES.items()}
SWAPPED = {11: [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]}  # Nodes of quadratic tetrahedra: gmsh's order and VTK's.
PRIMES = np.array([2654435761, 2246822519, 3266489917, 668265263, 374761393, 2147483647, 1181783497, 982451653,
                   961748927, 86028121], dtype=np.uint64)


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
        runs = [run for run in sections.blocks if run[0] == kind]
        if not runs:
            continue
        corners = positions(np.concatenate([run[4] for run in runs]), sections.tags)
        kept, cell_of = distinct(corners)
        mesh.blocks.append((number, corners[kept][:, SWAPPED.get(kind, slice(None))]))
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


def positions(tags, all_tags):
    """Where each of `tags` stands in `all_tags`."""
    order = np.argsort(all_tags, kind="stable")
    found = np.minimum(np.searchsorted(all_tags, tags, sorter=order), len(order) - 1)
    if len(order) == 0 or (all_tags[order[found]] != tags).any():
        raise BadFile("a cell or a value belongs to a node or element that is not in the file")
    return order[found]


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


def set_groups(mesh, members):
    """`members` has a row of cell and group for each group that a cell is in."""
    if len(members) == 0:
        return
    dimensions = mesh.cell_dimensions()
    cells, first = np.unique(members[:, 0], return_index=True)
    mesh.cell_data[PHYSICAL] = np.zeros(len(dimensions), dtype=np.int32)
    mesh.cell_data[PHYSICAL][cells] = members[first, 1]
    others = np.delete(members, first, axis=0)
    told = np.isin(members[:, 0], others[:, 0])
    names = {pair: name for name, pair in mesh.groups.items()}
    for tag, dimension in {(int(tag), int(dimensions[cell])) for cell, tag in members[told]}:
        inside = members[(members[:, 1] == tag) & (dimensions[members[:, 0]] == dimension), 0]
        name = names.get((tag, dimension), f"physical group {tag} of dimension {dimension}")
        mesh.cell_data[name] = np.zeros(len(dimensions), dtype=np.int8)
        mesh.cell_data[name][inside] = 1


def set_fields(arrays, fields, all_tags):
    """Values by number of node or element; NaN where a field has none."""
    for name, (tags, values) in fields.items():
        array = np.full((len(all_tags), values.shape[1]), np.nan)
        array[positions(tags, all_tags)] = values
        arrays[name] = array[:, 0] if values.shape[1] == 1 else array


def write(path, mesh):
    """Cells outside all groups have the group 0, which is none. Tags are those of the first array of TAG_ARRAYS. Other
    cell arrays are left out: meshio 5 cannot read a file that has any."""
    groups, count = tags_of(mesh), len(mesh.points)
    entities = np.maximum(mesh.cell_data.get(GEOMETRICAL, np.maximum(groups, 1)), 1).astype(np.int32)
    with open(path, "wb") as file:
        file.write(b"$MeshFormat\n2.2 1 8\n" + np.int32(1).tobytes() + b"\n$EndMeshFormat\n")
        if mesh.groups:
            lines = [f'{dimension} {tag} "{name}"\n' for name, (tag, dimension) in mesh.groups.items()]
            file.write(f"$PhysicalNames\n{len(lines)}\n{''.join(lines)}$EndPhysicalNames\n".encode())
        file.write(f"$Nodes\n{count}\n".encode())
        write_rows(file, mesh.points)
        file.write(f"\n$EndNodes\n$Elements\n{len(groups)}\n".encode())
        first = 0
        for number, corners in mesh.blocks:
            kind, last = GMSH_TYPES[number], first + len(corners)
            rows = np.column_stack([np.arange(first, last) + 1, groups[first:last], entities[first:last],
                                    1 + corners[:, SWAPPED.get(kind, slice(None))]])
            file.write(np.array([kind, len(corners), 2], dtype=np.int32).tobytes() + rows.astype(np.int32).tobytes())
            first = last
        file.write(b"\n$EndElements\n")
        for name, values in mesh.point_data.items():
            write_field(file, "NodeData", name, values)


def tags_of(mesh):
    """The groups of the cells; none below 0, which gmsh takes for a turned entity."""
    name = tag_array(mesh.cell_data)
    if name is None:
        return np.zeros(len(mesh.cell_dimensions()), dtype=np.int32)
    return np.maximum(mesh.cell_data[name], 0).astype(np.int32)


def write_rows(file, values):
    rows = np.empty(len(values), dtype=[("number", "<i4"), ("values", "<f8", (values.shape[1],))])
    rows["number"] = 1 + np.arange(len(values))
    rows["values"] = values
    file.write(rows.tobytes())


def write_field(file, section, name, values):
    """gmsh knows fields of 1, 3 and 9 components; others are filled up with zeros, or left out if they have more."""
    values = values.reshape(len(values), -1)
    width = next((size for size in (1, 3, 9) if size >= values.shape[1]), None)
    if width is None:
        return
    padded = np.zeros((len(values), width))
    padded[:, :values.shape[1]] = values
    file.write(f'${section}\n1\n"{name}"\n1\n0\n3\n0\n{width}\n{len(values)}\n'.encode())
    write_rows(file, padded)
    file.write(f"\n$End{section}\n".encode())
