#include "motion/BoundaryMotion.h"

#include "comm/CollectiveErrors.h"
#include "comm/Threads.h"
#include "mesh/MeshPlane.h"
#include "motion/UntanglingPatch.h"

#include <algorithm>
#include <iterator>
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
/// Cells that lost more of their mean ratio are smoothed.
constexpr double worthwhile = 0.9;

unsigned char larger(unsigned char a, unsigned char b)
{
  return std::max(a, b);
}

/// The steps of moveOntoCAD.
class VertexMover
{
public:
  VertexMover(RankExchange& exchange, DistributedMesh& mesh, Moves moves,
    Classification& classification, const MoveSettings& settings)
    : exchange_(exchange), mesh_(mesh), classification_(classification), settings_(settings),
      parallelFor_(forOnThreads(exchange)), start_(mesh.mesh().points), moves_(std::move(moves)),
      plane_(mesh.mesh().dimension == 2 ? planeNormal(exchange, mesh.mesh()) : Vector3{}),
      slid_(start_.size(), 0)
  {
    for (std::size_t v = 0; v < start_.size(); ++v)
    {
      if (moves_.fractions[v] > 0)
      {
        aimed_.push_back(static_cast<Index>(v));
      }
    }
    if (settings.mendCells)
    {
      findInvalidCells();
    }
  }

  void run()
  {
    const Progress& progress = exchange_.progress();
    progress.say(0, "moving vertices onto the CAD");
    const MoveGuard guard(mesh(), moves_, start_, plane_, parallelFor_);
    settle(guard, aimed_);
    std::int64_t left = findLeft();
    int idle = 0;
    for (int round = 0; left > 0 && idle < patience && round < maximumRounds; ++round)
    {
      progress.say(
        (1.0 + round) / (2.0 + maximumRounds), "untangling cells at " + std::to_string(left) +
                                                 " vertices, round " + std::to_string(round + 1));
      tryAgain(round);
      const std::int64_t before = left;
      left = findLeft();
      idle = left < before ? 0 : idle + 1;
      agreeOnFailure(exchange_, [&] { retarget(); });
    }
    if (left > 0 || settings_.smoothCells)
    {
      progress.say(1, "smoothing cells");
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

  /// Halves the moves of these vertices until every cell of every rank accepts them, then makes
  /// them.
  void settle(const MoveGuard& guard, const std::vector<Index>& moving)
  {
    while (exchange_.any(guard.halveUnaccepted(moves_)))
    {
      combineShared(exchange_, mesh_.shared, moves_.fractions,
        [](double a, double b) { return std::min(a, b); });
    }
    for (const Index vertex : moving)
    {
      mesh().points[vertex] = moves_.position(mesh(), vertex);
    }
    for (const Index vertex : moving)
    {
      moves_.fractions[vertex] = 0;
      moves_.whole[vertex] = 0;
    }
  }

  bool isStuck(Index vertex) const { return mesh_.mesh().points[vertex] != moves_.targets[vertex]; }

  /// The vertices that are not at their targets, and the invalid cells; the number of both over all
  /// ranks.
  std::int64_t findLeft()
  {
    stuck_.clear();
    std::copy_if(aimed_.begin(), aimed_.end(), std::back_inserter(stuck_),
      [&](Index vertex) { return isStuck(vertex); });
    const auto owned = std::count_if(stuck_.begin(), stuck_.end(),
      [&](Index vertex) { return mesh_.shared.owner(vertex) == exchange_.rank(); });
    invalid_.erase(std::remove_if(invalid_.begin(), invalid_.end(),
                     [&](Index cell) { return !isInvalid(cell); }),
      invalid_.end());
    return exchange_.sum(owned + static_cast<std::ptrdiff_t>(invalid_.size()));
  }

  bool isInterior(std::size_t vertex) const
  {
    return !settings_.fixed[vertex] && !classification_.entities[vertex];
  }

  bool canSlide(std::size_t vertex) const { return classification_.entities[vertex].dimension > 0; }

  /// Flags all vertices that share a cell with a flagged one, `rings` times.
  void grow(std::vector<unsigned char>& flags, int rings)
  {
    for (int ring = 0; ring < rings; ++ring)
    {
      flagVertices(mesh(), cellsAt(mesh(), flags, parallelFor_), flags);
      combineShared(exchange_, mesh_.shared, flags, larger);
    }
  }

  /// Where the vertices of the region, so many rings round the flagged ones, are to go for the sake
  /// of the cells there, with all vertices where they are wanted. Keeps the cells of the region.
  std::vector<VertexPlace> optimise(
    std::vector<unsigned char> region, const std::vector<Point3>& wanted, int rings, bool sliding)
  {
    combineShared(exchange_, mesh_.shared, region, larger);
    grow(region, rings);
    region_ = cellsAt(mesh(), region, parallelFor_);
    for (std::size_t v = 0; v < region.size(); ++v)
    {
      const auto mayMove = [&]
      {
        const bool stays = wanted[v] != moves_.targets[v]; // stopped, and not to try again
        return !stays && (isInterior(v) || (sliding && canSlide(v)));
      };
      region[v] = region[v] && mayMove();
    }
    const MovingVertices vertices{ region, classification_.entities, wanted, start_, region_ };
    return UntanglingPatch(exchange_, mesh_, vertices, plane_)
      .optimise(settings_.projector, sweepsARound);
  }

  void tryAgain(int round)
  {
    std::vector<unsigned char> left(start_.size(), 0);
    flagVertices(mesh(), invalid_, left);
    for (const Index vertex : stuck_)
    {
      left[vertex] = 1;
    }
    moveTo(optimise(std::move(left), moves_.targets, 1 + round / roundsARing,
             round >= roundsBeforeSliding),
      stuck_);
  }

  /// Vertices that slid and then stopped: to the nearest point of their entity.
  void retarget()
  {
    for (const Index vertex : stuck_)
    {
      if (slid_[vertex])
      {
        const EntityId entity = classification_.entities[vertex];
        const ClosestPoint where = settings_.projector.nearestOn(entity, mesh().points[vertex]);
        Point3& target = moves_.targets[vertex];
        target = where.entity == entity ? where.point : target;
      }
    }
  }

  /// Moves vertices of the region to these places, and `others` to their targets.
  void moveTo(const std::vector<VertexPlace>& places, const std::vector<Index>& others)
  {
    std::vector<Index> moving;
    std::vector<Index> settled; // they stay where they come to
    for (const auto& [vertex, point] : places)
    {
      if (point == mesh().points[vertex])
      {
        continue;
      }
      moving.push_back(vertex);
      slid_[vertex] = slid_[vertex] || (!isInterior(vertex) && point != moves_.targets[vertex]);
      const bool onCAD = !isInterior(vertex) && !isStuck(vertex);
      if (onCAD || isInterior(vertex))
      {
        settled.push_back(vertex);
      }
      moves_.add(vertex, point);
      moves_.whole[vertex] = onCAD;
    }
    for (const Index vertex : others)
    {
      if (moves_.fractions[vertex] == 0)
      {
        moving.push_back(vertex);
        moves_.add(vertex, moves_.targets[vertex]);
      }
    }
    settle(MoveGuard(mesh(), moves_, start_, plane_, region_, parallelFor_), moving);
    for (const Index vertex : settled)
    {
      moves_.targets[vertex] = mesh().points[vertex];
    }
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
    std::vector<unsigned char> flags(start_.size(), 0);
    for (const Index vertex : spoilt)
    {
      flags[vertex] = 1;
    }
    const bool isSurface = mesh().dimension == 2 && plane_ == Vector3{};
    moveTo(optimise(std::move(flags), mesh().points, 1, isSurface), {});
  }

  void record()
  {
    for (std::size_t v = 0; v < slid_.size(); ++v)
    {
      if (slid_[v])
      {
        classification_.set(static_cast<Index>(v),
          settings_.projector.nearestOn(classification_.entities[v], moves_.targets[v]));
      }
    }
    for (const Index vertex : aimed_)
    {
      classification_.distances[vertex] = distance(mesh().points[vertex], moves_.targets[vertex]);
    }
  }

  RankExchange& exchange_;
  DistributedMesh& mesh_;
  Classification& classification_;
  const MoveSettings& settings_;
  const ParallelFor parallelFor_;
  const std::vector<Point3> start_;
  Moves moves_; ///< Targets: of all vertices; of those that have none, where they are.
  const Vector3 plane_;
  std::vector<Index> aimed_;        ///< Vertices that are to reach a target.
  std::vector<Index> stuck_;        ///< Those of them that have not.
  std::vector<Index> invalid_;      ///< Cells of this rank that are to be mended.
  std::vector<Index> region_;       ///< Cells of this rank where something moves.
  std::vector<unsigned char> slid_; ///< Vertices on the CAD whose target has changed.
};

} // namespace

void moveOntoCAD(RankExchange& exchange, DistributedMesh& mesh, Moves moves,
  Classification& classification, const MoveSettings& settings)
{
  VertexMover(exchange, mesh, std::move(moves), classification, settings).run();
}

} // namespace cadrefine
