#include "ArrayTransfer.h"

#include <vtkAbstractArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace cadrefine
{
namespace
{

std::string nameOfIds(vtkDataSetAttributes* attributes, const char* otherwise)
{
  vtkDataArray* ids = attributes->GetGlobalIds();
  return ids && ids->GetName() ? ids->GetName() : otherwise;
}

vtkNew<vtkIdTypeArray> makeIds(const std::string& name, const std::vector<GlobalId>& ids)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfValues(static_cast<vtkIdType>(ids.size()));
  std::copy(ids.begin(), ids.end(), array->GetPointer(0));
  return array;
}

void setIds(vtkPointSet* source, const ConvertedMesh& mesh, vtkPointSet* output)
{
  output->GetPointData()->SetGlobalIds(
    makeIds(nameOfIds(source->GetPointData(), "GlobalPointIds"), mesh.mesh.ids));
  std::vector<GlobalId> cellIds;
  for (const auto& ids : mesh.cellIds)
  {
    cellIds.insert(cellIds.end(), ids.begin(), ids.end());
  }
  output->GetCellData()->SetGlobalIds(
    makeIds(nameOfIds(source->GetCellData(), "GlobalCellIds"), cellIds));
}

/// Arrays that are carried over; ids and ghosts are made anew or not at all.
bool isCarried(vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return array != attributes->GetGlobalIds() &&
         (!array->GetName() ||
           std::string(array->GetName()) != vtkDataSetAttributes::GhostArrayName());
}

vtkSmartPointer<vtkAbstractArray> emptyLike(vtkAbstractArray* array, vtkIdType count)
{
  auto result = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
  result->SetName(array->GetName());
  result->SetNumberOfComponents(array->GetNumberOfComponents());
  result->CopyComponentNames(array);
  result->SetNumberOfTuples(count);
  return result;
}

/// Adds the array, as scalars, vectors, ... if it was these.
void addLike(
  vtkDataSetAttributes* source, int index, vtkAbstractArray* array, vtkDataSetAttributes* output)
{
  const int added = output->AddArray(array);
  const int attribute = source->IsArrayAnAttribute(index);
  if (attribute >= 0)
  {
    output->SetActiveAttribute(added, attribute);
  }
}

void copyTuples(vtkDataSetAttributes* source, vtkIdList* from, vtkDataSetAttributes* output)
{
  vtkNew<vtkIdList> to;
  to->SetNumberOfIds(from->GetNumberOfIds());
  std::iota(to->begin(), to->end(), vtkIdType{ 0 });
  for (int a = 0; a < source->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = source->GetAbstractArray(a);
    if (isCarried(source, array))
    {
      auto copy = emptyLike(array, from->GetNumberOfIds());
      copy->InsertTuples(to, from, array);
      addLike(source, a, copy, output);
    }
  }
}

bool isReal(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
}

void interpolatePointArray(
  vtkAbstractArray* coarse, const RefinementTrace& trace, vtkAbstractArray* fine)
{
  const vtkIdType oldCount = coarse->GetNumberOfTuples();
  fine->InsertTuples(0, oldCount, 0, coarse);
  for (std::size_t n = 0; n < trace.parentEdges.size(); ++n)
  {
    const auto [a, b] = trace.parentEdges[n];
    const auto target = oldCount + static_cast<vtkIdType>(n);
    if (isReal(coarse))
    {
      fine->InterpolateTuple(target, a, coarse, b, coarse, 0.5);
    }
    else
    {
      fine->SetTuple(target, a, coarse);
    }
  }
}

vtkNew<vtkIdList> cellSources(vtkPointSet* coarse, const RefinementTrace& trace)
{
  vtkNew<vtkIdList> from;
  std::array<vtkIdType, 4> firsts{};
  std::array<vtkIdType, 4> counts{};
  for (vtkIdType c = 0; c < coarse->GetNumberOfCells(); ++c)
  {
    ++counts[coarse->GetCellType(c) == VTK_VERTEX     ? 0
             : coarse->GetCellType(c) == VTK_LINE     ? 1
             : coarse->GetCellType(c) == VTK_TRIANGLE ? 2
                                                      : 3];
  }
  for (int d = 1; d < 4; ++d)
  {
    firsts[d] = firsts[d - 1] + counts[d - 1];
  }
  for (int d = 0; d < 4; ++d)
  {
    for (const Index parent : trace.parentCells[d])
    {
      from->InsertNextId(firsts[d] + parent);
    }
  }
  return from;
}

} // namespace

void copyArrays(vtkPointSet* input, const ConvertedMesh& mesh, vtkPointSet* output)
{
  vtkNew<vtkIdList> points;
  std::for_each(mesh.pointOf.begin(), mesh.pointOf.end(),
    [&](vtkIdType point) { points->InsertNextId(point); });
  copyTuples(input->GetPointData(), points, output->GetPointData());
  if (input->GetNumberOfCells() > 0)
  {
    vtkNew<vtkIdList> cells;
    for (const auto& cellOf : mesh.cellOf)
    {
      std::for_each(
        cellOf.begin(), cellOf.end(), [&](vtkIdType cell) { cells->InsertNextId(cell); });
    }
    copyTuples(input->GetCellData(), cells, output->GetCellData());
  }
  output->GetFieldData()->PassData(input->GetFieldData());
  setIds(input, mesh, output);
}

void refineArrays(
  vtkPointSet* coarse, const ConvertedMesh& mesh, const RefinementTrace& trace, vtkPointSet* fine)
{
  vtkPointData* source = coarse->GetPointData();
  for (int a = 0; a < source->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = source->GetAbstractArray(a);
    if (isCarried(source, array))
    {
      auto refined = emptyLike(array, fine->GetNumberOfPoints());
      interpolatePointArray(array, trace, refined);
      addLike(source, a, refined, fine->GetPointData());
    }
  }
  copyTuples(coarse->GetCellData(), cellSources(coarse, trace), fine->GetCellData());
  fine->GetFieldData()->PassData(coarse->GetFieldData());
  setIds(coarse, mesh, fine);
}

} // namespace cadrefine
