// Middles of mesh edges on CAD models with thin parts, bows and holes.

#include <cadrefine/classification/MidpointProjection.h>

#include "TestShapes.h"

#include <cadrefine/cad/import/CADFile.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;

constexpr double unlimited = std::numeric_limits<double>::infinity();

constexpr double pi = 3.14159265358979323846;

Point3 at(double radius, double degrees, double z)
{
  const double angle = degrees * pi / 180;
  return { radius * std::cos(angle), radius * std::sin(angle), z };
}

std::array<EntityId, 2> entitiesAt(
  const BoundaryProjector& projector, const std::array<Point3, 2>& points)
{
  return { projector.nearest(points[0], unlimited).entity,
    projector.nearest(points[1], unlimited).entity };
}

/// A sheet of thickness 0.01: the chord of its outer side runs on the far side of the inner one.
class ThinSheet : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::pipe(1, 1.01, 1));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
};

TEST_F(ThinSheet, keepsMidpointsOnTheirSide)
{
  const std::array<Point3, 2> points{ at(1.01, 40, 0.5), at(1.01, 100, 0.5) };
  const EntityId outer = projector.nearest(at(1.02, 70, 0.5), unlimited).entity;
  ASSERT_EQ(outer.dimension, 2);
  ASSERT_NE(projector.nearest(0.5 * (points[0] + points[1]), unlimited).entity, outer)
    << "the plain nearest point jumps sides";
  const ClosestPoint where =
    projectMidpoint(projector, { { EdgeClass::Smooth, -1 }, points, { outer, outer } });
  EXPECT_EQ(where.entity, outer);
  EXPECT_NEAR(distance(where.point, at(1.01, 70, 0.5)), 0, 1e-9);
}

/// The same along the rim, where outer side and end meet, also where the closed edge begins.
TEST_F(ThinSheet, keepsMidpointsOnTheirCrease)
{
  const EntityId rim = projector.nearest(at(1.02, 70, 1.01), unlimited).entity;
  ASSERT_EQ(rim.dimension, 1);
  for (const double degrees : { 70, 0 })
  {
    const std::array<Point3, 2> points{ at(1.01, degrees - 30, 1), at(1.01, degrees + 30, 1) };
    const std::vector<FacetRecord> facets{ { at(1, degrees, 0), 1, 1, 0, -1 },
      { { 0, 0, 1 }, 1, 1, 0, -1 } };
    const EdgeClass edgeClass = projector.classify(points, { rim, rim }, facets);
    ASSERT_EQ(edgeClass.kind, EdgeClass::OnEdge);
    EXPECT_EQ(edgeClass.entity, rim.index);
    const ClosestPoint where = projectMidpoint(projector, { edgeClass, points, { rim, rim } });
    EXPECT_NEAR(distance(where.point, at(1.01, degrees, 1)), 0, 1e-9);
  }
}

/// Of a chord on the end, which is much narrower than the bow over that.
TEST_F(ThinSheet, keepsMidpointsInItsEnd)
{
  const std::array<Point3, 2> points{ at(1.005, 40, 1), at(1.005, 100, 1) };
  const EntityId end = projector.nearest(points[0], unlimited).entity;
  ASSERT_EQ(end.dimension, 2);
  const BoundaryEdge edge{ { EdgeClass::Smooth, end.index }, points, { end, end } };
  EXPECT_EQ(offBorder(projector, edge, projectMidpoint(projector, edge)).entity, end);
}

/// Of a diameter all of the bow over it is as near to its middle as its ends are.
TEST(HalfPipe, hasTheMiddleOfADiameterAtTheTopOfTheBow)
{
  const auto model = cadtest::modelOf(cadtest::halfPipe(1, 2));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  for (const double z : { 0.0, 0.7, 2.0 })
  {
    const std::array<Point3, 2> points{ { { 1, 0, z }, { -1, 0, z } } };
    const auto entities = entitiesAt(projector, points);
    const std::int32_t rim = projector.nearest({ 0, 1, z }, unlimited).entity.index;
    const EdgeClass edgeClass =
      z == 0.7 ? EdgeClass{ EdgeClass::Smooth, -1 } : EdgeClass{ EdgeClass::OnEdge, rim };
    const ClosestPoint where = projectMidpoint(projector, { edgeClass, points, entities });
    EXPECT_EQ(where.entity.dimension, z == 0.7 ? 2 : 1);
    EXPECT_NEAR(distance(where.point, { 0, 1, z }), 0, 1e-9);
    EXPECT_NEAR(where.distance, 1, 1e-9);
    const ClosestPoint back = projectMidpoint(
      projector, { edgeClass, { points[1], points[0] }, { entities[1], entities[0] } });
    EXPECT_EQ(back.point, where.point);
  }
}

/// Within a thin nose the sides are nearer to the middle of a chord than its tip is.
TEST(Nose, hasTheMiddleOfAChordAcrossItAtItsTip)
{
  constexpr double height = 0.06;
  const auto model = cadtest::modelOf(cadtest::ellipticPipe(1, height, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const auto placeOf = [&](double x, double y, double fromZ, double toZ)
  {
    const std::array<Point3, 2> points{ { { x, height * std::sqrt(1 - x * x), fromZ },
      { y, -height * std::sqrt(1 - y * y), toZ } } };
    const auto entities = entitiesAt(projector, points);
    EXPECT_EQ(entities[0].dimension, 2);
    const EdgeClass edgeClass{ EdgeClass::Smooth, entities[0].index };
    const ClosestPoint where = projectMidpoint(projector, { edgeClass, points, entities });
    const ClosestPoint back = projectMidpoint(
      projector, { edgeClass, { points[1], points[0] }, { entities[1], entities[0] } });
    EXPECT_EQ(back.point, where.point);
    return where.point;
  };
  EXPECT_NEAR(distance(placeOf(-0.975, -0.975, 0.5, 0.5), { -1, 0, 0.5 }), 0, 1e-6);
  EXPECT_NEAR(distance(placeOf(-0.975, -0.975, 0.4, 0.5), { -1, 0, 0.45 }), 0, 1e-6);
  EXPECT_NEAR(distance(placeOf(-0.97, -0.98, 0.5, 0.5), { -1, 0, 0.5 }), 0, 0.01);
  // No nose: a chord between the sides, far from both ends of the section.
  EXPECT_LT(std::abs(placeOf(-0.1, 0.1, 0.5, 0.5)[0]), 0.2);
}

/// Of two arcs of one circle the other one may be nearer to the middle of a chord.
TEST(Disc, hasTheMiddleOfAChordOnItsOwnArc)
{
  for (const double turn : { 0.0, 0.2, -0.2 })
  {
    const auto model = cadtest::modelOf(cadtest::discOfTwoArcs(1, turn));
    const BoundaryProjector projector(*model, BoundaryKind::Faces);
    const double x = std::cos(turn);
    const double y = std::sin(turn);
    const std::array<Point3, 2> points{ { { x, y, 0 }, { -x, y, 0 } } };
    const auto entities = entitiesAt(projector, points);
    ASSERT_EQ(entities[0].dimension, 0);
    for (const double side : { -1.0, 1.0 })
    {
      const EntityId arc = projector.nearest({ 0, 2 * side, 0 }, unlimited).entity;
      ASSERT_EQ(arc.dimension, 1);
      const ClosestPoint where =
        projectMidpoint(projector, { { EdgeClass::OnEdge, arc.index }, points, entities });
      EXPECT_EQ(where.entity, arc);
      const bool isDiameter = turn == 0; // all places of the arc are as near
      EXPECT_NEAR(distance(where.point, { 0, side, 0 }), 0, isDiameter ? 1 : 1e-9);
    }
  }
}

/// Where the arc goes the long way round, the edge cannot be meant to be on it.
TEST(Disc, leavesTheMiddleOfAShortChordWhereItIsNearest)
{
  const double turn = 1.4;
  const auto model = cadtest::modelOf(cadtest::discOfTwoArcs(1, turn));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const std::array<Point3, 2> points{ { { std::cos(turn), std::sin(turn), 0 },
    { -std::cos(turn), std::sin(turn), 0 } } };
  const auto entities = entitiesAt(projector, points);
  const EntityId around = projector.nearest({ 0, -2, 0 }, unlimited).entity;
  const ClosestPoint where =
    projectMidpoint(projector, { { EdgeClass::OnEdge, around.index }, points, entities });
  EXPECT_NEAR(distance(where.point, { 0, 1, 0 }), 0, 1e-9);
}

/// Of a chord from one rim to the other across a bow that gets narrower, a rim is nearer.
TEST(HalfCone, keepsTheMiddleOfAChordOffItsRims)
{
  const auto model = cadtest::modelOf(cadtest::halfCone(0.28, 0.186, 1.89));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const std::array<Point3, 2> points{ { { 0.28, 0, 0 }, { -0.186, 0, 1.89 } } };
  const EntityId face = projector.nearest({ 0, 0.3, 1 }, unlimited).entity;
  ASSERT_EQ(face.dimension, 2);
  const auto entities = entitiesAt(projector, points);
  ASSERT_NE(projector.nearest(0.5 * (points[0] + points[1]), unlimited).entity, face);
  const BoundaryEdge edge{ { EdgeClass::Smooth, face.index }, points, entities };
  const ClosestPoint where = projectMidpoint(projector, edge);
  EXPECT_EQ(where.entity, face);
  EXPECT_GT(where.point[1], 0.1);
  EXPECT_NEAR(distance(where.point, points[0]) / distance(where.point, points[1]), 1, 0.1);
}

/// From the inner rim of a ring to its outer one, through the hole.
TEST(Ring, keepsTheMiddleOfAChordThatCrossesTheHole)
{
  const auto model = cadtest::modelOf(cadtest::pipe(1, 1.5, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const std::array<Point3, 2> points{ { { 0, 1, 1 }, { -1.5, 0, 1 } } };
  std::array<EntityId, 2> entities;
  for (int k = 0; k < 2; ++k)
  {
    entities[k] = projector.nearest(points[k], unlimited).entity;
    ASSERT_EQ(entities[k].dimension, 1);
  }
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entities };
  const ClosestPoint nearest = projectMidpoint(projector, edge);
  EXPECT_EQ(nearest.entity, entities[0]);
  const ClosestPoint where = offBorder(projector, edge, nearest);
  const Point3 middle = 0.5 * (points[0] + points[1]);
  const double radius = std::hypot(middle[0], middle[1]);
  ASSERT_LT(radius, 1);
  EXPECT_EQ(where.entity.dimension, 2); // not on the rim, where the rim's own vertices go
  EXPECT_EQ(where.entity, projector.nearest({ 0, 1.25, 1 }, unlimited).entity);
  const double outside = (2 - radius) / radius;
  EXPECT_NEAR(distance(where.point, { outside * middle[0], outside * middle[1], 1 }), 0, 1e-9);
  EXPECT_NEAR(where.distance, distance(where.point, middle), 1e-15);
}

/// From the rim of a fillet to a vertex on the fillet, over the flat end inside the rim.
TEST(Fillet, hasTheMiddleOfAChordOverTheFlatEndInsideItsRim)
{
  const auto model = cadtest::modelOf(cadtest::filletedDisc(1, 0.5));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const double high = std::sqrt(0.25 - 0.01);
  const std::array<Point3, 2> points{ at(1, 40, 0.5), at(1.1, 100, high) };
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entitiesAt(projector, points) };
  ASSERT_EQ(edge.entities[0].dimension, 1);
  ASSERT_EQ(edge.entities[1].dimension, 2);
  const ClosestPoint nearest = projector.nearest(0.5 * (points[0] + points[1]), unlimited);
  ASSERT_NE(nearest.entity, edge.entities[1]); // but the flat end

  const ClosestPoint where = offBorder(projector, edge, nearest);
  EXPECT_EQ(where.entity, edge.entities[1]);
  // Over the rim, half as far from it as the second end.
  const double away = 0.5 * std::hypot(0.1, 0.5 - high);
  const double onFillet = std::hypot(away, 0.5);
  const Point3 sum = points[0] + points[1];
  const double degrees = 180 / pi * std::atan2(sum[1], sum[0]);
  const Point3 expected = at(1 + 0.5 * away / onFillet, degrees, 0.25 / onFillet);
  EXPECT_NEAR(distance(where.point, expected), 0, 1e-9);
}

/// Where a chord crosses the hole at the seam of its wall, a CAD vertex is nearest to its middle.
TEST(Ring, keepsTheMiddleOfAChordThatCrossesTheHoleAtItsSeam)
{
  const auto model = cadtest::modelOf(cadtest::pipe(1, 1.5, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const std::array<Point3, 2> points{ { { 0.95, 0.4, 1 }, { 0.95, -0.4, 1 } } };
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entitiesAt(projector, points) };
  const ClosestPoint nearest = projectMidpoint(projector, edge);
  ASSERT_EQ(nearest.entity.dimension, 0);
  const ClosestPoint where = offBorder(projector, edge, nearest);
  EXPECT_EQ(where.entity, projector.nearest({ 0, 1.25, 1 }, unlimited).entity);
  EXPECT_NEAR(distance(where.point, { 1.05, 0, 1 }), 0, 1e-9);
}

/// The middle of a chord that leaves its face may be nearest to another face, which it is not on.
TEST(Ring, takesTheMiddleOfAChordFromAnotherFaceToItsOwn)
{
  const auto model = cadtest::modelOf(cadtest::pipe(1, 1.5, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const std::array<Point3, 2> points{ { { 0, 1, 1 }, { -1.5, 0, 1 } } };
  const auto entities = entitiesAt(projector, points);
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entities };
  const ClosestPoint wall = projector.nearest({ -0.7, 0.7, 0.5 }, unlimited);
  const EntityId ring = projector.nearest({ 0, 1.25, 1 }, unlimited).entity;
  ASSERT_EQ(wall.entity.dimension, 2);
  ASSERT_NE(wall.entity, ring);
  const ClosestPoint where = offBorder(projector, edge, wall);
  EXPECT_EQ(where.entity, ring);
  EXPECT_EQ(where.point, offBorder(projector, edge, projectMidpoint(projector, edge)).point);
  const BoundaryEdge onWall{ { EdgeClass::OnEdge, entities[0].index }, points, entities };
  EXPECT_EQ(offBorder(projector, onWall, wall).entity, wall.entity) << "only of smooth edges";
}

/// A sphere cut off its centre, by a plane that is not in the CAD.
TEST(CutSphere, keepsMidpointsInThePlane)
{
  constexpr double radius = 2;
  const auto model = cadtest::modelOf(cadtest::sphere(radius));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const Vector3 normal{ 0, 0, 1 };
  for (const double height : { 0.0, 0.5, -1.2, 1.6 })
  {
    const double rim = std::sqrt(radius * radius - height * height);
    const std::array<Point3, 2> points{ Point3{ rim * std::cos(2), rim * std::sin(2), height },
      Point3{ rim * std::cos(3), rim * std::sin(3), height } };
    const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entitiesAt(projector, points) };
    const ClosestPoint nearest = projectMidpoint(projector, edge);
    const ClosestPoint where = inPlane(projector, edge, nearest, normal);
    EXPECT_EQ(where.entity, nearest.entity);
    const Point3 exact{ rim * std::cos(2.5), rim * std::sin(2.5), height };
    EXPECT_NEAR(distance(where.point, exact), 0, 1e-12);
    EXPECT_NEAR(where.distance, rim * (1 - std::cos(0.5)), 1e-12);
    EXPECT_EQ(inPlane(projector, edge, nearest, normalized(exact)).point, nearest.point)
      << "a tangent plane";
  }
}

/// Near the sharp trailing edge the two sides of the wing are close to each other.
TEST(SharpWing, keepsMidpointsAtTheTrailingEdgeOnTheirSide)
{
  const auto model = readCADFile(CADREFINE_DATA "/naca0012_sharp.igs");
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  for (const double side : { -1.0, 1.0 })
  {
    const ClosestPoint before = projector.nearest({ 2.94, 0.7, side * 0.3 }, unlimited);
    ASSERT_EQ(before.entity.dimension, 2);
    const ClosestPoint end = projector.nearestCrease({ 3.03, 0.7, 0 }, unlimited);
    ASSERT_EQ(end.entity.dimension, 1);
    const ClosestPoint where = projectMidpoint(projector,
      { { EdgeClass::Smooth, -1 }, { before.point, end.point }, { before.entity, end.entity } });
    EXPECT_EQ(where.entity.dimension, 2);
    EXPECT_GT(side * where.point[2], 0);
  }
}

/// An edge across a bore of radius 1, beyond whose axis the wall on the side of y > 0 is nearer:
/// the mesh may be on either side.
TEST(Bore, facesTheMesh)
{
  const auto model = cadtest::modelOf(cadtest::pipe(1, 3, 4));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const auto at = [](double x, double y) { return Point3{ x, y, 2 }; };
  const double half = std::sqrt(1 - 0.2 * 0.2);
  const std::array<Point3, 2> points{ at(half, 0.2), at(-half, 0.2) };
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, points, entitiesAt(projector, points) };
  const ClosestPoint nearest = projectMidpoint(projector, edge);
  ASSERT_NEAR(nearest.point[1], 1, 1e-9);
  ASSERT_TRUE(isFarAcross(projector, edge, nearest));
  const ClosestPoint off = projector.nearest(at(0.8, 0.6), unlimited);
  const Vector3 normal = model->normal(off.entity.index, off.parameters);
  FaceSides sides(model->count(2), 0);
  const Vector3 towards{ 0, 1, 0 };
  EXPECT_EQ(facing(projector, edge, nearest, towards, sides).point, nearest.point);
  sides[off.entity.index] = dot(normal, at(0.8, 0.6) - at(0, 0)) < 0 ? 1 : -1;
  EXPECT_EQ(facing(projector, edge, nearest, -1.0 * towards, sides).point, nearest.point);
  const ClosestPoint there = facing(projector, edge, nearest, towards, sides);
  EXPECT_NEAR(distance(there.point, at(0, -1)), 0, 1e-9);
  EXPECT_NEAR(there.distance, 1.2, 1e-9);
}

} // namespace
