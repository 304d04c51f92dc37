"""200 cycles of a solver that is coupled with the filters, in one process: each takes the mesh of the last one, marks
a few cells by an indicator of its own, refines them, and measures the new mesh."""

import ctypes
import os

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

CYCLES = 200
EARLY = 20
MARKED = 20  # cells a cycle


class MallInfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks",
                                                     "fsmblks", "uordblks", "fordblks", "keepcost")]


def memory():
    """Bytes in use, and bytes resident once what is free is given back."""
    libc = ctypes.CDLL(None)
    libc.mallinfo2.restype = MallInfo
    libc.malloc_trim(0)
    info = libc.mallinfo2()
    with open("/proc/self/statm", encoding="ascii") as file:
        resident = int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")
    return info.uordblks + info.hblkhd, resident


def indicated(mesh, cycle):
    """The mesh as a solver would hand it back: with an indicator that is 1 in the cells next to a point that goes
    along the wing."""
    copy = vtkUnstructuredGrid()
    copy.ShallowCopy(mesh)
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)
    centres = vtk_to_numpy(mesh.GetPoints().GetData())[cells].mean(axis=1)
    spot = [3 * cycle / CYCLES, 0.75, 0.1]
    nearest = numpy.argpartition(((centres - spot) ** 2).sum(axis=1), MARKED)[:MARKED]
    indicator = numpy.zeros(len(cells))
    indicator[nearest] = 1
    array = numpy_to_vtk(indicator, deep=True)
    array.SetName("Indicator")
    copy.GetCellData().AddArray(array)
    return copy


class Coupling:
    def __init__(self, data):
        cad = simple.CADReader(FileName=os.path.join(data, "naca0012_sharp.igs"))
        coarse = simple.ProjectOntoCAD(
            Input=simple.OpenDataFile(os.path.join(data, "naca0012_coarse.vtu")), CAD=cad)
        start = simple.RefineWithCAD(Input=coarse, CAD=cad, Method="Uniform Bisection", Levels=2)
        start.UpdatePipeline()
        self.mesh = start.GetClientSideObject().GetOutputDataObject(0)
        self.source = simple.TrivialProducer()
        self.refine = simple.RefineWithCAD(MarkingArray="Indicator", CAD=cad, Input=self.give(0))
        self.measure = simple.CADGeometricError(Input=self.refine, CAD=cad)

    def give(self, cycle):
        self.source.GetClientSideObject().SetOutput(indicated(self.mesh, cycle))
        self.source.MarkModified(None)
        return self.source

    def cycle(self, number):
        self.give(number)
        self.measure.UpdatePipeline()
        # A new object: the filter's own is written over in the next cycle.
        self.mesh = vtkUnstructuredGrid()
        self.mesh.ShallowCopy(self.measure.GetClientSideObject().GetOutputDataObject(0))

    def value(self, name):
        return self.mesh.GetFieldData().GetArray(name).GetComponent(0, 0)


def run(data):
    """Memory after cycle 20, after cycle 200, and after cycle 200 and cycle 20 once more, on the mesh that it had
    before."""
    coupling = Coupling(data)
    kept, early, sizes = None, None, []
    for number in range(1, CYCLES + 1):
        if number == EARLY:
            kept = coupling.mesh
        coupling.cycle(number)
        sizes.append(coupling.mesh.GetNumberOfCells())
        if number == EARLY:
            early = memory()
    last = {"cells": coupling.value("GlobalCells"), "invalid": coupling.value("InvalidCells"),
            "off the CAD": coupling.value("UnprojectedVertices"), "vertices": coupling.value("GlobalVertices"),
            "CAD vertices": coupling.value("CADVertices"), "worst": coupling.value("MinimumQuality")}
    late = memory()
    coupling.mesh = kept
    coupling.cycle(EARLY)
    assert coupling.mesh.GetNumberOfCells() == sizes[EARLY - 1]
    return {**last, "cells after 20": sizes[EARLY - 1], "memory after 20": early, "memory after 200": late,
            "memory after 200, size of 20": memory()}
