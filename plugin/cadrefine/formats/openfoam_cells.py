"""Which cells the faces of an OpenFOAM mesh enclose.

A hexahedron, wedge, pyramid or tetrahedron is known by how many triangles and quadrilaterals it has. One face is its
base: seen from inside its corners come first, in their order. The corner above each of them is found in the face beside
the base: seen from outside, it comes before the two that this face shares with the base.
"""

import numpy as np

from cadrefine.formats import BadFile

KINDS = {(4, 0): 10, (0, 6): 12, (2, 3): 13, (4, 1): 14}  # VTK's types, by the numbers of triangles and quadrilaterals.
BASE = {10: 3, 12: 4, 13: 3, 14: 4}  # Corners of the base.
PEAKED = (10, 14)  # Those with one corner above the base.
FILE = "constant/polyMesh/faces"


def cells_of(faces, owner, neighbour):
    """Blocks of type and corners, and for each of OpenFOAM's cells its place among them. `faces` has the corners of
    each, -1 where there are fewer; they look out of the owner. Throws BadFile."""
    cells = np.concatenate([owner, neighbour])
    numbers = np.concatenate([np.arange(len(owner)), np.arange(len(neighbour))])
    order = np.argsort(cells, kind="stable")
    inside_out = order >= len(owner)
    of_cell, numbers = cells[order], numbers[order]
    kinds = kinds_of(faces, of_cell, numbers)
    blocks, place, first = [], np.empty(len(kinds), int), 0
    for kind in np.unique(kinds).tolist():
        of_kind = np.flatnonzero(kinds == kind)
        chosen = kinds[of_cell] == kind
        width = np.count_nonzero(chosen) // len(of_kind)
        corners = looking_out(faces[numbers[chosen]], inside_out[chosen]).reshape(len(of_kind), width, -1)
        blocks.append((kind, corners_of(kind, corners, of_kind)))
        place[of_kind] = np.arange(first, first + len(of_kind))
        first += len(of_kind)
    return blocks, place


def kinds_of(faces, cells, numbers):
    """VTK's type of each cell."""
    sizes = (faces >= 0).sum(axis=1)[numbers]
    triangles, quadrilaterals = (np.bincount(cells, sizes == size, minlength=cells.max(initial=-1) + 1).astype(int)
                                 for size in (3, 4))
    counts = np.bincount(cells)
    kinds = np.zeros(len(counts), int)
    for (of_three, of_four), kind in KINDS.items():
        kinds[(triangles == of_three) & (quadrilaterals == of_four) & (counts == of_three + of_four)] = kind
    others = np.flatnonzero(kinds == 0)
    if len(others):
        raise BadFile(f"{FILE}: cells that are not hexahedra, wedges, pyramids or tetrahedra: {len(others)}, the "
                      f"first is cell {others[0]}, with {counts[others[0]]} faces")
    return kinds


def looking_out(corners, inside_out):
    """The corners of faces turned round where they are `inside_out`: the first one stays."""
    sizes = (corners >= 0).sum(axis=1)
    steps = np.arange(corners.shape[1])
    places = np.where(steps < sizes[:, np.newaxis], -steps % sizes[:, np.newaxis], steps)
    return np.where(inside_out[:, np.newaxis], np.take_along_axis(corners, places, axis=1), corners)


def corners_of(kind, faces, numbers):
    """The corners of cells of a type, from the corners (cells, faces, corners) of their faces."""
    sizes = (faces >= 0).sum(axis=2)
    size = BASE[kind]
    base = np.argmax(sizes == size, axis=1)
    bottom = np.take_along_axis(faces, base[:, np.newaxis, np.newaxis], axis=1)[:, 0, size - 1::-1]
    top = np.stack([corner_before(faces, sizes, bottom[:, i], bottom[:, (i + 1) % size]) for i in range(size)], axis=1)
    whole = (top >= 0).all(axis=1)
    top = top[:, :1] if kind in PEAKED else top
    corners = np.concatenate([bottom, top], axis=1)
    ordered = np.sort(corners, axis=1)
    whole &= (ordered[:, 1:] > ordered[:, :-1]).all(axis=1)  # All different,
    whole &= (np.isin(faces, [-1]) | (faces[..., np.newaxis] == corners[:, np.newaxis, np.newaxis]).any(axis=3)).all(
        axis=(1, 2))  # and no others in its faces.
    if not whole.all():
        raise BadFile(f"{FILE}: the faces of cell {numbers[np.argmin(whole)]} do not fit together")
    return corners


def corner_before(faces, sizes, start, end):
    """In the face of each cell with the edge from `start` to `end` the corner before these, or -1."""
    found = np.full(len(faces), -1)
    for face in range(faces.shape[1]):
        for corner in range(faces.shape[2]):
            size = sizes[:, face]
            after = np.where(corner + 1 < size, corner + 1, 0)
            here = (faces[:, face, corner] == start) & (
                np.take_along_axis(faces[:, face], after[:, np.newaxis], axis=1)[:, 0] == end) & (corner < size)
            before = np.where(corner > 0, corner - 1, size - 1)
            found[here] = np.take_along_axis(faces[:, face], before[:, np.newaxis], axis=1)[here, 0]
    return found
