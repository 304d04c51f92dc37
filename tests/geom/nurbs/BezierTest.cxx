// Evaluation against closed forms and differences.
#include "Shapes.h"

#include <cadrefine/nurbs/Bezier.h>

#include <gtest/gtest.h>

#include <cmath>

namespace cadrefine
{
namespace
{

TEST(Bezier, patchDerivativesMatchDifferences)
{
  const NurbsFace face = shapes::bumpyFace(1, 0.8, 21);
  BezierPatch patch = face.patches[0];
  patch.u0 = 2.0;
  patch.u1 = 5.0;
  patch.v0 = -1.0;
  patch.v1 = -0.5;
  const double u = 3.1;
  const double v = -0.83;
  const double h = 1e-5;
  const PatchDerivatives d = evaluateDerivatives(patch, u, v);
  const auto at = [&](double a, double b) { return evaluateDerivatives(patch, u + a, v + b); };
  const double scale = 1.0 / (2.0 * h);
  EXPECT_LT(distance(d.value, evaluate(patch, u, v)), 1e-14);
  EXPECT_LT(norm(scale * (at(h, 0).value - at(-h, 0).value) - d.u), 1e-7);
  EXPECT_LT(norm(scale * (at(0, h).value - at(0, -h).value) - d.v), 1e-6);
  EXPECT_LT(norm(scale * (at(h, 0).u - at(-h, 0).u) - d.uu), 1e-7);
  EXPECT_LT(norm(scale * (at(h, 0).v - at(-h, 0).v) - d.uv), 1e-6);
  EXPECT_LT(norm(scale * (at(0, h).v - at(0, -h).v) - d.vv), 1e-4);
}

TEST(Bezier, curveIsExactCircle)
{
  const NurbsEdge circle = shapes::circle(3.0, 1.0);
  for (const BezierCurve& segment : circle.segments)
  {
    for (int i = 0; i <= 10; ++i)
    {
      const CurveDerivatives d = evaluateDerivatives(segment, segment.t0 + 0.1 * i);
      EXPECT_NEAR(std::hypot(d.value[0], d.value[1]), 3.0, 1e-14);
      const double curvature = norm(cross(d.t, d.tt)) / std::pow(norm(d.t), 3);
      EXPECT_NEAR(curvature, 1.0 / 3.0, 1e-13);
    }
  }
}

TEST(Bezier, endsAreExactAndHighDegreeIsStable)
{
  BezierCurve curve = { 0.1, 0.7, {} };
  for (int i = 0; i <= 25; ++i)
  {
    curve.points.push_back({ i / 25.0, std::cos(i), 0.0, 1.0 });
  }
  EXPECT_EQ(evaluate(curve, 0.1), (Point3{ 0.0, 1.0, 0.0 }));
  EXPECT_EQ(evaluate(curve, 0.7), (Point3{ 1.0, std::cos(25), 0.0 }));
  // The abscissae are those of the linear function.
  EXPECT_NEAR(evaluate(curve, 0.4)[0], 0.5, 1e-14);
  EXPECT_NEAR(evaluateDerivatives(curve, 0.25).t[0], 1.0 / 0.6, 1e-12);
  EXPECT_NEAR(evaluateDerivatives(curve, 0.25).tt[0], 0.0, 1e-10);
}

} // namespace
} // namespace cadrefine
