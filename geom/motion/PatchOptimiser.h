// Moving the vertices of a patch of cells to where the cells are valid and well shaped.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/motion/ShapeEnergy.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace cadrefine
{

/// Simplices and what may be done with their vertices: an entry in each list for each vertex.
struct Patch
{
  Mesh mesh; ///< Points: where the vertices stand, or are to stand; may be tangled.
  /// For each simplex 1: it is to keep the shape that it has in `start`, as the corner of a cell of
  /// another shape; 0: it is to be equilateral. Empty: all are.
  std::vector<unsigned char> keepsShape;
  std::vector<Point3> start;           ///< Where they stood in the mesh; gives the size of a cell.
  std::vector<unsigned char> free;     ///< 1: it may move.
  std::vector<unsigned char> complete; ///< 1: all cells of the whole mesh round it are here.
  std::vector<EntityId> entities;      ///< The CAD entity to which a free vertex keeps.
  Vector3 plane{}; ///< Unit normal of a planar mesh; zero: triangles keep the side of `start`.
  /// Where all cells at a vertex have at least this mean ratio, the worst of them counts most.
  double fairQuality = std::numeric_limits<double>::infinity();
};

/// The directions in which a vertex that keeps to a CAD face or edge may go from a point of it:
/// none at a pole.
Directions directionsOn(const BoundaryProjector& projector, EntityId entity, const Point3& point);

/// Minimises the energies of the free vertices one after the other (see ShapeEnergy), each with the
/// others in place, in sweeps. A vertex waits for its free neighbours that come before it, in the
/// order of a hash of the global ids, so that a sweep has one result however the patch is split
/// over ranks: all ranks that hold all cells of a vertex compute the same bits, others wait for
/// them (see `place`). The order is random, so that chains of waiting vertices are short, O(log n),
/// and many vertices may take their turn at once, on several threads.
///
/// A vertex on a CAD face or edge moves in its tangents there and is put back onto the entity; it
/// stays where that is not possible (at a pole, or where it would leave the entity for its border),
/// and where an edge of the boundary there would be longer than all are now, and a facet farther
/// from the CAD than any is now, and than a quarter of what the corners of these were at the start:
/// after a bisection, of what their parents were.
///
/// No step raises the energy that it is for. Work of a sweep: linear in the number of cells, some
/// 10 microseconds a vertex, and up to 8 projections for each vertex on the CAD, with up to six for
/// each facet there where an edge would get longer.
class PatchOptimiser
{
public:
  /// `projector` is needed for vertices on the CAD only. Keeps references; moves patch.mesh.points.
  explicit PatchOptimiser(Patch& patch, const BoundaryProjector* projector = nullptr,
    ParallelFor parallelFor = serialFor);

  /// The smallest measure of a cell of the patch, 1 for the cell of its size in `start` that has
  /// the shape that it is to have, negative where it is inverted. 1 where there are no cells.
  double smallestMeasure() const;

  /// Begins a sweep, given the smallest measure over all ranks.
  void beginSweep(double smallest);
  /// Moves the vertices whose turn has come. Returns true if vertices are left that wait for
  /// others.
  bool advance();
  bool isDone(Index vertex) const { return done_[vertex] != 0; }
  /// Puts a vertex where another rank has moved it in this sweep.
  void place(Index vertex, const Point3& point);

private:
  /// The facets of the mesh's boundary at a vertex.
  struct Boundary
  {
    std::vector<std::array<Index, 2>> facets; ///< The other corners of each facet.
    std::vector<Index> neighbours;            ///< All of these corners.
    /// How far the middles of the facets and of their edges may lie from the CAD.
    double limit = 0;
  };

  bool keepsShape(std::size_t cell) const
  {
    return !patch_.keepsShape.empty() && patch_.keepsShape[cell];
  }
  double measure(const std::array<Index, 4>& cell, const std::vector<Point3>& points) const;
  double measure(const std::array<Index, 3>& cell, const std::vector<Point3>& points) const;
  Vector3 normalAt(const std::array<Index, 3>& triangle) const;
  template<std::size_t Corners>
  void prepare(const Cells<Corners>& cells);
  template<class Visit>
  void forCornersRound(Index vertex, const Visit& visit) const;
  bool comesBefore(Index other, Index vertex) const;
  void findLevels();
  bool mustWait(Index vertex) const;
  ShapeEnergy energyAt(Index vertex) const;
  Point3 onItsEntity(Index vertex, const Point3& point) const;
  Boundary boundaryAt(Index vertex) const;
  void findBoundaries();
  double distanceFromCAD(const Point3& point) const;
  std::vector<Point3> middlesRound(Index vertex, const Point3& point) const;
  bool staysAsClose(Index vertex, const Point3& next, std::optional<double>& farthestNow) const;
  void improve(Index vertex);

  Patch& patch_;
  const BoundaryProjector* projector_;
  ParallelFor parallelFor_;
  /// Measure of the cell of each cell's size in `start` that has the shape that it is to have.
  std::vector<double> sizes_;
  std::vector<std::size_t> firstOfStar_; ///< Cells round vertex v: from firstOfStar_[v] on.
  std::vector<Index> stars_;
  std::vector<Boundary> boundaries_; ///< The boundary at each free vertex on the CAD.
  std::vector<Index> order_;         ///< The free vertices, level by level.
  std::vector<std::size_t> levels_;  ///< Where each level begins, and the last ends.
  /// For each vertex, a number: the larger it is, the earlier the vertex's turn.
  std::vector<std::uint64_t> turns_;
  std::vector<unsigned char> done_;
  double delta_ = 0;
};

} // namespace cadrefine
