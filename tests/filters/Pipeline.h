// All filters, connected.
#pragma once

#include "Series.h"

#include <vtkAdaptToCAD.h>
#include <vtkCADGeometricError.h>
#include <vtkCADReader.h>
#include <vtkMeshValidity.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkProjectOntoCAD.h>
#include <vtkRefineWithCAD.h>

#include <functional>
#include <string>
#include <vector>

namespace cadtest
{

/// The filters on a series: projection, error, refinement and validity one after the other, and
/// beside them the adaptation.
struct Pipeline
{
  vtkNew<Series> series;
  vtkNew<vtkCADReader> cad;
  vtkNew<vtkProjectOntoCAD> project;
  vtkNew<vtkCADGeometricError> measure;
  vtkNew<vtkRefineWithCAD> refine;
  vtkNew<vtkMeshValidity> validity;
  vtkNew<vtkAdaptToCAD> adapt;

  using Setup = std::function<void(Pipeline&)>;

  /// `setup` is called when all is connected.
  Pipeline(
    vtkPointSet* piece, const std::string& cadFile, vtkMultiProcessController*, const Setup& setup);

  std::vector<vtkMeshAlgorithm*> filters() const;

private:
  void connect(vtkMeshAlgorithm*, vtkAlgorithm* before, vtkMultiProcessController*);
};

} // namespace cadtest
