#include "motion/LayerColumns.h"

#include "motion/ColumnPlanning.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace cadrefine
{
namespace
{

/// Where a node is to go, if anywhere.
struct Place
{
  Point3 point{};
  std::int64_t isSet = 0;
};

} // namespace

LayerColumns::LayerColumns(RankExchange& exchange, const DistributedMesh& mesh, ColumnNodes nodes,
  const Moves& moves, const BoundaryProjector& projector, const BoundarySearch& boundary,
  const Vector3& plane)
  : columns_{ mesh, std::move(nodes), projector, plane },
    any_(exchange.any(mesh.mesh().hasNonSimplices()))
{
  if (any_)
  {
    planColumns(exchange, moves, boundary, columns_);
  }
}

LayerColumns::Followers LayerColumns::follow(RankExchange& exchange, Moves& moves)
{
  const auto ofWalls = columns_.movesOfWalls(exchange, moves);
  const auto blocked =
    columns_.findBlocked(exchange, ofWalls, std::vector<unsigned char>(columns_.members.size(), 0));
  following_.clear();
  std::vector<Place> places(columns_.nodes.points.size());
  for (const ColumnMember& member : columns_.members)
  {
    const Vector3 move = ofWalls.of(member);
    if (move != Vector3{} && !blocked[member.node])
    {
      places[member.node] = { columns_.placeOf(member.node, move), 1 };
      following_.push_back(member);
    }
  }
  combineShared(exchange, columns_.nodes.shared, places,
    [](const Place& a, const Place& b) { return a.isSet ? a : b; });
  Followers followers;
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    if (places[n].isSet)
    {
      (moves.fractions[n] == 0 ? followers.joining : followers.redirected)
        .push_back(static_cast<Index>(n));
      moves.add(static_cast<Index>(n), places[n].point);
    }
  }
  return followers;
}

/// Calls use(column, node) for the nodes that go the same part of their way as their column.
template<class Use>
void LayerColumns::forAllTied(const Use& use) const
{
  for (const ColumnMember& member : following_)
  {
    use(member.column, member.node);
  }
  const auto useNodes = [&](const std::vector<Index>& nodes)
  {
    for (std::size_t c = 0; c < nodes.size(); ++c)
    {
      if (nodes[c] >= 0)
      {
        use(static_cast<Index>(c), nodes[c]);
      }
    }
  };
  useNodes(columns_.walls);
  useNodes(columns_.facing);
}

void LayerColumns::tie(RankExchange& exchange, Moves& moves) const
{
  // The second time what facing columns have got from each other's walls.
  for (int pass = 0; pass < (columns_.anyFacing ? 2 : 1); ++pass)
  {
    std::vector<double> smallest(columns_.walls.size(), std::numeric_limits<double>::infinity());
    forAllTied([&](Index column, Index node)
      { smallest[column] = std::min(smallest[column], moves.fractions[node]); });
    combineSmallest(exchange, columns_.shared, smallest);
    forAllTied([&](Index column, Index node)
      { moves.fractions[node] = std::min(moves.fractions[node], smallest[column]); });
    combineSmallest(exchange, columns_.nodes.shared, moves.fractions);
  }
}

} // namespace cadrefine
