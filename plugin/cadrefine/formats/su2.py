"""Reads and writes SU2's meshes; the names of markers are those of groups. (meshio's reader drops the names.)"""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import FACET_TYPES, LINEAR, TURNED, TYPES, turned_where_negative
from cadrefine.formats.grid import Mesh
from cadrefine.formats.grid import check as check_nodes
from cadrefine.formats.groups import NAME, group_names, grouped
from cadrefine.formats.sides import sides_of, tagged

TAGS = "su2:tag"
KINDS = (3, 5, 9, 10, 12, 13, 14)  # SU2 numbers types of cells as VTK does, and their corners.
WEDGE = 13


def read(path):
    """The Mesh; cells of the mesh's own dimension are in no group. Volume cells are the right way round, as SU2 turns
    them itself. Throws BadFile."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = Lines(file)
        try:
            return read_lines(lines)
        except (ValueError, IndexError) as error:
            raise BadFile(f"line {lines.number} is malformed: {error}") from None


class Lines:
    """The lines of a file that say something, without comments."""

    def __init__(self, file):
        self.file, self.number = file, 0

    def __iter__(self):
        for line in self.file:
            self.number += 1
            text = line.partition("%")[0].strip()
            if text:
                yield text

    def table(self, count):
        """The numbers of the next `count` lines."""
        rows = [text.split() for _, text in zip(range(count), self)]
        if len(rows) < count:
            raise BadFile("it is cut short")
        return rows


def read_lines(lines):
    points, cells, tags, groups, dimension, tag = np.zeros((0, 3)), {}, {}, {}, 0, 0
    for text in lines:
        key, _, value = (part.strip() for part in text.partition("="))
        if key == "NZONE" and int(value) > 1:
            raise BadFile("it holds several zones; save each in a file of its own")
        if key == "NDIME":
            dimension = int(value)
        elif key == "NPOIN":
            points = np.array([row[:dimension] for row in lines.table(int(value.split()[0]))], dtype=float)
        elif key == "MARKER_TAG":
            tag = number_of(value, groups)
            groups[value] = (tag, dimension - 1)
        elif key in ("NELEM", "MARKER_ELEMS"):
            add_cells(cells, tags, lines.table(int(value)), tag if key == "MARKER_ELEMS" else 0)
    blocks = [(kind, np.array(rows, dtype=int)) for kind, rows in cells.items()]
    numbers = np.concatenate([[], *(tags[kind] for kind, _ in blocks)]).astype(np.int32)
    mesh = Mesh(points, blocks, {}, {TAGS: numbers}, groups)
    check_nodes(mesh)
    mesh.blocks = [(kind, turned_where_negative(points, kind, corners)) for kind, corners in blocks]
    return mesh


def number_of(name, groups):
    """That which the name says, or the next one."""
    taken = {tag for tag, _ in groups.values()}
    wanted = int(name) if name.isdecimal() else 0
    return wanted if wanted > 0 and wanted not in taken else 1 + max(taken, default=0)


def add_cells(cells, tags, rows, tag):
    """Rows have a type, the corners and, in some files, the number of the cell."""
    for row in rows:
        kind = int(row[0])
        if kind == 1:  # A vertex, which tells of pieces of a mesh.
            continue
        if kind not in KINDS:
            raise BadFile(f"holds cells of the type {kind}")
        cells.setdefault(kind, []).append([int(word) for word in row[1:1 + TYPES[kind][2]]])
        tags.setdefault(kind, []).append(tag)


def check(mesh):
    """Throws BadFile where the format cannot hold the mesh."""
    if any(kind in LINEAR for kind, _ in mesh.blocks):
        raise BadFile("SU2 has no quadratic cells")
    if mesh.cell_dimensions().max(initial=0) < dimension_of(mesh):
        raise BadFile("SU2 has no meshes of surfaces in space")


def dimension_of(mesh):
    return 3 if np.any(mesh.points[:, 2]) else 2


def write(path, mesh):
    """Every facet of the boundary is in one marker, that of its first group; facets between cells cannot be in any."""
    check(mesh)
    mesh = grouped(mesh)
    sides = sides_of(mesh)
    tags = np.where(sides.neighbours < 0, tagged(mesh, sides), 0)
    dimension = dimension_of(mesh)
    with open(path, "w", encoding="utf-8") as file:
        cells = [block for block in mesh.blocks if TYPES[block[0]][1] == dimension]
        file.write(f"NDIME= {dimension}\nNELEM= {sum(len(corners) for _, corners in cells)}\n")
        for kind, corners in cells:
            write_cells(file, kind, corners[:, TURNED[kind]] if kind == WEDGE else corners)
        file.write(f"NPOIN= {len(mesh.points)}\n")
        np.savetxt(file, mesh.points[:, :dimension], "%.17g")
        markers = {tag: name for tag, name in group_names(mesh, dimension - 1, NAME).items() if (tags == tag).any()}
        file.write(f"NMARK= {len(markers)}\n")
        for tag, name in markers.items():
            corners = sides.corners[tags == tag]
            file.write(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(corners)}\n")
            sizes = (corners >= 0).sum(axis=1)
            for size in np.unique(sizes):
                write_cells(file, FACET_TYPES[size], corners[sizes == size, :size])


def write_cells(file, kind, corners):
    np.savetxt(file, np.column_stack([np.full(len(corners), kind), corners]), "%d")
