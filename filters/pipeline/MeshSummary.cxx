#include "pipeline/MeshSummary.h"

#include "comm/Threads.h"
#include "fields/CADArrays.h"
#include "mesh/MeshPlane.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/mesh/CellState.h>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>

#include <algorithm>
#include <numeric>

namespace cadrefine
{
namespace
{

CellQualities measureCells(RankExchange& exchange, const Mesh& mesh)
{
  CellQualities result;
  if (mesh.dimension < 2)
  {
    return result;
  }
  const Vector3 plane = planeNormal(exchange, mesh);
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        const auto points = cornersOf(cell, mesh.points);
        const CellState state = stateAt(shape, points, sideOf(shape, points, plane));
        result.qualities.push_back(state.quality);
        result.valid.push_back(state.valid);
      }
    });
  return result;
}

QualitySummary summaryOf(const CellQualities& qualities)
{
  const auto& ratios = qualities.qualities;
  QualitySummary summary;
  summary.invalidCells = std::count(qualities.valid.begin(), qualities.valid.end(), 0);
  summary.smallestRatio = std::accumulate(ratios.begin(), ratios.end(), summary.smallestRatio,
    [](double a, double b) { return std::min(a, b); });
  return summary;
}

QualitySummary overRanks(RankExchange& exchange, const QualitySummary& mine)
{
  return { exchange.sum(mine.invalidCells), exchange.min(mine.smallestRatio),
    exchange.min(mine.smallestCube) };
}

} // namespace

CellQualities measureQuality(RankExchange& exchange, const DistributedMesh& mesh)
{
  const Mesh& piece = mesh.mesh();
  CellQualities result = measureCells(exchange, piece);
  QualitySummary mine =
    piece.dimension == 3 ? summariseCells(piece, forOnThreads(exchange)) : summaryOf(result);
  if (mesh.converted.midNodes)
  {
    const Vector3 plane = planeNormal(exchange, piece);
    result.valid = findValidCells(piece, *mesh.converted.midNodes, plane);
    mine.invalidCells = summaryOf(result).invalidCells;
  }
  result.summary = overRanks(exchange, mine);
  return result;
}

QualitySummary summariseQuality(RankExchange& exchange, const DistributedMesh& mesh)
{
  return mesh.mesh().dimension == 3 && !mesh.converted.midNodes
           ? overRanks(exchange, summariseCells(mesh.mesh(), forOnThreads(exchange)))
           : measureQuality(exchange, mesh).summary;
}

std::string warningOfInvalidCells(const QualitySummary& quality, const MeshCounts& counts)
{
  const std::int64_t count = quality.invalidCells;
  if (2 * count > counts.cells)
  {
    throw Error("more than half of the cells are inverted or degenerate (" + std::to_string(count) +
                " of " + std::to_string(counts.cells) +
                "); if the whole mesh has the wrong orientation, swap two points of each cell");
  }
  return count == 0 ? std::string()
                    : "the input mesh has " + std::to_string(count) +
                        " inverted or degenerate cells; those that are tetrahedra or triangles "
                        "are repaired where possible while vertices move onto the CAD";
}

void setFieldValue(vtkFieldData* data, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  data->AddArray(array);
}

void setFieldValue(vtkFieldData* data, const char* name, std::int64_t value)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  data->AddArray(array);
}

void summariseMesh(RankExchange& exchange, const DistributedMesh& mesh,
  const QualitySummary& quality, vtkFieldData* data)
{
  const MeshCounts counts = countMesh(exchange, mesh);
  setFieldValue(data, "MeshDimension", std::int64_t(mesh.mesh().dimension));
  setFieldValue(data, arrays::vertexCount, counts.vertices);
  setFieldValue(data, arrays::cellCount, counts.cells);
  setFieldValue(data, arrays::invalidCells, quality.invalidCells);
  setFieldValue(data, arrays::leastQuality, quality.minimum());
}

std::int64_t summariseProjection(RankExchange& exchange, const DistributedMesh& mesh,
  const Classification& classification, std::int64_t projectedPoints, vtkFieldData* data)
{
  const auto owned = mesh.ownedPoints();
  std::vector<std::int64_t> counts(2, 0);
  for (std::size_t v = 0; v < owned.size(); ++v)
  {
    counts[0] += owned[v] && classification.entities[v];
    counts[1] += owned[v] && classification.distances[v] > 0;
  }
  counts = exchange.sum(counts);
  setFieldValue(data, arrays::verticesOnCAD, counts[0]);
  setFieldValue(data, arrays::unprojectedVertices, counts[1]);
  setFieldValue(data, arrays::projectedPoints, projectedPoints);
  return counts[0];
}

} // namespace cadrefine
