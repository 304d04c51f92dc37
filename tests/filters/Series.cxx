#include "Series.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace cadtest
{
namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

template<class Array, class ValueOf>
void addArray(vtkFieldData* fields, const char* name, vtkIdType count, const ValueOf& valueOf)
{
  vtkNew<Array> array;
  array->SetName(name);
  for (vtkIdType i = 0; i < count; ++i)
  {
    array->InsertNextValue(valueOf(i));
  }
  fields->AddArray(array);
}

void addFields(vtkUnstructuredGrid* grid, int step)
{
  addArray<vtkDoubleArray>(grid->GetPointData(), "Pressure", grid->GetNumberOfPoints(),
    [&](vtkIdType p) { return step + grid->GetPoint(p)[0] / 3; });
  vtkDataArray* tags = grid->GetCellData()->GetArray("Tag");
  addArray<vtkFloatArray>(grid->GetCellData(), "Heat", grid->GetNumberOfCells(),
    [&](vtkIdType c) { return static_cast<float>(step + tags->GetTuple1(c)); });
  addArray<vtkStringArray>(grid->GetCellData(), "Name", grid->GetNumberOfCells(),
    [&](vtkIdType c) { return std::to_string(step + static_cast<int>(tags->GetTuple1(c))); });
  addArray<vtkDoubleArray>(grid->GetFieldData(), "Step", 1, [&](vtkIdType) { return step; });
}

} // namespace

vtkStandardNewMacro(Series);

int Series::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  const double steps[] = { 0, 1, 2, 3, 4 };
  const double range[] = { 0, 4 };
  vtkInformation* info = outputs->GetInformationObject(0);
  info->Set(Pipeline::TIME_STEPS(), steps, 5);
  info->Set(Pipeline::TIME_RANGE(), range, 2);
  info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int Series::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  ++runs_;
  vtkInformation* info = outputs->GetInformationObject(0);
  const double time =
    info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 0;
  const int step = static_cast<int>(time);
  auto* output = vtkUnstructuredGrid::GetData(outputs);
  output->DeepCopy(mesh_);
  change_(output, step);
  addFields(output, step);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  return 1;
}

} // namespace cadtest
