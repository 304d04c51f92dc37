// What is known beforehand about the distance to a small patch. Private to geom/nurbs.
#pragma once

#include <cadrefine/base/Vector3.h>
#include <cadrefine/nurbs/Interval.h>
#include <cadrefine/nurbs/PatchView.h>

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
  /// Box that contains a vector, in the patch's frame.
  struct VectorBounds
  {
    std::array<float, 3> middle{}, radius{};
    VectorBounds() = default;
    explicit VectorBounds(const std::array<Interval, 3>& bounds);
    Interval dotRange(const Vector3& k) const;
    double largestNorm() const;
  };
  struct RoundedInterval
  {
    float low = 0;
    float high = 0;
    operator Interval() const { return { low, high }; }
  };
  struct Ranges;
  struct Hessian
  {
    Interval ss, st, tt;
  };

  void chooseFrame(const Vector3& tangentS, const Vector3& tangentT);
  Vector3 toFrame(const Vector3& v) const;
  Ranges rangesOf(const PatchView& patch) const;
  static RoundedInterval rounded(Interval x);
  static Hessian hessianByParts(const Ranges& ranges);
  Hessian hessianByForm(const PatchView& patch) const;
  void boundOwnHessian(const PatchView& patch, const Ranges& ranges);

  Point3 middle_{};
  Vector3 tangentS_{}; // at the middle
  Vector3 tangentT_{};
  // In single precision, rounded outward: queries spend their time on fetching this.
  std::array<std::array<float, 3>, 3> frame_{}; // rows, orthonormal to rounding
  VectorBounds ss_, st_, tt_;                   // second derivatives of S
  RoundedInterval ownSS_, ownST_, ownTT_;       // Hessian of |S - c|^2 / 2
  float radius_ = 0;
  float variationS_ = 0;
  float variationT_ = 0;
  float lengthS_ = 0;
  float lengthT_ = 0;
};

} // namespace cadrefine
