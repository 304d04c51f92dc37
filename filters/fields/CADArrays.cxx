#include "fields/CADArrays.h"

#include <cadrefine/base/Error.h>

#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

namespace cadrefine
{
namespace
{

vtkDataArray* requireArray(vtkPointSet* input, const char* name, int components)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name);
  if (!array && input->GetPointData()->HasArray(name))
  {
    throw Error(std::string("the point array ") + name + " is not numeric");
  }
  if (!array && input->GetNumberOfPoints() > 0)
  {
    throw Error(std::string("the mesh has no point array ") + name +
                "; apply the filter Project Onto CAD first");
  }
  if (array && array->GetNumberOfComponents() != components)
  {
    throw Error(std::string("the point array ") + name + " has " +
                std::to_string(array->GetNumberOfComponents()) + " components instead of " +
                std::to_string(components));
  }
  return array;
}

std::string atPoint(vtkIdType point)
{
  return " (point " + std::to_string(point) + ")";
}

/// The entity of a point. The arrays may be of any type: what is no whole number is refused like
/// what is out of range.
EntityId readEntity(double dimension, double index, const CADModel& model, vtkIdType point)
{
  if (dimension == -1)
  {
    return {};
  }
  const bool known = (dimension == 0 || dimension == 1 || dimension == 2) &&
                     std::isgreaterequal(index, 0.0) &&
                     index < model.count(static_cast<int>(dimension)) && std::floor(index) == index;
  if (!known)
  {
    std::ostringstream entity;
    entity << "(" << dimension << ", " << index << ")";
    throw Error("the point arrays CADDimension and CADEntity name an entity " + entity.str() +
                " that the CAD model does not have; were they made with another CAD file?" +
                atPoint(point));
  }
  return { static_cast<std::int8_t>(dimension), static_cast<std::int32_t>(index) };
}

void checkPlace(
  EntityId entity, const std::array<double, 2>& parameters, double distance, vtkIdType point)
{
  if (!std::isgreaterequal(distance, 0.0))
  {
    throw Error("the point array CADDistance has a value that is negative or NaN" + atPoint(point));
  }
  const bool finite = std::isfinite(parameters[0]) && std::isfinite(parameters[1]);
  if (entity.dimension > 0 && !finite)
  {
    throw Error("the point array CADParameters has a value that is not finite for a point on the "
                "CAD" +
                atPoint(point));
  }
}

/// How far a vertex that was projected may be from its place on the CAD: by this part of the
/// model's size, and, as files may have numbers of single precision, of its coordinates.
constexpr double ofSize = 1e-4;
constexpr double ofCoordinates = 4 * std::numeric_limits<float>::epsilon();

/// Throws Error where vertices that have reached the CAD are not where the arrays say.
void checkVerticesAreThere(vtkPointSet* input, const std::vector<vtkIdType>& pointOf,
  const Classification& classification, const CADModel& model)
{
  double farthest = 0;
  vtkIdType at = -1;
  for (std::size_t v = 0; v < pointOf.size(); ++v)
  {
    const EntityId entity = classification.entities[v];
    if (entity && classification.distances[v] == 0)
    {
      Point3 point{};
      input->GetPoint(pointOf[v], point.data());
      const double away = distance(point, model.evaluate(entity, classification.parameters[v]));
      if (away > std::max(farthest, ofSize * model.size() + ofCoordinates * norm(point)))
      {
        farthest = away;
        at = pointOf[v];
      }
    }
  }
  if (at >= 0)
  {
    std::ostringstream text;
    text << "vertices are up to " << farthest << " away from their places on the CAD by the point "
         << "arrays CADEntity and CADParameters; project the mesh onto this CAD file if it was "
            "projected onto another one, or with another unit of it, or has moved since"
         << atPoint(at);
    throw Error(text.str());
  }
}

template<class Array>
vtkNew<Array> makeArray(const char* name, int components, std::size_t count)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  return array;
}

} // namespace

bool isMeasured(const char* name)
{
  const std::array<const char*, 6> names{ arrays::error, arrays::errorDistance, arrays::chordError,
    arrays::normalAngle, arrays::validity, arrays::quality };
  return name && std::any_of(names.begin(), names.end(),
                   [&](const char* other) { return std::strcmp(name, other) == 0; });
}

bool hasClassification(vtkPointSet* input)
{
  return input->GetPointData()->HasArray(arrays::dimension) != 0;
}

Classification readClassification(
  vtkPointSet* input, const std::vector<vtkIdType>& pointOf, const CADModel& model)
{
  vtkDataArray* dimensions = requireArray(input, arrays::dimension, 1);
  vtkDataArray* entities = requireArray(input, arrays::entity, 1);
  vtkDataArray* parameters = requireArray(input, arrays::parameters, 2);
  vtkDataArray* distances = requireArray(input, arrays::distance, 1);
  Classification result(pointOf.size());
  for (std::size_t v = 0; v < pointOf.size(); ++v)
  {
    const vtkIdType point = pointOf[v];
    result.entities[v] =
      readEntity(dimensions->GetTuple1(point), entities->GetTuple1(point), model, point);
    parameters->GetTuple(point, result.parameters[v].data());
    if (result.entities[v])
    {
      result.distances[v] = distances->GetTuple1(point);
      checkPlace(result.entities[v], result.parameters[v], result.distances[v], point);
    }
  }
  checkVerticesAreThere(input, pointOf, result, model);
  return result;
}

void writeClassification(vtkPointSet* output, const Classification& classification)
{
  const std::size_t count = classification.entities.size();
  auto parameters = makeArray<vtkDoubleArray>(arrays::parameters, 2, count);
  auto distances = makeArray<vtkDoubleArray>(arrays::distance, 1, count);
  for (std::size_t v = 0; v < count; ++v)
  {
    const auto point = static_cast<vtkIdType>(v);
    parameters->SetTypedTuple(point, classification.parameters[v].data());
    distances->SetValue(point, classification.distances[v]);
  }
  vtkPointData* pointData = output->GetPointData();
  writeEntities(pointData, classification.entities);
  pointData->AddArray(parameters);
  pointData->AddArray(distances);
}

void writeEntities(vtkFieldData* output, const std::vector<EntityId>& entities)
{
  auto dimensions = makeArray<vtkSignedCharArray>(arrays::dimension, 1, entities.size());
  auto indices = makeArray<vtkIntArray>(arrays::entity, 1, entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i)
  {
    dimensions->SetValue(static_cast<vtkIdType>(i), entities[i].dimension);
    indices->SetValue(static_cast<vtkIdType>(i), entities[i].index);
  }
  output->AddArray(dimensions);
  output->AddArray(indices);
}

void writeNames(vtkFieldData* output, const char* array, const CADModel& model,
  const std::vector<EntityId>& entities)
{
  auto names = makeArray<vtkStringArray>(array, 1, entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i)
  {
    names->SetValue(
      static_cast<vtkIdType>(i), entities[i] ? model.attributes(entities[i]).name : "");
  }
  output->AddArray(names);
}

void writeColours(vtkFieldData* output, const char* array, const CADModel& model,
  const std::vector<EntityId>& entities)
{
  constexpr std::array<float, 3> white{ 1, 1, 1 };
  auto colours = makeArray<vtkUnsignedCharArray>(array, 3, entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i)
  {
    const auto colour = entities[i] ? model.attributes(entities[i]).colour.value_or(white) : white;
    for (int k = 0; k < 3; ++k)
    {
      colours->SetTypedComponent(
        static_cast<vtkIdType>(i), k, static_cast<unsigned char>(std::lround(255 * colour[k])));
    }
  }
  output->AddArray(colours);
}

void writeConflicts(vtkPointData* output, const std::vector<unsigned char>& conflicts)
{
  auto array = makeArray<vtkUnsignedCharArray>(arrays::conflict, 1, conflicts.size());
  for (std::size_t v = 0; v < conflicts.size(); ++v)
  {
    array->SetValue(static_cast<vtkIdType>(v), conflicts[v]);
  }
  output->AddArray(array);
}

} // namespace cadrefine
