// Moving mid nodes onto the CAD without making a cell of second order invalid.
#pragma once

#include <cadrefine/base/Moves.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/EdgeTable.h>
#include <cadrefine/mesh/Mesh.h>

#include <vector>

namespace cadrefine
{

/// 1 for the mid nodes of pyramids, which are to stay in the middle (see isValid). Over ranks take
/// the maximum of shared edges.
std::vector<unsigned char> midNodesOfPyramids(const EdgeTable& table);

/// Finds how far mid nodes can go so that all cells of the mesh's own dimension stay valid by the
/// Bezier bounds of isValid.
///
/// Each cell that is not valid takes its mid nodes back a step, all cells at once, until all are
/// valid: what is left of the way is 1/128 first, then twice as much each time up to one half, then
/// the way itself is halved, and after 12 halvings the node stays in the middle. A straight cell is
/// valid if it was before, so this ends, and in a state that does not depend on the order of cells.
/// Over ranks take the minimum of the fractions of shared edges after each sweep, until no rank
/// changes any.
///
/// Steps are small at first, since cells with three edges on a smooth surface at a corner have
/// tangents there that lie nearly in a plane: the exact cell has Jacobian 0 at that corner,
/// whatever its size, and its interpolation one of either sign, smaller by a factor of the size h
/// than that of the straight cell. A part of the way of order h is then enough to make it valid,
/// which keeps the distance to the surface of third order; half of the way would make it second
/// order.
class MidNodeGuard
{
public:
  static constexpr double firstStep = 1.0 / 128;
  static constexpr int maximumHalvings = 12;

  /// `middles`: of the edges, where their nodes start. `plane` is the unit normal of a planar mesh,
  /// from whose end its cells should turn; where it is zero, cells of area keep the side of their
  /// straight normal. Keeps references to mesh, table and middles. Work: one look at each cell;
  /// memory for those with a node that moves.
  MidNodeGuard(const Mesh& mesh, const EdgeTable& table, const std::vector<Point3>& middles,
    const Moves& moves, const Vector3& plane, const ParallelFor& parallelFor = serialFor);

  /// One sweep: takes the mid nodes of every invalid cell back a step. Returns true where it took
  /// any. Work: isValid for the guarded cells with a node that has moved since the last sweep.
  bool stepBack(Moves& moves);

  /// 1 for the cells of the mesh's own dimension that nodes were taken back for, but for those that
  /// were not valid before either.
  const std::vector<unsigned char>& tooCurved() const { return tooCurved_; }

private:
  template<class Shape>
  std::vector<unsigned char> findInvalid(
    Shape shape, const std::vector<Index>& cells, const Moves& moves) const;

  const Mesh& mesh_;
  const EdgeTable& table_;
  const std::vector<Point3>& middles_;
  Vector3 plane_;
  ParallelFor parallelFor_;
  std::vector<std::vector<Index>> cells_; ///< Cells of each shape with a node that moves.
  std::vector<double> seen_;              ///< The fractions at the last sweep.
  std::vector<unsigned char> tooCurved_;
};

} // namespace cadrefine
