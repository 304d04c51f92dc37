#include "motion/LayerColumns.h"

#include "mesh/BoundaryFacets.h"

#include <cadrefine/mesh/Quality.h>

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
/// A stack that is so many moves high takes all of a move, and no cell of it loses more than 1.5
/// over this of its height; of a lower one so much less fades out within it.
constexpr double heightsOfMove = 6;
/// A vertex on the CAD that goes along comes off its way by less of it.
constexpr double alongEntity = 0.1;
/// Of what fades out: from so much height on it does so smoothly, and the first height stays.
constexpr double smoothHeights = 2;
/// The least cosine between a facet's normal and a move across it, not along it.
constexpr double across = 0.5;

double smaller(double a, double b)
{
  return std::min(a, b);
}

double larger(double a, double b)
{
  return std::max(a, b);
}

const Vector3& nonZero(const Vector3& a, const Vector3& b)
{
  return a == Vector3{} ? b : a;
}

/// The facet at a moving node whose normal is nearest to the direction of its move.
struct BestFacet
{
  double cosine = -1;
  std::array<GlobalId, 4> ids{};
};

BestFacet better(const BestFacet& a, const BestFacet& b)
{
  return a.cosine != b.cosine ? (a.cosine > b.cosine ? a : b) : (a.ids < b.ids ? a : b);
}

/// Where a column ends: at a moving node, so high up.
struct Arrival
{
  GlobalId end = -1;
  double height = 0;
};

/// Where a node is to go, if anywhere.
struct Place
{
  Point3 point{};
  std::int64_t isSet = 0;
};

Vector3 unitNormal(const Mesh& mesh, const Facet& facet, const Vector3& plane)
{
  std::array<Point3, 4> p{};
  std::transform(
    facet.begin(), facet.end(), p.begin(), [&](Index vertex) { return mesh.points[vertex]; });
  return normalized(
    facet.corners() == 2 ? cross(p[1] - p[0], plane) : twofoldAreaVector(p, facet.corners()));
}

/// For each moving node the facet that its column stands on. Collective.
std::vector<BestFacet> findBestFacets(RankExchange& exchange, const Mesh& mesh,
  const ColumnNodes& nodes, const Moves& moves, const std::vector<Facet>& facets,
  const Vector3& plane)
{
  std::vector<BestFacet> best(nodes.points.size());
  for (const Facet& facet : facets)
  {
    const Vector3 normal = unitNormal(mesh, facet, plane);
    for (int k = 0; k < nodes.count(facet); ++k)
    {
      const Index n = nodes.at(facet, k);
      if (moves.fractions[n] > 0)
      {
        const Vector3 direction = normalized(moves.targets[n] - nodes.points[n]);
        best[n] =
          better(best[n], { std::abs(dot(direction, normal)), idsOf(mesh, facet.vertices) });
      }
    }
  }
  combineShared(exchange, nodes.shared, best, better);
  return best;
}

} // namespace

LayerColumns::LayerColumns(RankExchange& exchange, const DistributedMesh& mesh, ColumnNodes nodes,
  const Moves& moves, const BoundaryProjector& projector, const std::vector<unsigned char>& fixed,
  const Vector3& plane)
  : mesh_(mesh), nodes_(std::move(nodes)), projector_(projector), plane_(plane)
{
  const Mesh& piece = mesh.mesh();
  const bool isSurface = piece.dimension == 2 && plane == Vector3{};
  any_ = exchange.any(piece.hasOtherThanSimplices()) && !isSurface;
  if (!any_)
  {
    return;
  }
  facets_ = findBoundaryFacets(exchange, mesh, fixed);
  const auto best = findBestFacets(exchange, piece, nodes_, moves, facets_, plane);
  const CellStacks stacks(piece);
  ColumnClimb climb(mesh, stacks, nodes_);
  for (const Facet& facet : facets_)
  {
    for (int k = 0; k < nodes_.count(facet); ++k)
    {
      const Index n = nodes_.at(facet, k);
      if (moves.fractions[n] > 0 && best[n].ids == idsOf(piece, facet.vertices))
      {
        const double move = distance(moves.targets[n], nodes_.points[n]);
        climb.start(facet, k, move / nodes_.leastMove, reachOfMove * move);
      }
    }
  }
  listMembers(exchange, climb.run(exchange), moves);
  lifts_.assign(columns_.size(), Vector3{});
  if (nodes_.parents)
  {
    findLifts(exchange, findFirstEdges(exchange, stacks, nodes_, facets_, moves, projector, fixed));
  }
  std::vector<double> cosines;
  std::transform(best.begin(), best.end(), std::back_inserter(cosines),
    [](const BestFacet& facet) { return facet.cosine; });
  findYielding(exchange, moves, cosines);
  const auto claims = findClaims(exchange, moves, std::vector<unsigned char>(members_.size(), 0));
  const auto spans = findSpans(exchange, moves, claims);
  const auto isBeyond = [&](const Member& member)
  {
    const Span& span = spans[member.column];
    return claims[member.node] < claimOf(member) || member.height > span.end ||
           (member.height == span.height && span.faded == 1);
  };
  members_.erase(std::remove_if(members_.begin(), members_.end(), isBeyond), members_.end());
  for (Member& member : members_)
  {
    const auto& [first, end, height, faded, smooth] = spans[member.column];
    const double x = end > first ? (member.height - first) / (end - first) : 0;
    member.part =
      1 - faded * (smooth * x * x * (3 - 2 * x) + (1 - smooth) * (member.height / height));
  }
}

/// The columns that came to nodes of this rank, and these nodes.
void LayerColumns::listMembers(
  RankExchange& exchange, const std::vector<ColumnVisit>& visits, const Moves& moves)
{
  std::transform(visits.begin(), visits.end(), std::back_inserter(columns_),
    [](const ColumnVisit& visit) { return visit.column; });
  std::sort(columns_.begin(), columns_.end());
  columns_.erase(std::unique(columns_.begin(), columns_.end()), columns_.end());
  std::vector<Index> numbers(columns_.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  shared_ = findSharedVertices(exchange, columns_, numbers);
  for (const auto& [node, column, level, height] : visits)
  {
    const auto found = std::lower_bound(columns_.begin(), columns_.end(), column);
    members_.push_back({ node, static_cast<Index>(found - columns_.begin()), level, height, 1 });
  }

  std::vector<std::pair<GlobalId, Index>> moving;
  for (std::size_t n = 0; n < nodes_.ids.size(); ++n)
  {
    if (moves.fractions[n] > 0)
    {
      moving.emplace_back(nodes_.ids[n], static_cast<Index>(n));
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

/// use(node, normal) of all facets.
template<class Use>
void LayerColumns::forAllFacets(const Use& use) const
{
  for (const Facet& facet : facets_)
  {
    const Vector3 normal = unitNormal(mesh_.mesh(), facet, plane_);
    for (int k = 0; k < nodes_.count(facet); ++k)
    {
      use(nodes_.at(facet, k), normal);
    }
  }
}

/// Nodes that are to move along their facets only, and to which a column comes that does so too:
/// they start none themselves. Given the cosines between the moves and the facets' normals.
/// Collective.
void LayerColumns::findYielding(
  RankExchange& exchange, const Moves& moves, const std::vector<double>& cosines)
{
  const auto slides = [&](Index n) { return moves.fractions[n] > 0 && cosines[n] < across; };
  std::vector<unsigned char> ofSliding(columns_.size(), 0);
  for (std::size_t c = 0; c < walls_.size(); ++c)
  {
    ofSliding[c] = walls_[c] >= 0 && slides(walls_[c]);
  }
  combineFlags(exchange, shared_, ofSliding);
  std::vector<unsigned char> isLeftOut;
  std::transform(members_.begin(), members_.end(), std::back_inserter(isLeftOut),
    [&](const Member& member) { return ofSliding[member.column]; });
  yields_.resize(nodes_.points.size());
  for (std::size_t n = 0; n < yields_.size(); ++n)
  {
    yields_[n] = slides(static_cast<Index>(n));
  }
  const auto claims = findClaims(exchange, moves, isLeftOut);
  for (std::size_t k = 0; k < members_.size(); ++k)
  {
    isLeftOut[k] = isLeftOut[k] || claims[members_[k].node] < claimOf(members_[k]);
  }
  const auto ofNodes = movesOfMembers(exchange, movesOfWalls(exchange, moves), isLeftOut);
  std::vector<unsigned char> stays(ofNodes.size(), 0);
  forAllFacets([&](Index n, const Vector3& normal)
    { stays[n] = stays[n] || std::abs(dot(ofNodes[n], normal)) > across * norm(ofNodes[n]); });
  combineFlags(exchange, nodes_.shared, stays);
  for (std::size_t n = 0; n < yields_.size(); ++n)
  {
    yields_[n] = yields_[n] && ofNodes[n] != Vector3{} && !stays[n];
  }
  std::vector<unsigned char> isNone(columns_.size(), 0);
  for (std::size_t c = 0; c < walls_.size(); ++c)
  {
    isNone[c] = walls_[c] >= 0 && yields_[walls_[c]];
  }
  combineFlags(exchange, shared_, isNone);
  members_.erase(std::remove_if(members_.begin(), members_.end(),
                   [&](const Member& member) { return isNone[member.column]; }),
    members_.end());
  for (std::size_t c = 0; c < walls_.size(); ++c)
  {
    walls_[c] = isNone[c] ? -1 : walls_[c];
  }
}

/// Collective.
void LayerColumns::findLifts(RankExchange& exchange, const std::vector<FirstEdge>& edges)
{
  for (const Member& member : members_)
  {
    const Index wall = walls_[member.column];
    if (member.level == 1 && wall >= 0 &&
        edges[wall].up == nodes_.points[member.node] - nodes_.points[wall])
    {
      lifts_[member.column] = edges[wall].lifted - edges[wall].up;
    }
  }
  combineShared(exchange, shared_, lifts_, nonZero);
}

/// Which columns have the nodes, given 1 for members that are left out. Collective.
std::vector<LayerColumns::Claim> LayerColumns::findClaims(
  RankExchange& exchange, const Moves& moves, const std::vector<unsigned char>& isLeftOut) const
{
  std::vector<Claim> claims(nodes_.points.size());
  for (std::size_t n = 0; n < claims.size(); ++n)
  {
    claims[n] = moves.fractions[n] > 0 && !yields_[n] ? Claim{ 0, -1 } : Claim{};
  }
  for (std::size_t k = 0; k < members_.size(); ++k)
  {
    Claim& claim = claims[members_[k].node];
    claim = isLeftOut[k] ? claim : std::min(claim, claimOf(members_[k]));
  }
  combineShared(
    exchange, nodes_.shared, claims, [](const Claim& a, const Claim& b) { return std::min(a, b); });
  return claims;
}

/// Pairs of columns of which each ends at the wall of the other one, so near that their moves do
/// not fade out between them, and which share their nodes with no third column, given the heights
/// of their tops: 1 for columns of such pairs. Collective.
std::vector<unsigned char> LayerColumns::findFacing(RankExchange& exchange, const Moves& moves,
  const std::vector<Claim>& claims, const std::vector<double>& tops)
{
  std::vector<GlobalId> ends(columns_.size(), -1); // moving nodes
  facing_.assign(columns_.size(), -1);
  for (const auto& [node, c, level, height, part] : members_)
  {
    if (height == tops[c] && claims[node].column < 0)
    {
      ends[c] = nodes_.ids[node];
      facing_[c] = node;
    }
  }
  const auto largest = [](GlobalId a, GlobalId b) { return std::max(a, b); };
  combineShared(exchange, shared_, ends, largest);
  std::vector<unsigned char> faces(columns_.size(), 0);
  if (!exchange.any(std::any_of(ends.begin(), ends.end(), [](GlobalId end) { return end >= 0; })))
  {
    return faces;
  }
  std::vector<std::array<Arrival, 2>> arrivals(nodes_.points.size()); // of the columns on a node
  for (std::size_t c = 0; c < columns_.size(); ++c)
  {
    if (walls_[c] >= 0)
    {
      arrivals[walls_[c]][columns_[c] % 2] = { ends[c], tops[c] };
    }
  }
  combineShared(exchange, nodes_.shared, arrivals,
    [](const auto& a, const auto& b) {
      return std::array{ a[0].end < 0 ? b[0] : a[0], a[1].end < 0 ? b[1] : a[1] };
    });

  const auto ofWalls = movesOfWalls(exchange, moves);
  std::vector<GlobalId> faced(columns_.size(), -1); // columns
  for (std::size_t c = 0; c < columns_.size(); ++c)
  {
    for (int side = 0; side < 2 && facing_[c] >= 0; ++side)
    {
      const Arrival& back = arrivals[facing_[c]][side];
      const bool isNear = std::min(tops[c], back.height) <
                          heightsOfMove * (norm(ofWalls.own[c]) + norm(ofWalls.facing[c]));
      faced[c] = back.end == columns_[c] / 2 && isNear ? 2 * ends[c] + side : faced[c];
    }
  }
  combineShared(exchange, shared_, faced, largest);
  std::vector<unsigned char> isNone(columns_.size(), 0);
  for (const Member& member : members_)
  {
    const GlobalId owner = claims[member.node].column;
    const Index c = member.column;
    isNone[c] =
      isNone[c] || faced[c] < 0 || (owner >= 0 && owner != columns_[c] && owner != faced[c]);
  }
  combineFlags(exchange, shared_, isNone);
  for (std::size_t c = 0; c < columns_.size(); ++c)
  {
    facing_[c] = isNone[c] ? -1 : facing_[c];
  }
  std::transform(
    isNone.begin(), isNone.end(), faces.begin(), [](unsigned char none) { return none ? 0 : 1; });
  anyFacing_ = exchange.any(std::count(faces.begin(), faces.end(), 1) > 0);
  return faces;
}

/// Collective.
std::vector<LayerColumns::Span> LayerColumns::findSpans(
  RankExchange& exchange, const Moves& moves, const std::vector<Claim>& claims)
{
  std::vector<double> firsts(columns_.size(), infinity);
  std::vector<double> tops(columns_.size(), 0);
  for (const Member& member : members_)
  {
    const Index c = member.column;
    firsts[c] = std::min(firsts[c], member.height);
    tops[c] = std::max(tops[c], member.height);
  }
  combineShared(exchange, shared_, firsts, smaller);
  combineShared(exchange, shared_, tops, larger);
  const auto faces = findFacing(exchange, moves, claims, tops);
  const auto ofWalls = movesOfWalls(exchange, moves);
  std::vector<unsigned char> isLost;
  std::transform(members_.begin(), members_.end(), std::back_inserter(isLost),
    [&](const Member& member) { return claims[member.node] < claimOf(member); });
  std::vector<double> lost(columns_.size(), infinity);
  std::vector<double> lasts(columns_.size(), 0); // below the tops
  for (std::size_t k = 0; k < members_.size(); ++k)
  {
    const auto& [node, c, level, height, part] = members_[k];
    lost[c] = isLost[k] && !faces[c] ? std::min(lost[c], height) : lost[c];
    lasts[c] = height < tops[c] ? std::max(lasts[c], height) : lasts[c];
  }
  combineShared(exchange, shared_, lost, smaller);
  combineShared(exchange, shared_, lasts, larger);

  const auto blocked = findBlocked(exchange, ofWalls, isLost);
  std::vector<double> faded(columns_.size(), 0);
  for (const Member& member : members_)
  {
    const Index c = member.column;
    const double move = norm(ofWalls.own[c]);
    const double height = tops[c] - firsts[c];
    if (member.height == tops[c])
    {
      const bool goesAlong = !faces[c] && lost[c] == infinity && tops[c] < reachOfMove * move &&
                             !blocked[member.node] && keepsDirection(member.node, ofWalls.own[c]);
      faded[c] = goesAlong ? std::max(faded[c], std::min(1.0, height / (heightsOfMove * move))) : 1;
    }
  }
  combineShared(exchange, shared_, faded, larger);
  std::vector<Span> spans(columns_.size());
  for (std::size_t c = 0; c < spans.size(); ++c)
  {
    const double height = std::min(lost[c], tops[c]);
    const double end = faces[c] ? lasts[c] : height;
    const double difference = norm(ofWalls.own[c] - ofWalls.facing[c]);
    const double smooth =
      std::clamp((end - firsts[c]) / difference - (smoothHeights - 1), 0.0, 1.0);
    spans[c] = { firsts[c], end, height, faded[c], faded[c] < 1 ? 1 : smooth };
  }
  return spans;
}

std::vector<Vector3> LayerColumns::movesOf(
  RankExchange& exchange, const Moves& moves, const std::vector<Index>& ofColumns) const
{
  std::vector<Vector3> result(columns_.size(), Vector3{});
  for (std::size_t c = 0; c < ofColumns.size(); ++c)
  {
    const Index n = ofColumns[c];
    if (n >= 0 && moves.fractions[n] > 0)
    {
      result[c] = moves.targets[n] - nodes_.points[n];
    }
  }
  combineShared(exchange, shared_, result, nonZero);
  return result;
}

/// Collective.
LayerColumns::WallMoves LayerColumns::movesOfWalls(RankExchange& exchange, const Moves& moves) const
{
  WallMoves result{ movesOf(exchange, moves, walls_), movesOf(exchange, moves, facing_) };
  std::transform(result.own.begin(), result.own.end(), lifts_.begin(), result.own.begin(),
    [](const Vector3& move, const Vector3& lift) { return move + lift; });
  return result;
}

/// The moves of the walls over which nodes are, of one of them where there are several. Collective.
std::vector<Vector3> LayerColumns::movesOfMembers(RankExchange& exchange, const WallMoves& ofWalls,
  const std::vector<unsigned char>& isLeftOut) const
{
  std::vector<Vector3> ofNodes(nodes_.points.size(), Vector3{});
  for (std::size_t k = 0; k < members_.size(); ++k)
  {
    if (!isLeftOut[k])
    {
      ofNodes[members_[k].node] = ofWalls.of(members_[k]);
    }
  }
  combineShared(exchange, nodes_.shared, ofNodes, nonZero);
  return ofNodes;
}

/// 1 for nodes that are held, and those of a boundary off the CAD that would leave the plane of a
/// facet. Members that are lost do not count: one column at most moves a node.
std::vector<unsigned char> LayerColumns::findBlocked(
  RankExchange& exchange, const WallMoves& ofWalls, const std::vector<unsigned char>& isLost) const
{
  const auto ofNodes = movesOfMembers(exchange, ofWalls, isLost);
  std::vector<unsigned char> blocked = nodes_.held;
  blocked.resize(ofNodes.size(), 0);
  forAllFacets(
    [&](Index n, const Vector3& normal)
    {
      const Vector3& move = ofNodes[n];
      blocked[n] =
        blocked[n] || (!nodes_.entities[n] && std::abs(dot(move, normal)) > inPlane * norm(move));
    });
  combineFlags(exchange, nodes_.shared, blocked);
  return blocked;
}

/// Where a move brings a node that keeps to its entity.
Point3 LayerColumns::placeOf(Index node, const Vector3& move) const
{
  const Point3 target = nodes_.points[node] + move;
  const EntityId entity = nodes_.entities[node];
  return entity ? projector_.nearestOn(entity, target).point : target;
}

bool LayerColumns::keepsDirection(Index node, const Vector3& move) const
{
  return distance(placeOf(node, move), nodes_.points[node] + move) <= alongEntity * norm(move);
}

LayerColumns::Followers LayerColumns::follow(RankExchange& exchange, Moves& moves)
{
  const auto ofWalls = movesOfWalls(exchange, moves);
  const auto blocked =
    findBlocked(exchange, ofWalls, std::vector<unsigned char>(members_.size(), 0));
  following_.clear();
  std::vector<Place> places(nodes_.points.size());
  for (const Member& member : members_)
  {
    const Vector3 move = ofWalls.of(member);
    if (move != Vector3{} && !blocked[member.node])
    {
      places[member.node] = { placeOf(member.node, move), 1 };
      following_.push_back(member);
    }
  }
  lifts_.assign(lifts_.size(), Vector3{}); // what is left of them is part of what is left to go
  combineShared(exchange, nodes_.shared, places,
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

/// use(column, node) of what goes the same part of its way.
template<class Use>
void LayerColumns::forAllTied(const Use& use) const
{
  for (const Member& member : following_)
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
  useNodes(walls_);
  useNodes(facing_);
}

void LayerColumns::tie(RankExchange& exchange, Moves& moves) const
{
  // The second time what facing columns have got from each other's walls.
  for (int pass = 0; pass < (anyFacing_ ? 2 : 1); ++pass)
  {
    std::vector<double> smallest(walls_.size(), infinity);
    forAllTied([&](Index column, Index node)
      { smallest[column] = std::min(smallest[column], moves.fractions[node]); });
    combineShared(exchange, shared_, smallest, smaller);
    forAllTied([&](Index column, Index node)
      { moves.fractions[node] = std::min(moves.fractions[node], smallest[column]); });
    combineShared(exchange, nodes_.shared, moves.fractions, smaller);
  }
}

} // namespace cadrefine
