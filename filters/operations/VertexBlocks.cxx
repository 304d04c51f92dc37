#include "operations/VertexBlocks.h"

#include <cadrefine/operations/EditableMesh.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();

std::int64_t joined(std::int64_t a, std::int64_t b)
{
  if (a == unknown || b == unknown || a == b)
  {
    return std::min(a, b);
  }
  return manyBlocks;
}

/// Calls use(corners) for the edges, or the triangles, of all simplices of blocks.
template<std::size_t Corners, class Use>
void forSidesInBlocks(const Mesh& mesh, const std::vector<std::int64_t>& ofCells, const Use& use)
{
  const auto forSidesOf = [&](const auto& cell)
  {
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        if constexpr (Corners == 2)
        {
          use({ cell[i], cell[j] });
        }
        else
        {
          for (std::size_t k = 0; k < j; ++k)
          {
            use({ cell[i], cell[j], cell[k] });
          }
        }
      }
    }
  };
  visitOwnSimplices(mesh,
    [&](const auto& cells)
    {
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        if (ofCells[c] >= 0)
        {
          forSidesOf(cells[c]);
        }
      }
    });
}

/// Makes the vertices of the first `count` listed cells stay, except for listed cells that are
/// sides of cells in blocks. Returns whether there are any that stay.
template<std::size_t Corners>
bool holdStrays(const Mesh& mesh, const std::vector<std::int64_t>& ofCells,
  const Cells<Corners>& listed, std::size_t count, std::vector<std::int64_t>& ofVertices)
{
  Cells<Corners> atBlocks;
  for (std::size_t c = 0; c < count; ++c)
  {
    if (blockOf(listed[c], ofVertices) >= 0)
    {
      atBlocks.push_back(sorted(listed[c]));
    }
  }
  if (atBlocks.empty())
  {
    return false;
  }
  std::sort(atBlocks.begin(), atBlocks.end());
  std::vector<unsigned char> isSide(atBlocks.size(), 0);
  forSidesInBlocks<Corners>(mesh, ofCells,
    [&](const std::array<Index, Corners>& corners)
    {
      const auto found = std::lower_bound(atBlocks.begin(), atBlocks.end(), sorted(corners));
      if (found != atBlocks.end() && *found == sorted(corners))
      {
        isSide[found - atBlocks.begin()] = 1;
      }
    });
  for (std::size_t c = 0; c < atBlocks.size(); ++c)
  {
    for (const Index vertex : atBlocks[c])
    {
      ofVertices[vertex] = isSide[c] ? ofVertices[vertex] : manyBlocks;
    }
  }
  return std::find(isSide.begin(), isSide.end(), 0) != isSide.end();
}

} // namespace

std::vector<std::int64_t> blocksOfVertices(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<std::int64_t>& ofCells)
{
  std::vector<std::int64_t> result(mesh.mesh().points.size(), unknown);
  const auto joinAt = [&](const auto& cells)
  {
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      for (const Index vertex : cells[c])
      {
        result[vertex] = joined(result[vertex], ofCells[c]);
      }
    }
  };
  visitOwnSimplices(mesh.mesh(), joinAt);
  visitOwnShapes(mesh.mesh(),
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        for (const Index vertex : cell)
        {
          result[vertex] = isSimplex(shape) ? result[vertex] : manyBlocks;
        }
      }
    });
  for (const auto& [vertex] : mesh.mesh().vertices)
  {
    result[vertex] = manyBlocks; // it is listed
  }
  combineShared(exchange, mesh.shared, result, joined);
  std::replace(result.begin(), result.end(), unknown, manyBlocks);
  return result;
}

void holdStrays(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<std::int64_t>& ofCells, std::vector<std::int64_t>& ofVertices)
{
  const Mesh& piece = mesh.mesh();
  const bool triangles =
    holdStrays(piece, ofCells, piece.triangles, listedTriangles(piece), ofVertices);
  const bool segments =
    holdStrays(piece, ofCells, piece.segments, piece.segments.size(), ofVertices);
  if (exchange.any(triangles || segments))
  {
    combineShared(exchange, mesh.shared, ofVertices, joined);
  }
}

void markBesideOthers(
  RankExchange& exchange, const DistributedMesh& mesh, std::vector<std::int64_t>& ofVertices)
{
  const auto mark = [&](const auto& cell, std::int64_t code)
  {
    for (const Index vertex : cell)
    {
      ofVertices[vertex] = code;
    }
  };
  visitOwnShapes(mesh.mesh(),
    [&](auto shape, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        if (!isSimplex(shape))
        {
          mark(cell, besideOthers);
        }
      }
    });
  combineSmallest(exchange, mesh.shared, ofVertices);
  for (const auto& segment : mesh.mesh().segments)
  {
    if (blockOf(segment, ofVertices) < 0)
    {
      mark(segment, manyBlocks);
    }
  }
  combineLargest(exchange, mesh.shared, ofVertices);
}

std::size_t listedTriangles(const Mesh& mesh)
{
  return mesh.dimension == 3 ? mesh.triangles.size() : 0;
}

} // namespace cadrefine
