"""Runs in pvbatch and pvpython: opens and saves mesh files with the plugin's proxies, as a script of a user's does.

    mesh_files.py PLUGIN DATA FOLDER

FOLDER has gmsh4binary.msh, mixed.msh and files that cannot be read. What was found is left there in found.json: where
it is not, the script failed. (Under mpirun pvbatch hangs when its script ends with an exception.)
"""

import json
import os
import sys
import traceback

from paraview import simple
from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import vtkOutputWindow

ENDINGS = ("msh", "med", "su2", "inp", "foam", "xdmf")
errors = []


@calldata_type("string0")
def collect(_window, _event, text):
    if "returned failure for request" not in text:
        errors.append(text)


def described(source):
    source.UpdatePipeline()
    information = source.GetDataInformation()
    return {"label": source.GetXMLLabel(), "cells": information.GetNumberOfCells(),
            "points": information.GetNumberOfPoints(), "fields": sorted(source.FieldData.keys())}


def measured(source):
    """How many volume cells are positive, and their volume, over all ranks."""
    sizes = simple.CellSize(Input=source, ComputeSum=1)
    solids = simple.Threshold(Input=sizes, Scalars=["CELLS", "Volume"], LowerThreshold=1e-12, UpperThreshold=1e9)
    solids.UpdatePipeline()
    sizes.UpdatePipeline()
    return [solids.GetDataInformation().GetNumberOfCells(), sizes.FieldData["Volume"].GetRange()[1]]


def errors_of(work):
    errors.clear()
    work()
    return [text.strip().partition("): ")[2] for text in errors]


def run(plugin, data, folder):
    def path(name):
        return os.path.join(folder, name)

    simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    found = {"files": {}, "bad": {}, "unwritten": {}}
    mesh = simple.OpenDataFile(path("gmsh4binary.msh"))
    found["opened"] = described(mesh)
    cad = simple.OpenDataFile(os.path.join(data, "cylinder.brep"))
    # Facets that operations change may span the narrow fillet, and be of no face for a step.
    adapted = simple.AdaptToCAD(Input=mesh, CAD=cad, MaximumSteps=1, BoundaryCells=1, Operations="Cut only")
    found["adapted"] = described(adapted)
    for ending in ENDINGS:
        simple.SaveData(path("saved." + ending), adapted)
        found["files"][ending] = described(simple.MeshReader(FileName=path("saved." + ending)))
    simple.SaveData(path("text.msh"), mesh, MshVersion="4.1", Ascii=1)
    spread = simple.RedistributeDataSet(Input=mesh)
    simple.SaveData(path("spread.msh"), spread)
    found["spread"] = described(simple.OpenDataFile(path("spread.msh")))
    mixed = simple.RedistributeDataSet(Input=simple.OpenDataFile(path("mixed.msh")))
    found["mixed"] = {}
    for ending in (*ENDINGS, "bdf", "mesh"):
        simple.SaveData(path("mixed_saved." + ending), mixed)
        found["mixed"][ending] = measured(simple.MeshReader(FileName=path("mixed_saved." + ending)))
    found["abaqus"] = simple.OpenDataFile(path("saved.inp")).GetXMLLabel()
    found["avs"] = simple.OpenDataFile(path("avs.inp")).GetXMLLabel()
    for name in sorted(os.listdir(folder)):
        if name.startswith("bad"):
            found["bad"][name] = errors_of(simple.MeshReader(FileName=path(name)).UpdatePipeline)
    for name in ("saved.msh", "nowhere/new.msh"):
        found["unwritten"][name] = errors_of(lambda: simple.SaveData(path(name), adapted, MshVersion="3"))
    return found


def main(plugin, data, folder):
    vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", collect)
    found = run(plugin, data, folder)
    with open(os.path.join(folder, "found.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


try:
    main(*sys.argv[1:])
except Exception:
    traceback.print_exc()
