// Exact search of a leaf over which the distance need not be convex. Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/BernsteinForm.h>
#include <cadrefine/nurbs/LeafQuery.h>

#include <vector>

namespace cadrefine
{

/// Branch and bound on the Bernstein forms of |N - q w|^2 and w^2 (the leaf is N / w):
///  1. a rectangle is dropped where the least ratio of their coefficients, or a second-order lower
///     bound about its middle, is not below what is known already;
///  2. where the sublevel sets of the distance are convex it is solved by Newton's method;
///  3. where the distance falls all the way towards a side, beyond which the surface goes on or its
///     edges lie, nothing is to be found either: what matters is on the other side, or on the
///     border;
///  4. else it is split, across the direction of larger second derivatives.
/// Ends because of a limit on the work of the whole query, which then has not converged.
class LeafSubdivision
{
public:
  LeafSubdivision(LeafQuery& query, const SearchLeaf& leaf);
  void run();

private:
  struct Part
  {
    ParameterRectangle rectangle;
    bool cut = false;
  };
  /// Second derivatives of the form numerator - level * denominator, enclosed, and its middle.
  struct Curvature
  {
    Interval ss, st, tt;
    bool isConvex() const;
  };

  double* numerator(int entry) const;
  double* denominator(int entry) const;
  bool spend(double work);
  void fillForms();
  Interval ratioRange(int entry) const;
  void boundRounding();
  bool isDropped(int entry);
  void fillLevel(int entry, double level) const;
  Curvature curvature(int entry, double level) const;
  bool isMonotone(int entry, double lowest, double highest) const;
  void solveIn(const ParameterRectangle& box, const Part& start);
  bool canSplit(const Part& part, bool acrossS) const;
  bool cutsAcrossS(const Part& part, const Curvature& c, const MiddleValue& middle) const;
  void split(int entry);
  bool isTrimmedAway(Part& part) const;

  LeafQuery& query_;
  const SearchLeaf& leaf_;
  Degrees degrees_;
  std::vector<double>& forms_; ///< Numerator and denominator of every entry of the stack.
  std::vector<double>& level_; ///< Scratch: one form.
  std::vector<Part> stack_;
  double formRounding_ = 0;  ///< What a coefficient of numerator - level * denominator is wrong by.
  double ratioRounding_ = 0; ///< What the ratio of two coefficients is wrong by.
};

} // namespace cadrefine
