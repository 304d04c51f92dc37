#include "motion/BoundaryMotion.h"

#include "comm/CollectiveErrors.h"
#include "comm/Threads.h"
#include "mesh/BoundaryFacets.h"
#include "mesh/MeshPlane.h"
#include "motion/LayerColumns.h"
#include "motion/Untangling.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/mesh/ThinCells.h>
#include <cadrefine/mesh/VertexFlags.h>
#include <cadrefine/motion/MovesOntoCAD.h>

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr int maximumRounds = 12;
/// So many rounds in a row may bring no vertex to its target and mend no cell.
constexpr int patience = 4;
/// After so many rounds the region that gives way grows by a ring of cells.
constexpr int roundsARing = 2;
/// Vertices on the CAD make way only if the interior cannot.
constexpr int roundsBeforeSliding = 2;
constexpr int sweepsARound = 5;
/// Cells with less than this part of their former mean ratio are smoothed.
constexpr double worthwhile = 0.9;
/// A mean ratio from which on cells are no matter of local operations.
constexpr double fairQuality = 0.3;
/// A wall that moves by less than this part of the first cell's height does so alone.
constexpr double leastMoveOfWalls = 1e-3;
constexpr double noQuality = std::numeric_limits<double>::infinity();

/// Where a vertex of cells that are neither simplices nor pyramids makes no way.
enum class Hold : unsigned char
{
  None,
  OnCAD,
  Everywhere ///< In layers: where one of these cells is thin.
};

/// A mesh on its way onto the CAD.
struct Motion
{
  RankExchange& exchange;
  DistributedMesh& distributed;
  const Classification& classification;
  const MoveSettings& settings;
  const ParallelFor parallelFor;
  const Vector3 plane;
  const std::vector<unsigned char>& fixed; ///< See findFixed.
  std::vector<Point3> start;               ///< Points of the unmoved mesh.
  Moves moves; ///< Targets of all vertices; of those that have none, where they are.
  std::vector<unsigned char> slid; ///< Vertices on the CAD whose target has changed.
  std::vector<Hold> held;          ///< Empty: there are no other cells than simplices.
  LayerColumns columns;
  std::vector<Index> aimed; ///< Vertices that are to reach the CAD; some more than once.
  std::vector<unsigned char> ends = {}; ///< 1 for fixed vertices that make way; none: none do.

  Mesh& mesh() const { return distributed.mesh(); }
  bool isStuck(Index vertex) const { return mesh().points[vertex] != moves.targets[vertex]; }
  Hold holdOf(std::size_t vertex) const { return held.empty() ? Hold::None : held[vertex]; }
  bool isInterior(std::size_t vertex) const
  {
    const bool makesWay = !fixed[vertex] || (!ends.empty() && ends[vertex]);
    return makesWay && !classification.entities[vertex];
  }
  bool canSlide(std::size_t vertex) const
  {
    return classification.entities[vertex].dimension > 0 && holdOf(vertex) == Hold::None;
  }
  /// Whether an interior vertex may make way: it does not go along with a wall.
  bool canMakeWay(std::size_t vertex) const
  {
    return isInterior(vertex) && holdOf(vertex) != Hold::Everywhere && moves.fractions[vertex] == 0;
  }
};

std::vector<Index> movingVertices(const Moves& moves)
{
  return indicesWhere(
    moves.fractions.size(), [&](std::size_t v) { return moves.fractions[v] > 0; });
}

/// Whether a cell is invalid; a mesh of area in space has no invalid cells.
bool isInvalid(const Mesh& mesh, const Vector3& plane, Index cell)
{
  bool invalid = false;
  if (!isSurface(mesh, plane))
  {
    visitOwnCell(mesh, cell,
      [&](auto shape, const auto& corners)
      { invalid = !stateAt(shape, cornersOf(corners, mesh.points), plane, 0).valid; });
  }
  return invalid;
}

std::vector<Index> invalidCells(
  const Mesh& mesh, const Vector3& plane, const ParallelFor& parallelFor)
{
  return indicesWhere(parallelFor, mesh.cellCount(mesh.dimension),
    [&](std::size_t c) { return isInvalid(mesh, plane, static_cast<Index>(c)); });
}

/// How each vertex makes way (see Motion::held). Collective.
std::vector<Hold> findHeld(RankExchange& exchange, const DistributedMesh& mesh)
{
  const Mesh& piece = mesh.mesh();
  if (!exchange.any(piece.hasNonSimplices()))
  {
    return {};
  }
  std::vector<Hold> held(piece.points.size(), Hold::None);
  visitOwnShapes(piece,
    [&](auto shape, const auto& cells)
    {
      if constexpr (!isSimplex(shape) && !std::is_same_v<decltype(shape), shapes::Pyramid>)
      {
        for (const auto& cell : cells)
        {
          const bool isOfLayer = isThin(shape, cornersOf(cell, piece.points));
          for (const Index vertex : cell)
          {
            held[vertex] = std::max(held[vertex], isOfLayer ? Hold::Everywhere : Hold::OnCAD);
          }
        }
      }
    });
  combineLargest(exchange, mesh.shared, held);
  return held;
}

/// 1 for vertices of the ends of layers (see MoveSettings). Collective.
std::vector<unsigned char> findEndsOfLayers(const Motion& motion)
{
  const Mesh& mesh = motion.mesh();
  const auto& entities = motion.classification.entities;
  const auto& fixed = motion.fixed;
  const auto facets = findBoundaryFacets(motion.exchange, motion.distributed, fixed);
  std::vector<unsigned char> ends(mesh.points.size(), 0);
  std::vector<unsigned char> others(mesh.points.size(), 0);
  const auto flag = [&](const Facet& facet)
  {
    const bool isOff =
      std::any_of(facet.begin(), facet.end(), [&](Index vertex) { return !entities[vertex]; });
    const bool isEnd =
      facet.isInside && isOff &&
      motion.settings.projector.isBesideCAD(pointsOf(mesh, facet), facet.corners());
    for (const Index vertex : facet)
    {
      (isEnd ? ends : others)[vertex] = 1;
    }
  };
  agreeOnFailure(motion.exchange, [&] { std::for_each(facets.begin(), facets.end(), flag); });
  combineFlags(motion.exchange, motion.distributed.shared, ends);
  combineFlags(motion.exchange, motion.distributed.shared, others);
  for (std::size_t v = 0; v < ends.size(); ++v)
  {
    ends[v] = ends[v] && !others[v] && fixed[v] == 1;
  }
  return ends;
}

/// The flags of MoveSettings::fixed, and 2 for vertices that separate what is tagged or are listed.
/// Collective.
std::vector<unsigned char> findFixed(
  RankExchange& exchange, const DistributedMesh& mesh, const MoveSettings& settings)
{
  std::vector<unsigned char> fixed = settings.fixed;
  const auto between = verticesBetweenTags(exchange, mesh, settings.tags);
  const auto listed = verticesOfListedLines(exchange, mesh);
  for (std::size_t v = 0; v < fixed.size(); ++v)
  {
    fixed[v] = fixed[v] == 0 && (between[v] || listed[v]) ? 2 : fixed[v];
  }
  return fixed;
}

ColumnNodes verticesOf(const DistributedMesh& mesh, const Classification& classification,
  const std::vector<std::array<Index, 2>>* parents = nullptr)
{
  return { mesh.mesh().points, mesh.mesh().ids, mesh.shared, classification.entities, {},
    leastMoveOfWalls, nullptr, parents };
}

/// Halves the moves of these vertices until every cell of every rank accepts them, then makes them.
void settle(Motion& motion, MoveGuard& guard, const std::vector<Index>& moving)
{
  Moves& moves = motion.moves;
  while (motion.exchange.any(guard.halveUnaccepted(moves)))
  {
    combineSmallest(motion.exchange, motion.distributed.shared, moves.fractions);
    if (motion.columns.any())
    {
      motion.columns.tie(motion.exchange, moves);
    }
  }
  for (const Index vertex : moving)
  {
    motion.mesh().points[vertex] = moves.position(motion.mesh().points, vertex);
  }
  for (const Index vertex : moving)
  {
    moves.fractions[vertex] = 0;
    moves.whole[vertex] = 0;
  }
}

/// What is not yet as it should be.
struct Left
{
  std::vector<Index> stuck;   ///< Vertices that are not at their targets.
  std::vector<Index> invalid; ///< Invalid cells of this rank.
};

/// Drops what has come right. Returns how much is left over all ranks.
std::int64_t dropDone(const Motion& motion, Left& left)
{
  const auto drop = [](std::vector<Index>& list, const auto& isDone)
  { list.erase(std::remove_if(list.begin(), list.end(), isDone), list.end()); };
  drop(left.stuck, [&](Index vertex) { return !motion.isStuck(vertex); });
  drop(left.invalid, [&](Index cell) { return !isInvalid(motion.mesh(), motion.plane, cell); });
  const auto owned = std::count_if(left.stuck.begin(), left.stuck.end(),
    [&](Index vertex)
    { return motion.distributed.shared.owner(vertex) == motion.exchange.rank(); });
  return motion.exchange.sum(owned + static_cast<std::ptrdiff_t>(left.invalid.size()));
}

/// Cells where something moves, and the places where their vertices are to go.
struct Region
{
  std::vector<Index> cells;
  std::vector<VertexPlace> places;
};

/// Finds the cells up to so many rings round the flagged vertices, and the places where these
/// vertices are to go: where the cells are valid and well shaped once all vertices are where they
/// are wanted.
Region untangleRound(const Motion& motion, std::vector<unsigned char> flags,
  const std::vector<Point3>& wanted, int rings, bool sliding, double fair = noQuality)
{
  flagRings(motion.exchange, motion.distributed, rings, flags, motion.parallelFor);
  const std::vector<Index> cells = cellsAt(motion.mesh(), flags, motion.parallelFor);
  for (std::size_t v = 0; v < flags.size(); ++v)
  {
    const bool stays = wanted[v] != motion.moves.targets[v]; // stopped, and not to try again
    flags[v] = flags[v] && !stays && (motion.canMakeWay(v) || (sliding && motion.canSlide(v)));
  }
  const MovingVertices vertices{ std::move(flags), motion.classification.entities, wanted,
    motion.start, cells, fair };
  return { cells, untangle(motion.exchange, motion.distributed, vertices, motion.plane,
                    motion.settings.projector, sweepsARound) };
}

/// Takes along the cells over the walls that move: appends their vertices to those that move, and
/// those off the CAD to those that stay where they come to. Collective.
void takeAlong(Motion& motion, std::vector<Index>& moving, std::vector<Index>& settled)
{
  if (!motion.columns.any())
  {
    return;
  }
  const auto isOnCAD = [&](Index vertex)
  { return static_cast<bool>(motion.classification.entities[vertex]); };
  const auto [joining, redirected] = motion.columns.follow(motion.exchange, motion.moves);
  moving.insert(moving.end(), joining.begin(), joining.end());
  for (const Index vertex : joining)
  {
    motion.slid[vertex] = motion.slid[vertex] || isOnCAD(vertex);
    (isOnCAD(vertex) ? motion.aimed : settled).push_back(vertex);
  }
  for (const Index vertex : redirected)
  {
    motion.slid[vertex] = motion.slid[vertex] || isOnCAD(vertex);
  }
}

void stayThere(Motion& motion, const std::vector<Index>& vertices)
{
  for (const Index vertex : vertices)
  {
    motion.moves.targets[vertex] = motion.mesh().points[vertex];
  }
}

/// Moves vertices of the region to their places there, and those that are `moving` already to their
/// targets. Those that are `settled`, or come to be, stay where they come to.
void moveTo(Motion& motion, const Region& region, std::vector<Index> moving = {},
  std::vector<Index> settled = {})
{
  Moves& moves = motion.moves;
  const std::vector<Point3>& points = motion.mesh().points;
  for (const auto& [vertex, point] : region.places)
  {
    if (point == points[vertex])
    {
      continue;
    }
    if (moves.fractions[vertex] == 0)
    {
      moving.push_back(vertex);
    }
    const bool isInterior = motion.isInterior(vertex);
    const bool slides = !isInterior && !motion.isStuck(vertex);
    if (isInterior || slides)
    {
      settled.push_back(vertex);
    }
    motion.slid[vertex] = motion.slid[vertex] || (!isInterior && point != moves.targets[vertex]);
    moves.add(vertex, point);
    moves.whole[vertex] = slides;
  }
  takeAlong(motion, moving, settled);
  const Mesh& mesh = motion.mesh();
  MoveGuard guard =
    motion.columns.any()
      ? MoveGuard(mesh, moves, motion.start, motion.plane, motion.parallelFor)
      : MoveGuard(mesh, moves, motion.start, motion.plane, region.cells, motion.parallelFor);
  settle(motion, guard, moving);
  stayThere(motion, settled);
}

/// Makes one more round: what is left goes on, and what is round it makes way.
void tryAgain(Motion& motion, const Left& left, int round)
{
  std::vector<Index> moving = left.stuck;
  for (const Index vertex : moving)
  {
    motion.moves.add(vertex, motion.moves.targets[vertex]);
  }
  std::vector<Index> settled;
  takeAlong(motion, moving, settled);
  std::vector<unsigned char> flags(motion.start.size(), 0);
  flagVertices(motion.mesh(), left.invalid, flags);
  for (const Index vertex : moving)
  {
    flags[vertex] = 1;
  }
  const Region region = untangleRound(motion, std::move(flags), motion.moves.targets,
    1 + round / roundsARing, round >= roundsBeforeSliding);
  moveTo(motion, region, std::move(moving), std::move(settled));
}

/// Sends vertices that slid and then stopped to the nearest point of their entity.
void retarget(Motion& motion, const std::vector<Index>& stuck)
{
  for (const Index vertex : stuck)
  {
    if (motion.slid[vertex])
    {
      const EntityId entity = motion.classification.entities[vertex];
      const ClosestPoint where =
        motion.settings.projector.nearestOn(entity, motion.mesh().points[vertex]);
      Point3& target = motion.moves.targets[vertex];
      target = where.entity == entity ? where.point : target;
    }
  }
}

/// Moves interior vertices round cells that lost much of their shape to where these are better. A
/// mesh of triangles in space has no interior vertices: there, vertices slide.
void smooth(Motion& motion, const MoveGuard& guard)
{
  const auto spoilt = guard.verticesOfSpoiltCells(worthwhile);
  if (!motion.exchange.any(!spoilt.empty()))
  {
    return;
  }
  std::vector<unsigned char> flags(motion.start.size(), 0);
  for (const Index vertex : spoilt)
  {
    flags[vertex] = 1;
  }
  const bool slides = isSurface(motion.mesh(), motion.plane);
  const double fair = motion.settings.smoothWorst ? fairQuality : noQuality;
  moveTo(motion, untangleRound(motion, std::move(flags), motion.mesh().points, 1, slides, fair));
}

/// Writes where vertices slid to, and how far those that were to move are from their targets.
void record(const Motion& motion, Classification& classification)
{
  const Moves& moves = motion.moves;
  for (std::size_t v = 0; v < motion.slid.size(); ++v)
  {
    if (motion.slid[v])
    {
      classification.set(static_cast<Index>(v),
        motion.settings.projector.nearestOn(classification.entities[v], moves.targets[v]));
    }
  }
  for (const Index vertex : motion.aimed)
  {
    classification.distances[vertex] =
      distance(motion.mesh().points[vertex], moves.targets[vertex]);
  }
}

/// The vertices of MotionTrace::inside.
std::vector<Index> movedInside(const Motion& motion)
{
  return indicesWhere(motion.start.size(),
    [&](std::size_t v)
    {
      return motion.isInterior(v) && motion.holdOf(v) != Hold::Everywhere &&
             motion.mesh().points[v] != motion.start[v];
    });
}

} // namespace

MotionTrace moveOntoCAD(RankExchange& exchange, DistributedMesh& mesh, Moves moves,
  Classification& classification, const MoveSettings& settings)
{
  const Progress& progress = exchange.progress();
  progress.say(0, "moving vertices onto the CAD");
  const Vector3 plane =
    planeNormal(exchange, mesh.mesh(), settings.projector.kind() == BoundaryKind::Edges);
  const std::vector<Index> aimed = movingVertices(moves);
  Left left{ aimed, settings.mendCells ? invalidCells(mesh.mesh(), plane, forOnThreads(exchange))
                                       : std::vector<Index>{} };
  const auto fixed = findFixed(exchange, mesh, settings);
  Motion motion{ exchange, mesh, classification, settings, forOnThreads(exchange), plane, fixed,
    mesh.mesh().points, Moves(mesh.mesh().points),
    std::vector<unsigned char>(mesh.mesh().points.size(), 0), findHeld(exchange, mesh),
    LayerColumns(exchange, mesh, verticesOf(mesh, classification, settings.parents), moves,
      settings.projector, { fixed, settings.tags }, plane),
    aimed };
  motion.moves = std::move(moves);

  std::vector<Index> moving = aimed;
  std::vector<Index> settled;
  takeAlong(motion, moving, settled);
  MoveGuard guard(mesh.mesh(), motion.moves, motion.start, plane, motion.parallelFor);
  settle(motion, guard, moving);
  stayThere(motion, settled);
  std::int64_t count = dropDone(motion, left);
  if (count > 0 && exchange.any(mesh.mesh().cellCount(mesh.mesh().dimension - 1) > 0))
  {
    motion.ends = findEndsOfLayers(motion);
  }
  int idle = 0;
  for (int round = 0; count > 0 && idle < patience && round < maximumRounds; ++round)
  {
    progress.say((1.0 + round) / (2.0 + maximumRounds),
      "untangling " + std::to_string(count) + (count == 1 ? " vertex" : " vertices") + ", round " +
        std::to_string(round + 1) + " of " + std::to_string(maximumRounds));
    tryAgain(motion, left, round);
    const std::int64_t before = std::exchange(count, dropDone(motion, left));
    idle = count < before ? 0 : idle + 1;
    agreeOnFailure(exchange, [&] { retarget(motion, left.stuck); });
  }
  if (count > 0 || settings.smoothCells)
  {
    progress.say(1, "smoothing cells");
    smooth(motion, guard);
  }
  record(motion, classification);
  std::vector<Index> inside = movedInside(motion);
  return { std::move(motion.start), std::move(inside) };
}

std::vector<Point3> wantedPoints(RankExchange& exchange, const DistributedMesh& mesh,
  const BoundaryProjector& projector, const Classification& classification,
  const std::vector<unsigned char>& fixed)
{
  const Mesh& piece = mesh.mesh();
  const auto& distances = classification.distances;
  const auto off = indicesWhere(distances.size(), [&](std::size_t v) { return distances[v] > 0; });
  if (!exchange.any(!off.empty()))
  {
    return piece.points;
  }
  Moves moves(piece.points);
  for (const Index vertex : off)
  {
    moves.add(vertex, placeToReach(vertex, piece.points[vertex], projector, classification).point);
  }
  LayerColumns columns(exchange, mesh, verticesOf(mesh, classification), moves, projector,
    { fixed, {} }, planeNormal(exchange, piece, projector.kind() == BoundaryKind::Edges));
  if (columns.any())
  {
    columns.follow(exchange, moves);
  }
  return moves.targets;
}

} // namespace cadrefine
