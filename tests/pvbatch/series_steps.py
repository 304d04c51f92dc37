"""Runs in pvpython or pvbatch: all filters at the time steps of a series; what became of it goes to a file.

usage: series_steps.py PLUGIN CAD RESULT.json SERIES.pvd...
"""

import json
import sys
import traceback

from paraview import servermanager, simple

STEPS = (0, 1, 2)


def pipeline(series, cad):
    """The filters by their names, each with those before it."""
    projected = simple.ProjectOntoCAD(Input=series, CAD=cad)
    error = simple.CADGeometricError(Input=projected, CAD=cad)
    refined = simple.RefineWithCAD(Input=error, CAD=cad, MarkingArray="GeometricError", Threshold=1e-5, Levels=2)
    adapted = simple.AdaptToCAD(Input=series, CAD=cad, MaximumSteps=3, ErrorMarking="Threshold",
                                ErrorThreshold=1e-5)
    return {"project": projected, "error": error, "refine": refined, "adapt": adapted,
            "validity": simple.MeshValidity(Input=refined)}


def ranges(attributes):
    """Repr, which is exact, and knows NaN."""
    arrays = {array.GetName(): array for array in attributes}
    return {name: [repr(array.GetRange(k)) for k in range(array.GetNumberOfComponents())]
            for name, array in arrays.items() if name != "vtkProcessId"}


def outcome(proxy, step):
    """Of a filter at a time step."""
    proxy.UpdatePipeline(step)
    proxy.UpdatePropertyInformation()
    information = proxy.GetDataInformation()
    return {
        "reused": json.loads(proxy.GetProperty("RunStatistics").GetData())["geometry reused"],
        "cells": information.GetNumberOfCells(),
        "bounds": [repr(x) for x in information.GetBounds()],
        "arrays": [ranges(data) for data in (proxy.PointData, proxy.CellData, proxy.FieldData)],
    }


def run(file, cad):
    """All steps one after the other, and the last one again with filters that have seen no other."""
    series = simple.PVDReader(FileName=file)
    filters = pipeline(series, cad)
    steps = [{name: outcome(proxy, step) for name, proxy in filters.items()} for step in STEPS]
    fresh = {name: outcome(proxy, STEPS[-1]) for name, proxy in pipeline(series, cad).items()}
    return {"times": list(series.TimestepValues), "steps": steps, "fresh": fresh}


def main():
    plugin, cad_file, result, *files = sys.argv[1:]
    simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    cad = simple.CADReader(FileName=cad_file)
    results = [run(file, cad) for file in files]
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        with open(result, "w", encoding="utf-8") as output:
            json.dump(results, output)


try:
    main()
except Exception:  # under mpirun pvbatch would hang
    traceback.print_exc()
