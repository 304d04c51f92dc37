"""Reads universal files (.unv) of I-DEAS, SALOME and gmsh, with groups. (meshio has no reader for them.)"""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.bulk import Bulk

PROPERTY = "unv:property"  # Cell array: number of the physical property.
NODES, ELEMENTS, GROUPS = ("2411", "781"), ("2412",), ("2435", "2452", "2467", "2477")
ELEMENT_MEMBER = 8  # Kind of a member of a group.
BEAMS = (11, 21, 22, 23, 24)  # Their second line is about their section.
# VTK's types, by the descriptor of an element: plane, axisymmetric and shell triangles and quadrilaterals; solids.
# SALOME uses the cubic wedge's number for pyramids of second order.
TYPES = {**dict.fromkeys((41, 51, 61, 74, 81, 91), 5), **dict.fromkeys((42, 52, 62, 72, 82, 92), 22),
         **dict.fromkeys((44, 54, 64, 71, 84, 94), 9), **dict.fromkeys((45, 55, 65, 75, 85, 95), 23), 111: 10, 118: 24,
         115: 12, 116: 25, 112: 13, 113: 26, 114: 27}
# Nodes go round an element, mid nodes between the corners, layer by layer.
ORDERS = {21: [0, 2, 1], 22: [0, 2, 4, 1, 3, 5], 23: [0, 2, 4, 6, 1, 3, 5, 7], 24: [0, 2, 4, 9, 1, 3, 5, 6, 7, 8],
          25: [0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11],
          26: [0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8], 27: [0, 2, 4, 6, 12, 1, 3, 5, 7, 8, 9, 10, 11]}


def read(path):
    """The Mesh. Throws BadFile."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    bulk = Bulk()
    try:
        for name, section in sections(lines):
            if name in NODES:
                read_nodes(bulk, section)
            elif name in ELEMENTS:
                read_elements(bulk, section)
            elif name in GROUPS:
                read_groups(bulk, section)
    except (ValueError, IndexError, StopIteration) as error:
        raise BadFile(f"the dataset {name} is malformed: {error or 'it is cut short'}") from None
    return bulk.mesh(PROPERTY)


def sections(lines):
    """Number and lines of each dataset: between two lines of -1."""
    marks = [number for number, line in enumerate(lines) if line.strip() == "-1"]
    if len(marks) % 2:
        raise BadFile("it is cut short: the last dataset has no end")
    for start, end in zip(marks[::2], marks[1::2]):
        yield lines[start + 1].strip(), lines[start + 2:end]


def read_nodes(bulk, lines):
    for head, line in zip(lines[::2], lines[1::2], strict=True):
        words = line.upper().replace("D", "E").split()
        bulk.add_node(int(head.split()[0]), [float(word) for word in words[:3]])


def read_elements(bulk, lines):
    lines = iter(lines)
    for head in lines:
        number, descriptor, property_number, _, _, count = (int(word) for word in head.split()[:6])
        if descriptor in BEAMS:
            next(lines)
        nodes = []
        while len(nodes) < count:
            nodes += [int(word) for word in next(lines).split()]
        if descriptor not in TYPES and descriptor not in BEAMS:
            raise BadFile(f"holds elements of the type {descriptor} of universal files")
        kind = TYPES.get(descriptor, 21 if count == 3 else 3)  # SALOME's of second order are tapered beams, 22.
        nodes = [nodes[place] for place in ORDERS.get(kind, range(count))]
        bulk.add_element(number, kind, nodes, property_number)


def read_groups(bulk, lines):
    lines = iter(lines)
    for head in lines:
        count, name = int(head.split()[7]), next(lines).strip()
        values = []
        while len(values) < 4 * count:
            values += [int(word) for word in next(lines).split()]
        members = np.array(values).reshape(-1, 4)
        bulk.sets.append((name, members[members[:, 0] == ELEMENT_MEMBER, 1]))
