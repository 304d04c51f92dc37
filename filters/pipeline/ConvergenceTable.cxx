#include "pipeline/ConvergenceTable.h"

#include "fields/CADArrays.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

namespace cadrefine
{
namespace
{

constexpr const char* ownCounts[] = { "Step", "MarkedCells" };
constexpr const char* counts[] = { arrays::vertexCount, arrays::cellCount, arrays::verticesOnCAD,
  arrays::projectedPoints, arrays::invalidCells, arrays::unprojectedVertices };
constexpr const char* measures[] = { arrays::globalError, arrays::largestErrorDistance,
  arrays::largestChordError, arrays::largestNormalAngle, arrays::leastQuality };

template<class Array, class Names>
void addColumns(vtkTable* table, const Names& names)
{
  for (const char* name : names)
  {
    vtkNew<Array> column;
    column->SetName(name);
    table->AddColumn(column);
  }
}

} // namespace

ConvergenceTable::ConvergenceTable()
{
  addColumns<vtkIdTypeArray>(table_, ownCounts);
  addColumns<vtkIdTypeArray>(table_, counts);
  addColumns<vtkDoubleArray>(table_, measures);
}

void ConvergenceTable::addStep(std::int64_t markedCells, vtkFieldData* ofMesh)
{
  const vtkIdType row = table_->InsertNextBlankRow();
  table_->SetValueByName(row, ownCounts[0], row);
  table_->SetValueByName(row, ownCounts[1], static_cast<vtkIdType>(markedCells));
  const auto copy = [&](const auto& names)
  {
    for (const char* name : names)
    {
      table_->SetValueByName(row, name, ofMesh->GetAbstractArray(name)->GetVariantValue(0));
    }
  };
  copy(counts);
  copy(measures);
}

void ConvergenceTable::setStopReason(const std::string& reason)
{
  vtkNew<vtkStringArray> array;
  array->SetName("StopReason");
  array->InsertNextValue(reason);
  table_->GetFieldData()->AddArray(array);
}

} // namespace cadrefine
