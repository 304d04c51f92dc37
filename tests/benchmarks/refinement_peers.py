#!/usr/bin/python3
"""One peer's refinement of the unit box: refinement_peers.py PROGRAM uniform|marked EDGES. Prints a JSON object.

Marked are the cells whose centre is within 0.2 of the box's axis along z. `seconds` is the processor time of the call
that refines.
"""

import json
import sys
import time

RADIUS = 0.2


def timed(work):
    started = time.process_time()
    result = work()
    return result, time.process_time() - started


def near_axis(x, y):
    return (x - 0.5) ** 2 + (y - 0.5) ** 2 < RADIUS**2


def dolfin(method, edges):
    import dolfin as df

    df.set_log_level(df.LogLevel.ERROR)
    mesh = df.UnitCubeMesh(edges, edges, edges)
    if method == "uniform":
        fine, seconds = timed(lambda: df.refine(mesh))
        return mesh.num_cells(), fine.num_cells(), seconds
    markers = df.MeshFunction("bool", mesh, 3, False)
    corners = mesh.coordinates()[mesh.cells()].mean(axis=1)
    markers.array()[:] = near_axis(corners[:, 0], corners[:, 1])
    fine, seconds = timed(lambda: df.refine(mesh, markers))
    return mesh.num_cells(), fine.num_cells(), seconds


def dolfinx(method, edges):
    import dolfinx.mesh as dm
    import numpy as np
    from mpi4py import MPI

    mesh = dm.create_unit_cube(MPI.COMM_WORLD, edges, edges, edges)
    cells = mesh.topology.index_map(3).size_local
    mesh.topology.create_entities(1)  # Its caller has to; not counted.
    if method == "uniform":
        fine, seconds = timed(lambda: dm.refine(mesh, redistribute=False))
    else:
        mesh.topology.create_connectivity(3, 1)
        corners = mesh.geometry.x[mesh.geometry.dofmap.array.reshape(-1, 4)].mean(axis=1)
        marked = np.flatnonzero(near_axis(corners[:, 0], corners[:, 1])).astype(np.int32)
        marked_edges = dm.compute_incident_entities(mesh, marked, 3, 1)
        fine, seconds = timed(lambda: dm.refine(mesh, marked_edges, redistribute=False))
    return cells, fine.topology.index_map(3).size_local, seconds


def gmsh(_method, edges):
    import gmsh as gm

    gm.initialize()
    gm.option.setNumber("General.Terminal", 0)
    points, cells = kuhn_box(edges)
    volume = gm.model.addDiscreteEntity(3)
    gm.model.mesh.addNodes(3, volume, range(1, len(points) // 3 + 1), points)
    gm.model.mesh.addElementsByType(volume, 4, [], cells)
    _, seconds = timed(gm.model.mesh.refine)
    made = len(gm.model.mesh.getElementsByType(4)[0])
    gm.finalize()
    return len(cells) // 4, made, seconds


def kuhn_box(edges):
    """Coordinates of the vertices of the unit box, and vertices (from 1 on) of its tetrahedra, in rows."""
    import itertools

    import numpy as np

    side = np.arange(edges + 1) / edges
    z, y, x = np.meshgrid(side, side, side, indexing="ij")
    corner = np.arange((edges + 1) ** 3).reshape(edges + 1, edges + 1, edges + 1)[:-1, :-1, :-1].ravel()
    step = (1, edges + 1, (edges + 1) ** 2)
    blocks = []
    for order in itertools.permutations(range(3)):
        path = np.cumsum([0] + [step[k] for k in order])
        odd = order in ((0, 2, 1), (1, 0, 2), (2, 1, 0))
        path = path[[0, 2, 1, 3]] if odd else path
        blocks.append(corner[:, None] + path)
    cells = np.stack(blocks, axis=1).reshape(-1) + 1
    return np.column_stack([x.ravel(), y.ravel(), z.ravel()]).ravel(), cells


def main():
    program, method, edges = sys.argv[1:]
    cells, made, seconds = {"dolfin": dolfin, "dolfinx": dolfinx, "gmsh": gmsh}[program](method, int(edges))
    print(json.dumps({"cells": cells, "made": made, "seconds": seconds}))


if __name__ == "__main__":
    main()
