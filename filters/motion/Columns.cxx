#include "motion/Columns.h"

#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cadrefine
{
namespace
{

/// A move that is in a plane leaves it by less than this part of its length.
constexpr double inPlane = 1e-9;
/// A vertex on the CAD that goes along comes off its way by no more than this part of it.
constexpr double alongEntity = 0.1;

} // namespace

Vector3 Columns::normalOf(const Facet& facet) const
{
  const Mesh& piece = mesh.mesh();
  const std::array<Point3, 4> p = pointsOf(piece, facet);
  if (facet.corners() > 2)
  {
    return normalized(twofoldAreaVector(p, facet.corners()));
  }
  const Vector3 ofCell =
    onSurface()
      ? twofoldAreaVector(
          cornersOf(piece.quadrilaterals[facet.cell - piece.triangles.size()], piece.points), 4)
      : plane;
  return normalized(cross(p[1] - p[0], ofCell));
}

/// The moves of these nodes, one for each column, on this rank or on others. Collective.
std::vector<Vector3> Columns::movesOf(
  RankExchange& exchange, const Moves& moves, const std::vector<Index>& ofColumns) const
{
  std::vector<Vector3> result(walls.size(), Vector3{});
  for (std::size_t c = 0; c < ofColumns.size(); ++c)
  {
    const Index n = ofColumns[c];
    if (n >= 0 && moves.fractions[n] > 0)
    {
      result[c] = moves.targets[n] - nodes.points[n];
    }
  }
  combineShared(exchange, shared, result, nonZero);
  return result;
}

WallMoves Columns::movesOfWalls(RankExchange& exchange, const Moves& moves) const
{
  WallMoves result{ movesOf(exchange, moves, walls), movesOf(exchange, moves, facing) };
  std::transform(result.own.begin(), result.own.end(), lifts.begin(), result.own.begin(),
    [](const Vector3& move, const Vector3& lift) { return move + norm(move) * lift; });
  return result;
}

std::vector<Vector3> Columns::movesOfNodes(RankExchange& exchange, const WallMoves& ofWalls,
  const std::vector<unsigned char>& isLeftOut) const
{
  std::vector<Vector3> ofNodes(nodes.points.size(), Vector3{});
  for (std::size_t k = 0; k < members.size(); ++k)
  {
    if (!isLeftOut[k])
    {
      ofNodes[members[k].node] = ofWalls.of(members[k]);
    }
  }
  combineShared(exchange, nodes.shared, ofNodes, nonZero);
  return ofNodes;
}

std::vector<unsigned char> Columns::findBlocked(
  RankExchange& exchange, const WallMoves& ofWalls, const std::vector<unsigned char>& isLost) const
{
  const auto ofNodes = movesOfNodes(exchange, ofWalls, isLost);
  std::vector<unsigned char> blocked = nodes.held;
  blocked.resize(ofNodes.size(), 0);
  forAllFacets(
    [&](Index n, const Facet& facet, const Vector3& normal)
    {
      const Vector3& move = ofNodes[n];
      blocked[n] = blocked[n] || (!nodes.entities[n] && !facet.isInside &&
                                   std::abs(dot(move, normal)) > inPlane * norm(move));
    });
  if (onSurface())
  {
    std::transform(blocked.begin(), blocked.end(), nodes.entities.begin(), blocked.begin(),
      [](bool isBlocked, EntityId entity) { return isBlocked || !entity; });
  }
  combineFlags(exchange, nodes.shared, blocked);
  return blocked;
}

Point3 Columns::placeOf(Index node, const Vector3& move) const
{
  const Point3 target = nodes.points[node] + move;
  const EntityId entity = nodes.entities[node];
  return entity ? projector.nearestOn(entity, target).point : target;
}

bool Columns::keepsDirection(Index node, const Vector3& move) const
{
  return distance(placeOf(node, move), nodes.points[node] + move) <= alongEntity * norm(move);
}

} // namespace cadrefine
