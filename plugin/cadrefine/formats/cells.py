"""The types of cells, by VTK's numbers, and how their nodes are numbered.

Corners are numbered as in VTK, but for wedges: their triangle 0, 1, 2 looks into the cell, as in gmsh, Exodus, CGNS,
Abaqus and Nastran, and not out of it, as in VTK, SU2 and MED. Mid nodes follow the corners, in VTK's order of edges.
"""

import numpy as np

TYPES = {  # Name in meshio, dimension, number of points.
    1: ("vertex", 0, 1), 3: ("line", 1, 2), 5: ("triangle", 2, 3), 9: ("quad", 2, 4), 10: ("tetra", 3, 4),
    12: ("hexahedron", 3, 8), 13: ("wedge", 3, 6), 14: ("pyramid", 3, 5), 21: ("line3", 1, 3),
    22: ("triangle6", 2, 6), 23: ("quad8", 2, 8), 24: ("tetra10", 3, 10), 25: ("hexahedron20", 3, 20),
    26: ("wedge15", 3, 15), 27: ("pyramid13", 3, 13),
}
TYPE_OF_NAME = {name: number for number, (name, _, _) in TYPES.items()}
LINEAR = {21: 3, 22: 5, 23: 9, 24: 10, 25: 12, 26: 13, 27: 14}  # Of those of second order.
CORNERS = {kind: TYPES[LINEAR.get(kind, kind)][2] for kind in TYPES}
# Types with nodes on sides and inside too, and what they are without: their first nodes are the same.
REDUCED = {28: 23, 29: 25, 32: 26, 33: 25, 34: 22, 37: 27}
REDUCED_NAMES = {"triangle7": 22, "quad9": 23, "hexahedron24": 25, "hexahedron27": 25, "wedge18": 26, "pyramid14": 27}

FACET_TYPES = {2: 3, 3: 5, 4: 9}  # Types of sides, by the number of corners.
SECOND_ORDER = {linear: kind for kind, linear in LINEAR.items()}
SIDES = {  # Corners of the sides of each type of cells: normals outwards, in the order of Exodus.
    5: ((0, 1), (1, 2), (2, 0)), 9: ((0, 1), (1, 2), (2, 3), (3, 0)),
    10: ((0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)),
    12: ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)),
    13: ((0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)),
    14: ((0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3), (0, 3, 2, 1)),
}
SIDES.update({kind: SIDES[linear] for kind, linear in LINEAR.items() if linear in SIDES})
EDGES = {  # Corners of the edges whose mid nodes follow the corners.
    21: ((0, 1),), 22: ((0, 1), (1, 2), (2, 0)), 23: ((0, 1), (1, 2), (2, 3), (3, 0)),
    24: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    25: ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)),
    26: ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
    27: ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)),
}


def order_of(kind, corners, edges):
    """The places of a cell's nodes for one who numbers corners and edges so."""
    places = {frozenset(edge): place for place, edge in enumerate(EDGES.get(kind, ()), CORNERS[kind])}
    return [*corners, *(places[frozenset(edge)] for edge in edges)]


def facet_of(kind, corners):
    """The type of a cell's facet with these corners, and the places of its nodes in the cell."""
    facet = FACET_TYPES[len(corners)]
    facet = SECOND_ORDER[facet] if kind in LINEAR else facet
    return facet, order_of(kind, corners, [(corners[a], corners[b]) for a, b in EDGES.get(facet, ())])


def mirrored(kind, corners):
    """The same of one to whom the cell is the other way round."""
    return order_of(kind, corners, [(corners[a], corners[b]) for a, b in EDGES.get(kind, ())])


# The places of the nodes of volume cells turned round: its own inverse.
TURNED = {10: [0, 2, 1, 3], 12: [0, 3, 2, 1, 4, 7, 6, 5], 13: [0, 2, 1, 3, 5, 4], 14: [0, 3, 2, 1, 4]}
TURNED.update({kind: mirrored(kind, TURNED[linear]) for kind, linear in LINEAR.items() if linear in TURNED})
# The places of nodes for Exodus, CGNS and Nastran, who have the mid nodes of upright edges before those above.
LAYERED = {25: [*range(12), 16, 17, 18, 19, 12, 13, 14, 15], 26: [*range(9), 12, 13, 14, 9, 10, 11]}


def inverse(orders):
    """The orders that undo these, by type."""
    return {kind: np.argsort(order).tolist() for kind, order in orders.items()}


def reordered(kind, corners, orders):
    """The nodes of cells in the order of their type, if there is one."""
    return corners[:, orders[kind]] if kind in orders else corners


def volumes(points, kind, corners):
    """Of volume cells with bilinear sides, by their corners: negative where the normals of SIDES look inwards."""
    first, result = points[corners[:, 0]], 0
    for side in SIDES[kind]:
        of_side = points[corners[:, side]] - first[:, np.newaxis]
        middle = of_side.mean(axis=1)
        for corner in range(len(side)):
            result += np.einsum("ij,ij->i", middle, np.cross(of_side[:, corner - 1], of_side[:, corner])) / 6
    return result


def turned_where_negative(points, kind, corners):
    """Volume cells of negative volume the other way round."""
    if kind not in TURNED:
        return corners
    negative = volumes(points, kind, corners) < 0
    return np.where(negative[:, np.newaxis], corners[:, TURNED[kind]], corners)
