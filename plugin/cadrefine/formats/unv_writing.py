"""Writes universal files (.unv) of I-DEAS, as SALOME reads them, with groups."""

import numpy as np

from cadrefine.formats import BadFile
from cadrefine.formats.cells import inverse, reordered
from cadrefine.formats.grid import PHYSICAL
from cadrefine.formats.groups import grouped, members
from cadrefine.formats.unv import BEAMS, ELEMENT_MEMBER, ORDERS

DESCRIPTORS = {3: 11, 21: 22, 5: 91, 22: 92, 9: 94, 23: 95, 10: 111, 24: 118, 12: 115, 25: 116, 13: 112, 26: 113,
               27: 114}
RING_ORDERS = inverse(ORDERS)
A_LINE = 8  # Numbers in a line.
PYRAMID = 14


def write(path, mesh):
    """Vertices are left out."""
    mesh = grouped(mesh)
    if any(kind == PYRAMID for kind, _ in mesh.blocks):
        raise BadFile("universal files can hold only quadratic pyramids")
    dimensions = mesh.cell_dimensions()
    numbers = np.cumsum(dimensions > 0) * (dimensions > 0)
    with open(path, "w", encoding="utf-8") as file:
        begin(file, 2411)
        table = np.column_stack([1 + np.arange(len(mesh.points)), mesh.points])
        np.savetxt(file, table, "%10d         1         1        11\n%25.16E%25.16E%25.16E")
        end(file)
        begin(file, 2412)
        first = 0
        for kind, nodes in mesh.blocks:
            cells = slice(first, first + len(nodes))
            first = cells.stop
            if kind in DESCRIPTORS:
                tags = np.maximum(mesh.cell_data[PHYSICAL][cells], 1)
                rows = np.column_stack([numbers[cells], tags, reordered(kind, nodes, RING_ORDERS) + 1])
                np.savetxt(file, rows, element_format(DESCRIPTORS[kind], nodes.shape[1]))
        end(file)
        begin(file, 2467)
        for number, (name, (_, dimension)) in enumerate(mesh.groups.items(), 1):
            if dimension > 0:
                write_group(file, number, name, numbers[members(mesh, name)])
        end(file)


def begin(file, dataset):
    file.write(f"    -1\n{dataset:>6}\n")


def end(file):
    file.write("    -1\n")


def element_format(descriptor, count):
    head = f"%10d{descriptor:>10}%10d{1:>10}{7:>10}{count:>10}\n"
    beam = f"{0:>10}{1:>10}{1:>10}\n" if descriptor in BEAMS else ""
    lines = [min(A_LINE, count - first) for first in range(0, count, A_LINE)]
    return head + beam + "\n".join("%10d" * of_line for of_line in lines)


def write_group(file, number, name, elements):
    file.write(f"{number:>10}{'         0' * 6}{len(elements):>10}\n{name}\n")
    rows = np.column_stack([np.full(len(elements), ELEMENT_MEMBER), elements, *np.zeros((2, len(elements)), int)])
    pairs = len(rows) // 2 * 2
    np.savetxt(file, rows[:pairs].reshape(-1, A_LINE), "%10d" * A_LINE)
    np.savetxt(file, rows[pairs:], "%10d" * rows.shape[1])
