"""Runs in pvbatch: the CAD model survives File > Save Data, and File > Reload Files reads a changed file anew.

usage: saved_cad.py PLUGIN DATA FOLDER
"""

import os
import shutil
import sys
import traceback

from paraview import simple


def projected(mesh, cad):
    """Field data of the mesh projected onto the CAD, and its points' bounds."""
    project = simple.ProjectOntoCAD(Input=mesh, CAD=cad)
    project.UpdatePipeline()
    names = ("ProjectedPoints", "CADVertices", "UnprojectedVertices")
    values = [project.FieldData[name].GetRange(0)[0] for name in names]
    return values, project.GetDataInformation().GetBounds(), project.PointData["CADDistance"].GetRange()


def main():
    plugin, data, folder = sys.argv[1:]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    mesh = simple.OpenDataFile(os.path.join(data, "naca0012_coarse.vtu"))
    file = os.path.join(folder, "model.igs")
    shutil.copy(os.path.join(data, "naca0012_sharp.igs"), file)
    cad = simple.OpenDataFile(file)
    direct = projected(mesh, cad)
    assert direct[0][0] > 0, "nothing was projected"

    saved = os.path.join(folder, "model.vtpc")
    # Appended data, the default, cannot be read back where libexpat has the corrections of 2024 (see docs/filters/README.md).
    simple.SaveData(saved, cad, DataMode="Binary")
    again = projected(mesh, simple.OpenDataFile(saved))
    assert again == direct, f"with the saved model {again} instead of {direct}"

    cells = cad.GetDataInformation().GetNumberOfCells()
    shutil.copy(os.path.join(data, "three_arcs.igs"), file)
    simple.ReloadFiles(cad)
    cad.UpdatePipeline()
    assert cad.GetDataInformation().GetNumberOfCells() < cells, "the changed file was not read anew"
    with open(os.path.join(folder, "passed"), "w", encoding="utf-8"):
        pass


try:
    main()
except Exception:  # under mpirun pvbatch would hang
    traceback.print_exc()
