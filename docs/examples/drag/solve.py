#!/usr/bin/python3
"""Computes the flow past the wing in MESH.vtu, its drag and the indicator of each cell; writes them to OUTPUT.vtu.

    mpirun -np N /usr/bin/python3 -m mpi4py solve.py MESH.vtu OUTPUT.vtu [options]

(`-m mpi4py` ends all ranks where one fails.) The flow starts from the arrays velocity and pressure of MESH, if it has
them: refinement has interpolated them from the mesh before.
"""

import argparse
import json

import dolfin as df
import numpy as np

import exchange
import flow as flows
from exchange import COMM
from indicator import dual_weighted_residual

WING, WALLS, FAR = 1, 2, 3  # Tags of naca0012_mesh.py: the wing, the walls at its ends, the rest of the box.


def boundary_parts(file):
    """The tags of flow.py for the file's triangles: (triangles,) integers. The far field is told by its planes."""
    tags = file.cell_data_dict[exchange.TAGS]["triangle"]
    corners = file.points[file.cells_dict["triangle"]]
    lower, upper = file.points.min(axis=0), file.points.max(axis=0)
    far = tags == FAR
    inflow = far & (corners[:, :, 0] == lower[0]).all(axis=1)
    sides = far & ((corners[:, :, 2] == lower[2]) | (corners[:, :, 2] == upper[2])).all(axis=1)
    parts = [(tags == WING, flows.WING), (tags == WALLS, flows.WALLS), (inflow, flows.INFLOW), (sides, flows.SIDES)]
    return np.select([chosen for chosen, _ in parts], [part for _, part in parts], 0)


def start(flow, file):
    """Sets the first state. Returns whether it was carried over from another mesh."""
    arrays = file.point_data
    if "velocity" not in arrays:
        flow.start_from_inflow()
        return False
    exchange.to_function(np.column_stack([arrays["velocity"], arrays["pressure"]]), flow.state)
    return True


def wing_size(file):
    """Chord and span."""
    wing = file.points[file.cells_dict["triangle"][file.cell_data_dict[exchange.TAGS]["triangle"] == WING].ravel()]
    extent = wing.max(axis=0) - wing.min(axis=0)
    return float(extent[0]), float(extent[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh")
    parser.add_argument("output")
    parser.add_argument("--reynolds", type=float, default=1000.0, help="of the chord (default %(default)g)")
    parser.add_argument("--time-step", type=float, default=0.5, help="the chord is 3, the speed 1 (default %(default)g)")
    parser.add_argument("--steps", type=int, default=40, help="time steps (default %(default)s)")
    parser.add_argument("--averaged", type=int, default=13, help="the last ones, whose mean counts (default %(default)s)")
    parser.add_argument("--report", help="a .json file")
    options = parser.parse_args()
    df.set_log_level(df.LogLevel.ERROR)

    file = exchange.read_file(options.mesh)
    chord, span = wing_size(file)
    mesh = exchange.distributed_mesh(file, options.output + ".xdmf")
    flow = flows.Flow(mesh, exchange.facet_tags(mesh, file, boundary_parts(file)), nu=chord / options.reynolds)
    carried_over = start(flow, file)
    first = exchange.from_function(flow.state, file)
    change = flow.run(options.time_step, options.steps, options.averaged)
    drag = flow.drag()
    indicator = exchange.from_cells(dual_weighted_residual(flow, flow.dual()), file)
    mean = exchange.from_function(flow.mean, file)
    if COMM.rank == 0:
        exchange.write_file(options.output, file, {"velocity": mean[:, :3], "pressure": mean[:, 3]}, indicator)
        report = {"cells": len(exchange.tetrahedra(file)), "vertices": len(file.points), "ranks": COMM.size,
                  "drag": drag, "drag_coefficient": drag / (0.5 * chord * span), "change": change,
                  "carried_over": carried_over, "first_state": float(np.linalg.norm(first)),
                  "indicator_sum": float(indicator.sum())}
        print(json.dumps(report))
        if options.report:
            with open(options.report, "w", encoding="utf-8") as output:
                json.dump(report, output, indent=2)


if __name__ == "__main__":
    main()
