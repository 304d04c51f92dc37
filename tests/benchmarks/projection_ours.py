"""ProjectOntoCAD's wall clock time in pvpython: of a mesh after so many uniform levels, or of points near the CAD.

    projection_ours.py CAD [MESH LEVELS]
"""

import json
import os
import sys
import time

import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "plugin"))

from cadrefine import session
from paraview import simple

REPETITIONS = 4
POINTS = 1_000_000


def points_near(cad):
    surface = simple.ExtractSurface(Input=simple.MergeBlocks(Input=cad))
    surface.UpdatePipeline()
    drawn = dataset_adapter.WrapDataObject(surface.GetClientSideObject().GetOutputDataObject(0)).Points
    size = numpy.linalg.norm(drawn.max(0) - drawn.min(0))
    random = numpy.random.default_rng(1)
    scattered = drawn[random.integers(0, len(drawn), POINTS)] + random.normal(size=(POINTS, 3)) * 1e-3 * size
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    data.GetPoints().SetData(numpy_to_vtk(scattered.astype(float), deep=True))
    glyphs = vtkVertexGlyphFilter()
    glyphs.SetInputData(data)
    glyphs.Update()
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(glyphs.GetOutput())
    return source


def refined(cad, mesh, levels):
    projected = simple.ProjectOntoCAD(Input=simple.OpenDataFile(mesh), CAD=cad)
    return simple.RefineWithCAD(Input=projected, CAD=cad, Method="Uniform Bisection", Levels=levels)


def main():
    session.start()
    session.load_plugin()
    cad = simple.CADReader(FileName=sys.argv[1])
    cad.UpdatePipeline()
    source = refined(cad, sys.argv[2], int(sys.argv[3])) if len(sys.argv) > 2 else points_near(cad)
    source.UpdatePipeline()
    times = []
    for _ in range(REPETITIONS):
        projected = simple.ProjectOntoCAD(Input=source, CAD=cad)
        start = time.perf_counter()
        projected.UpdatePipeline()
        times.append(time.perf_counter() - start)
        simple.Delete(projected)
        del projected
    data = source.GetClientSideObject().GetOutputDataObject(0)
    print(json.dumps({"points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(), "seconds": min(times)}))


if __name__ == "__main__":
    main()
