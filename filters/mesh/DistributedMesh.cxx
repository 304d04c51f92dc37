#include "mesh/DistributedMesh.h"

#include "comm/Threads.h"
#include "comm/VertexNumbering.h"
#include "mesh/PieceCheck.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/mesh/Facets.h>
#include <cadrefine/mesh/VertexFlags.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace cadrefine
{
namespace
{

/// The boxes round other ranks' pieces that meet the one round this rank's.
std::vector<BoundingBox> boxesNearby(RankExchange& exchange, const Mesh& mesh)
{
  const BoundingBox mine = boxOf(mesh.points);
  const auto& [low, high] = mine;
  const auto gathered = exchange.gather({ low[0], low[1], low[2], high[0], high[1], high[2] });
  std::vector<BoundingBox> boxes;
  for (int rank = 0; rank < exchange.size(); ++rank)
  {
    const double* numbers = gathered.data() + 6 * static_cast<std::ptrdiff_t>(rank);
    const BoundingBox box{ { numbers[0], numbers[1], numbers[2] },
      { numbers[3], numbers[4], numbers[5] } };
    if (rank != exchange.rank() && box.meets(mine))
    {
      boxes.push_back(box);
    }
  }
  return boxes;
}

/// 1 for the vertices of sides of cells that are met once in this piece.
std::vector<unsigned char> onSurface(const Mesh& mesh, const ParallelFor& parallelFor)
{
  std::vector<unsigned char> flags(mesh.points.size(), 0);
  for (const Facet& facet : findOuterFacets(mesh, {}, parallelFor))
  {
    for (const Index vertex : facet.vertices)
    {
      if (vertex >= 0)
      {
        flags[vertex] = 1;
      }
    }
  }
  return flags;
}

/// Vertices that other ranks may hold: those in the boxes round their pieces. Where these are many
/// and all cells of the mesh are tetrahedra, of those only the ones on the surface of this piece.
///
/// A vertex off that surface is held by no other rank, if cells do not overlap. The sides opposite
/// to it, seen from it, are triangles on a sphere; each edge of one is a side at the vertex, met
/// twice, with another triangle beyond it. So they have no rim and cover the sphere, however the
/// mesh is knotted elsewhere, and no room is left for another rank's cell. A vertex at which blocks
/// meet in an edge or a point alone has a rim in each of them. Inverted cells do not matter, as
/// long as the mesh has the connectivity of one without.
///
/// Triangles in space leave room: where three sheets meet at an edge and this rank has two, each
/// side there is met twice, but the vertices are the third sheet's too. Listed cells of lower
/// dimension may be anywhere.
std::vector<Index> candidates(RankExchange& exchange, const Mesh& mesh)
{
  constexpr std::size_t many = 4; // of this number of vertices, one
  const auto boxes = boxesNearby(exchange, mesh);
  const auto isNearby = [&](std::size_t v)
  {
    return std::any_of(boxes.begin(), boxes.end(),
      [&](const BoundingBox& box) { return box.contains(mesh.points[v]); });
  };
  std::vector<Index> result = indicesWhere(mesh.points.size(), isNearby);
  const ParallelFor parallelFor = forOnThreads(exchange);
  const bool others = mesh.dimension < 3 || mesh.cellCount() > mesh.tetrahedra.size();
  if (!exchange.any(others) && many * result.size() > mesh.points.size())
  {
    const auto flags = onSurface(mesh, parallelFor);
    result.erase(std::remove_if(
                   result.begin(), result.end(), [&](Index vertex) { return flags[vertex] == 0; }),
      result.end());
  }
  return result;
}

/// The key of a cell: the vertex with the smallest id, and the ids of the others.
template<std::size_t K>
VertexKey<K> keyOf(const Mesh& mesh, Index* first, Index* last)
{
  std::sort(first, last, [&](Index a, Index b) { return mesh.ids[a] < mesh.ids[b]; });
  VertexKey<K> key{ *first, {} };
  key.rest.fill(-1);
  std::transform(first + 1, last, key.rest.begin(), [&](Index vertex) { return mesh.ids[vertex]; });
  return key;
}

/// Numbers all cells, those of dimension 0 first, of which each has at most K + 1 corners. A cell
/// of lower dimension has fewer, and may be listed twice: its key ends with a negative number that
/// grows with the rank and within the piece.
template<std::size_t K>
std::vector<GlobalId> numbersOfCells(RankExchange& exchange, const DistributedMesh& mesh)
{
  constexpr GlobalId cellsOfARank = GlobalId{ 1 } << 32;
  const Mesh& piece = mesh.mesh();
  std::vector<VertexKey<K>> keys;
  reserveLong(keys, piece.cellCount());
  GlobalId place = std::numeric_limits<GlobalId>::min() + exchange.rank() * cellsOfARank;
  visitShapes(piece,
    [&](auto, const auto& cells)
    {
      for (auto cell : cells)
      {
        if constexpr (std::tuple_size_v<decltype(cell)> <= K + 1)
        {
          keys.push_back(keyOf<K>(piece, cell.data(), cell.data() + cell.size()));
        }
        if constexpr (std::tuple_size_v<decltype(cell)> <= K)
        {
          keys.back().rest.back() = place++;
        }
      }
    });
  return numberAtVertices(exchange, mesh.shared, piece.ids, keys).numbers;
}

bool haveIds(const ConvertedMesh& converted)
{
  return converted.cellIds[converted.mesh.dimension].size() ==
         converted.cellOf[converted.mesh.dimension].size();
}

} // namespace

void numberCells(RankExchange& exchange, DistributedMesh& mesh)
{
  const Mesh& cells = mesh.mesh();
  const bool mixed = exchange.any(cells.hasNonSimplices());
  const auto numbers =
    mixed ? numbersOfCells<7>(exchange, mesh) : numbersOfCells<3>(exchange, mesh);
  for (int d = 0; d < 4; ++d)
  {
    mesh.converted.cellIds[d].assign(numbers.begin() + firstCellOfDimension(cells, d),
      d < 3 ? numbers.begin() + firstCellOfDimension(cells, d + 1) : numbers.end());
  }
}

std::vector<GlobalId> numberFacets(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<Facet>& facets)
{
  std::vector<VertexKey<3>> keys;
  keys.reserve(facets.size());
  for (Facet facet : facets)
  {
    keys.push_back(
      keyOf<3>(mesh.mesh(), facet.vertices.data(), facet.vertices.data() + facet.corners()));
  }
  return numberAtVertices(exchange, mesh.shared, mesh.mesh().ids, keys).numbers;
}

SharedVertices findShared(RankExchange& exchange, const Mesh& mesh)
{
  if (exchange.size() == 1)
  {
    return {};
  }
  return findSharedVertices(exchange, mesh.ids, candidates(exchange, mesh));
}

std::size_t DistributedMesh::pointCount() const
{
  return mesh().points.size() + (converted.midNodes ? converted.midNodes->points.size() : 0);
}

std::vector<char> DistributedMesh::ownedPoints() const
{
  return (converted.midNodes ? sharedPoints : shared).ownedHere(static_cast<Index>(pointCount()));
}

SharedVertices findSharedPoints(const DistributedMesh& mesh, const SharedEdges& edges)
{
  std::vector<Index> numbers(mesh.pointCount() - mesh.mesh().points.size());
  std::iota(numbers.begin(), numbers.end(), static_cast<Index>(mesh.mesh().points.size()));
  return sharedWithMidpoints(mesh.shared, edges, numbers);
}

DistributedMesh makeDistributedMesh(RankExchange& exchange, vtkPointSet* input, CellOrder order)
{
  DistributedMesh result;
  result.converted = convert(exchange, input, order);
  result.shared = findShared(exchange, result.mesh());
  checkPieces(exchange, result);
  if (exchange.any(!haveIds(result.converted)))
  {
    numberCells(exchange, result);
  }
  const auto& ids = result.mesh().ids;
  GlobalId largest = ids.empty() ? -1 : *std::max_element(ids.begin(), ids.end());
  if (const auto& midNodes = result.converted.midNodes)
  {
    result.sharedPoints = findSharedPoints(
      result, findSharedEdges(exchange, result.shared, ids, midNodes->table.edges));
    largest = std::accumulate(midNodes->ids.begin(), midNodes->ids.end(), largest,
      [](GlobalId a, GlobalId b) { return std::max(a, b); });
  }
  result.vertexIdBound = exchange.max(largest) + 1;
  return result;
}

void flagRings(RankExchange& exchange, const DistributedMesh& mesh, int rings,
  std::vector<unsigned char>& flags, const ParallelFor& parallelFor)
{
  combineFlags(exchange, mesh.shared, flags);
  for (int ring = 0; ring < rings; ++ring)
  {
    flagVertices(mesh.mesh(), cellsAt(mesh.mesh(), flags, parallelFor), flags);
    combineFlags(exchange, mesh.shared, flags);
  }
}

BoundingBox combineBoxes(RankExchange& exchange, const BoundingBox& box)
{
  const auto& [low, high] = box;
  const auto least = exchange.min(std::vector<double>(low.begin(), low.end()));
  const auto largest = exchange.max(std::vector<double>(high.begin(), high.end()));
  return { { least[0], least[1], least[2] }, { largest[0], largest[1], largest[2] } };
}

BoundingBox findBox(RankExchange& exchange, const Mesh& mesh)
{
  return combineBoxes(exchange, boxOf(mesh.points));
}

MeshCounts countMesh(RankExchange& exchange, const DistributedMesh& mesh)
{
  const auto owned = mesh.ownedPoints();
  const auto vertices = std::count(owned.begin(), owned.end(), 1);
  const auto& cellIds = mesh.converted.cellIds[mesh.mesh().dimension];
  const auto sums = exchange.sum(std::vector<std::int64_t>{
    static_cast<std::int64_t>(vertices), static_cast<std::int64_t>(cellIds.size()) });
  return { sums[0], sums[1] };
}

} // namespace cadrefine
