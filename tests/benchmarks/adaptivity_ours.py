"""Adapt To CAD in pvpython: its convergence table as JSON, and the seconds it took.

    adaptivity_ours.py CAD MESH PROPERTIES

PROPERTIES is a JSON object of properties of the filter.
"""

import json
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "plugin"))

from cadrefine import session
from paraview import simple


def rows_of(table):
    columns = [table.GetColumnName(i) for i in range(table.GetNumberOfColumns())]
    return [{name: table.GetValueByName(row, name).ToDouble() for name in columns}
            for row in range(table.GetNumberOfRows())]


def main():
    session.start()
    session.load_plugin()
    cad = simple.CADReader(FileName=sys.argv[1])
    mesh = simple.OpenDataFile(sys.argv[2])
    cad.UpdatePipeline()
    mesh.UpdatePipeline()
    filter_ = simple.AdaptToCAD(Input=mesh, CAD=cad, RecursionDepth=1, **json.loads(sys.argv[3]))
    start = time.perf_counter()
    filter_.UpdatePipeline()
    seconds = time.perf_counter() - start
    print(json.dumps({"steps": rows_of(filter_.GetClientSideObject().GetOutputDataObject(1)), "seconds": seconds}))


if __name__ == "__main__":
    main()
