#!/usr/bin/python3
"""Measures ProjectOntoCAD on one core against two: points near the CAD, and a mesh, most of whose work is the mesh.

    tests/benchmarks/projection.py [CASE ...]

A case is a CAD file, after a comma a mesh and how often to refine it, or else a million points near the CAD are used.
"""

import os
import sys

from refinement import HERE, ROOT, run

DATA = os.path.join(ROOT, "data")
CASES = (
    os.path.join(DATA, "aeroplane.igs"),
    "/usr/share/opencascade/data/iges/bearing.iges",
    os.path.join(DATA, "naca0012_sharp.igs"),
    f"{DATA}/aeroplane.igs,{DATA}/aeroplane_coarse.vtu,1",
    f"{DATA}/naca0012_sharp.igs,{DATA}/naca0012_coarse.vtu,5",
)


def main():
    print("ProjectOntoCAD, one core and two")
    print(f"{'CAD':>22} {'points':>9} {'cells':>9} {'one, s':>7} {'two, s':>7} {'ratio':>6}; wanted: 1.8")
    for case in sys.argv[1:] or CASES:
        command = ["pvpython", os.path.join(HERE, "projection_ours.py"), *case.split(",")]
        one, two = run(command, 1), run(command, 2)
        name = os.path.basename(case.split(",")[0])
        print(f"{name:>22} {one['points']:9,} {one['cells']:9,} {one['seconds']:7.3f} {two['seconds']:7.3f} "
              f"{one['seconds'] / two['seconds']:6.2f}", flush=True)


if __name__ == "__main__":
    main()
