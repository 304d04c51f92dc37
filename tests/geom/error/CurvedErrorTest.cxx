// Error of parabolas and quadratic triangles that interpolate shapes of known area and volume.

#include <cadrefine/error/CurvedError.h>

#include "FacetAlone.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Parabola through the ends and the middle of an arc that spans this angle.
class Parabola : public testing::TestWithParam<double>
{
protected:
  static constexpr double radius = 3;
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::circle(radius), ".brep");
  BoundaryProjector projector{ *model, BoundaryKind::Edges };
  double angle = GetParam();

  static Point3 at(double turn) { return { radius * std::cos(turn), radius * std::sin(turn), 0 }; }

  /// Its mid node stands at `height` sagittas over the chord.
  CurvedErrorFacet facet(double height = 1) const
  {
    CurvedErrorFacet result{};
    result.straight.corners.points = { at(1), at(1 + angle), Point3{} };
    for (int k = 0; k < 2; ++k)
    {
      result.straight.corners.entities[k] =
        projector.nearest(result.straight.corners.points[k], unlimited).entity;
    }
    result.straight.edges[0] = { EdgeClass::Smooth, -1 };
    const Point3 middle = 0.5 * (at(1) + at(1 + angle));
    result.nodes[0] = middle + height * (at(1 + angle / 2) - middle);
    result.entities[0] = projector.nearest(result.nodes[0], unlimited).entity;
    result.offCAD[0] = height != 1;
    return result;
  }

  double sagitta() const { return radius * (1 - std::cos(angle / 2)); }
  double segment() const { return radius * radius * (angle - std::sin(angle)) / 2; }
  /// Archimedes: two thirds of chord times height.
  double underParabola(double height) const
  {
    return 2.0 / 3 * 2 * radius * std::sin(angle / 2) * height * sagitta();
  }
};

INSTANTIATE_TEST_SUITE_P(Angles, Parabola, testing::Values(1.5, 0.5, 0.1));

TEST_P(Parabola, errorIsTheAreaBetweenItAndTheArc)
{
  const double area = segment() - underParabola(1);
  EXPECT_NEAR(curvedError(projector, facet(), 6).measure, area, 0.002 * area);
}

TEST_P(Parabola, errorConvergesLikeFourToTheDepth)
{
  const double area = segment() - underParabola(1);
  double before = area - curvedError(projector, facet(), 1).measure;
  for (int depth = 2; depth <= 5; ++depth)
  {
    const FacetError error = curvedError(projector, facet(), depth);
    const double missing = area - error.measure;
    EXPECT_NEAR(error.lastLevel, before - missing, 1e-14);
    EXPECT_NEAR(extrapolatedMeasure(error), area, 0.03 * area);
    EXPECT_GT(before / missing, 3.6) << depth;
    EXPECT_LT(before / missing, 4.4) << depth;
    before = missing;
  }
}

/// The mid node has stopped half way: its place is not where it stands.
TEST_P(Parabola, aMidNodeOffTheCADCounts)
{
  const double area = segment() - underParabola(0.5);
  const FacetError error = curvedError(projector, facet(0.5), 6);
  EXPECT_NEAR(error.measure, area, 0.002 * area);
  EXPECT_NEAR(error.largestDistance, 0.5 * sagitta(), 1e-9);
  EXPECT_NEAR(error.chordError, 0.5 * sagitta(), 1e-9);
}

/// The parabola's distance at a quarter of its parameters, by hand.
TEST_P(Parabola, distanceIsThatOfPointsOnTheParabola)
{
  const double x = radius * std::sin(angle / 2) / 2;
  const double y = radius * std::cos(angle / 2) + 0.75 * sagitta();
  EXPECT_NEAR(
    curvedError(projector, facet(), 1).largestDistance, std::abs(std::hypot(x, y) - radius), 1e-12);
}

/// A straight facet written as one of second order, its mid nodes off the CAD: the volume between
/// triangle and sphere, as the error of first order finds it.
TEST(CurvedError, ofAStraightFacetIsThatOfFirstOrder)
{
  const auto model = cadtest::modelOf(cadtest::sphere(2));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  CurvedErrorFacet facet{};
  facet.straight.corners.points = { Point3{ 2, 0, 0 }, { 0, 2, 0 }, { 0, 0, 2 } };
  const auto& p = facet.straight.corners.points;
  for (int k = 0; k < 3; ++k)
  {
    facet.straight.corners.entities[k] = projector.nearest(p[k], unlimited).entity;
    facet.straight.edges[k] = { EdgeClass::Smooth, -1 };
    facet.nodes[k] = 0.5 * (p[k] + p[(k + 1) % 3]);
    facet.entities[k] = projector.nearest(facet.nodes[k], unlimited).entity;
    facet.offCAD[k] = true;
  }
  // An eighth of the ball without the tetrahedron at its centre.
  const double volume = 4 * std::acos(-1.0) / 3 - 8.0 / 6;
  EXPECT_NEAR(curvedError(projector, facet, 5).measure, volume, 0.002 * volume);
  const FacetError coarse = curvedError(projector, facet, 2);
  EXPECT_NEAR(coarse.lastLevel, coarse.measure - curvedError(projector, facet, 1).measure, 1e-14);
  EXPECT_NEAR(extrapolatedMeasure(coarse), volume, 0.03 * volume);
  EXPECT_NEAR(
    cadtest::geometricError(projector, facet.straight, 6).measure, volume, 0.002 * volume);
  // Of the points at sixteenths of the parameters, (5, 5, 6) / 16 is nearest to the centre.
  EXPECT_NEAR(curvedError(projector, facet, 3).largestDistance, 2 - 2 * std::sqrt(86.0) / 16, 1e-9);
  EXPECT_NEAR(curvedError(projector, facet, 3).chordError, 2 - std::sqrt(2.0), 1e-9);
}

} // namespace
