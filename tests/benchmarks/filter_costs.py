"""Processor time and peak memory of each filter for the NACA section after LEVELS uniform levels, in one pvpython.

    taskset -c 0 pvpython tests/benchmarks/filter_costs.py [LEVELS]

Memory is what the process has at its peak beyond what it had before the filter ran, the output included.
"""

import ctypes
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "plugin"))

from cadrefine import session
from paraview import simple

DATA = os.path.join(HERE, "..", "..", "data")


def memory(name):
    """VmRSS or VmHWM of this process in bytes."""
    with open("/proc/self/status", encoding="ascii") as file:
        return next(int(line.split()[1]) * 1024 for line in file if line.startswith(name))


def reset_peak():
    ctypes.CDLL(None).malloc_trim(0)  # What earlier filters freed does not serve this one.
    with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
        file.write("5")


def measure(label, proxy):
    reset_peak()
    before, started = memory("VmRSS"), time.process_time()
    proxy.UpdatePipeline()
    seconds, peak = time.process_time() - started, memory("VmHWM") - before
    cells = proxy.GetDataInformation().GetNumberOfCells()
    print(f"| {label} | {cells:,} | {seconds:.2f} | {1e6 * seconds / cells:.2f} | {peak / cells:.0f} |", flush=True)
    return proxy


def main():
    levels = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    session.start()
    session.load_plugin()
    cad = simple.CADReader(FileName=os.path.join(DATA, "naca0012_sharp.igs"))
    coarse = simple.ProjectOntoCAD(Input=simple.OpenDataFile(os.path.join(DATA, "naca0012_coarse.vtu")), CAD=cad)
    mesh = simple.RefineWithCAD(Input=coarse, CAD=cad, Method="Uniform Bisection", Levels=levels)
    mesh.UpdatePipeline()
    print("| Filter | cells of the output | processor s | microseconds a cell | bytes a cell, peak |\n|---|---|---|---|---|")
    measure("Project Onto CAD", simple.ProjectOntoCAD(Input=mesh, CAD=cad))
    error = measure("CAD Geometric Error", simple.CADGeometricError(Input=mesh, CAD=cad))
    measure("Refine With CAD, uniform", simple.RefineWithCAD(Input=mesh, CAD=cad, Method="Uniform Bisection"))
    measure("Refine With CAD, bulk 0.5", simple.RefineWithCAD(Input=error, CAD=cad, MarkingArray="GeometricError",
                                                              Marking="Bulk", Fraction=0.5, CutFacets=1))
    measure("Refine With CAD, quadratic cells alone",
            simple.RefineWithCAD(Input=mesh, CAD=cad, Levels=0, QuadraticCells=1))
    measure("Adapt To CAD, three steps, bulk 0.5, recursion depth 1",
            simple.AdaptToCAD(Input=mesh, CAD=cad, RecursionDepth=1, ErrorMarking="Bulk", MaximumSteps=3))
    measure("Mesh Validity", simple.MeshValidity(Input=mesh))


main()
