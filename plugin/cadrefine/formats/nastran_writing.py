"""Writes Nastran's bulk data: nodes, and elements whose properties are the groups that they are in."""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import LAYERED, TYPES, reordered
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import grouped

CARDS = {3: "CROD", 5: "CTRIA3", 22: "CTRIA6", 9: "CQUAD4", 23: "CQUAD8", 10: "CTETRA", 24: "CTETRA", 12: "CHEXA",
         25: "CHEXA", 13: "CPENTA", 26: "CPENTA", 14: "CPYRAM", 27: "CPYRAM"}
A_LINE = 8  # Fields of a line, behind the name of the card.
LARGEST = 99_999_999  # Number that a field takes.
LONG = 16  # Columns of a field of the long format.


def write(path, mesh):
    """To be included behind BEGIN BULK. A cell has one property, that of its first group; names are HyperMesh's
    comments. Cells in no group have a property of their own; vertices and quadratic edges are left out."""
    mesh = grouped(mesh)
    blocks, first = [], 0
    pairs = sorted(mesh.groups.values(), key=lambda pair: -pair[1])
    properties = {pair: number for number, pair in enumerate(pairs, 1)}
    rest = len(properties) + 1
    for kind, nodes in mesh.blocks:
        tags = mesh.cell_data[PHYSICAL][first:first + len(nodes)].tolist()
        first += len(nodes)
        if kind in CARDS:
            numbers = np.array([properties.get((tag, TYPES[kind][1]), rest) for tag in tags])
            blocks.append((kind, numbers, reordered(kind, nodes, LAYERED) + 1))
    if max(len(mesh.points), first) > LARGEST:
        raise BadFile(f"the mesh is too large: Nastran numbers nodes and elements only up to {LARGEST}")
    with open(path, "w", encoding="utf-8") as file:
        file.write("$ CADRefine\n")
        for name, pair in mesh.groups.items():
            file.write(f'$HMNAME PROP{properties[pair]:>20}"{name}"\n')
        for number, point in enumerate(mesh.points.tolist(), 1):
            x, y, z = map(real, point)
            file.write(f"GRID*   {number:>{LONG}}{'':{LONG}}{x}{y}\n*       {z}\n")
        written = 1
        for kind, numbers, nodes in blocks:
            ids = np.arange(written, written + len(nodes))
            written += len(nodes)
            np.savetxt(file, np.column_stack([ids, numbers, nodes]), card_format(CARDS[kind], 2 + nodes.shape[1]))


def card_format(name, fields):
    lines = [min(A_LINE, fields - first) for first in range(0, fields, A_LINE)]
    return "\n".join(f"{name if place == 0 else '+':<8}{'%8d' * count}" for place, count in enumerate(lines))


def real(value):
    """With as many digits as the field has room for."""
    text = next(text for text in (f"{value:.{digits}E}" if abs(value) < 1e-3 else f"{value:#.{digits}G}"
                                  for digits in range(LONG, 0, -1)) if len(text) <= LONG)
    return f"{text:>{LONG}}"
