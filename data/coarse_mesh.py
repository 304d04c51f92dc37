"""Coarse meshes around a hole with python3-gmsh, from polygons whose edges stay edges of the mesh."""

import gmsh
import numpy as np

TRIANGLE, TETRAHEDRON = 2, 4  # gmsh's numbers of cell types.
CORNERS = {TRIANGLE: 3, TETRAHEDRON: 4}


def mesh_around(outer, hole, inside=(), size=1e9, draw_out=None):
    """Meshes the plane between two polygons, with further vertices at `inside`.

    Polygons are lists of points (x, y, z); edges of `outer` are cut to `size`. With `draw_out`, a vector and
    a number of layers, the triangles are drawn out to tetrahedra. Returns points (n, 3) and cells.
    """
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    geo = gmsh.model.geo
    loops = []
    for polygon in (outer, hole):
        points = [geo.addPoint(*point, size) for point in polygon]
        curves = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
        if polygon is hole:
            for curve in curves:
                geo.mesh.setTransfiniteCurve(curve, 2)
        loops.append(geo.addCurveLoop(curves))
    surface = geo.addPlaneSurface(loops)
    extra = [geo.addPoint(*point, size) for point in inside]
    geo.synchronize()
    gmsh.model.mesh.embed(0, extra, 2, surface)
    if draw_out:
        vector, layers = draw_out
        geo.extrude([(2, surface)], *vector, numElements=[layers])
        geo.synchronize()
    gmsh.model.mesh.generate(3 if draw_out else 2)
    return finished_mesh(TETRAHEDRON if draw_out else TRIANGLE)


def finished_mesh(cell_type=TETRAHEDRON):
    """Points and cells of the mesh that gmsh has made; ends gmsh."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, nodes = gmsh.model.mesh.getElementsByType(cell_type)
    gmsh.finalize()
    number = {tag: i for i, tag in enumerate(tags)}
    cells = np.array([number[node] for node in nodes]).reshape(-1, CORNERS[cell_type])
    return used_points(coordinates.reshape(-1, 3), cells)


def used_points(points, cells):
    """Drops points that no cell uses, rounds gmsh's noise away and turns tetrahedra to positive volume and
    triangles of the plane z = 0 to positive area."""
    used, numbers = np.unique(cells, return_inverse=True)
    points, cells = points[used].round(14) + 0.0, numbers.reshape(cells.shape)
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    inverted = (np.linalg.det(edges) if cells.shape[1] == 4 else np.cross(edges[:, 0], edges[:, 1])[:, 2]) < 0
    cells[inverted, -2:] = cells[inverted, -2:][:, ::-1]
    return points, cells


def boundary_faces(cells):
    """The faces that belong to one tetrahedron only, pointing outward."""
    faces = cells[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]
