// The arrays by which a mesh remembers where it lies on the CAD.
#pragma once

#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/classification/Classification.h>

#include <vector>

#include <vtkType.h>

class vtkFieldData;
class vtkPointData;
class vtkPointSet;

namespace cadrefine
{

namespace arrays
{
constexpr const char* dimension = "CADDimension";
constexpr const char* entity = "CADEntity";
constexpr const char* parameters = "CADParameters";
constexpr const char* distance = "CADDistance";
constexpr const char* name = "CADName";
constexpr const char* colour = "CADColor";
constexpr const char* conflict = "CADConflict";
constexpr const char* error = "GeometricError";
constexpr const char* errorDistance = "GeometricDistance";
constexpr const char* chordError = "ChordError";
constexpr const char* normalAngle = "NormalAngle";
constexpr const char* validity = "CellValidity";
constexpr const char* quality = "CellQuality";
// Field data.
constexpr const char* globalError = "GlobalGeometricError";
constexpr const char* errorDimension = "GeometricErrorDimension";
constexpr const char* largestErrorDistance = "MaximumGeometricDistance";
constexpr const char* largestChordError = "MaximumChordError";
constexpr const char* largestNormalAngle = "MaximumNormalAngle";
constexpr const char* leastQuality = "MinimumQuality";
constexpr const char* vertexCount = "GlobalVertices";
constexpr const char* cellCount = "GlobalCells";
constexpr const char* invalidCells = "InvalidCells";
constexpr const char* verticesOnCAD = "CADVertices";
constexpr const char* projectedPoints = "ProjectedPoints";
constexpr const char* unprojectedVertices = "UnprojectedVertices";
} // namespace arrays

/// Whether a cell array of this name is what CAD Geometric Error or Mesh Validity found, and so
/// holds for the mesh as it was alone. Null: no.
bool isMeasured(const char* name);

/// Reads the arrays of a projected mesh for the vertices that come from its points `pointOf`.
/// The distance of a vertex without an entity is 0. Throws Error where an array is missing, is not
/// one of numbers, has the wrong number of components, or names an entity that `model` does not
/// have, and for a vertex with one (point named) where a parameter is not finite, the distance is
/// negative or NaN, or is 0 though the vertex is elsewhere than its place on the CAD: by more than
/// 1e-4 of the model's size and what single precision of its coordinates explains. Work: one
/// evaluation for each vertex on the CAD.
Classification readClassification(
  vtkPointSet* input, const std::vector<vtkIdType>& pointOf, const CADModel& model);

/// Whether the data set has the arrays.
bool hasClassification(vtkPointSet* input);

/// Adds or replaces the point arrays; one entry for each point of `output`.
void writeClassification(vtkPointSet* output, const Classification& classification);

/// Adds or replaces the arrays CADDimension and CADEntity.
void writeEntities(vtkFieldData* output, const std::vector<EntityId>& entities);

/// Adds or replaces an array with the names of these entities in the CAD file; empty without one.
void writeNames(vtkFieldData* output, const char* array, const CADModel& model,
  const std::vector<EntityId>& entities);

/// Adds or replaces an array with the colours of these entities in the CAD file, as red, green and
/// blue; white without one.
void writeColours(vtkFieldData* output, const char* array, const CADModel& model,
  const std::vector<EntityId>& entities);

/// Adds or replaces the point array CADConflict; one entry for each point.
void writeConflicts(vtkPointData* output, const std::vector<unsigned char>& conflicts);

} // namespace cadrefine
