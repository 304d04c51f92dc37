"""CADRefine's VTK classes: vtkCADReader, vtkProjectOntoCAD, vtkCADGeometricError, vtkRefineWithCAD,
vtkCoarsenWithCAD, vtkAdaptToCAD, vtkCADBoundary, vtkMeshValidity, vtkMeshReader, vtkMeshWriter.

They work on ParaView's VTK: run in pvpython or pvbatch, or in a Python that finds ParaView's vtkmodules.
"""

from .CADRefineFilters import *
