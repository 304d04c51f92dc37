#include "Relocation.h"

#include "Quality.h"

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

const double smallestFraction = std::ldexp(1.0, -MoveGuard::maximumHalvings);

bool accepts(double before, double after)
{
  return before > 0 ? after >= std::min(MoveGuard::qualityFloor, 0.5 * before) : after >= before;
}

/// Mean ratio of a triangle, negative where its normal has turned against `reference`.
double orientedMeanRatio(
  const Point3& a, const Point3& b, const Point3& c, const Vector3& reference)
{
  const Vector3 normal = twofoldAreaVector(a, b, c);
  return std::copysign(meanRatio(a, b, c), dot(normal, reference));
}

/// Whether the cell stays good, by its state at the reference points `p`; called for the cells with
/// a vertex that moves.
bool acceptsMoves(const SimplexMesh& mesh, const std::vector<Point3>& p,
  const std::array<Index, 4>& cell, const Moves& moves)
{
  const auto at = [&](int k) { return moves.position(mesh, cell[k]); };
  return accepts(meanRatio(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]),
    meanRatio(at(0), at(1), at(2), at(3)));
}

bool acceptsMoves(const SimplexMesh& mesh, const std::vector<Point3>& p,
  const std::array<Index, 3>& cell, const Moves& moves)
{
  const auto at = [&](int k) { return moves.position(mesh, cell[k]); };
  return accepts(meanRatio(p[cell[0]], p[cell[1]], p[cell[2]]),
    orientedMeanRatio(at(0), at(1), at(2), twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]])));
}

/// Vertices of cells that do not accept.
template<std::size_t Corners>
void collectUnaccepted(const SimplexMesh& mesh, const std::vector<Point3>& reference,
  const std::vector<std::array<Index, Corners>>& cells, const Moves& moves,
  std::vector<Index>& vertices)
{
  for (const auto& cell : cells)
  {
    const bool moving = std::any_of(
      cell.begin(), cell.end(), [&](Index vertex) { return moves.fractions[vertex] > 0; });
    if (moving && !acceptsMoves(mesh, reference, cell, moves))
    {
      vertices.insert(vertices.end(), cell.begin(), cell.end());
    }
  }
}

} // namespace

Moves::Moves(const SimplexMesh& mesh) : targets(mesh.points), fractions(mesh.points.size(), 0.0) {}

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

bool MoveGuard::halveUnaccepted(Moves& moves) const
{
  std::vector<Index> vertices;
  if (mesh_.dimension == 3)
  {
    collectUnaccepted(mesh_, reference_, mesh_.tetrahedra, moves, vertices);
  }
  else
  {
    collectUnaccepted(mesh_, reference_, mesh_.triangles, moves, vertices);
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  bool halved = false;
  for (const Index vertex : vertices)
  {
    double& fraction = moves.fractions[vertex];
    if (fraction > 0)
    {
      fraction = fraction > smallestFraction ? 0.5 * fraction : 0;
      halved = true;
    }
  }
  return halved;
}

} // namespace cadrefine
