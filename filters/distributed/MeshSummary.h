// Numbers of the whole mesh, as field data.
#pragma once

#include "CADArrays.h"
#include "DistributedMesh.h"
#include "QualitySummary.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkPointSet;

namespace cadrefine
{

/// Validity and quality of each cell of the mesh's own dimension.
struct CellQualities
{
  std::vector<double> meanRatios;   ///< Negative where inverted.
  std::vector<unsigned char> valid; ///< 0: inverted or degenerate.
  QualitySummary summary;           ///< Over all ranks.
};

/// Tetrahedra are valid if their volume is positive in VTK's order of vertices. Triangles are valid
/// if their area is positive and, where all lie in a coordinate plane, they turn the way most do.
/// Both are decided exactly (see orientation); the mean ratio is a measure in floating point. Cells
/// of second order are valid by isValid of CurvedCells; the mean ratio is that of their corners.
/// Collective; two reductions.
CellQualities measureQuality(RankExchange& exchange, const DistributedMesh& mesh);

/// The same without the entries of the cells: for tetrahedra several times as fast.
QualitySummary summariseQuality(RankExchange& exchange, const DistributedMesh& mesh);

/// What to tell the user of invalid cells in an input whose vertices are going to move; empty where
/// there are none. Throws Error where more than half of the cells are invalid: the mesh is turned
/// the other way, or is none, and moving vertices would make valid cells of it but no shape. The
/// same on every rank; collective.
std::string warningOfInvalidCells(RankExchange& exchange, const DistributedMesh& mesh);

/// Adds a field array of one value to `output`.
void setFieldValue(vtkPointSet* output, const char* name, double value);
void setFieldValue(vtkPointSet* output, const char* name, std::int64_t value);

/// Adds MeshDimension, GlobalVertices, GlobalCells, InvalidCells and MinimumQuality. Collective.
void summariseMesh(RankExchange& exchange, const DistributedMesh& mesh,
  const QualitySummary& quality, vtkPointSet* output);

/// Adds ClassificationConflicts, the number of vertices with a conflict. Collective.
void summariseConflicts(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<unsigned char>& conflicts, vtkPointSet* output);

/// Adds CADVertices, UnprojectedVertices and ProjectedPoints. Collective.
void summariseProjection(RankExchange& exchange, const DistributedMesh& mesh,
  const Classification& classification, std::int64_t projectedPoints, vtkPointSet* output);

} // namespace cadrefine
