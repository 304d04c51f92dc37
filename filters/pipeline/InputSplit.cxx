#include "pipeline/InputSplit.h"

#include "fields/CADArrays.h"
#include "fields/CellTags.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

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

/// Adds the arrays, but for those of these names; what is active (as scalars, ...) stays so unless
/// one of them takes its place. (PassData would take it away.)
void addArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target,
  const std::vector<std::string>& left = {})
{
  for (int a = 0; a < source->GetNumberOfArrays(); ++a)
  {
    const char* name = source->GetArrayName(a);
    if (!name || std::find(left.begin(), left.end(), name) == left.end())
    {
      addAs(source->IsArrayAnAttribute(a), source->GetAbstractArray(a), target);
    }
  }
}

std::vector<std::string> withGhosts(std::vector<std::string> names)
{
  names.emplace_back(vtkDataSetAttributes::GhostArrayName());
  return names;
}

void remove(std::initializer_list<const char*> names, vtkFieldData* from)
{
  for (const char* name : names)
  {
    from->RemoveArray(name);
  }
}

} // namespace

InputSplit splitInput(
  vtkPointSet* input, const std::vector<std::string>& cellArrays, bool readsTags)
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
  InputSplit parts{ geometry, arraysOf(fields), {} };
  for (int a = 0; readsTags && a < fields->GetCellData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = fields->GetCellData()->GetArray(a);
    if (array && isTag(array))
    {
      geometry->GetCellData()->AddArray(array);
      parts.tags.emplace_back(array->GetName());
    }
  }
  return parts;
}

bool hasMeans(const InputSplit& parts)
{
  const auto hasSome = [](vtkCellData* cells)
  {
    for (int a = 0; a < cells->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* array = cells->GetArray(a);
      const int type = array ? array->GetDataType() : VTK_VOID;
      if ((type == VTK_DOUBLE || type == VTK_FLOAT) && !isMeasured(array->GetName()))
      {
        return true;
      }
    }
    return false;
  };
  return hasSome(parts.fields.ofCells) || hasSome(parts.geometry->GetCellData());
}

void removeMeasured(vtkFieldData* ofCells, vtkFieldData* ofMesh)
{
  remove(
    { arrays::error, arrays::errorDistance, arrays::chordError, arrays::normalAngle }, ofCells);
  removeQualities(ofCells);
  remove({ arrays::globalError, arrays::errorDimension, arrays::largestErrorDistance,
           arrays::largestChordError, arrays::largestNormalAngle },
    ofMesh);
}

void removeQualities(vtkFieldData* ofCells)
{
  remove({ arrays::validity, arrays::quality }, ofCells);
}

void OutputJoin::fill(RankExchange& exchange, vtkPointSet* mesh, const FieldMapping& mapping,
  const ArraySelection& selection, vtkPointSet* output)
{
  fields_ = mapping.follow(exchange, std::move(fields_), stages_);
  stages_ = mapping.stageCount();
  const MeshArrays fields = select(fields_, selection);
  output->Initialize(); // VTK has passed all of the input's field data
  output->CopyStructure(mesh);
  addArrays(fields.ofVertices, output->GetPointData());
  addArrays(fields.ofCells, output->GetCellData());
  output->GetFieldData()->PassData(fields.ofMesh);
  addArrays(mesh->GetPointData(), output->GetPointData());
  addArrays(mesh->GetCellData(), output->GetCellData(), parts_.tags);
  output->GetFieldData()->PassData(mesh->GetFieldData());
  if (mesh->GetCellData()->GetScalars())
  {
    // ParaView colours by the active scalars, those of points first.
    output->GetPointData()->SetActiveScalars(nullptr);
  }
  else if (!output->GetPointData()->GetScalars() &&
           (parts_.geometry->GetPointData()->GetScalars() || !output->GetCellData()->GetScalars()))
  {
    output->GetPointData()->SetActiveScalars(arrays::entity);
  }
}

} // namespace cadrefine
