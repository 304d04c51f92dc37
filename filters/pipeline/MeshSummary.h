// Numbers of the whole mesh, as field data.
#pragma once

#include "fields/CADArrays.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/mesh/QualitySummary.h>

#include <cstdint>
#include <string>
#include <vector>

class vtkFieldData;

namespace cadrefine
{

/// Validity and quality of each cell of the mesh's own dimension.
struct CellQualities
{
  std::vector<double> qualities;    ///< Quality of each cell, see CellState.
  std::vector<unsigned char> valid; ///< 0: the cell is inverted or degenerate.
  QualitySummary summary;           ///< Summary of the cells of all ranks.
};

/// Finds the validity and quality of all cells. Tetrahedra are valid if their volume is positive in
/// VTK's order of vertices. Triangles are valid if their area is positive and, where all lie in a
/// coordinate plane, they turn the way most do. Both are decided exactly (see orientation); the
/// mean ratio is a measure in floating point. Other cells: see CellState. Cells of second order are
/// valid by isValid of CurvedCells; the mean ratio is that of their corners. Collective; two
/// reductions.
CellQualities measureQuality(RankExchange& exchange, const DistributedMesh& mesh);

/// The summary of measureQuality without the entries of the cells: for tetrahedra several times as
/// fast.
QualitySummary summariseQuality(RankExchange& exchange, const DistributedMesh& mesh);

/// What to tell the user of invalid cells in an input whose vertices are going to move; empty where
/// there are none. Throws Error where more than half of the cells are invalid: the mesh is turned
/// the other way, or is none, and moving vertices would make valid cells of it but no shape.
std::string warningOfInvalidCells(const QualitySummary& quality, const MeshCounts& counts);

/// Sets a field array of one value.
void setFieldValue(vtkFieldData* data, const char* name, double value);
void setFieldValue(vtkFieldData* data, const char* name, std::int64_t value);

/// Sets MeshDimension, GlobalVertices, GlobalCells, InvalidCells and MinimumQuality. Collective.
void summariseMesh(RankExchange& exchange, const DistributedMesh& mesh,
  const QualitySummary& quality, vtkFieldData* data);

/// Sets CADVertices, UnprojectedVertices and ProjectedPoints. Returns the value of CADVertices.
/// Collective.
std::int64_t summariseProjection(RankExchange& exchange, const DistributedMesh& mesh,
  const Classification& classification, std::int64_t projectedPoints, vtkFieldData* data);

} // namespace cadrefine
