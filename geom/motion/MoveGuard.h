// Moving vertices to their targets without ever inverting a cell.
#pragma once

#include <cadrefine/base/Moves.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/mesh/Mesh.h>

#include <array>
#include <vector>

namespace cadrefine
{

/// Keeps cells valid while their vertices move, from a mesh whose points are the starting state.
///
/// A valid cell accepts moves after which it is still valid and its quality (see CellState) is at
/// least `qualityFloor`, or at least half of what it was in the reference state and not below
/// `lowestQuality`; a pyramid's at least `pyramidFloor`, as worse ones may be too distorted to be
/// refined uniformly (see cellsCutBadly). A cell that is worse than that in the reference state,
/// inverted or flat accepts moves that make it no worse. With the state before all moves as
/// reference, no number of moves in a row wears cells down. Halving the way of the vertices of
/// every cell that does not accept, at once and until all do, ends in a state that does not depend
/// on the order of cells: the unmoved state is accepted by all. Over ranks take the minimum of the
/// fractions of shared vertices after each sweep, until no rank changes any.
class MoveGuard
{
public:
  static constexpr double qualityFloor = 0.05;
  static constexpr double lowestQuality = 0.001;
  static constexpr double pyramidFloor = 0.1;
  static constexpr int maximumHalvings = 12;

  /// `reference` has a point for each vertex; all cells accept the starting state. `plane` is the
  /// unit normal of a planar mesh, from whose end its triangles should turn; where it is zero,
  /// triangles keep the side that they have in the reference state. `cells` are those with a vertex
  /// that moves (others among them are left out); without them all are looked at. Memory for those
  /// with a vertex that moves. Keeps a reference to the mesh. All methods loop by `parallelFor`.
  MoveGuard(const Mesh& mesh, const Moves& moves, const std::vector<Point3>& reference,
    const Vector3& plane, const ParallelFor& parallelFor = serialFor);
  MoveGuard(const Mesh& mesh, const Moves& moves, const std::vector<Point3>& reference,
    const Vector3& plane, const std::vector<Index>& cells,
    const ParallelFor& parallelFor = serialFor);

  /// One sweep: halves the fractions of the moving vertices of every cell that does not accept (to
  /// 0 after `maximumHalvings`, and at once where they move wholly). Returns true where it halved
  /// any. Between sweeps only fractions may change. Work: a look at each cell with a vertex that
  /// moves; its state only where a fraction has changed since the sweep before.
  bool halveUnaccepted(Moves& moves);

  /// Vertices of the guarded cells whose quality, with the mesh's points as they now are, is
  /// below this part of what it was in the reference state. In any order; may name a vertex more
  /// than once.
  std::vector<Index> verticesOfSpoiltCells(double part) const;

private:
  /// A cell with a vertex that moves, and what it accepts.
  struct GuardedCell
  {
    Index cell = -1; ///< Among those of its shape.
    CellState before;
    double leastQuality = 0;
    Vector3 side{};
  };

  template<class Shape>
  std::vector<GuardedCell> guard(Shape shape, std::vector<Index> chosen, const Moves& moves,
    const std::vector<Point3>& reference, const Vector3& plane) const;
  template<class Shape>
  bool accepts(Shape shape, const GuardedCell& guarded, const Moves& moves) const;
  template<class Predicate>
  std::vector<Index> cornersWhere(const Predicate& holds) const;

  const Mesh& mesh_;
  ParallelFor parallelFor_;
  /// Guarded cells of each shape, in the order of the shapes.
  std::array<std::vector<GuardedCell>, 4> guarded_;
  std::vector<double> lastFractions_; ///< Fractions in the last sweep; empty before the first.
};

} // namespace cadrefine
