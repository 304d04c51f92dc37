// What is known beforehand about the distance to a small patch. Private to geom/nurbs.
#pragma once

#include "Interval.h"
#include "PatchView.h"
#include "Vector3.h"

#include <array>

namespace cadrefine
{

/// Bounds on the second derivatives of f = |S - q|^2 / 2 over the unit square of a patch, for any
/// q. With c the patch's middle point, Hess f = Hess |S - c|^2 / 2 + (c - q) . Hess S: the first
/// term is enclosed once, and Hess S too, component by component. So convexity is proved, or not,
/// in a few operations for each query, and f is bounded from below by a bound that knows the
/// patch's direction and curvature.
class ConvexityBounds
{
public:
  ConvexityBounds() = default;
  /// O(degreeU^2 degreeV^2).
  explicit ConvexityBounds(const PatchView& patch);

  /// What one query learns.
  struct Answer
  {
    bool convex = false;             ///< f is strictly convex over the square.
    double squaredDistanceBound = 0; ///< 2 f is nowhere smaller.
    double s = 0.5;                  ///< Guess of the minimiser; the middle where not convex.
    double t = 0.5;
  };
  Answer ask(const Point3& q) const;

  const Point3& middle() const { return middle_; }
  /// Largest distance from the middle point to a point of the patch (at most).
  double radius() const { return radius_; }
  /// How much the first derivatives turn or stretch along s and along t, relative to their size.
  double variationS() const { return variationS_; }
  double variationT() const { return variationT_; }
  /// Largest lengths of the first derivatives.
  double lengthS() const { return lengthS_; }
  double lengthT() const { return lengthT_; }

private:
  /// Box that contains a vector.
  struct VectorBounds
  {
    Vector3 middle{};
    Vector3 radius{};
    Interval dotRange(const Vector3& k) const;
    double largestNorm() const;
  };
  struct HomogeneousRanges;

  void boundDerivatives(const HomogeneousRanges& ranges);
  void boundOwnHessian(const PatchView& patch);

  Point3 middle_{};
  Vector3 tangentS_{}; // at the middle
  Vector3 tangentT_{};
  VectorBounds ss_, st_, tt_;      // second derivatives of S
  Interval ownSS_, ownST_, ownTT_; // Hessian of |S - c|^2 / 2
  double radius_ = 0;
  double variationS_ = 0;
  double variationT_ = 0;
  double lengthS_ = 0;
  double lengthT_ = 0;
};

} // namespace cadrefine
