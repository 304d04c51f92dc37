// The arrays by which a mesh remembers where it lies on the CAD.
#pragma once

#include "CADModel.h"
#include "EntityId.h"
#include "MeshTypes.h"

#include <array>
#include <vector>

#include <vtkType.h>

class vtkPointSet;

namespace cadrefine
{

/// CAD entity, parameters and distance of each vertex.
struct Classification
{
  std::vector<EntityId> entities;
  std::vector<std::array<double, 2>> parameters;
  std::vector<double> distances; ///< How far the vertex still is from its place on the CAD.

  /// `count` vertices that are not on the CAD.
  explicit Classification(std::size_t count = 0) { resize(count); }
  void resize(std::size_t count);
  void set(Index vertex, const ClosestPoint& where);
};

namespace arrays
{
constexpr const char* dimension = "CADDimension";
constexpr const char* entity = "CADEntity";
constexpr const char* parameters = "CADParameters";
constexpr const char* distance = "CADDistance";
constexpr const char* conflict = "CADConflict";
constexpr const char* error = "GeometricError";
constexpr const char* errorDistance = "GeometricDistance";
constexpr const char* chordError = "ChordError";
constexpr const char* normalAngle = "NormalAngle";
} // namespace arrays

/// Reads the arrays of a projected mesh for the vertices that come from its points `pointOf`.
/// The distance of a vertex without an entity is 0. Throws Error where an array is missing, is not
/// one of numbers, has the wrong number of components, or names an entity that `model` does not
/// have, and for a vertex with one (point named) where a parameter is not finite or the distance is
/// negative or no number.
Classification readClassification(
  vtkPointSet* input, const std::vector<vtkIdType>& pointOf, const CADModel& model);

/// Whether the data set has the arrays.
bool hasClassification(vtkPointSet* input);

/// Adds or replaces the point arrays; one entry for each point of `output`.
void writeClassification(vtkPointSet* output, const Classification& classification);

/// Adds or replaces the point array CADConflict; one entry for each point of `output`.
void writeConflicts(vtkPointSet* output, const std::vector<unsigned char>& conflicts);

} // namespace cadrefine
