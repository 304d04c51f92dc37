#include "pipeline/MeshSummary.h"

#include "comm/Threads.h"
#include "mesh/MeshPlane.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

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

void add(CellQualities& qualities, double ratio, bool valid)
{
  qualities.meanRatios.push_back(ratio);
  qualities.valid.push_back(valid);
}

CellQualities measureCells(RankExchange& exchange, const SimplexMesh& mesh)
{
  CellQualities result;
  const auto& p = mesh.points;
  if (mesh.dimension == 3)
  {
    for (const auto& [a, b, c, d] : mesh.tetrahedra)
    {
      add(result, meanRatio(p[a], p[b], p[c], p[d]), orientation(p[a], p[b], p[c], p[d]) > 0);
    }
    return result;
  }
  const Vector3 normal = planeNormal(exchange, mesh);
  for (const auto& [a, b, c] : mesh.triangles)
  {
    const double ratio = meanRatio(p[a], p[b], p[c]);
    const Vector3 side = normal == Vector3{} ? twofoldAreaVector(p[a], p[b], p[c]) : normal;
    const int turn = turnOf(p[a], p[b], p[c], side);
    add(result, turn < 0 ? -ratio : ratio, turn > 0);
  }
  return result;
}

QualitySummary summaryOf(const CellQualities& qualities)
{
  const auto& ratios = qualities.meanRatios;
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
  const SimplexMesh& piece = mesh.mesh();
  CellQualities result = measureCells(exchange, piece);
  QualitySummary mine =
    piece.dimension == 3 ? summariseTetrahedra(piece, forOnThreads(exchange)) : summaryOf(result);
  if (mesh.converted.midNodes)
  {
    const Vector3 plane = piece.dimension == 2 ? planeNormal(exchange, piece) : Vector3{};
    result.valid = findValidCells(piece, *mesh.converted.midNodes, plane);
    mine.invalidCells = summaryOf(result).invalidCells;
  }
  result.summary = overRanks(exchange, mine);
  return result;
}

QualitySummary summariseQuality(RankExchange& exchange, const DistributedMesh& mesh)
{
  return mesh.mesh().dimension == 3 && !mesh.converted.midNodes
           ? overRanks(exchange, summariseTetrahedra(mesh.mesh(), forOnThreads(exchange)))
           : measureQuality(exchange, mesh).summary;
}

std::string warningOfInvalidCells(const QualitySummary& quality, const MeshCounts& counts)
{
  const std::int64_t count = quality.invalidCells;
  if (2 * count > counts.cells)
  {
    throw Error("more than half of the cells are inverted or degenerate (" + std::to_string(count) +
                " of " + std::to_string(counts.cells) +
                "); if its orientation is reversed, swap two points of each cell");
  }
  return count == 0 ? std::string()
                    : "the input mesh has " + std::to_string(count) +
                        " inverted or degenerate cells; they are repaired where that is possible "
                        "while vertices move onto the CAD";
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
  setFieldValue(data, "GlobalVertices", counts.vertices);
  setFieldValue(data, "GlobalCells", counts.cells);
  setFieldValue(data, "InvalidCells", quality.invalidCells);
  setFieldValue(data, "MinimumQuality", quality.minimum());
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
  setFieldValue(data, "CADVertices", counts[0]);
  setFieldValue(data, "UnprojectedVertices", counts[1]);
  setFieldValue(data, "ProjectedPoints", projectedPoints);
  return counts[0];
}

} // namespace cadrefine
