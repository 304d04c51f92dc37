"""Writes gmsh's .msh files, versions 2.2 and 4.1, text and binary."""

import numpy as np

from cadrefine.formats.cells import TYPES, reordered
from cadrefine.formats.grid import GEOMETRICAL
from cadrefine.formats.groups import grouped, sets_of_groups
from cadrefine.formats.msh_types import GMSH_ORDERS, GMSH_TYPES


class Text:
    """Rows of numbers as lines."""

    def __init__(self, file):
        self.file = file

    def rows(self, *columns):
        """One or more columns, each a kind ("i", "n", "d") and its numbers (rows, any)."""
        table = np.column_stack([values for _, values in columns])
        formats = ["%.17g" if kind == "d" else "%d" for kind, values in columns for _ in range(np.shape(values)[1])]
        np.savetxt(self.file, table, formats)

    def end(self):
        pass


class Binary:
    KINDS = {"i": "<i4", "n": "<i8", "d": "<f8"}

    def __init__(self, file):
        self.file = file

    def rows(self, *columns):
        kind = np.dtype([(f"f{i}", self.KINDS[k], (np.shape(values)[1],)) for i, (k, values) in enumerate(columns)])
        table = np.empty(len(columns[0][1]), kind)
        for name, (_, values) in zip(kind.names, columns):
            table[name] = values
        self.file.write(table.tobytes())

    def end(self):
        self.file.write(b"\n")


def write(path, mesh, version="2.2", ascii=False):
    """Cells outside all groups have the group 0, which is none. Of the cell arrays only the groups are kept: meshio 5
    cannot read a file that has others."""
    mesh = grouped(mesh)
    entities, place = entities_of(mesh, *sets_of_groups(mesh))
    with open(path, "wb") as file:
        numbers = Text(file) if ascii else Binary(file)
        file.write(f"$MeshFormat\n{version} {int(not ascii)} 8\n".encode())
        if not ascii:
            numbers.rows(("i", [[1]]))
            numbers.end()
        file.write(b"$EndMeshFormat\n")
        write_names(file, mesh)
        for name, write_section in SECTIONS[version].items():
            file.write(f"${name}\n".encode())
            write_section(numbers, mesh, entities, place)
            numbers.end()
            file.write(f"$End{name}\n".encode())
        for name, values in mesh.point_data.items():
            write_field(numbers, name, values)


def entities_of(mesh, set_of_cell, sets):
    """Entities, each a dimension, a tag and the groups, and the place of each cell's one in them. To gmsh, the cells of
    an entity are in the same groups: where they are not, it is made several."""
    given = np.maximum(mesh.cell_data.get(GEOMETRICAL, np.zeros(len(set_of_cell), int)), 0)
    rows, place = np.unique(np.column_stack([mesh.cell_dimensions(), given, set_of_cell]), axis=0, return_inverse=True)
    entities, taken, last = [], set(), int(given.max(initial=0))
    for dimension, tag, number in rows.tolist():
        if tag == 0 or (dimension, tag) in taken:
            tag = last = last + 1
        taken.add((dimension, tag))
        entities.append((dimension, tag, sets[number]))
    return entities, place.ravel()


def write_names(file, mesh):
    if mesh.groups:
        lines = [f'{dimension} {tag} "{name}"\n' for name, (tag, dimension) in mesh.groups.items()]
        file.write(f"$PhysicalNames\n{len(lines)}\n{''.join(lines)}$EndPhysicalNames\n".encode())


def write_nodes_2(numbers, mesh, _entities, _place):
    numbers.file.write(f"{len(mesh.points)}\n".encode())
    numbers.rows(("i", counted(mesh.points)), ("d", mesh.points))


def write_elements_2(numbers, mesh, entities, place):
    """A cell of several groups comes once for each of them."""
    copies = np.array([max(len(groups), 1) for _, _, groups in entities], int)[place]
    numbers.file.write(f"{copies.sum()}\n".encode())
    labels = np.array([(group, tag) for _, tag, groups in entities for group in groups or [0]], int).reshape(-1, 2)
    first_label = np.cumsum([0, *(max(len(groups), 1) for _, _, groups in entities)])
    first, written = 0, 0
    for kind, corners in mesh.blocks:
        of_block = slice(first, first + len(corners))
        first = of_block.stop
        rows = np.repeat(np.arange(len(corners)), copies[of_block])
        within = np.arange(len(rows)) - np.repeat(np.cumsum(copies[of_block]) - copies[of_block], copies[of_block])
        cell_labels = labels[first_label[place[of_block][rows]] + within]
        ids = np.arange(written, written + len(rows))[:, np.newaxis] + 1
        written += len(rows)
        nodes = 1 + reordered(kind, corners[rows], GMSH_ORDERS)
        if isinstance(numbers, Binary):
            numbers.rows(("i", [[GMSH_TYPES[kind], len(rows), 2]]))
            numbers.rows(("i", ids), ("i", cell_labels), ("i", nodes))
        else:
            heads = np.tile([GMSH_TYPES[kind], 2], (len(rows), 1))
            numbers.rows(("i", ids), ("i", heads), ("i", cell_labels), ("i", nodes))


def write_entities_4(numbers, mesh, entities, place):
    numbers.rows(("n", [[sum(entity[0] == dimension for entity in entities) for dimension in range(4)]]))
    for (dimension, tag, groups), nodes in zip(entities, nodes_of(mesh, place, len(entities))):
        points = mesh.points[nodes]
        box = [*points.min(axis=0), *points.max(axis=0)]
        columns = [("i", [[tag]]), ("d", [box if dimension > 0 else box[:3]]), ("n", [[len(groups)]]), ("i", [groups])]
        numbers.rows(*columns, *([("n", [[0]])] if dimension > 0 else []))


def nodes_of(mesh, place, count):
    """The nodes of each entity's cells."""
    nodes, first = [[] for _ in range(count)], 0
    for _, corners in mesh.blocks:
        of_block = place[first:first + len(corners)]
        first += len(corners)
        for entity in np.unique(of_block):
            nodes[entity].append(np.unique(corners[of_block == entity]))
    return [np.concatenate(parts) for parts in nodes]


def write_nodes_4(numbers, mesh, entities, place):
    """Each node is part of the entity of the lowest dimension that it lies on."""
    owners, first = np.zeros(len(mesh.points), int), len(place)
    for kind, corners in sorted(mesh.blocks, key=lambda block: -TYPES[block[0]][1]):
        first = first_cell(mesh, kind)
        owners[corners.ravel()] = np.repeat(place[first:first + len(corners)], corners.shape[1])
    found = np.unique(owners)
    numbers.rows(("n", [[len(found), len(owners), 1, len(owners)]]))
    for owner in found:
        nodes = np.flatnonzero(owners == owner)
        numbers.rows(("i", [[*entities[owner][:2], 0]]), ("n", [[len(nodes)]]))
        numbers.rows(("n", 1 + nodes[:, np.newaxis]))
        numbers.rows(("d", mesh.points[nodes]))


def first_cell(mesh, kind):
    """Number of the first cell of a type."""
    kinds = [number for number, _ in mesh.blocks]
    return sum(len(corners) for _, corners in mesh.blocks[:kinds.index(kind)])


def write_elements_4(numbers, mesh, entities, place):
    runs, first = [], 0
    for kind, corners in mesh.blocks:
        of_block = place[first:first + len(corners)]
        runs += [(kind, entity, np.flatnonzero(of_block == entity), corners, first) for entity in np.unique(of_block)]
        first += len(corners)
    numbers.rows(("n", [[len(runs), first, 1, first]]))
    for kind, entity, cells, corners, first in runs:
        numbers.rows(("i", [[*entities[entity][:2], GMSH_TYPES[kind]]]), ("n", [[len(cells)]]))
        nodes = reordered(kind, corners[cells], GMSH_ORDERS)
        numbers.rows(("n", 1 + first + cells[:, np.newaxis]), ("n", 1 + nodes))


def write_field(numbers, name, values):
    """gmsh knows fields of 1, 3 and 9 components; others are filled up with zeros, or left out if they have more."""
    values = values.reshape(len(values), -1)
    width = next((size for size in (1, 3, 9) if size >= values.shape[1]), None)
    if width is None:
        return
    padded = np.zeros((len(values), width))
    padded[:, :values.shape[1]] = values
    numbers.file.write(f'$NodeData\n1\n"{name}"\n1\n0\n3\n0\n{width}\n{len(values)}\n'.encode())
    numbers.rows(("i", counted(values)), ("d", padded))
    numbers.end()
    numbers.file.write(b"$EndNodeData\n")


def counted(rows):
    """A column 1, 2, ..."""
    return 1 + np.arange(len(rows))[:, np.newaxis]


SECTIONS = {
    "2.2": {"Nodes": write_nodes_2, "Elements": write_elements_2},
    "4.1": {"Entities": write_entities_4, "Nodes": write_nodes_4, "Elements": write_elements_4},
}
