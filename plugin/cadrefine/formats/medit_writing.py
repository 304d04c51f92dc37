"""Writes Medit's files in text, as Mmg and others read them, with the numbers of groups as references."""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import LINEAR
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import grouped

KEYWORDS = {3: "Edges", 5: "Triangles", 9: "Quadrilaterals", 10: "Tetrahedra", 12: "Hexahedra", 13: "Prisms",
            14: "Pyramids"}


def write(path, mesh):
    """A cell has one reference, the number of its first group, or 0; vertices are no cells there."""
    if any(kind in LINEAR for kind, _ in mesh.blocks):
        raise BadFile("Medit has no quadratic cells")
    mesh = grouped(mesh)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(mesh.points)}\n")
        np.savetxt(file, mesh.points, "%.17g %.17g %.17g 0")
        first = 0
        for kind, nodes in mesh.blocks:
            tags = mesh.cell_data[PHYSICAL][first:first + len(nodes)]
            first += len(nodes)
            if kind in KEYWORDS:
                file.write(f"{KEYWORDS[kind]}\n{len(nodes)}\n")
                np.savetxt(file, np.column_stack([nodes + 1, tags]), "%d")
        file.write("End\n")
