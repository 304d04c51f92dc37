#!/usr/bin/python3
"""Writes a hole bounded by three circular arcs, as IGES curves, or a square of coarse triangles around it.

The arcs bulge outward from the triangle (0, 0), (4, 0), (0, 3) and meet at its corners with an angle. Corners,
centres and radii are exact in binary:

    arc   from     to       centre             radius   half angle
    0     (0, 0)   (4, 0)   (2, 3.75)          4.25     asin(8/17)
    1     (4, 0)   (0, 3)   (-0.8125, -2.25)   5.3125   asin(8/17)
    2     (0, 3)   (0, 0)   (2, 1.5)           2.5      asin(3/5)

Counter-clockwise, as IGES wants them. A chord that spans the angle a of an arc of radius r cuts off the circular
segment r^2 (a - sin a) / 2.

The mesh's vertices on the hole lie near the arcs but not on them: moved along the arc's normal by up to 4 percent
of the edge; one vertex stands near each corner. Meshing needs python3-gmsh.
"""

import argparse
import math

from iges import IgesFile

CORNERS = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)]
CENTRES = [(2.0, 3.75), (-0.8125, -2.25), (2.0, 1.5)]
RADII = [4.25, 5.3125, 2.5]
SQUARE = [(-3.0, -4.0), (6.0, -4.0), (6.0, 5.0), (-3.0, 5.0)]
EDGES = [3, 4, 3]  # Edges of the mesh along each arc.
OFFSET = 0.04  # Largest distance of a moved vertex from its arc, in edge lengths.


def arc_ends(arc):
    return CORNERS[arc], CORNERS[(arc + 1) % 3]


def arc_angles(arc):
    """First and last angle of the arc, the last the larger."""
    (x0, y0), (x1, y1) = arc_ends(arc)
    cx, cy = CENTRES[arc]
    first, last = math.atan2(y0 - cy, x0 - cx), math.atan2(y1 - cy, x1 - cx)
    return first, last if last > first else last + 2 * math.pi


def point_on_arc(arc, angle, radius_change=0.0):
    radius = RADII[arc] + radius_change
    return CENTRES[arc][0] + radius * math.cos(angle), CENTRES[arc][1] + radius * math.sin(angle)


def write_iges(path, as_nurbs):
    file = IgesFile(path.rsplit("/", 1)[-1], "Three circular arcs that close a curve with three corners")
    for arc, centre in enumerate(CENTRES):
        start, end = arc_ends(arc)
        if as_nurbs:
            half = (arc_angles(arc)[1] - arc_angles(arc)[0]) / 2
            apex = point_on_arc(arc, arc_angles(arc)[0] + half, RADII[arc] * (1 / math.cos(half) - 1))
            file.curve(2, [0, 0, 0, 1, 1, 1], [(*start, 0.0), (*apex, 0.0), (*end, 0.0)],
                       planar_normal=(0, 0, 1), rational_weights=[1.0, math.cos(half), 1.0])
        else:
            file.add(100, [0.0, *centre, *start, *end], [centre, start, end])
    file.write(path)


def hole_polygon():
    """The mesh's vertices on the hole: off the arcs, out and in by turns; near the corners, but not on them."""
    polygon = []
    for arc, edges in enumerate(EDGES):
        first, last = arc_angles(arc)
        edge = RADII[arc] * (last - first) / edges
        for i in range(edges):
            share = OFFSET * (-1) ** i * (0.75 if i == 0 else 1.0 - 0.25 * (i % 3))
            polygon.append((*point_on_arc(arc, first + (last - first) * i / edges, share * edge), 0.0))
    return polygon


def write_mesh(path, size):
    from coarse_mesh import mesh_around
    from vtu import mean_ratio, write_vtu

    points, cells = mesh_around([(*corner, 0.0) for corner in SQUARE], hole_polygon(), size=size)
    write_vtu(path, points, [cells])
    quality = mean_ratio(points, cells)
    print(f"{path}: {len(points)} vertices, {len(cells)} triangles, {sum(EDGES)} vertices around the hole, "
          f"quality {quality.min():.3f} to {quality.max():.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nurbs", action="store_true", help="entities 126 (rational B-splines) instead of 100 (arcs)")
    parser.add_argument("--size", type=float, default=3.0, help="edge length on the square (default %(default)s)")
    parser.add_argument("output", help="an .igs file for the curves, a .vtu file for the mesh")
    arguments = parser.parse_args()
    if arguments.output.endswith(".vtu"):
        write_mesh(arguments.output, arguments.size)
    else:
        write_iges(arguments.output, arguments.nurbs)


if __name__ == "__main__":
    main()
