// A time series on a mesh.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGridAlgorithm.h>

#include <functional>

class vtkPointSet;

namespace cadtest
{

/// A source of the time steps 0 to 4. As a reader does, it makes each anew: a copy of the mesh with
/// the point array Pressure (double), the cell arrays Heat (float) and Name (strings, of Tag), and
/// the field array Step, which tell the time step.
class Series : public vtkUnstructuredGridAlgorithm
{
public:
  static Series* New();
  vtkTypeMacro(Series, vtkUnstructuredGridAlgorithm);

  /// What is changed of the copy for a time step; before it has its arrays.
  using Change = std::function<void(vtkUnstructuredGrid*, int)>;

  void setMesh(vtkPointSet* mesh) { mesh_ = mesh; }
  void setChange(Change change) { change_ = std::move(change); }
  /// How often a step was made.
  int runs() const { return runs_; }

protected:
  Series() { SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSmartPointer<vtkPointSet> mesh_;
  Change change_ = [](vtkUnstructuredGrid*, int) {};
  int runs_ = 0;
};

} // namespace cadtest
