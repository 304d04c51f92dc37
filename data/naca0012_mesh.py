#!/usr/bin/python3
"""Writes a box of extremely coarse tetrahedra around the NACA 0012 section of naca0012.py (needs python3-gmsh).

The wing goes from wall to wall (y = 0 to y = span). The plane around the section is meshed with triangles and
drawn out along y in a few layers. Then the wing's vertices are moved off the surface, along the section's normal,
by up to 4 percent of their shorter edge along the section: the mesh lies near the CAD but not on it, as meshes of another CAD
version or of a facetted model do. The moves depend on the vertex number only: the same file every time.

Points of the trailing edge stay points of the mesh: one of a sharp edge and the two corners of a blunt one,
at each station along the span.
"""

import argparse
import math

import numpy as np

from coarse_mesh import boundary_faces, mesh_around
from naca0012 import CHORD, SPAN, half_thickness
from vtu import mean_ratio, write_vtu

# Lengths in the plane are in chords.
BOX_X = (-1.5, 2.5)
BOX_Z = (-1.5, 1.5)
LAYERS = 2
NOSE = 0.05  # x of the first vertices behind the leading edge, with 22 vertices around the section.
RING = 6  # Points between the section and the box, on an ellipse round the section.
OFFSET = 0.04  # Largest distance of a moved vertex from the surface, in lengths of its shorter edge.
TAGS = {"wing": 1, "walls": 2, "far": 3}


def chord_stations(count):
    """x of `count` + 1 points along one side, closer to each other near the leading edge."""
    first = NOSE * (11.0 / count) ** 2
    return [0.0] + [first + (1.0 - first) * (i / (count - 1)) ** 1.15 for i in range(count)]


def section_polygon(around, trailing_edge):
    """Points (x, z) of the section, from the trailing edge along the lower side, round the nose and back."""
    points = around - (trailing_edge == "blunt")
    lower, upper = chord_stations(points // 2), chord_stations(points - points // 2)
    polygon = [(x, -half_thickness(x, trailing_edge)) for x in lower[::-1]]
    polygon += [(x, half_thickness(x, trailing_edge)) for x in upper[1:]]
    return polygon[:-1] if trailing_edge == "sharp" else polygon


def box():
    return [(x, z) for z in BOX_Z for x in BOX_X[:: 1 if z < 0 else -1]]


def ring():
    angles = [2 * math.pi * i / RING for i in range(RING)]
    return [(0.5 + 0.95 * math.cos(angle), 0.6 * math.sin(angle)) for angle in angles]


def on_wall(plane):
    return [(x, 0.0, z) for x, z in plane]


def move_off_surface(points, polygon):
    """Moves the wing's points along the section's normal, out and in by turns and by different lengths."""
    polygon = np.array(polygon)
    following, previous = np.roll(polygon, -1, axis=0), np.roll(polygon, 1, axis=0)
    shorter = np.minimum(np.linalg.norm(following - polygon, axis=1), np.linalg.norm(polygon - previous, axis=1))
    tangents = following - previous
    normals = np.column_stack([-tangents[:, 1], tangents[:, 0]]) / np.linalg.norm(tangents, axis=1)[:, None]
    wing = np.zeros(len(points), dtype=bool)
    for index, point in enumerate(points):
        nearest = int(np.argmin(np.linalg.norm(polygon - point[[0, 2]], axis=1)))
        if np.linalg.norm(polygon[nearest] - point[[0, 2]]) < 1e-9:
            wing[index] = True
            station = int(round(1000 * point[1]))
            share = OFFSET * (0.6 + 0.4 * math.cos(1.7 * nearest + 0.003 * station)) * (-1) ** nearest
            points[index, [0, 2]] += share * shorter[nearest] * normals[nearest]
    return wing


def boundary_triangles(points, cells, wing, span):
    """The boundary's triangles, pointing outward, and their tags."""
    triangles = boundary_faces(cells)
    y = points[triangles, 1]
    walls = (y == 0.0).all(axis=1) | (y == span).all(axis=1)
    tags = np.where(walls, TAGS["walls"], np.where(wing[triangles].all(axis=1), TAGS["wing"], TAGS["far"]))
    return triangles, tags


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trailing-edge", choices=("blunt", "sharp"), default="sharp")
    parser.add_argument("--around", type=int, default=22, help="vertices around the section (default %(default)s)")
    parser.add_argument("--chord", type=float, default=float(CHORD), help="length along x (default %(default)s)")
    parser.add_argument("--span", type=float, default=SPAN, help="length along y (default %(default)s)")
    parser.add_argument("--layers", type=int, default=LAYERS, help="layers of cells along y (default %(default)s)")
    parser.add_argument("--far-size", type=float, default=4.0, help="edge length far away, in chords (default %(default)s)")
    parser.add_argument("--boundary-triangles", action="store_true",
                        help="write the boundary's triangles too, with the cell array gmsh:physical: "
                        "1 wing, 2 walls, 3 far field, 0 tetrahedra")
    parser.add_argument("output", help="the .vtu file")
    arguments = parser.parse_args()
    if not 8 <= arguments.around <= 60:
        parser.error("--around must lie between 8 and 60")

    polygon = section_polygon(arguments.around, arguments.trailing_edge)
    points, cells = mesh_around(on_wall(box()), on_wall(polygon), on_wall(ring()), arguments.far_size,
                                draw_out=((0.0, arguments.span / arguments.chord, 0.0), arguments.layers))
    wing = move_off_surface(points, polygon)
    points *= arguments.chord
    blocks, arrays = [cells], {}
    if arguments.boundary_triangles:
        triangles, tags = boundary_triangles(points, cells, wing, arguments.span)
        blocks.append(triangles)
        arrays["gmsh:physical"] = np.concatenate([np.zeros(len(cells), dtype=np.int32), tags.astype(np.int32)])
    write_vtu(arguments.output, points, blocks, arrays)
    quality = mean_ratio(points, cells)
    print(f"{arguments.output}: {len(points)} vertices, {len(cells)} tetrahedra, {len(polygon)} vertices around "
          f"the section, quality {quality.min():.3f} to {quality.max():.3f}")


if __name__ == "__main__":
    main()
