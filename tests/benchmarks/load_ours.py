"""One case of load.py in pvpython or pvbatch. Prints a JSON object.

    load_ours.py FOLDER surface|uniform|adaptive|cycles

A file in FOLDER for each rank gets its largest resident memory, in MiB, and its processor time.
"""

import json
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "plugin"))
sys.path.insert(0, HERE)

from cadrefine import session
import load_cycles
from paraview import simple

DATA = os.path.join(HERE, "..", "..", "data")
TELL_COSTS = """
import json, os, time
with open("/proc/self/status", encoding="ascii") as file:
    peak = next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM"))
with open(os.path.join({folder!r}, str(os.getpid())), "w", encoding="ascii") as file:
    json.dump({{"peak": peak, "seconds": time.process_time()}}, file)
"""


def values(proxy):
    """The numbers of the output's field data, which are the same on all ranks."""
    return {name: proxy.FieldData[name].GetRange()[0] for name in proxy.FieldData.keys()
            if proxy.FieldData[name].GetNumberOfComponents() == 1}


def updated(proxy):
    proxy.UpdatePipeline()
    session.raise_errors("load")
    return proxy


def aeroplane(surface):
    """Projected, and its CAD."""
    cad = updated(simple.CADReader(FileName=os.path.join(DATA, "aeroplane.igs")))
    mesh = simple.OpenDataFile(os.path.join(DATA, "aeroplane_coarse.vtu"))
    mesh = simple.ExtractSurface(Input=mesh) if surface else mesh
    return updated(simple.ProjectOntoCAD(Input=mesh, CAD=cad)), cad


def refined(mesh, cad, **properties):
    return updated(simple.RefineWithCAD(Input=mesh, CAD=cad, **properties))


def measured(mesh, cad):
    return updated(simple.CADGeometricError(Input=mesh, CAD=cad))


def checks(before, after):
    """Of the first mesh and the last one, measured."""
    coarse, fine = values(before), values(after)
    return {"vertices": fine["GlobalVertices"], "cells": fine["GlobalCells"], "CAD vertices": fine["CADVertices"],
            "off the CAD": fine["UnprojectedVertices"], "invalid": fine["InvalidCells"],
            "worst": fine["MinimumQuality"], "error falls": coarse["GlobalGeometricError"] / fine["GlobalGeometricError"]}


def surface():
    """The aeroplane's boundary as triangles, 11 million vertices on the CAD, projected anew and measured."""
    coarse, cad = aeroplane(surface=True)
    before = measured(coarse, cad)
    halved = refined(coarse, cad)
    fine = refined(halved, cad, Method="Uniform Bisection", Levels=5)
    return checks(before, measured(updated(simple.ProjectOntoCAD(Input=fine, CAD=cad)), cad))


def uniform():
    """The mesh round the aeroplane: three uniform levels."""
    coarse, cad = aeroplane(surface=False)
    before = measured(coarse, cad)
    return checks(before, measured(refined(coarse, cad, Method="Uniform Bisection", Levels=3), cad))


def adaptive():
    """The mesh round the aeroplane: two uniform levels, and four steps where it is off the CAD."""
    coarse, cad = aeroplane(surface=False)
    before = measured(coarse, cad)
    mesh = refined(coarse, cad, Method="Uniform Bisection", Levels=2)
    return checks(before, updated(simple.AdaptToCAD(Input=mesh, CAD=cad, RecursionDepth=1, MaximumSteps=4,
                                                    MaximumCells=0, ErrorMarking="Threshold")))


def cycles():
    return load_cycles.run(DATA)


def main():
    folder, case = sys.argv[1:]
    session.start()
    session.load_plugin()
    started = time.perf_counter()
    result = {"surface": surface, "uniform": uniform, "adaptive": adaptive, "cycles": cycles}[case]()
    result["wall"] = time.perf_counter() - started
    session.run_on_all_ranks(TELL_COSTS.format(folder=folder))
    if session.speaks():
        print(json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
