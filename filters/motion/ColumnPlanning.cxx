#include "motion/ColumnPlanning.h"

#include "motion/ColumnStarts.h"
#include "motion/FirstEdges.h"

#include <cadrefine/base/SortUniquely.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A stack that is so many moves high takes all of a move, and no cell of it loses more than 1.5
/// over this of its height; in a lower one, so much less fades out within it.
constexpr double heightsOfMove = 6;
/// In a column at least so many times as high as what fades out, it does so smoothly, and the first
/// height stays.
constexpr double smoothHeights = 2;
/// The least cosine between a facet's normal and a move across it, not along it.
constexpr double across = 0.5;

/// The moving node at which a column ends, and its height.
struct Arrival
{
  GlobalId end = -1;
  double height = 0;
};

/// The steps of planColumns, each with what those before it found.
class ColumnPlanning
{
public:
  explicit ColumnPlanning(Columns& columns) : columns_(columns) {}

  void run(RankExchange& exchange, const Moves& moves, const BoundarySearch& boundary);

private:
  /// Which column has a node: the one that is lowest there, of these the smallest one; -1: the node
  /// moves by itself.
  struct Claim
  {
    double height = infinity;
    GlobalId column = -1;

    friend bool operator<(const Claim& a, const Claim& b)
    {
      return a.height != b.height ? a.height < b.height : a.column < b.column;
    }
  };

  /// How a column's move fades out: smoothly from its first node to where it ends, or in proportion
  /// to the height, from the wall on.
  struct Span
  {
    double first;  ///< Height of the first node.
    double end;    ///< Height of the last node; between walls, of that before the facing wall.
    double height; ///< Height at which the column ends, or of the facing wall.
    double faded;  ///< Part of the move that has faded out there.
    double smooth; ///< Weight of the smooth way.
  };

  void listMembers(
    RankExchange& exchange, const std::vector<ColumnVisit>& visits, const Moves& moves);
  void findYielding(RankExchange& exchange, const Moves& moves, const std::vector<double>& cosines);
  void findLifts(RankExchange& exchange, const Moves& moves, const std::vector<FirstEdge>& edges);
  std::vector<Claim> findClaims(
    RankExchange& exchange, const Moves& moves, const std::vector<unsigned char>& isLeftOut) const;
  Claim claimOf(const ColumnMember& member) const
  {
    return { member.height, columns_.ids[member.column] };
  }
  std::vector<unsigned char> findFacing(RankExchange& exchange, const Moves& moves,
    const std::vector<Claim>& claims, const std::vector<double>& tops);
  std::vector<Span> findSpans(
    RankExchange& exchange, const Moves& moves, const std::vector<Claim>& claims);

  Columns& columns_;
  std::vector<unsigned char> yields_; ///< 1: a node that goes with a column, wherever it was to go.
};

void ColumnPlanning::run(RankExchange& exchange, const Moves& moves, const BoundarySearch& boundary)
{
  const CellStacks stacks(columns_.mesh.mesh());
  const ColumnStarts starts = startColumns(exchange, moves, boundary, stacks, columns_);
  listMembers(exchange, starts.visits, moves);
  columns_.lifts.assign(columns_.ids.size(), Vector3{});
  if (columns_.nodes.parents)
  {
    findLifts(exchange, moves,
      findFirstEdges(exchange, stacks, columns_.nodes, columns_.facets, moves, columns_.projector,
        boundary.among));
  }
  findYielding(exchange, moves, starts.cosines);
  const auto claims =
    findClaims(exchange, moves, std::vector<unsigned char>(columns_.members.size(), 0));
  const auto spans = findSpans(exchange, moves, claims);
  const auto isBeyond = [&](const ColumnMember& member)
  {
    const Span& span = spans[member.column];
    return claims[member.node] < claimOf(member) || member.height > span.end ||
           (member.height == span.height && span.faded == 1);
  };
  columns_.members.erase(std::remove_if(columns_.members.begin(), columns_.members.end(), isBeyond),
    columns_.members.end());
  for (ColumnMember& member : columns_.members)
  {
    const auto& [first, end, height, faded, smooth] = spans[member.column];
    const double x = end > first ? (member.height - first) / (end - first) : 0;
    member.part =
      1 - faded * (smooth * x * x * (3 - 2 * x) + (1 - smooth) * (member.height / height));
  }
}

/// Lists the columns that came to nodes of this rank, and these nodes.
void ColumnPlanning::listMembers(
  RankExchange& exchange, const std::vector<ColumnVisit>& visits, const Moves& moves)
{
  std::transform(visits.begin(), visits.end(), std::back_inserter(columns_.ids),
    [](const ColumnVisit& visit) { return visit.column; });
  sortUniquely(columns_.ids);
  std::vector<Index> numbers(columns_.ids.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  columns_.shared = findSharedVertices(exchange, columns_.ids, numbers);
  for (const auto& [node, column, height] : visits)
  {
    const auto found = std::lower_bound(columns_.ids.begin(), columns_.ids.end(), column);
    columns_.members.push_back(
      { node, static_cast<Index>(found - columns_.ids.begin()), height, 1 });
  }

  std::vector<std::pair<GlobalId, Index>> moving;
  for (std::size_t n = 0; n < columns_.nodes.ids.size(); ++n)
  {
    if (moves.fractions[n] > 0)
    {
      moving.emplace_back(columns_.nodes.ids[n], static_cast<Index>(n));
    }
  }
  std::sort(moving.begin(), moving.end());
  for (const GlobalId column : columns_.ids)
  {
    const auto found =
      std::lower_bound(moving.begin(), moving.end(), std::pair{ column / 2, Index{ 0 } });
    columns_.walls.push_back(
      found != moving.end() && found->first == column / 2 ? found->second : -1);
  }
}

/// Finds nodes that are to move along their facets only, or by a rounding, and to which a column
/// comes that moves along them too: they start none themselves. Given the cosines between the moves
/// and the facets' normals. Collective.
void ColumnPlanning::findYielding(
  RankExchange& exchange, const Moves& moves, const std::vector<double>& cosines)
{
  const auto slides = [&](Index n) { return moves.fractions[n] > 0 && cosines[n] < across; };
  std::vector<unsigned char> ofSliding(columns_.ids.size(), 0);
  for (std::size_t c = 0; c < columns_.walls.size(); ++c)
  {
    ofSliding[c] = columns_.walls[c] >= 0 && slides(columns_.walls[c]);
  }
  combineFlags(exchange, columns_.shared, ofSliding);
  std::vector<unsigned char> isLeftOut;
  std::transform(columns_.members.begin(), columns_.members.end(), std::back_inserter(isLeftOut),
    [&](const ColumnMember& member) { return ofSliding[member.column]; });
  yields_.resize(columns_.nodes.points.size());
  for (std::size_t n = 0; n < yields_.size(); ++n)
  {
    yields_[n] = slides(static_cast<Index>(n));
  }
  const auto claims = findClaims(exchange, moves, isLeftOut);
  for (std::size_t k = 0; k < columns_.members.size(); ++k)
  {
    isLeftOut[k] = isLeftOut[k] || claims[columns_.members[k].node] < claimOf(columns_.members[k]);
  }
  const auto ofNodes =
    columns_.movesOfNodes(exchange, columns_.movesOfWalls(exchange, moves), isLeftOut);
  std::vector<unsigned char> stays(ofNodes.size(), 0);
  columns_.forAllFacets([&](Index n, const Facet&, const Vector3& normal)
    { stays[n] = stays[n] || std::abs(dot(ofNodes[n], normal)) > across * norm(ofNodes[n]); });
  combineFlags(exchange, columns_.nodes.shared, stays);
  for (std::size_t n = 0; n < yields_.size(); ++n)
  {
    yields_[n] = yields_[n] && ofNodes[n] != Vector3{} && !stays[n];
  }
  std::vector<unsigned char> isNone(columns_.ids.size(), 0);
  for (std::size_t c = 0; c < columns_.walls.size(); ++c)
  {
    isNone[c] = columns_.walls[c] >= 0 && yields_[columns_.walls[c]];
  }
  combineFlags(exchange, columns_.shared, isNone);
  columns_.members.erase(std::remove_if(columns_.members.begin(), columns_.members.end(),
                           [&](const ColumnMember& member) { return isNone[member.column]; }),
    columns_.members.end());
  for (std::size_t c = 0; c < columns_.walls.size(); ++c)
  {
    columns_.walls[c] = isNone[c] ? -1 : columns_.walls[c];
  }
}

/// Finds the lifts of columns, given the first edges over their walls. Collective.
void ColumnPlanning::findLifts(
  RankExchange& exchange, const Moves& moves, const std::vector<FirstEdge>& edges)
{
  for (const ColumnMember& member : columns_.members)
  {
    const Index wall = columns_.walls[member.column];
    if (wall >= 0 &&
        edges[wall].up == columns_.nodes.points[member.node] - columns_.nodes.points[wall])
    {
      const double way = distance(moves.targets[wall], columns_.nodes.points[wall]);
      const Vector3 lift = edges[wall].lifted - edges[wall].up;
      columns_.lifts[member.column] = way > 0 ? (1 / way) * lift : Vector3{};
    }
  }
  combineShared(exchange, columns_.shared, columns_.lifts, nonZero);
}

/// Finds which column has each node, given 1 for members that are left out. Collective.
std::vector<ColumnPlanning::Claim> ColumnPlanning::findClaims(
  RankExchange& exchange, const Moves& moves, const std::vector<unsigned char>& isLeftOut) const
{
  std::vector<Claim> claims(columns_.nodes.points.size());
  for (std::size_t n = 0; n < claims.size(); ++n)
  {
    claims[n] = moves.fractions[n] > 0 && !yields_[n] ? Claim{ 0, -1 } : Claim{};
  }
  for (std::size_t k = 0; k < columns_.members.size(); ++k)
  {
    Claim& claim = claims[columns_.members[k].node];
    claim = isLeftOut[k] ? claim : std::min(claim, claimOf(columns_.members[k]));
  }
  combineSmallest(exchange, columns_.nodes.shared, claims);
  return claims;
}

/// Finds pairs of columns of which each ends at the wall of the other one, so near that their moves
/// do not fade out between them, and which share their nodes with no third column, given the
/// heights of their tops. Returns 1 for columns of such pairs. Collective.
std::vector<unsigned char> ColumnPlanning::findFacing(RankExchange& exchange, const Moves& moves,
  const std::vector<Claim>& claims, const std::vector<double>& tops)
{
  std::vector<GlobalId> ends(columns_.ids.size(), -1); // moving nodes
  columns_.facing.assign(columns_.ids.size(), -1);
  for (const auto& [node, c, height, part] : columns_.members)
  {
    if (height == tops[c] && claims[node].column < 0)
    {
      ends[c] = columns_.nodes.ids[node];
      columns_.facing[c] = node;
    }
  }
  combineLargest(exchange, columns_.shared, ends);
  std::vector<unsigned char> faces(columns_.ids.size(), 0);
  if (!exchange.any(std::any_of(ends.begin(), ends.end(), [](GlobalId end) { return end >= 0; })))
  {
    return faces;
  }
  std::vector<std::array<Arrival, 2>> arrivals(
    columns_.nodes.points.size()); // of the columns on a node
  for (std::size_t c = 0; c < columns_.ids.size(); ++c)
  {
    if (columns_.walls[c] >= 0)
    {
      arrivals[columns_.walls[c]][columns_.ids[c] % 2] = { ends[c], tops[c] };
    }
  }
  combineShared(exchange, columns_.nodes.shared, arrivals,
    [](const auto& a, const auto& b) {
      return std::array{ a[0].end < 0 ? b[0] : a[0], a[1].end < 0 ? b[1] : a[1] };
    });

  const auto ofWalls = columns_.movesOfWalls(exchange, moves);
  std::vector<GlobalId> faced(columns_.ids.size(), -1); // columns
  for (std::size_t c = 0; c < columns_.ids.size(); ++c)
  {
    for (int side = 0; side < 2 && columns_.facing[c] >= 0; ++side)
    {
      const Arrival& back = arrivals[columns_.facing[c]][side];
      const bool isNear = std::min(tops[c], back.height) <
                          heightsOfMove * (norm(ofWalls.own[c]) + norm(ofWalls.facing[c]));
      faced[c] = back.end == columns_.ids[c] / 2 && isNear ? 2 * ends[c] + side : faced[c];
    }
  }
  combineLargest(exchange, columns_.shared, faced);
  std::vector<unsigned char> isNone(columns_.ids.size(), 0);
  for (const ColumnMember& member : columns_.members)
  {
    const GlobalId owner = claims[member.node].column;
    const Index c = member.column;
    isNone[c] =
      isNone[c] || faced[c] < 0 || (owner >= 0 && owner != columns_.ids[c] && owner != faced[c]);
  }
  combineFlags(exchange, columns_.shared, isNone);
  for (std::size_t c = 0; c < columns_.ids.size(); ++c)
  {
    columns_.facing[c] = isNone[c] ? -1 : columns_.facing[c];
  }
  std::transform(
    isNone.begin(), isNone.end(), faces.begin(), [](unsigned char none) { return none ? 0 : 1; });
  columns_.anyFacing = exchange.any(std::count(faces.begin(), faces.end(), 1) > 0);
  return faces;
}

/// Finds how the move of each column fades out. Collective.
std::vector<ColumnPlanning::Span> ColumnPlanning::findSpans(
  RankExchange& exchange, const Moves& moves, const std::vector<Claim>& claims)
{
  std::vector<double> firsts(columns_.ids.size(), infinity);
  std::vector<double> tops(columns_.ids.size(), 0);
  for (const ColumnMember& member : columns_.members)
  {
    const Index c = member.column;
    firsts[c] = std::min(firsts[c], member.height);
    tops[c] = std::max(tops[c], member.height);
  }
  combineSmallest(exchange, columns_.shared, firsts);
  combineLargest(exchange, columns_.shared, tops);
  const auto faces = findFacing(exchange, moves, claims, tops);
  const auto ofWalls = columns_.movesOfWalls(exchange, moves);
  std::vector<unsigned char> isLost;
  std::transform(columns_.members.begin(), columns_.members.end(), std::back_inserter(isLost),
    [&](const ColumnMember& member) { return claims[member.node] < claimOf(member); });
  std::vector<double> lost(columns_.ids.size(), infinity);
  std::vector<double> lasts(columns_.ids.size(), 0); // below the tops
  for (std::size_t k = 0; k < columns_.members.size(); ++k)
  {
    const auto& [node, c, height, part] = columns_.members[k];
    lost[c] = isLost[k] && !faces[c] ? std::min(lost[c], height) : lost[c];
    lasts[c] = height < tops[c] ? std::max(lasts[c], height) : lasts[c];
  }
  combineSmallest(exchange, columns_.shared, lost);
  combineLargest(exchange, columns_.shared, lasts);

  const auto blocked = columns_.findBlocked(exchange, ofWalls, isLost);
  std::vector<double> faded(columns_.ids.size(), 0);
  for (const ColumnMember& member : columns_.members)
  {
    const Index c = member.column;
    const double move = norm(ofWalls.own[c]);
    const double height = tops[c] - firsts[c];
    if (member.height == tops[c])
    {
      const bool goesAlong = !faces[c] && lost[c] == infinity && tops[c] < reachOfMove * move &&
                             !blocked[member.node] &&
                             columns_.keepsDirection(member.node, ofWalls.own[c]);
      faded[c] = goesAlong ? std::max(faded[c], std::min(1.0, height / (heightsOfMove * move))) : 1;
    }
  }
  combineLargest(exchange, columns_.shared, faded);
  std::vector<Span> spans(columns_.ids.size());
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

} // namespace

void planColumns(
  RankExchange& exchange, const Moves& moves, const BoundarySearch& boundary, Columns& columns)
{
  ColumnPlanning(columns).run(exchange, moves, boundary);
}

} // namespace cadrefine
