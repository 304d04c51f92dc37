#include "Relocation.h"

#include "Orientation.h"
#include "Quality.h"

#include <algorithm>
#include <cmath>

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

void Moves::addWhole(Index vertex, const Point3& target)
{
  add(vertex, target);
  whole[vertex] = 1;
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

std::vector<Index> cellsAt(const SimplexMesh& mesh, const std::vector<unsigned char>& flags)
{
  std::vector<Index> result;
  const auto look = [&](const auto& cells)
  {
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      unsigned char any = 0;
      for (const Index vertex : cells[c])
      {
        any |= flags[vertex];
      }
      if (any)
      {
        result.push_back(static_cast<Index>(c));
      }
    }
  };
  if (mesh.dimension == 3)
  {
    look(mesh.tetrahedra);
  }
  else
  {
    look(mesh.triangles);
  }
  return result;
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

MoveGuard::MoveGuard(const SimplexMesh& mesh, const Moves& moves,
  const std::vector<Point3>& reference, const Vector3& plane)
  : MoveGuard(mesh, moves, reference, plane, cellsAt(mesh, movingVertices(moves)))
{
}

MoveGuard::MoveGuard(const SimplexMesh& mesh, const Moves& moves,
  const std::vector<Point3>& reference, const Vector3& plane, const std::vector<Index>& cells)
  : mesh_(mesh)
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
  for (const Index c : chosen)
  {
    const auto& cell = cells[c];
    if (std::none_of(
          cell.begin(), cell.end(), [&](Index vertex) { return moves.fractions[vertex] > 0; }))
    {
      continue;
    }
    const Vector3 side = sideOf(cell, reference, plane);
    CellState before = stateOf(cell, reference, side);
    if (!before.valid)
    {
      before = stateOf(cell, mesh_.points, side); // once mended, it stays so
    }
    const double least =
      before.valid ? std::min(qualityFloor, 0.5 * before.quality) : before.quality;
    guarded_.push_back({ c, before, least, side });
  }
}

template<std::size_t Corners>
void MoveGuard::findUnaccepted(
  const Simplices<Corners>& cells, const Moves& moves, std::vector<Index>& vertices) const
{
  for (const GuardedCell& guarded : guarded_)
  {
    const auto& cell = cells[guarded.cell];
    std::array<Point3, Corners> points;
    std::transform(cell.begin(), cell.end(), points.begin(),
      [&](Index vertex) { return moves.position(mesh_, vertex); });
    const CellState after = stateAt(points, guarded.side);
    if (after.valid < guarded.before.valid || !(after.quality >= guarded.leastQuality))
    {
      vertices.insert(vertices.end(), cell.begin(), cell.end());
    }
  }
}

bool MoveGuard::halveUnaccepted(Moves& moves) const
{
  std::vector<Index> vertices;
  if (mesh_.dimension == 3)
  {
    findUnaccepted(mesh_.tetrahedra, moves, vertices);
  }
  else
  {
    findUnaccepted(mesh_.triangles, moves, vertices);
  }
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

template<std::size_t Corners>
void MoveGuard::findSpoilt(
  const Simplices<Corners>& cells, double part, std::vector<Index>& vertices) const
{
  for (const GuardedCell& guarded : guarded_)
  {
    const auto& cell = cells[guarded.cell];
    const CellState now = stateOf(cell, mesh_.points, guarded.side);
    if (guarded.before.valid && now.quality < part * guarded.before.quality)
    {
      vertices.insert(vertices.end(), cell.begin(), cell.end());
    }
  }
}

std::vector<Index> MoveGuard::verticesOfSpoiltCells(double part) const
{
  std::vector<Index> vertices;
  if (mesh_.dimension == 3)
  {
    findSpoilt(mesh_.tetrahedra, part, vertices);
  }
  else
  {
    findSpoilt(mesh_.triangles, part, vertices);
  }
  return vertices;
}

} // namespace cadrefine
