"""Reads and writes Abaqus's and CalculiX's input files. (meshio drops surfaces, and knows few types of elements.)"""

import re

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.bulk import Bulk
from cadrefine.formats.cells import LINEAR, SIDES, TYPES, facet_of
from cadrefine.formats.groups import NAME, group_names, grouped, members
from cadrefine.formats.sides import sides_of

# VTK's types, by number of nodes: the order of these is the same. Nodes on sides and inside are the last ones.
SOLIDS = {4: 10, 10: 24, 8: 12, 20: 25, 27: 25, 6: 13, 15: 26, 5: 14, 13: 27}
PLANE = {3: 5, 6: 22, 4: 9, 8: 23, 9: 23}
LINES = {2: 3, 3: 21}
# How names of element types begin.
FAMILIES = (
    (re.compile(r"(C3D|DC3D|AC3D|F3D|SC\d)"), SOLIDS),
    (re.compile(r"(CP[ES]|CG?AX|DC2D|DCAX|AC2D|S\d|STRI|M3D|R3D|SFM3D|DS|F2D)"), PLANE),
    (re.compile(r"(T2D|T3D|B[23]|FRAME|DC1D)"), LINES),
)
SHELLS = re.compile(r"(S\d|STRI|DS)")  # Their first two sides are above and below.
# Corners of the sides S1, S2, ... by VTK's type.
FACES = {
    10: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), 5: ((0, 1), (1, 2), (2, 0)), 9: ((0, 1), (1, 2), (2, 3), (3, 0)),
    12: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
    13: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    14: ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
}
FACES.update({kind: FACES[linear] for kind, linear in LINEAR.items() if linear in FACES})
ELEMENTS = {3: "T3D2", 21: "T3D3", 5: "CPS3", 22: "CPS6", 9: "CPS4", 23: "CPS8", 10: "C3D4", 24: "C3D10", 12: "C3D8",
            25: "C3D20", 13: "C3D6", 26: "C3D15", 14: "C3D5"}  # Written for VTK's types.
IN_SPACE = {5: "S3", 22: "STRI65", 9: "S4", 23: "S8R"}
FIRST_SHELL_SIDE = 2  # Of a shell's sides, as written; above and below come before its edges.
A_LINE = 16  # The most numbers that a line may have.


class Reader:
    """What the file has said so far. Names of sets are in capitals."""

    def __init__(self):
        self.bulk, self.elements, self.names, self.pending = Bulk(), {}, {}, None
        self.sets, self.element_sets, self.surfaces = {}, {}, {}

    def read(self, lines):
        keyword, options, number = "", {}, 0
        for number, line in enumerate(lines, 1):
            line = line.strip().rstrip(",")
            if not line or line.startswith("**"):
                continue
            try:
                if line.startswith("*"):
                    keyword, options = self.keyword_of(line)
                elif keyword in READERS:
                    READERS[keyword](self, options, [word.strip() for word in line.split(",")])
            except (ValueError, IndexError, KeyError) as error:
                raise BadFile(f"line {number} is malformed: {error}") from None
        self.finish_element()
        return self.mesh()

    def keyword_of(self, line):
        """The keyword and its options, both in capitals."""
        self.finish_element()
        words = [word.strip() for word in line[1:].split(",")]
        options = {key.strip().upper(): value.strip().strip('"') for key, _, value in
                   (word.partition("=") for word in words[1:])}
        keyword = " ".join(words[0].upper().split())
        if keyword == "INCLUDE":
            raise BadFile("it includes another file; merge both into one")
        for key in ("ELSET", "NAME"):
            if key in options:
                self.names.setdefault(options[key].upper(), options[key])
        return keyword, options

    def add_node(self, _options, words):
        self.bulk.add_node(int(words[0]), [float(word) for word in (words[1:4] + ["0"] * 3)[:3]])

    def add_element(self, options, words):
        """An element may go on in the next line: it ends where it has as many nodes as its type."""
        self.pending = (options, [*(self.pending[1] if self.pending else []), *(int(word) for word in words)])
        kinds = kinds_of(options["TYPE"])
        wanted = nodes_of(options["TYPE"])
        if len(self.pending[1]) - 1 >= (wanted or max(kinds)):
            self.finish_element()

    def finish_element(self):
        if self.pending is None:
            return
        (options, (number, *nodes)), self.pending = self.pending, None
        kinds = kinds_of(options["TYPE"])
        if len(nodes) not in kinds:
            raise BadFile(f"holds elements {options['TYPE']} of {len(nodes)} nodes")
        kind = kinds[len(nodes)]
        nodes = nodes[:TYPES[kind][2]]
        self.bulk.add_element(number, kind, nodes)
        self.elements[number] = kind, nodes, options["TYPE"].upper()
        if "ELSET" in options:
            self.element_sets.setdefault(options["ELSET"].upper(), []).append(number)

    def add_to_set(self, options, words):
        found = self.sets.setdefault(options["ELSET"].upper(), [])
        if "GENERATE" in options:
            first, last, step = (int(word) for word in (words + ["1"])[:3])
            found += range(first, last + 1, step)
        else:
            for word in words:
                found += [int(word)] if word.isdecimal() else self.members_of(word)

    def members_of(self, name):
        key = name.strip('"').upper()
        if key not in self.sets and key not in self.element_sets:
            raise BadFile(f"the set {name} is not in the file")
        return [*self.sets.get(key, []), *self.element_sets.get(key, [])]

    def add_to_surface(self, options, words):
        """Sides of elements; surfaces of nodes have none."""
        if options.get("TYPE", "ELEMENT").upper() != "ELEMENT" or len(words) < 2:
            return
        side = re.fullmatch(r"S(\d)", words[1].upper())
        if not side:
            return
        for number in [int(words[0])] if words[0].isdecimal() else self.members_of(words[0]):
            facet = self.facet_of(number, int(side[1]) - 1)
            if facet:
                self.surfaces.setdefault(options["NAME"].upper(), []).append(facet)

    def facet_of(self, number, side):
        """Type and nodes of a side."""
        kind, nodes, element = self.elements[number] if number in self.elements else (0, (), "")
        side -= FIRST_SHELL_SIDE if SHELLS.match(element) else 0
        if kind not in FACES or not 0 <= side < len(FACES[kind]):
            return None
        facet, places = facet_of(kind, FACES[kind][side])
        return facet, [nodes[place] for place in places]

    def mesh(self):
        """Sets that were made by themselves come before those that elements name."""
        sets = {**self.sets, **{key: value for key, value in self.element_sets.items() if key not in self.sets}}
        self.bulk.sets = [(self.names[key], numbers) for key, numbers in sets.items()]
        self.bulk.extra = {self.names[key]: facets for key, facets in self.surfaces.items()}
        return self.bulk.mesh()


READERS = {"NODE": Reader.add_node, "ELEMENT": Reader.add_element, "ELSET": Reader.add_to_set,
           "SURFACE": Reader.add_to_surface}


def kinds_of(name):
    for start, kinds in FAMILIES:
        if start.match(name.upper()):
            return kinds
    raise BadFile(f"holds elements of the type {name}")


def nodes_of(name):
    """As the name tells: C3D10 has 10. Beams (B31) and some shells (STRI65, S4R5) tell of other things."""
    number = re.match(r"S(\d)", name.upper()) or re.search(r"(\d+)[A-Z]*$", name.upper())
    kinds = kinds_of(name)
    if kinds is LINES:
        return int(number[1][-1]) + (1 if name.upper().startswith("B") else 0)
    return 6 if name.upper() == "STRI65" else int(number[1]) if number and int(number[1]) in kinds else None


def read(path):
    """The Mesh: sets of elements and surfaces are groups. Throws BadFile."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return Reader().read(file)


def write(path, mesh):
    """Groups of cells are sets of elements; those of facets surfaces and sets of nodes; others sets of nodes."""
    mesh = grouped(mesh)
    if any(kind not in ELEMENTS for kind, _ in mesh.blocks if TYPES[kind][1] == 3):
        raise BadFile("Abaqus has no quadratic pyramids")
    dimensions = mesh.cell_dimensions()
    highest = int(dimensions.max(initial=0))
    flat = highest < 3 and not np.any(mesh.points[:, 2])
    place = np.cumsum(dimensions == highest) * (dimensions == highest)
    with open(path, "w", encoding="utf-8") as file:
        file.write("*HEADING\nCADRefine\n*NODE\n")
        table = np.column_stack([1 + np.arange(len(mesh.points)), mesh.points])
        np.savetxt(file, table, ["%d", "%.17g", "%.17g", "%.17g"], ", ")
        first = 0
        for kind, corners in mesh.blocks:
            if TYPES[kind][1] == highest and len(corners):
                element = ELEMENTS[kind] if flat or highest == 3 else IN_SPACE.get(kind, ELEMENTS[kind])
                file.write(f"*ELEMENT, TYPE={element}\n")
                write_rows(file, np.column_stack([place[first:first + len(corners)], corners + 1]))
            first += len(corners)
        plain = {tag: name for dimension in range(4) for tag, name in group_names(mesh, dimension, NAME).items()}
        sides = sides_of(mesh)
        for name, (tag, dimension) in mesh.groups.items():
            inside = members(mesh, name)
            if dimension == highest:
                write_set(file, f"*ELSET, ELSET={plain[tag]}", place[inside])
            else:
                write_set(file, f"*NSET, NSET={plain[tag]}", nodes_in(mesh, inside))
            if dimension == highest - 1:
                offset = 0 if flat or highest == 3 else FIRST_SHELL_SIDE
                write_surface(file, plain[tag], mesh, sides, inside, place, offset)


def write_rows(file, rows):
    words = ["%d"] * rows.shape[1]
    lines = [", ".join(words[first:first + A_LINE]) for first in range(0, len(words), A_LINE)]
    np.savetxt(file, rows, ",\n".join(lines))


def nodes_in(mesh, inside):
    nodes, first = [], 0
    for _, corners in mesh.blocks:
        nodes.append(corners[inside[first:first + len(corners)]].ravel())
        first += len(corners)
    return np.unique(np.concatenate(nodes)) + 1


def write_set(file, head, numbers):
    file.write(head + "\n")
    for start in range(0, len(numbers), A_LINE):
        file.write(", ".join(map(str, numbers[start:start + A_LINE])) + "\n")


def write_surface(file, name, mesh, sides, inside, place, offset):
    chosen = np.flatnonzero((sides.facets >= 0) & inside[sides.facets])
    if len(chosen) == 0:
        return
    kinds = np.repeat([kind for kind, _ in mesh.blocks], [len(corners) for _, corners in mesh.blocks])
    file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n")
    for cell, number in zip(sides.cells[chosen], sides.numbers[chosen]):
        kind = int(kinds[cell])
        side = [set(face) for face in FACES[kind]].index(set(SIDES[kind][number]))
        file.write(f"{place[cell]}, S{side + 1 + offset}\n")
