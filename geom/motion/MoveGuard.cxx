#include <cadrefine/motion/MoveGuard.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace cadrefine
{
namespace
{

const double smallestFraction = std::ldexp(1.0, -MoveGuard::maximumHalvings);

CellState stateAt(const std::array<Point3, 4>& p, const Vector3&)
{
  return { orientation(p[0], p[1], p[2], p[3]) > 0, meanRatio(p[0], p[1], p[2], p[3]) };
}

CellState stateAt(const std::array<Point3, 3>& p, const Vector3& side)
{
  const int turn = turnOf(p[0], p[1], p[2], side);
  return { turn > 0, std::copysign(meanRatio(p[0], p[1], p[2]), turn) };
}

template<std::size_t Corners>
std::array<Point3, Corners> pointsOf(
  const std::array<Index, Corners>& cell, const std::vector<Point3>& points)
{
  std::array<Point3, Corners> result;
  std::transform(cell.begin(), cell.end(), result.begin(), [&](Index v) { return points[v]; });
  return result;
}

Vector3 sideOf(const std::array<Index, 4>&, const std::vector<Point3>&, const Vector3&)
{
  return {};
}

Vector3 sideOf(
  const std::array<Index, 3>& cell, const std::vector<Point3>& points, const Vector3& plane)
{
  return plane != Vector3{} ? plane
                            : twofoldAreaVector(points[cell[0]], points[cell[1]], points[cell[2]]);
}

std::vector<unsigned char> movingVertices(const Moves& moves)
{
  std::vector<unsigned char> flags(moves.fractions.size());
  std::transform(moves.fractions.begin(), moves.fractions.end(), flags.begin(),
    [](double fraction) { return fraction > 0; });
  return flags;
}

} // namespace

Moves::Moves(const SimplexMesh& mesh)
  : targets(mesh.points), fractions(mesh.points.size(), 0.0), whole(mesh.points.size(), 0)
{
}

void Moves::add(Index vertex, const Point3& target)
{
  targets[vertex] = target;
  fractions[vertex] = 1;
}

Point3 Moves::position(const SimplexMesh& mesh, Index vertex) const
{
  const double fraction = fractions[vertex];
  if (fraction == 1)
  {
    return targets[vertex];
  }
  const Point3& start = mesh.points[vertex];
  return fraction == 0 ? start : start + fraction * (targets[vertex] - start);
}

CellState stateOf(
  const std::array<Index, 4>& cell, const std::vector<Point3>& points, const Vector3& side)
{
  return stateAt(pointsOf(cell, points), side);
}

CellState stateOf(
  const std::array<Index, 3>& cell, const std::vector<Point3>& points, const Vector3& side)
{
  return stateAt(pointsOf(cell, points), side);
}

std::vector<Index> cellsAt(
  const SimplexMesh& mesh, const std::vector<unsigned char>& flags, const ParallelFor& parallelFor)
{
  const auto lookAt = [&](const auto& cells)
  {
    return collect<Index>(parallelFor, cells.size(), fineGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& found)
      {
        for (std::size_t c = begin; c < end; ++c)
        {
          unsigned char any = 0;
          for (const Index vertex : cells[c])
          {
            any |= flags[vertex];
          }
          if (any)
          {
            found.push_back(static_cast<Index>(c));
          }
        }
      });
  };
  return mesh.dimension == 3 ? lookAt(mesh.tetrahedra) : lookAt(mesh.triangles);
}

void flagVertices(
  const SimplexMesh& mesh, const std::vector<Index>& cells, std::vector<unsigned char>& flags)
{
  const auto flag = [&](const auto& all)
  {
    for (const Index cell : cells)
    {
      for (const Index vertex : all[cell])
      {
        flags[vertex] = 1;
      }
    }
  };
  if (mesh.dimension == 3)
  {
    flag(mesh.tetrahedra);
  }
  else
  {
    flag(mesh.triangles);
  }
}

MoveGuard::MoveGuard(const SimplexMesh& mesh, const Moves& moves)
  : MoveGuard(mesh, moves, mesh.points, {})
{
}

MoveGuard::MoveGuard(const SimplexMesh& mesh, const Moves& moves,
  const std::vector<Point3>& reference, const Vector3& plane, const ParallelFor& parallelFor)
  : MoveGuard(
      mesh, moves, reference, plane, cellsAt(mesh, movingVertices(moves), parallelFor), parallelFor)
{
}

MoveGuard::MoveGuard(const SimplexMesh& mesh, const Moves& moves,
  const std::vector<Point3>& reference, const Vector3& plane, const std::vector<Index>& cells,
  const ParallelFor& parallelFor)
  : mesh_(mesh), parallelFor_(parallelFor)
{
  if (mesh.dimension == 3)
  {
    guard(mesh.tetrahedra, cells, moves, reference, plane);
  }
  else
  {
    guard(mesh.triangles, cells, moves, reference, plane);
  }
}

template<std::size_t Corners>
void MoveGuard::guard(const Simplices<Corners>& cells, const std::vector<Index>& chosen,
  const Moves& moves, const std::vector<Point3>& reference, const Vector3& plane)
{
  std::vector<Index> moving;
  std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(moving),
    [&](Index c)
    {
      return std::any_of(cells[c].begin(), cells[c].end(),
        [&](Index vertex) { return moves.fractions[vertex] > 0; });
    });
  resizeLong(guarded_, moving.size(), parallelFor_);
  const auto look = [&](GuardedCell& guarded, Index number)
  {
    guarded.cell = number;
    const auto& cell = cells[guarded.cell];
    guarded.side = sideOf(cell, reference, plane);
    guarded.before = stateOf(cell, reference, guarded.side);
    if (!guarded.before.valid)
    {
      guarded.before = stateOf(cell, mesh_.points, guarded.side); // once mended, it stays so
    }
    const double quality = guarded.before.quality;
    const double half = std::clamp(0.5 * quality, lowestQuality, qualityFloor);
    guarded.leastQuality = guarded.before.valid ? std::min(half, quality) : quality;
  };
  forEachIndex(
    parallelFor_, guarded_.size(), fineGrain, [&](std::size_t i) { look(guarded_[i], moving[i]); });
}

template<std::size_t Corners>
bool MoveGuard::accepts(
  const std::array<Index, Corners>& cell, const GuardedCell& guarded, const Moves& moves) const
{
  std::array<Point3, Corners> points;
  std::transform(cell.begin(), cell.end(), points.begin(),
    [&](Index vertex) { return moves.position(mesh_, vertex); });
  const CellState after = stateAt(points, guarded.side);
  return after.valid >= guarded.before.valid && after.quality >= guarded.leastQuality;
}

/// The corners of the guarded cells for which holds(cell, guarded).
template<class Predicate>
std::vector<Index> MoveGuard::cornersWhere(const Predicate& holds) const
{
  const auto lookAt = [&](const auto& cells)
  {
    return collect<Index>(parallelFor_, guarded_.size(), fineGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& corners)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          const auto& cell = cells[guarded_[i].cell];
          if (holds(cell, guarded_[i]))
          {
            corners.insert(corners.end(), cell.begin(), cell.end());
          }
        }
      });
  };
  return mesh_.dimension == 3 ? lookAt(mesh_.tetrahedra) : lookAt(mesh_.triangles);
}

bool MoveGuard::halveUnaccepted(Moves& moves) const
{
  std::vector<Index> vertices = cornersWhere(
    [&](const auto& cell, const GuardedCell& guarded) { return !accepts(cell, guarded, moves); });
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  bool halved = false;
  for (const Index vertex : vertices)
  {
    double& fraction = moves.fractions[vertex];
    if (fraction > 0)
    {
      fraction = fraction > smallestFraction && !moves.whole[vertex] ? 0.5 * fraction : 0;
      halved = true;
    }
  }
  return halved;
}

std::vector<Index> MoveGuard::verticesOfSpoiltCells(double part) const
{
  return cornersWhere(
    [&](const auto& cell, const GuardedCell& guarded)
    {
      const CellState now = stateOf(cell, mesh_.points, guarded.side);
      return guarded.before.valid && now.quality < part * guarded.before.quality;
    });
}

} // namespace cadrefine
