#include "motion/ColumnClimb.h"

#include "mesh/BoundaryFacets.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadrefine
{
namespace
{

/// Of the length of first edges: those that differ by less were made equal.
constexpr double equal = 1e-3;

const FirstEdge& shorter(const FirstEdge& a, const FirstEdge& b)
{
  if (a.wantedLength == 0 || b.wantedLength == 0)
  {
    return a.wantedLength == 0 ? b : a;
  }
  return std::pair(a.wantedLength, a.up) < std::pair(b.wantedLength, b.up) ? a : b;
}

bool isHalfway(const FirstEdge& edge, const FirstEdge& a, const FirstEdge& b)
{
  return edge.wantedLength > 0 && a.wantedLength > 0 && b.wantedLength > 0 &&
         distance(edge.up, 0.5 * (a.up + b.up)) < equal * edge.wantedLength;
}

} // namespace

ColumnClimb::ColumnClimb(const DistributedMesh& mesh, const ColumnNodes& nodes)
  : mesh_(mesh), nodes_(nodes), stacks_(mesh.mesh())
{
  for (const Index vertex : mesh.shared.all)
  {
    vertexOf_.emplace_back(mesh.mesh().ids[vertex], vertex);
  }
  std::sort(vertexOf_.begin(), vertexOf_.end());
  outgoing_.resize(mesh.shared.neighbours.size());
}

std::vector<FirstEdge> ColumnClimb::firstEdges(RankExchange& exchange,
  const std::vector<Facet>& facets, const std::vector<unsigned char>& onBoundary) const
{
  std::vector<FirstEdge> edges(nodes_.points.size());
  for (const Facet& facet : facets)
  {
    const Facet above = stacks_.opposite(facet);
    for (int k = 0; above.cell >= 0 && k < nodes_.count(facet); ++k)
    {
      const Vector3 up = upFrom(facet, above, k);
      FirstEdge& edge = edges[nodes_.at(facet, k)];
      edge = shorter(edge, { up, norm(up), onBoundary[nodes_.at(above, k)] != 0 });
    }
  }
  combineShared(exchange, nodes_.shared, edges, shorter);
  const std::size_t first = edges.size() - nodes_.parents->size();
  for (std::size_t n = first; n < edges.size(); ++n)
  {
    const auto& [i, k] = (*nodes_.parents)[n - first];
    const FirstEdge& a = edges[i];
    const FirstEdge& b = edges[k];
    const double longest = std::max(a.wantedLength, b.wantedLength);
    if (isHalfway(edges[n], a, b) && std::abs(a.wantedLength - b.wantedLength) < equal * longest)
    {
      edges[n].wantedLength = 0.5 * (a.wantedLength + b.wantedLength);
    }
  }
  return edges;
}

void ColumnClimb::start(const Facet& facet, int place, double highest, double reach)
{
  const GlobalId wall = nodes_.ids[nodes_.at(facet, place)];
  climb(facet, { 2 * wall, {}, place, 0, 0, highest, reach });
  goBeyond(facet, { 2 * wall + 1, {}, place, 0, 0, highest, reach });
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

/// Through `side.cell`, and on.
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
    front.height += norm(upFrom(side, above, place));
    ++front.level;
    if (front.level == 1 && front.height > front.highest)
    {
      return;
    }
    visited_.push_back({ node, front.column, front.level, front.height });
    if (front.height >= front.reach)
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

Vector3 ColumnClimb::upFrom(const Facet& side, const Facet& above, int place) const
{
  return nodes_.points[nodes_.at(above, place)] - nodes_.points[nodes_.at(side, place)];
}

void ColumnClimb::goBeyond(const Facet& side, const Front& front)
{
  const Facet next = stacks_.beyond(side);
  next.cell >= 0 ? climb(next, front) : send(side, front);
}

/// To the ranks that have all corners of the side.
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
