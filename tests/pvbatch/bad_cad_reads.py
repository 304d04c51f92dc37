"""Gives CAD files, bad ones among them, to the reader and to Project Onto CAD, one after the other, in one process.

usage: bad_cad_reads.py PLUGIN RESULT.json MESH.vtu CAD...

Writes the numbers of cells of both results for each file.
"""

import json
import sys
import traceback

from paraview import servermanager, simple


def cells_of(proxy):
    proxy.UpdatePipeline()
    return proxy.GetDataInformation().GetNumberOfCells()


def main():
    plugin, result, mesh_file, *files = sys.argv[1:]
    simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
    mesh = simple.XMLUnstructuredGridReader(FileName=[mesh_file])
    counts = []
    for file in files:
        cad = simple.CADReader(FileName=file)
        counts.append([cells_of(cad), cells_of(simple.ProjectOntoCAD(Input=mesh, CAD=cad))])
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        with open(result, "w", encoding="ascii") as output:
            json.dump(counts, output)


try:
    main()
except Exception:  # under mpirun pvbatch would hang
    traceback.print_exc()
