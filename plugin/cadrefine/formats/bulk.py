"""Puts together what text files list one by one: nodes and elements with numbers, and groups by these."""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import TYPES
from cadrefine.formats.grid import Mesh, positions
from cadrefine.formats.groups import set_groups, unused


class Bulk:
    """Nodes and elements as a file has them. `sets` are pairs of a name and numbers of elements; `extra` holds, by name
    of a group, further cells that are no elements of the file: type and node numbers."""

    def __init__(self):
        self.nodes, self.points = [], []
        self.elements = {}  # By VTK's type: numbers and node numbers.
        self.tags = {}  # By VTK's type: a number of each element, if the file has one.
        self.sets, self.extra = [], {}

    def add_node(self, number, point):
        self.nodes.append(number)
        self.points.append(point)

    def add_element(self, number, kind, nodes, tag=0):
        ids, rows = self.elements.setdefault(kind, ([], []))
        ids.append(number)
        rows.append(nodes)
        self.tags.setdefault(kind, []).append(tag)

    def mesh(self, tag_name=None):
        """The Mesh. Each set is a group of the highest dimension that it has cells of; `tag_name` gets the tags."""
        if not self.elements:
            raise BadFile("the mesh has no cells")
        nodes, ids = np.array(self.nodes, int), []
        mesh = Mesh(np.array(self.points, float), [])
        if len(np.unique(nodes)) < len(nodes):
            raise BadFile("two nodes have the same number; merge the parts of the mesh into one first")
        extra = {}
        for name, cells in self.extra.items():
            for kind, corners in cells:
                extra.setdefault(kind, []).append((name, corners))
        for kind in sorted({*self.elements, *extra}):
            numbers, rows = self.elements.get(kind, ([], []))
            added = [corners for _, corners in extra.get(kind, [])]
            rows = [*rows, *added]
            if any(len(row) != TYPES[kind][2] for row in rows):
                raise BadFile(f"a {TYPES[kind][0]} does not have {TYPES[kind][2]} nodes")
            mesh.blocks.append((kind, positions(np.array(rows, int), nodes)))
            ids += [np.array(numbers, int), np.full(len(added), -1)]
        numbers = np.concatenate(ids)
        members = [(name, rows_of(elements, numbers)) for name, elements in self.sets]
        members += [(name, self.places(mesh, extra, name)) for name in self.extra]
        self.add_groups(mesh, members)
        if tag_name:
            tags = [np.array([*self.tags.get(kind, []), *[0] * len(extra.get(kind, []))]) for kind, _ in mesh.blocks]
            mesh.cell_data[tag_name] = np.concatenate(tags).astype(np.int32)
        return mesh

    def places(self, mesh, extra, name):
        """Where the further cells of a group are."""
        found, first = [np.zeros(0, int)], 0
        for kind, corners in mesh.blocks:
            added = extra.get(kind, [])
            start = first + len(corners) - len(added)
            found.append(start + np.flatnonzero([of == name for of, _ in added]))
            first += len(corners)
        return np.concatenate(found).astype(int)

    @staticmethod
    def add_groups(mesh, members):
        dimensions, rows = mesh.cell_dimensions(), []
        for tag, (name, cells) in enumerate(members, 1):
            if len(cells):
                mesh.groups[unused(name, mesh.groups)] = (tag, int(dimensions[cells].max()))
                rows.append(np.column_stack([cells, np.full(len(cells), tag)]))
        if rows:
            set_groups(mesh, np.concatenate(rows))


def rows_of(elements, numbers):
    """Where the elements of a set are; those that are no cells of the mesh are left out."""
    return np.flatnonzero(np.isin(numbers, np.array(elements, int)) & (numbers >= 0))
