#include "InputParts.h"

#include "CADArrays.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// Removes the arrays of this kind from one of two sets with the same arrays, and the others from
/// the other.
void split(const std::vector<std::string>& names, vtkDataSetAttributes* geometry,
  vtkDataSetAttributes* fields)
{
  for (int a = geometry->GetNumberOfArrays() - 1; a >= 0; --a)
  {
    vtkDataArray* array = geometry->GetArray(a);
    const char* name = geometry->GetArrayName(a);
    const bool isRead =
      array && (array == geometry->GetGlobalIds() ||
                 (name && std::find(names.begin(), names.end(), name) != names.end()));
    (isRead ? fields : geometry)->RemoveArray(a);
  }
}

/// Adds the arrays; what is active (as scalars, ...) stays so unless one of them takes its place.
/// (PassData would take it away.)
void addArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target)
{
  for (int a = 0; a < source->GetNumberOfArrays(); ++a)
  {
    addAs(source->IsArrayAnAttribute(a), source->GetAbstractArray(a), target);
  }
}

std::vector<std::string> withGhosts(std::vector<std::string> names)
{
  names.emplace_back(vtkDataSetAttributes::GhostArrayName());
  return names;
}

} // namespace

InputParts splitInput(vtkPointSet* input, const std::vector<std::string>& cellArrays)
{
  const auto copyOfInput = [&]
  {
    auto copy = vtkSmartPointer<vtkPointSet>::Take(input->NewInstance());
    copy->ShallowCopy(input);
    return copy;
  };
  const auto geometry = copyOfInput();
  const auto fields = copyOfInput();
  split(withGhosts({ arrays::dimension, arrays::entity, arrays::parameters, arrays::distance }),
    geometry->GetPointData(), fields->GetPointData());
  split(withGhosts(cellArrays), geometry->GetCellData(), fields->GetCellData());
  geometry->GetFieldData()->Initialize();
  return { geometry, arraysOf(fields) };
}

void joinOutput(
  RankExchange& exchange, const InputParts& parts, const StepResult& result, vtkPointSet* output)
{
  const MeshArrays fields = result.route.follow(exchange, parts.fields);
  output->CopyStructure(result.mesh);
  addArrays(fields.ofVertices, output->GetPointData());
  addArrays(fields.ofCells, output->GetCellData());
  output->GetFieldData()->PassData(fields.ofMesh);
  addArrays(result.mesh->GetPointData(), output->GetPointData());
  addArrays(result.mesh->GetCellData(), output->GetCellData());
  output->GetFieldData()->PassData(result.mesh->GetFieldData());
  if (result.mesh->GetCellData()->GetScalars())
  {
    // ParaView colours by the active scalars, those of points first.
    output->GetPointData()->SetActiveScalars(nullptr);
  }
}

} // namespace cadrefine
