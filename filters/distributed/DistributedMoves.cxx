#include "DistributedMoves.h"

#include "Agreement.h"
#include "MeshPlane.h"
#include "MovingPatch.h"

#include <algorithm>

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
/// Cells that lost more of their mean ratio are smoothed.
constexpr double worthwhile = 0.9;

unsigned char larger(unsigned char a, unsigned char b)
{
  return std::max(a, b);
}

template<std::size_t Corners>
void growOverCells(const std::vector<std::array<Index, Corners>>& cells,
  const std::vector<unsigned char>& flags, std::vector<unsigned char>& grown)
{
  for (const auto& cell : cells)
  {
    if (std::any_of(cell.begin(), cell.end(), [&](Index vertex) { return flags[vertex] != 0; }))
    {
      for (const Index vertex : cell)
      {
        grown[vertex] = 1;
      }
    }
  }
}

/// The flags and those of all vertices that share a cell with a flagged one, `rings` times.
std::vector<unsigned char> grow(
  RankExchange& exchange, const DistributedMesh& mesh, std::vector<unsigned char> flags, int rings)
{
  for (int ring = 0; ring < rings; ++ring)
  {
    auto grown = flags;
    if (mesh.mesh().dimension == 3)
    {
      growOverCells(mesh.mesh().tetrahedra, flags, grown);
    }
    else
    {
      growOverCells(mesh.mesh().triangles, flags, grown);
    }
    combineShared(exchange, mesh.shared, grown, larger);
    flags = std::move(grown);
  }
  return flags;
}

/// The steps of moveOntoCAD.
class VertexMover
{
public:
  VertexMover(RankExchange& exchange, DistributedMesh& mesh, const Moves& moves,
    Classification& classification, const MoveSettings& settings)
    : exchange_(exchange), mesh_(mesh), classification_(classification), settings_(settings),
      start_(mesh.mesh().points), targets_(moves.targets),
      plane_(mesh.mesh().dimension == 2 ? planeNormal(exchange, mesh.mesh()) : Vector3{}),
      slid_(start_.size(), 0)
  {
    if (settings.mendCells)
    {
      findInvalidCells();
    }
  }

  void run(Moves moves)
  {
    const MoveGuard guard(mesh(), moves, start_, plane_);
    settle(moves, guard);
    std::int64_t left = findLeft();
    int idle = 0;
    for (int round = 0; left > 0 && idle < patience && round < maximumRounds; ++round)
    {
      tryAgain(round);
      const std::int64_t before = left;
      left = findLeft();
      idle = left < before ? 0 : idle + 1;
      attempt(exchange_, [&] { aimAnew(); });
    }
    if (left > 0 || settings_.smoothCells)
    {
      smooth(guard);
    }
    record();
  }

private:
  SimplexMesh& mesh() { return mesh_.mesh(); }

  bool isInvalid(Index cell) const
  {
    const SimplexMesh& mesh = mesh_.mesh();
    if (mesh.dimension == 3)
    {
      return !stateOf(mesh.tetrahedra[cell], mesh.points).valid;
    }
    return plane_ != Vector3{} && !stateOf(mesh.triangles[cell], mesh.points, plane_).valid;
  }

  void findInvalidCells()
  {
    const std::size_t count =
      mesh().dimension == 3 ? mesh().tetrahedra.size() : mesh().triangles.size();
    for (std::size_t c = 0; c < count; ++c)
    {
      if (isInvalid(static_cast<Index>(c)))
      {
        invalid_.push_back(static_cast<Index>(c));
      }
    }
  }

  void settle(Moves& moves) { settle(moves, MoveGuard(mesh(), moves, start_, plane_)); }

  /// Halves the moves until every cell of every rank accepts them, then makes them.
  void settle(Moves& moves, const MoveGuard& guard)
  {
    while (exchange_.any(guard.halveUnaccepted(moves)))
    {
      combineShared(exchange_, mesh_.shared, moves.fractions,
        [](double a, double b) { return std::min(a, b); });
    }
    std::vector<Point3> positions(start_.size());
    for (std::size_t v = 0; v < positions.size(); ++v)
    {
      positions[v] = moves.position(mesh(), static_cast<Index>(v));
    }
    mesh().points = std::move(positions);
  }

  bool isStuck(std::size_t vertex) const { return mesh_.mesh().points[vertex] != targets_[vertex]; }

  /// Flags the vertices that are not at their targets and those of invalid cells; the number of
  /// both over all ranks.
  std::int64_t findLeft()
  {
    const auto owned = mesh_.shared.ownedHere(static_cast<Index>(start_.size()));
    left_.assign(start_.size(), 0);
    std::int64_t count = 0;
    for (std::size_t v = 0; v < left_.size(); ++v)
    {
      left_[v] = isStuck(v);
      count += owned[v] && left_[v];
    }
    invalid_.erase(std::remove_if(invalid_.begin(), invalid_.end(),
                     [&](Index cell) { return !isInvalid(cell); }),
      invalid_.end());
    for (const Index cell : invalid_)
    {
      flagCorners(cell);
    }
    if (settings_.mendCells)
    {
      combineShared(exchange_, mesh_.shared, left_, larger);
    }
    return exchange_.sum(count + static_cast<std::int64_t>(invalid_.size()));
  }

  void flagCorners(Index cell)
  {
    const auto flag = [&](const auto& corners)
    {
      for (const Index vertex : corners)
      {
        left_[vertex] = 1;
      }
    };
    if (mesh().dimension == 3)
    {
      flag(mesh().tetrahedra[cell]);
    }
    else
    {
      flag(mesh().triangles[cell]);
    }
  }

  bool isInterior(std::size_t vertex) const
  {
    return !settings_.fixed[vertex] && !classification_.entities[vertex];
  }

  bool canSlide(std::size_t vertex) const { return classification_.entities[vertex].dimension > 0; }

  /// Where the vertices of the region, so many rings round what is left, are to go for its sake.
  std::vector<Point3> optimise(std::vector<Point3> wanted, int rings, bool sliding)
  {
    MovingVertices vertices{ grow(exchange_, mesh_, left_, rings), classification_.entities,
      std::move(wanted), start_ };
    for (std::size_t v = 0; v < vertices.free.size(); ++v)
    {
      const bool stays = vertices.wanted[v] != targets_[v]; // stopped, and not to try again
      vertices.free[v] = vertices.free[v] && !stays && (isInterior(v) || (sliding && canSlide(v)));
    }
    return MovingPatch(exchange_, mesh_, vertices, plane_)
      .optimise(settings_.projector, sweepsARound);
  }

  void tryAgain(int round)
  {
    moveTo(optimise(targets_, 1 + round / roundsARing, round >= roundsBeforeSliding));
  }

  /// Vertices that slid and then stopped: to the nearest point of their entity.
  void aimAnew()
  {
    for (std::size_t v = 0; v < slid_.size(); ++v)
    {
      if (slid_[v] && isStuck(v))
      {
        const EntityId entity = classification_.entities[v];
        const ClosestPoint where = settings_.projector.nearestOn(entity, mesh().points[v]);
        targets_[v] = where.entity == entity ? where.point : targets_[v];
      }
    }
  }

  void moveTo(const std::vector<Point3>& places)
  {
    Moves moves(mesh());
    for (std::size_t v = 0; v < places.size(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      if (places[v] == mesh().points[v])
      {
        continue;
      }
      if (isInterior(v) || isStuck(v))
      {
        slid_[v] = slid_[v] || places[v] != targets_[v];
        moves.add(vertex, places[v]);
      }
      else
      {
        slid_[v] = 1;
        moves.addWhole(vertex, places[v]);
      }
    }
    const auto wasStuck = stuckFlags();
    const auto start = mesh().points;
    settle(moves);
    for (std::size_t v = 0; v < places.size(); ++v)
    {
      if (!wasStuck[v])
      {
        targets_[v] = mesh().points[v];
      }
      else if (moves.targets[v] != start[v])
      {
        targets_[v] = places[v];
      }
    }
  }

  std::vector<unsigned char> stuckFlags() const
  {
    std::vector<unsigned char> flags(start_.size());
    for (std::size_t v = 0; v < flags.size(); ++v)
    {
      flags[v] = isStuck(v);
    }
    return flags;
  }

  /// Interior vertices round cells that lost much move to where these are better. A mesh of
  /// triangles in space has none: there, vertices slide.
  void smooth(const MoveGuard& guard)
  {
    const auto spoilt = guard.verticesOfSpoiltCells(worthwhile);
    if (!exchange_.any(!spoilt.empty()))
    {
      return;
    }
    left_.assign(start_.size(), 0);
    for (const Index vertex : spoilt)
    {
      left_[vertex] = 1;
    }
    combineShared(exchange_, mesh_.shared, left_, larger);
    const bool isSurface = mesh().dimension == 2 && plane_ == Vector3{};
    moveTo(optimise(mesh().points, 1, isSurface));
  }

  void record()
  {
    for (std::size_t v = 0; v < targets_.size(); ++v)
    {
      if (slid_[v] && !isInterior(v))
      {
        classification_.set(static_cast<Index>(v),
          settings_.projector.nearestOn(classification_.entities[v], targets_[v]));
      }
      classification_.distances[v] = distance(mesh().points[v], targets_[v]);
    }
  }

  RankExchange& exchange_;
  DistributedMesh& mesh_;
  Classification& classification_;
  const MoveSettings& settings_;
  const std::vector<Point3> start_;
  std::vector<Point3> targets_; ///< Of each vertex; where it is, if it has none.
  const Vector3 plane_;
  std::vector<Index> invalid_;      ///< Cells of this rank that are to be mended.
  std::vector<unsigned char> left_; ///< Vertices off their targets, and of invalid cells.
  std::vector<unsigned char> slid_; ///< Vertices on the CAD whose target has changed.
};

} // namespace

void moveOntoCAD(RankExchange& exchange, DistributedMesh& mesh, const Moves& moves,
  Classification& classification, const MoveSettings& settings)
{
  VertexMover(exchange, mesh, moves, classification, settings).run(moves);
}

} // namespace cadrefine
