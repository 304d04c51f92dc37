#!/usr/bin/python3
"""Writes a box of coarse tetrahedra around the aeroplane of aeroplane.cxx (needs python3-gmsh).

The aeroplane comes as the solid that `aeroplane --plain` writes: the shape of aeroplane.igs without its patch lines,
which would force short edges on the mesh. Edges are shorter in the nose, x in [0.05, 0.2], and grow with the distance
from the aeroplane. Then the aeroplane's vertices are moved off the surface, along its normal, by up to 4 percent of
their shortest edge on it: the mesh lies near the CAD but not on it. The moves depend on the vertex alone.
"""

import argparse
import math

import gmsh
import numpy as np

from coarse_mesh import boundary_faces, finished_mesh
from vtu import mean_ratio, write_vtu

BOX = ((-2.0, -3.0, -2.5), (5.0, 3.0, 2.5))
NOSE_X = (0.05, 0.2)
GROWTH = 0.35  # Of the edge length, a length away from the aeroplane.
FROM_NOSE = 0.5  # The same, along the fuselage from the nose.
OFFSET = 0.04  # Largest distance of a moved vertex from the surface, in lengths of its shortest edge.
DIGITS = 9  # Behind the point, in the file.
TAGS = {"aeroplane": 1, "far": 2}


def set_sizes(surfaces, size, nose_size):
    """Edge lengths over the distance from the aeroplane and from its nose."""
    field = gmsh.model.mesh.field
    field.add("Distance", 1)
    field.setNumbers(1, "SurfacesList", surfaces)
    field.setNumber(1, "NumPointsPerCurve", 60)  # And so squared on each surface.
    centre, half = sum(NOSE_X) / 2, (NOSE_X[1] - NOSE_X[0]) / 2
    from_nose = f"{FROM_NOSE}*Max(0,Abs(x-{centre})-{half})"
    field.add("MathEval", 2)
    field.setString(2, "F", f"Min({size},{nose_size}+{from_nose})+{GROWTH}*F1")
    field.setAsBackgroundMesh(2)
    for source in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)


def mesh_around(path, size, nose_size):
    """Points and tetrahedra between the solid of the file and the box."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    solid = gmsh.model.occ.importShapes(path)
    low, high = np.array(BOX)
    box = gmsh.model.occ.addBox(*low, *(high - low))
    gmsh.model.occ.cut([(3, box)], solid)
    gmsh.model.occ.synchronize()
    boxes = {tag: gmsh.model.getBoundingBox(2, tag) for _, tag in gmsh.model.getEntities(2)}
    set_sizes([tag for tag, ends in boxes.items() if ends[0] > -1 and ends[3] < 3], size, nose_size)
    gmsh.model.mesh.generate(3)
    return finished_mesh()


def boundary_triangles(points, cells):
    """The boundary's triangles, pointing outward, and their tags."""
    triangles = boundary_faces(cells)
    low, high = np.array(BOX)
    corners = points[triangles]
    far = (np.isclose(corners, low) | np.isclose(corners, high)).all(axis=1).any(axis=1)
    return triangles, np.where(far, TAGS["far"], TAGS["aeroplane"])


def normals_and_edges(points, triangles):
    """Unit normal and shortest edge of each vertex of the triangles; NaN and infinity at the others."""
    corners = points[triangles]
    normals = np.zeros_like(points)
    shortest = np.full(len(points), np.inf)
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for k in range(3):
        np.add.at(normals, triangles[:, k], areas)
        lengths = np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1)
        for end in (k, k - 1):
            np.minimum.at(shortest, triangles[:, end], lengths)
    with np.errstate(invalid="ignore"):
        return normals / np.linalg.norm(normals, axis=1)[:, None], shortest


def move_off_surface(points, cells, triangles):
    """Moves the aeroplane's vertices along its normal, out and in, by different lengths. Where a cell would lose half
    of its quality, its vertices stay."""
    normals, shortest = normals_and_edges(points, triangles)
    moves = np.zeros_like(points)
    for vertex in np.unique(triangles):
        share = OFFSET * math.cos(1.7 * vertex) * (0.6 + 0.4 * math.cos(0.3 * vertex))
        moves[vertex] = share * shortest[vertex] * normals[vertex]
    before = mean_ratio(points, cells)
    while (worse := mean_ratio(points + moves, cells) < 0.5 * before).any():
        moves[cells[worse]] = 0.0
    return points + moves


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=float, default=0.035, help="edge length on the aeroplane (default %(default)s)")
    parser.add_argument("--nose-size", type=float, default=0.0087, help="and on its nose (default %(default)s)")
    parser.add_argument("--boundary-triangles", action="store_true",
                        help="write the boundary's triangles too, with the cell array gmsh:physical: "
                        "1 aeroplane, 2 far field, 0 tetrahedra")
    parser.add_argument("solid", help="the .brep file that `aeroplane --plain` writes")
    parser.add_argument("output", help="the .vtu file")
    arguments = parser.parse_args()

    points, cells = mesh_around(arguments.solid, arguments.size, arguments.nose_size)
    triangles, tags = boundary_triangles(points, cells)
    points = move_off_surface(points, cells, triangles[tags == TAGS["aeroplane"]]).round(DIGITS) + 0.0
    blocks, arrays = [cells], {}
    if arguments.boundary_triangles:
        blocks.append(triangles)
        arrays["gmsh:physical"] = np.concatenate([np.zeros(len(cells), dtype=np.int32), tags.astype(np.int32)])
    write_vtu(arguments.output, points, blocks, arrays)
    quality = mean_ratio(points, cells)
    around = points[np.unique(triangles[tags == TAGS["aeroplane"]])]
    nose = (around[:, 0] >= NOSE_X[0]) & (around[:, 0] <= NOSE_X[1])
    nose &= (np.abs(around[:, 1]) <= 0.25) & (np.abs(around[:, 2]) <= 0.2)
    print(f"{arguments.output}: {len(points)} vertices, {len(cells)} tetrahedra, {len(around)} vertices on the "
          f"aeroplane, {nose.sum()} of them in the nose, quality {quality.min():.3f} to {quality.max():.3f}")


if __name__ == "__main__":
    main()
