#include "motion/ColumnClimb.h"

#include "mesh/BoundaryFacets.h"

#include <algorithm>

namespace cadrefine
{

ColumnClimb::ColumnClimb(const DistributedMesh& mesh, const CellStacks& stacks,
  const ColumnNodes& nodes, const Moves& moves, const InnerWalls& walls, bool onSurface)
  : mesh_(mesh), nodes_(nodes), stacks_(stacks), moves_(moves), walls_(walls), onSurface_(onSurface)
{
  for (const Index vertex : mesh.shared.all)
  {
    vertexOf_.emplace_back(mesh.mesh().ids[vertex], vertex);
  }
  std::sort(vertexOf_.begin(), vertexOf_.end());
  outgoing_.resize(mesh.shared.neighbours.size());
}

void ColumnClimb::start(const Facet& facet, int place, double highest, double reach)
{
  const GlobalId wall = nodes_.ids[nodes_.at(facet, place)];
  const auto& ids = mesh_.mesh().ids;
  const bool isOther = onSurface_ && ids[facet.vertices[0]] > ids[facet.vertices[1]];
  climb(facet, { 2 * wall + (isOther ? 1 : 0), {}, place, 0, highest, reach });
  if (!onSurface_)
  {
    goBeyond(facet, { 2 * wall + 1, {}, place, 0, highest, reach });
  }
}

std::vector<ColumnVisit> ColumnClimb::run(RankExchange& exchange)
{
  const auto isEmpty = [](const std::vector<Front>& fronts) { return fronts.empty(); };
  while (exchange.any(!std::all_of(outgoing_.begin(), outgoing_.end(), isEmpty)))
  {
    const auto incoming = exchange.exchange(mesh_.shared.neighbours, outgoing_);
    std::for_each(outgoing_.begin(), outgoing_.end(), [](auto& fronts) { fronts.clear(); });
    for (const auto& fronts : incoming)
    {
      for (const Front& front : fronts)
      {
        const Facet side = stacks_.beyond(facetOf(front.side));
        if (side.cell >= 0)
        {
          climb(side, front);
        }
      }
    }
  }
  return std::move(visited_);
}

/// Lets a column climb through `side.cell`, and on.
void ColumnClimb::climb(Facet side, Front front)
{
  while (side.cell >= 0)
  {
    const Facet above = stacks_.opposite(side);
    if (above.cell < 0)
    {
      return;
    }
    const auto place = static_cast<int>(front.place);
    const Index node = nodes_.at(above, place);
    const bool isFirst = front.height == 0;
    front.height += distance(nodes_.points[nodes_.at(side, place)], nodes_.points[node]);
    if (isFirst && front.height > front.highest)
    {
      return;
    }
    visited_.push_back({ node, front.column, front.height });
    if (front.height >= front.reach || endsAt(above, node))
    {
      return;
    }
    side = stacks_.beyond(above);
    if (side.cell < 0)
    {
      send(above, front);
    }
  }
}

bool ColumnClimb::endsAt(const Facet& side, Index node) const
{
  const auto isOf = [&](const std::vector<unsigned char>& wall) {
    return std::all_of(side.begin(), side.end(), [&](Index vertex) { return wall[vertex] != 0; });
  };
  return isOf(walls_.staying) || ((onSurface_ || moves_.fractions[node] > 0) && isOf(walls_.onCAD));
}

void ColumnClimb::goBeyond(const Facet& side, const Front& front)
{
  const Facet next = stacks_.beyond(side);
  next.cell >= 0 ? climb(next, front) : send(side, front);
}

/// Sends a column on to the ranks that have all corners of the side.
void ColumnClimb::send(const Facet& side, Front front)
{
  front.side = idsOf(mesh_.mesh(), side.vertices);
  const SharedVertices& shared = mesh_.shared;
  for (std::size_t n = 0; n < shared.neighbours.size(); ++n)
  {
    const auto isHeld = [&](Index vertex)
    {
      const auto holders = shared.holdersOf(vertex);
      return std::binary_search(holders.begin(), holders.end(), shared.neighbours[n]);
    };
    if (std::all_of(side.begin(), side.end(), isHeld))
    {
      outgoing_[n].push_back(front);
    }
  }
}

Facet ColumnClimb::facetOf(const std::array<GlobalId, 4>& ids) const
{
  Facet facet;
  std::transform(ids.begin(), ids.end(), facet.vertices.begin(),
    [&](GlobalId id)
    {
      return id < 0
               ? -1
               : std::lower_bound(vertexOf_.begin(), vertexOf_.end(), std::pair{ id, Index{ 0 } })
                   ->second;
    });
  return facet;
}

} // namespace cadrefine
