#include "motion/LayerColumns.h"

#include "mesh/BoundaryFacets.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/CellStacks.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace cadrefine
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Of a move: one that is in a plane leaves it by less.
constexpr double inPlane = 1e-9;
/// A column is so many times as high as the move of its wall, at most: over that the move may fade
/// out, as no height changes by more than some hundredths, and the first one not by one.
constexpr double reachOfMove = 100;

double smaller(double a, double b)
{
  return std::min(a, b);
}

double larger(double a, double b)
{
  return std::max(a, b);
}

/// A side of cells on its way to the rank that has the cell beyond it, and the column that stands
/// on one of its corners.
struct Front
{
  GlobalId column;
  std::array<GlobalId, 4> side;
  std::int64_t corner;
  std::int64_t level;
  double height;
  double reach; ///< The column ends at this height.
};

/// Which column has a vertex: that of the lowest level, of these the smallest one.
struct Claim
{
  std::int64_t level = std::numeric_limits<std::int64_t>::max();
  GlobalId column = -1;

  friend bool operator<(const Claim& a, const Claim& b)
  {
    return a.level != b.level ? a.level < b.level : a.column < b.column;
  }
};

/// The facet at a moving vertex whose normal is nearest to the direction of its move.
struct BestFacet
{
  double cosine = -1;
  std::array<GlobalId, 4> ids{};
};

BestFacet better(const BestFacet& a, const BestFacet& b)
{
  return a.cosine != b.cosine ? (a.cosine > b.cosine ? a : b) : (a.ids < b.ids ? a : b);
}

/// Where a vertex is to go, if anywhere.
struct Place
{
  Point3 point{};
  std::int64_t isSet = 0;
};

Vector3 unitNormal(const SimplexMesh& mesh, const Facet& facet, const Vector3& plane)
{
  std::array<Point3, 4> p{};
  std::transform(
    facet.begin(), facet.end(), p.begin(), [&](Index vertex) { return mesh.points[vertex]; });
  return normalized(
    facet.corners() == 2 ? cross(p[1] - p[0], plane) : twofoldAreaVector(p, facet.corners()));
}

std::array<GlobalId, 4> idsOf(const SimplexMesh& mesh, const Facet& side)
{
  std::array<GlobalId, 4> ids{ -1, -1, -1, -1 };
  std::transform(
    side.begin(), side.end(), ids.begin(), [&](Index vertex) { return mesh.ids[vertex]; });
  return ids;
}

/// Climbs columns over all ranks.
class Climb
{
public:
  Climb(const DistributedMesh& mesh, const CellStacks& stacks) : mesh_(mesh), stacks_(stacks)
  {
    for (const Index vertex : mesh.shared.all)
    {
      vertexOf_.emplace_back(mesh.mesh().ids[vertex], vertex);
    }
    std::sort(vertexOf_.begin(), vertexOf_.end());
    outgoing_.resize(mesh.shared.neighbours.size());
  }

  /// A column that stands on this corner of a facet, on both sides of it.
  void start(const Facet& facet, int corner, double reach)
  {
    const GlobalId wall = mesh_.mesh().ids[facet.vertices[corner]];
    climb(facet, { 2 * wall, {}, corner, 0, 0, reach });
    goBeyond(facet, { 2 * wall + 1, {}, corner, 0, 0, reach });
  }

  /// Collective.
  std::vector<ColumnVertex> run(RankExchange& exchange)
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

private:
  /// Through `side.cell`, and on.
  void climb(Facet side, Front front)
  {
    while (side.cell >= 0)
    {
      const Facet above = stacks_.opposite(side);
      if (above.cell < 0)
      {
        return;
      }
      const auto& points = mesh_.mesh().points;
      const Index vertex = above.vertices[front.corner];
      front.height += distance(points[side.vertices[front.corner]], points[vertex]);
      ++front.level;
      visited_.push_back({ vertex, front.column, front.level, front.height });
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

  void goBeyond(const Facet& side, const Front& front)
  {
    const Facet next = stacks_.beyond(side);
    next.cell >= 0 ? climb(next, front) : send(side, front);
  }

  /// To the ranks that have all corners of the side.
  void send(const Facet& side, Front front)
  {
    front.side = idsOf(mesh_.mesh(), side);
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

  Facet facetOf(const std::array<GlobalId, 4>& ids) const
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

  const DistributedMesh& mesh_;
  const CellStacks& stacks_;
  std::vector<std::pair<GlobalId, Index>> vertexOf_; ///< Of the ids of shared vertices.
  std::vector<std::vector<Front>> outgoing_;
  std::vector<ColumnVertex> visited_;
};

/// For each moving vertex the facet that its column stands on. Collective.
std::vector<BestFacet> findBestFacets(RankExchange& exchange, const DistributedMesh& mesh,
  const Moves& moves, const std::vector<Facet>& facets, const Vector3& plane)
{
  const SimplexMesh& piece = mesh.mesh();
  std::vector<BestFacet> best(piece.points.size());
  for (const Facet& facet : facets)
  {
    const Vector3 normal = unitNormal(piece, facet, plane);
    for (const Index v : facet)
    {
      if (moves.fractions[v] > 0)
      {
        const Vector3 direction = normalized(moves.targets[v] - piece.points[v]);
        best[v] = better(best[v], { std::abs(dot(direction, normal)), idsOf(piece, facet) });
      }
    }
  }
  combineShared(exchange, mesh.shared, best, better);
  return best;
}

} // namespace

LayerColumns::LayerColumns(RankExchange& exchange, const DistributedMesh& mesh, const Moves& moves,
  const std::vector<unsigned char>& fixed, const Vector3& plane, bool mixed)
  : mesh_(mesh), plane_(plane)
{
  const SimplexMesh& piece = mesh.mesh();
  const bool isSurface = piece.dimension == 2 && plane == Vector3{};
  any_ = mixed && !isSurface;
  if (!any_)
  {
    return;
  }
  facets_ = findBoundaryFacets(exchange, mesh, fixed);
  const CellStacks stacks(piece);
  const auto best = findBestFacets(exchange, mesh, moves, facets_, plane);
  Climb climb(mesh, stacks);
  for (const Facet& facet : facets_)
  {
    for (int k = 0; k < facet.corners(); ++k)
    {
      const Index v = facet.vertices[k];
      if (moves.fractions[v] > 0 && best[v].ids == idsOf(piece, facet))
      {
        climb.start(facet, k, reachOfMove * distance(moves.targets[v], piece.points[v]));
      }
    }
  }
  const std::vector<ColumnVertex> visited = climb.run(exchange);
  listColumns(exchange, visited, moves);
  const auto spans = findSpans(exchange, visited, moves);
  for (const auto& [vertex, column, level, height] : visited)
  {
    const Index c = numberOf(column);
    const auto& [first, end] = spans[c];
    if (height < end)
    {
      const double x = (height - first) / (end - first);
      members_.push_back({ vertex, c, 1 - x * x * (3 - 2 * x) });
    }
  }
}

Index LayerColumns::numberOf(GlobalId column) const
{
  return static_cast<Index>(
    std::lower_bound(columns_.begin(), columns_.end(), column) - columns_.begin());
}

/// Those that came to vertices of this rank.
void LayerColumns::listColumns(
  RankExchange& exchange, const std::vector<ColumnVertex>& visited, const Moves& moves)
{
  std::transform(visited.begin(), visited.end(), std::back_inserter(columns_),
    [](const ColumnVertex& v) { return v.column; });
  std::sort(columns_.begin(), columns_.end());
  columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  std::vector<Index> numbers(columns_.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  shared_ = findSharedVertices(exchange, columns_, numbers);

  const SimplexMesh& mesh = mesh_.mesh();
  std::vector<std::pair<GlobalId, Index>> moving;
  for (std::size_t v = 0; v < mesh.ids.size(); ++v)
  {
    if (moves.fractions[v] > 0)
    {
      moving.emplace_back(mesh.ids[v], static_cast<Index>(v));
    }
  }
  std::sort(moving.begin(), moving.end());
  for (const GlobalId column : columns_)
  {
    const auto found =
      std::lower_bound(moving.begin(), moving.end(), std::pair{ column / 2, Index{ 0 } });
    walls_.push_back(found != moving.end() && found->first == column / 2 ? found->second : -1);
  }
}

/// Collective.
std::vector<LayerColumns::Span> LayerColumns::findSpans(
  RankExchange& exchange, const std::vector<ColumnVertex>& visited, const Moves& moves) const
{
  std::vector<Claim> claims(mesh_.mesh().points.size());
  for (std::size_t v = 0; v < claims.size(); ++v)
  {
    claims[v] = moves.fractions[v] > 0 ? Claim{ 0, -1 } : Claim{};
  }
  for (const auto& [vertex, column, level, height] : visited)
  {
    claims[vertex] = std::min(claims[vertex], Claim{ level, column });
  }
  combineShared(
    exchange, mesh_.shared, claims, [](const Claim& a, const Claim& b) { return std::min(a, b); });

  std::vector<double> firsts(columns_.size(), infinity);
  std::vector<double> lost(columns_.size(), infinity);
  std::vector<double> tops(columns_.size(), 0);
  for (const auto& [vertex, column, level, height] : visited)
  {
    const Index c = numberOf(column);
    firsts[c] = std::min(firsts[c], height);
    tops[c] = std::max(tops[c], height);
    if (claims[vertex].column != column || claims[vertex].level != level)
    {
      lost[c] = std::min(lost[c], height);
    }
  }
  combineShared(exchange, shared_, firsts, smaller);
  combineShared(exchange, shared_, lost, smaller);
  combineShared(exchange, shared_, tops, larger);
  std::vector<Span> spans(columns_.size());
  for (std::size_t c = 0; c < spans.size(); ++c)
  {
    spans[c] = { firsts[c], std::min(lost[c], tops[c]) };
  }
  return spans;
}

std::vector<Vector3> LayerColumns::movesOfWalls(RankExchange& exchange, const Moves& moves) const
{
  std::vector<Vector3> ofWalls(walls_.size(), Vector3{});
  for (std::size_t c = 0; c < walls_.size(); ++c)
  {
    const Index v = walls_[c];
    if (v >= 0 && moves.fractions[v] > 0)
    {
      ofWalls[c] = moves.targets[v] - mesh_.mesh().points[v];
    }
  }
  combineShared(exchange, shared_, ofWalls,
    [](const Vector3& a, const Vector3& b) { return a == Vector3{} ? b : a; });
  return ofWalls;
}

/// 1 for vertices of a boundary off the CAD that would leave the plane of a facet.
std::vector<unsigned char> LayerColumns::findBlocked(RankExchange& exchange,
  const std::vector<Vector3>& ofWalls, const Classification& classification) const
{
  const SimplexMesh& mesh = mesh_.mesh();
  std::vector<Vector3> ofVertices(mesh.points.size(), Vector3{});
  for (const Member& member : members_)
  {
    ofVertices[member.vertex] = ofWalls[member.column];
  }
  combineShared(exchange, mesh_.shared, ofVertices,
    [](const Vector3& a, const Vector3& b) { return a == Vector3{} ? b : a; });
  std::vector<unsigned char> blocked(mesh.points.size(), 0);
  for (const Facet& facet : facets_)
  {
    const Vector3 normal = unitNormal(mesh, facet, plane_);
    for (const Index v : facet)
    {
      const Vector3& move = ofVertices[v];
      blocked[v] = blocked[v] || (!classification.entities[v] &&
                                   std::abs(dot(move, normal)) > inPlane * norm(move));
    }
  }
  combineShared(exchange, mesh_.shared, blocked,
    [](unsigned char a, unsigned char b) { return std::max(a, b); });
  return blocked;
}

std::vector<Index> LayerColumns::follow(RankExchange& exchange, Moves& moves,
  const BoundaryProjector& projector, const Classification& classification)
{
  const auto ofWalls = movesOfWalls(exchange, moves);
  const auto blocked = findBlocked(exchange, ofWalls, classification);
  following_.clear();
  std::vector<Place> places(mesh_.mesh().points.size());
  for (const Member& member : members_)
  {
    const auto& [vertex, column, part] = member;
    if (ofWalls[column] != Vector3{} && !blocked[vertex])
    {
      const Point3 target = mesh_.mesh().points[vertex] + part * ofWalls[column];
      const EntityId entity = classification.entities[vertex];
      places[vertex] = { entity ? projector.nearestOn(entity, target).point : target, 1 };
      following_.push_back(member);
    }
  }
  combineShared(
    exchange, mesh_.shared, places, [](const Place& a, const Place& b) { return a.isSet ? a : b; });
  std::vector<Index> vertices;
  for (std::size_t v = 0; v < places.size(); ++v)
  {
    if (places[v].isSet)
    {
      vertices.push_back(static_cast<Index>(v));
      moves.add(vertices.back(), places[v].point);
    }
  }
  return vertices;
}

/// use(column, vertex) of what goes the same part of its way.
template<class Use>
void LayerColumns::forAllTied(const Use& use) const
{
  for (const auto& [vertex, column, part] : following_)
  {
    use(column, vertex);
  }
  for (std::size_t c = 0; c < walls_.size(); ++c)
  {
    if (walls_[c] >= 0)
    {
      use(static_cast<Index>(c), walls_[c]);
    }
  }
}

void LayerColumns::tie(RankExchange& exchange, Moves& moves) const
{
  std::vector<double> smallest(walls_.size(), infinity);
  forAllTied([&](Index column, Index vertex)
    { smallest[column] = std::min(smallest[column], moves.fractions[vertex]); });
  combineShared(exchange, shared_, smallest, smaller);
  forAllTied([&](Index column, Index vertex)
    { moves.fractions[vertex] = std::min(moves.fractions[vertex], smallest[column]); });
}

} // namespace cadrefine
