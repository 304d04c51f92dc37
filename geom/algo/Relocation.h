// Moving vertices to their targets without ever inverting a cell.
#pragma once

#include "SimplexMesh.h"

#include <vector>

namespace cadrefine
{

/// Straight moves of some vertices of a mesh, each done up to a part of its way.
struct Moves
{
  std::vector<Point3> targets;   ///< A vertex each; the vertex itself where it does not move.
  std::vector<double> fractions; ///< In [0, 1]; 0 where it does not move.

  /// No moves of the vertices of `mesh`.
  explicit Moves(const SimplexMesh& mesh);
  void add(Index vertex, const Point3& target);
  /// Where the vertex stands: its target exactly at fraction 1.
  Point3 position(const SimplexMesh& mesh, Index vertex) const;
};

/// Keeps cells valid while their vertices move, from a mesh whose points are the starting state.
///
/// A cell accepts a move if its mean ratio stays above the smaller of `qualityFloor` and half of
/// what it was in the reference state; a cell that was inverted there, if it gets no worse. With
/// the state before all moves as reference, no number of moves in a row wears cells down. Halving
/// the way of the vertices of every cell that does not accept, at once and until all do, ends in a
/// state that does not depend on the order of cells: the unmoved state is accepted by all. Over
/// ranks take the minimum of the fractions of shared vertices after each sweep, until no rank
/// changes any.
class MoveGuard
{
public:
  static constexpr double qualityFloor = 0.05;
  static constexpr int maximumHalvings = 12;

  /// The starting state is the reference.
  explicit MoveGuard(const SimplexMesh& mesh) : MoveGuard(mesh, mesh.points) {}
  /// `reference` has a point for each vertex; all cells accept the starting state. Keeps
  /// references.
  MoveGuard(const SimplexMesh& mesh, const std::vector<Point3>& reference)
    : mesh_(mesh), reference_(reference)
  {
  }

  /// One sweep: halves the fractions of the moving vertices of every cell that does not accept
  /// (to 0 after `maximumHalvings`). Returns true where it halved any. Work linear in the number of
  /// cells.
  bool halveUnaccepted(Moves& moves) const;

private:
  const SimplexMesh& mesh_;
  const std::vector<Point3>& reference_;
};

} // namespace cadrefine
