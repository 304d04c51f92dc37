#!/usr/bin/python3
"""Two builds of the plugin against each other, in turns: seconds, peak memory, and whether the results are the same.

    tests/benchmarks/versions.py BEFORE/CADRefine.so [NOW/CADRefine.so] [--rounds 3] [--case NAME]

The times are the least of the rounds, of the filters alone. Results are compared by all of their bytes; a case whose
results differ fails.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "..", "data")
NACA = ("naca0012_coarse.vtu", "naca0012_sharp.igs")
NOSE = ("aeroplane_coarse.vtu", "aeroplane.igs")
REGION = [0.05, 0.2, -0.25, 0.25, -0.2, 0.2]


def maker(name):
    """The function of paraview.simple that makes the filter; older versions wrote its name with another case."""
    from paraview import simple
    return next(getattr(simple, item) for item in dir(simple) if item.lower() == name.lower())


def adapt(mesh, cad, **properties):
    return [maker("AdaptToCAD")(Input=mesh, CAD=cad, MaximumCells=0, **properties)]


def project_and_measure(mesh, cad):
    projected = maker("ProjectOntoCAD")(Input=mesh, CAD=cad, UseRegion=1, Region=REGION)
    return [projected, maker("CADGeometricError")(Input=projected, CAD=cad, RecursionDepth=3)]


def uniform(mesh, cad, on_cad):
    projected = maker("ProjectOntoCAD")(Input=mesh, CAD=cad)
    projected.UpdatePipeline()
    if not on_cad:  # Nor do the vertices know where they are.
        projected = mesh
    return [maker("RefineWithCAD")(Input=projected, CAD=cad, Method="Uniform Bisection", Levels=5,
                                 ProjectNewVertices=int(on_cad))]


CASES = {
    "NACA, Adapt To CAD, threshold 0": (NACA, lambda *case: adapt(*case, MaximumSteps=9, ErrorMarking="Threshold")),
    "NACA, Adapt To CAD, bulk 0.5": (NACA, lambda *case: adapt(*case, MaximumSteps=18, ErrorMarking="Bulk")),
    "nose, Adapt To CAD, threshold 0": (NOSE, lambda *case: adapt(*case, MaximumSteps=5, UseRegion=1, Region=REGION,
                                                                  ErrorMarking="Threshold")),
    "nose, Adapt To CAD, bulk 0.5": (NOSE, lambda *case: adapt(*case, MaximumSteps=9, UseRegion=1, Region=REGION,
                                                               ErrorMarking="Bulk")),
    "nose, projection and error at depth 3": (NOSE, project_and_measure),
    "NACA, uniform with CAD": (NACA, lambda *case: uniform(*case, True)),
    "NACA, uniform without CAD": (NACA, lambda *case: uniform(*case, False)),
}


def peak_memory():
    with open("/proc/self/status", encoding="ascii") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmHWM"))


def content(mesh):
    """A hash of the points, the cells and all arrays but their order."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    parts = [("points", mesh.GetPoints().GetData()), ("cells", mesh.GetCells().GetConnectivityArray())]
    for kind, arrays in (("point", mesh.GetPointData()), ("cell", mesh.GetCellData()), ("field", mesh.GetFieldData())):
        parts += sorted(((f"{kind} {arrays.GetArrayName(i)}", arrays.GetArray(i))
                         for i in range(arrays.GetNumberOfArrays())), key=lambda part: part[0])
    total = hashlib.sha256()
    for name, array in parts:
        total.update(name.encode())
        total.update(vtk_to_numpy(array).tobytes())
    return total.hexdigest()


def run_case(plugin, name):
    """In pvpython: prints a JSON object."""
    from paraview import simple
    simple.LoadPlugin(plugin, ns=vars(simple))
    (mesh, cad), make = CASES[name]
    mesh = simple.OpenDataFile(os.path.join(DATA, mesh))
    cad = simple.CADReader(FileName=os.path.join(DATA, cad))
    mesh.UpdatePipeline()
    cad.UpdatePipeline()
    # What the model prepares for its first query: some versions do so while they read it.
    maker("ProjectOntoCAD")(Input=simple.PointSource(NumberOfPoints=1), CAD=cad, MaximumDistance=1e9).UpdatePipeline()
    chain = make(mesh, cad)
    started, processor = time.perf_counter(), time.process_time()
    for proxy in chain:
        proxy.UpdatePipeline()
    seconds, processor = time.perf_counter() - started, time.process_time() - processor
    output = chain[-1].GetClientSideObject().GetOutputDataObject(0)
    print(json.dumps({"cells": output.GetNumberOfCells(), "seconds": seconds, "processor": processor,
                      "peak": peak_memory(), "content": content(output)}))


def measured(plugin, name):
    result = subprocess.run(["pvpython", os.path.abspath(__file__), plugin, "--run", name], check=True,
                            stdout=subprocess.PIPE, text=True)
    return json.loads(result.stdout.splitlines()[-1])


def compare(before, now, name, rounds):
    """Prints a row; whether the results are the same."""
    runs = {plugin: [] for plugin in (before, now)}
    for _ in range(rounds):
        for plugin, results in runs.items():
            results.append(measured(plugin, name))
    best = [{key: min(result[key] for result in results) for key in results[0]} for results in runs.values()]
    same = len({result["content"] for results in runs.values() for result in results}) == 1
    print(f"| {name} | {best[1]['cells']:,} | " + " | ".join(
        f"{best[0][key]:.2f} | {best[1][key]:.2f} | {best[0][key] / best[1][key]:.2f}" for key in ("seconds", "processor"))
          + f" | {best[0]['peak']:.0f} | {best[1]['peak']:.0f} | {'same' if same else 'DIFFERENT'} |", flush=True)
    return same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("now", nargs="?", default=os.path.join(HERE, "..", "..", "build", "release"))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--case", choices=CASES, action="append")
    parser.add_argument("--run", choices=CASES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        return run_case(options.before, options.run)
    plugins = [next((os.path.join(folder, name) for folder, _, names in os.walk(place) for name in names
                     if name == "CADRefine.so"), place) for place in (options.before, options.now)]
    print("| case | cells | s before | s now | ratio | processor s before | now | ratio | MiB before | now | results |")
    print("|---" * 11 + "|", flush=True)
    same = [compare(*plugins, name, options.rounds) for name in options.case or CASES]
    return 0 if all(same) else "results differ"


if __name__ == "__main__":
    sys.exit(main())
