// Running the filters, and what became of them.
#pragma once

#include <vtkCADGeometricError.h>
#include <vtkCADReader.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkMeshValidity.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointSet.h>
#include <vtkProjectOntoCAD.h>
#include <vtkRefineWithCAD.h>
#include <vtkSmartPointer.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace cadtest
{

/// What a filter did.
struct Outcome
{
  bool succeeded = false;
  std::vector<std::string> errors;   ///< Of the filter itself.
  std::vector<std::string> warnings; ///< The same.
  vtkSmartPointer<vtkDataObject> output;
  vtkSmartPointer<vtkDataObject> secondOutput; ///< Null where the filter has one only.

  vtkPointSet* pointSet() const { return vtkPointSet::SafeDownCast(output); }
};

/// Runs a filter with its inputs set and keeps what it reports.
Outcome execute(vtkAlgorithm* filter);

/// Filters with one CAD file, on the ranks of a controller (none: one rank). Where the input has no
/// invalid cell here, it is a failure of the test if the output, of the same dimension, has one, by
/// exact orientation.
class FilterRun
{
public:
  using Data = vtkSmartPointer<vtkPointSet>;

  explicit FilterRun(const std::string& cadFile, vtkMultiProcessController* controller = nullptr);
  /// With any data object in place of the output of a vtkCADReader.
  explicit FilterRun(vtkDataObject* cad, vtkMultiProcessController* controller = nullptr);

  /// Runs a filter that `configure` has set up.
  template<class Filter, class Configure>
  Outcome attempt(vtkPointSet* mesh, const Configure& configure) const
  {
    vtkNew<Filter> filter;
    filter->SetController(controller_);
    filter->SetInputDataObject(0, mesh);
    if (filter->GetNumberOfInputPorts() > 1)
    {
      filter->SetInputDataObject(1, cad_);
    }
    configure(filter.Get());
    Outcome outcome = execute(filter);
    if (outcome.succeeded)
    {
      expectValid(mesh, outcome.pointSet());
    }
    return outcome;
  }

  /// The same; throws where the filter fails.
  template<class Filter, class Configure>
  Data run(vtkPointSet* mesh, const Configure& configure) const
  {
    return require(attempt<Filter>(mesh, configure));
  }

  /// The mean ratio than which this part of the cells have a lower one.
  double qualityPercentile(vtkPointSet* mesh, double part) const;

  Data project(vtkPointSet* mesh) const;
  /// Vertices are moved, cells stay.
  Data moveOntoCAD(vtkPointSet* mesh) const;
  Data measure(vtkPointSet* mesh, int depth) const;
  Data refineUniformly(vtkPointSet* mesh, int levels = 1) const;
  /// Uniformly, new vertices stay where they are.
  Data refineStraight(vtkPointSet* mesh, int levels = 1) const;
  /// Longest edge bisection of the cells whose GeometricError is larger.
  Data refineWhereErrorExceeds(vtkPointSet* mesh, double threshold) const;

  vtkDataObject* cad() const { return cad_; }

private:
  static Data require(const Outcome& outcome);
  static void expectValid(vtkPointSet* input, vtkPointSet* output);

  vtkSmartPointer<vtkDataObject> cad_;
  vtkMultiProcessController* controller_;
};

} // namespace cadtest
