#!/usr/bin/python3
"""Writes a boundary layer of wedges round the blunt NACA 0012 section of data/naca0012.py.

The section has some forty vertices, and the wing runs from wall to wall in a few strips along y. Each of their
quadrilaterals is two triangles, over which wedges stand, each layer higher than the one below it by a constant factor,
out to two fifths of a chord. Vertices of the wing are on the section already, its facets are chords.
"""

import argparse
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data"))
from naca0012 import CHORD, SPAN  # noqa: E402
from naca0012_mesh import section_polygon  # noqa: E402
from vtu import write_vtu  # noqa: E402


def directions(polygon):
    """Outward at each vertex, as long as keeps a layer as high over both edges there."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / np.linalg.norm(edges, axis=1)[:, None]
    sums = normals + np.roll(normals, 1, axis=0)
    return 2 * sums / (sums**2).sum(axis=1)[:, None]


def heights(first, growth, layers):
    return np.concatenate([[0.0], np.cumsum(first * growth**np.arange(layers))])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--around", type=int, default=41, help="vertices round the section (default %(default)s)")
    parser.add_argument("--strips", type=int, default=4, help="of cells along y (default %(default)s)")
    parser.add_argument("--layers", type=int, default=22, help="(default %(default)s)")
    parser.add_argument("--first", type=float, default=1e-4, help="height of the first one in chords (default %(default)s)")
    parser.add_argument("--growth", type=float, default=1.4, help="of the height (default %(default)s)")
    parser.add_argument("output", help="the .vtu file")
    arguments = parser.parse_args()

    polygon = np.array(section_polygon(arguments.around, "blunt"))
    levels = heights(arguments.first, arguments.growth, arguments.layers)
    rings = CHORD * (polygon + levels[:, None, None] * directions(polygon))
    stations = np.linspace(0, SPAN, arguments.strips + 1)
    points = np.array([(x, y, z) for ring in rings for y in stations for x, z in ring])

    around = len(polygon)
    on_level = around * len(stations)
    triangles = []
    for strip in range(arguments.strips):
        for i in range(around):
            a, b = around * strip + i, around * strip + (i + 1) % around
            c, d = b + around, a + around
            triangles += [(a, b, c), (a, c, d)] if (strip + i) % 2 else [(a, b, d), (b, c, d)]
    triangles = np.array(triangles)
    # As VTK draws wedges: the first triangle looks out of the cell, here into the wing.
    wedges = np.concatenate([np.hstack([triangles + on_level * k, triangles + on_level * (k + 1)])
                             for k in range(arguments.layers)])
    write_vtu(arguments.output, points, [wedges])
    print(f"{arguments.output}: {len(points)} vertices, {len(wedges)} wedges, {arguments.layers} layers "
          f"of {levels[1]:g} to {levels[-1] - levels[-2]:.2g} chords")


if __name__ == "__main__":
    main()
