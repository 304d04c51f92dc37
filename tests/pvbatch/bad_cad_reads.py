"""Gives CAD files, bad ones among them, to the reader and to Project Onto CAD, one after the other, in one process.

usage: bad_cad_reads.py PLUGIN RESULT.json MESH.vtu CAD...

Writes the numbers of cells of both results for each file, and what this rank was told: mpirun of Open MPI 5 mixes what
the ranks print, within lines.
"""

import json
import sys
import traceback

from paraview import servermanager, simple
from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import vtkOutputWindow

errors = []


@calldata_type("string0")
def collect(_window, _event, text):
    errors.append(text)


def cells_of(proxy):
    proxy.UpdatePipeline()
    return proxy.GetDataInformation().GetNumberOfCells()


def main():
    plugin, result, mesh_file, *files = sys.argv[1:]
    vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", collect)
    simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    mesh = simple.XMLUnstructuredGridReader(FileName=[mesh_file])
    found = []
    for file in files:
        errors.clear()
        cad = simple.CADReader(FileName=file)
        cells = [cells_of(cad), cells_of(simple.ProjectOntoCAD(Input=mesh, CAD=cad))]
        found.append([cells, [line for text in errors for line in text.splitlines() if file in line]])
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        with open(result, "w", encoding="ascii") as output:
            json.dump(found, output)


try:
    main()
except Exception:  # under mpirun pvbatch would hang
    traceback.print_exc()
