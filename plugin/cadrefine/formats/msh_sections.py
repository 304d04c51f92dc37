"""The sections of gmsh's .msh files, versions 2.2 and 4.1, text and binary, as numbers.

The format is described in gmsh's reference manual, chapter "File formats". (meshio reads no file of version 4.1 that
has cells in and cells outside physical groups.)
"""

import re

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.msh_numbers import Binary, Text, alike
from cadrefine.formats.msh_types import POINTS



class Reader:
    """One file: its sections in the order that they come in.

    `blocks` holds for runs of elements: gmsh's type, numbers (n), entities (n), physical groups (n, any; 0 is none) and
    corners by node number (n, corners). Nodes are `tags` (n) and `points` (n, 3), fields numbers and values by name."""

    def __init__(self, content):
        self.content, self.at = content, 0
        self.names, self.groups_of_entity = {}, {}
        self.tags, self.points = np.zeros(0, int), np.zeros((0, 3))
        self.blocks = []
        self.node_data, self.element_data = {}, {}

    def line(self):
        end = self.content.find(b"\n", self.at)
        end = len(self.content) if end < 0 else end
        text, self.at = self.content[self.at:end].strip(), end + 1
        return text

    def read(self):
        sections = {b"PhysicalNames": self.read_names, b"Entities": self.read_entities, b"Nodes": self.read_nodes,
                    b"Elements": self.read_elements, b"NodeData": lambda: self.read_data(b"NodeData", self.node_data),
                    b"ElementData": lambda: self.read_data(b"ElementData", self.element_data)}
        while self.at < len(self.content):
            line = self.line()
            if line == b"$MeshFormat":
                self.read_format()
            elif line == b"$PartitionedEntities":
                raise BadFile("the mesh is partitioned; save it in one part")
            elif line.startswith(b"$") and line[1:] in sections:
                sections[line[1:]]()
            elif line.startswith(b"$") and not line.startswith(b"$End"):
                self.skip(line[1:])
        return self

    def read_format(self):
        words = self.line().split()
        self.version = words[0].decode() if len(words) == 3 else ""
        if self.version not in ("2", "2.1", "2.2", "4.1"):
            raise BadFile(f"version {self.version or 'unknown'} of the format; save it as version 4.1 or 2.2")
        self.binary, self.order = words[1] == b"1", "<"
        if self.binary:
            if words[2] != b"8":
                raise BadFile(f"its numbers have {words[2].decode()} bytes instead of 8")
            self.order = "<" if self.content[self.at:self.at + 4] == b"\1\0\0\0" else ">"
            self.at += 4
        self.skip(b"MeshFormat")

    def skip(self, name):
        end = self.content.find(b"$End" + name, self.at)
        if end < 0:
            raise BadFile(f"the section {name.decode(errors='replace')} has no end")
        self.at = end
        self.line()

    def numbers(self, name):
        return Binary(self.content, self.at, name, self.order) if self.binary else Text(self.content, self.at, name)

    def leave(self, name, numbers):
        if self.binary:
            self.at = numbers.at
        self.skip(name)

    def read_names(self):
        for _ in range(int(self.line())):
            match = re.fullmatch(rb'(\d+)\s+(\d+)\s+"(.*)"', self.line())
            if not match:
                raise BadFile("a line of PhysicalNames is malformed")
            self.names[match[3].decode(errors="replace")] = (int(match[2]), int(match[1]))
        self.skip(b"PhysicalNames")

    def read_entities(self):
        numbers = self.numbers(b"Entities")
        for dimension, count in enumerate(numbers.sizes(4)):
            for _ in range(count):
                tag = int(numbers.integers(1)[0])
                numbers.doubles(3 if dimension == 0 else 6)
                # A group's number is negative where the entity is turned round in it.
                self.groups_of_entity[dimension, tag] = np.abs(numbers.integers(int(numbers.sizes(1)[0])))
                if dimension > 0:
                    numbers.integers(int(numbers.sizes(1)[0]))
        self.leave(b"Entities", numbers)

    def read_nodes(self):
        if self.version == "4.1":
            numbers = self.numbers(b"Nodes")
            tags, points = [], []
            for _ in range(int(numbers.sizes(4)[0])):
                dimension, _, parametric = numbers.integers(3)
                count = int(numbers.sizes(1)[0])
                tags.append(numbers.sizes(count))
                points.append(numbers.rows(count, ("d", 3), ("d", int(dimension) if parametric else 0))[0])
            self.tags, self.points = np.concatenate(tags or [[]]), np.concatenate(points or [np.zeros((0, 3))])
        else:
            count = int(self.line())
            numbers = self.numbers(b"Nodes")
            tags, self.points = numbers.rows(count, ("i", 1), ("d", 3))
            self.tags = tags[:, 0]
        self.leave(b"Nodes", numbers)

    def read_elements(self):
        if self.version == "4.1":
            numbers = self.numbers(b"Elements")
            for _ in range(int(numbers.sizes(4)[0])):
                dimension, entity, kind = (int(value) for value in numbers.integers(3))
                count = int(numbers.sizes(1)[0])
                ids, corners = numbers.rows(count, ("n", 1), ("n", points_of(kind)))
                groups = self.groups_of_entity.get((dimension, entity), np.zeros(0, int))
                self.blocks.append((kind, ids[:, 0], np.full(count, entity), np.tile(groups, (count, 1)), corners))
        else:
            count = int(self.line())
            numbers = self.numbers(b"Elements")
            (self.read_packed if self.binary else self.read_listed)(numbers, count)
        self.leave(b"Elements", numbers)

    def read_packed(self, numbers, count):
        """Elements of version 2 in binary: a type, how many, number of tags; then number, tags, corners of each. gmsh
        writes each element by itself."""
        while count > 0:
            kind, run, tags = (int(value) for value in numbers.ahead(1, 3)[0])
            width = 1 + tags + points_of(kind)
            if run == 1:
                rows = alike(numbers, count, 3 + width, [0, 1, 2])[:, 3:]
            else:
                numbers.integers(3)
                rows = numbers.integers(run * width).reshape(run, width)
            self.add_labelled(kind, rows[:, 0], rows[:, 1:1 + tags], rows[:, 1 + tags:])
            count -= len(rows)

    def read_listed(self, numbers, count):
        """Elements of version 2 in text: number, type, number of tags, tags, corners."""
        while count > 0:
            _, kind, tags = (int(value) for value in numbers.ahead(1, 3)[0])
            rows = alike(numbers, count, 3 + tags + points_of(kind), [1, 2])
            self.add_labelled(kind, rows[:, 0], rows[:, 3:3 + tags], rows[:, 3 + tags:])
            count -= len(rows)

    def add_labelled(self, kind, ids, labels, corners):
        group = labels[:, :1] if labels.shape[1] > 0 else np.zeros((len(ids), 0), int)
        entity = labels[:, 1] if labels.shape[1] > 1 else np.zeros(len(ids), int)
        self.blocks.append((kind, ids, entity, group, corners))

    def read_data(self, name, data):
        """A field, as `data[its name]`: numbers of nodes or elements, and values. Of a series the last one counts."""
        words = [self.line() for _ in range(int(self.line()))]
        for _ in range(int(self.line())):
            self.line()
        _, components, count = [int(self.line()) for _ in range(int(self.line()))][:3]
        numbers = self.numbers(name)
        ids, values = numbers.rows(count, ("i", 1), ("d", components))
        data[words[0].decode(errors="replace").strip('"')] = (ids[:, 0], values)
        self.leave(name, numbers)


def points_of(kind):
    if int(kind) not in POINTS:
        raise BadFile(f"holds cells of gmsh's type {int(kind)}, of higher order or polyhedra")
    return POINTS[int(kind)]
