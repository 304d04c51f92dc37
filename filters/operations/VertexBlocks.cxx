#include "operations/VertexBlocks.h"

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

/// Takes the vertices of these cells of lower dimension that are no sides of cells, such as fins
/// and beams on a solid, out of their blocks on this rank: they stay. `sides(use)` calls
/// use(corners) for those of all cells.
template<std::size_t Corners, class Sides>
void holdStrays(const Cells<Corners>& listed, std::size_t count, const Sides& sides,
  std::vector<std::int64_t>& ofVertices)
{
  const auto sorted = [](std::array<Index, Corners> corners)
  {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  Cells<Corners> strays;
  for (std::size_t c = 0; c < count; ++c)
  {
    if (blockOf(listed[c], ofVertices) >= 0)
    {
      strays.push_back(sorted(listed[c]));
    }
  }
  if (strays.empty())
  {
    return;
  }
  std::sort(strays.begin(), strays.end());
  std::vector<unsigned char> isSide(strays.size(), 0);
  sides(
    [&](const std::array<Index, Corners>& corners)
    {
      if (blockOf(corners, ofVertices) >= 0)
      {
        const auto key = sorted(corners);
        const auto [first, last] = std::equal_range(strays.begin(), strays.end(), key);
        std::fill(
          isSide.begin() + (first - strays.begin()), isSide.begin() + (last - strays.begin()), 1);
      }
    });
  for (std::size_t c = 0; c < strays.size(); ++c)
  {
    for (const Index vertex : strays[c])
    {
      ofVertices[vertex] = isSide[c] ? ofVertices[vertex] : manyBlocks;
    }
  }
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
  visitCells(mesh.mesh(), joinAt);
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

void holdStrays(
  RankExchange& exchange, const DistributedMesh& mesh, std::vector<std::int64_t>& ofVertices)
{
  const Mesh& piece = mesh.mesh();
  const std::vector<std::int64_t> before = ofVertices;
  holdStrays<3>(
    piece.triangles, listedTriangles(piece),
    [&](const auto& use)
    {
      for (const auto& cell : piece.tetrahedra)
      {
        for (const auto& [i, j, k] : tetrahedronFaces)
        {
          use({ cell[i], cell[j], cell[k] });
        }
      }
    },
    ofVertices);
  holdStrays<2>(
    piece.segments, piece.segments.size(),
    [&](const auto& use)
    {
      visitCells(piece,
        [&](const auto& cells)
        {
          for (const auto& cell : cells)
          {
            for (std::size_t i = 0; i < cell.size(); ++i)
            {
              for (std::size_t k = 0; k < i; ++k)
              {
                use({ cell[i], cell[k] });
              }
            }
          }
        });
    },
    ofVertices);
  if (exchange.any(ofVertices != before))
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
  combineShared(exchange, mesh.shared, ofVertices,
    [](std::int64_t a, std::int64_t b) { return std::min(a, b); });
  for (const auto& segment : mesh.mesh().segments)
  {
    if (blockOf(segment, ofVertices) < 0)
    {
      mark(segment, manyBlocks);
    }
  }
  combineShared(exchange, mesh.shared, ofVertices,
    [](std::int64_t a, std::int64_t b) { return std::max(a, b); });
}

std::size_t listedTriangles(const Mesh& mesh)
{
  return mesh.dimension == 3 ? mesh.triangles.size() : 0;
}

} // namespace cadrefine
