#!/usr/bin/python3
"""Writes a ball of radius 2 in hexahedra, near the surface of the ball of data/solid_mesh.py but not on it.

A cube of cubes in the middle, and shells of hexahedra from its surface to the sphere, so that no cell has two facets
on it. Vertices of the surface are moved off the sphere, in and out by turns.
"""

import argparse
import itertools
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data"))
from vtu import write_vtu  # noqa: E402

RADIUS = 2.0
CUBE = 0.8  # Half the side of the cube.
OFFSET = 0.02  # Of the radius: how far vertices are off the surface.
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # Outward.


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=2, help="along each edge of the cube (default %(default)s)")
    parser.add_argument("--shells", type=int, default=2, help="round it (default %(default)s)")
    parser.add_argument("output", help="the .vtu file")
    arguments = parser.parse_args()

    count = arguments.cells
    lattice = np.array(list(itertools.product(range(count + 1), repeat=3)))
    steps = np.array([(count + 1)**2, count + 1, 1])
    firsts = np.array(list(itertools.product(range(count), repeat=3))) @ steps
    cells = firsts[:, None] + np.array(CORNERS) @ steps
    outer = ((lattice == 0) | (lattice == count)).any(axis=1)
    sides = np.array([cell[list(face)] for cell in cells for face in FACES])
    # All corners on one side of the cube.
    sides = sides[[any((lattice[side][:, k] == end).all() for k in range(3) for end in (0, count)) for side in sides]]

    cube = CUBE * (2 * lattice / count - 1)
    inside = cube[outer]
    turns = (-1.0) ** lattice[outer].sum(axis=1)
    sphere = RADIUS * (1 + OFFSET * turns[:, None]) * inside / np.linalg.norm(inside, axis=1)[:, None]
    parts = np.arange(1, arguments.shells + 1) / arguments.shells
    points = np.vstack([cube, *(inside + part * (sphere - inside) for part in parts)])
    number = np.cumsum(outer) - 1
    shells = [sides] + [len(cube) + k * outer.sum() + number[sides] for k in range(arguments.shells)]
    hexahedra = np.vstack([cells, *(np.hstack(pair) for pair in zip(shells, shells[1:]))])
    write_vtu(arguments.output, points, [hexahedra])
    print(f"{arguments.output}: {len(points)} vertices, {len(hexahedra)} hexahedra")


if __name__ == "__main__":
    main()
