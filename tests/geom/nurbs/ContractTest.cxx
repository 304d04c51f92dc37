// Ties, masks, limits, purity and the errors of the closest-point search.
#include "Reference.h"
#include "Shapes.h"

#include <cadrefine/base/Error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <thread>

namespace cadrefine
{
namespace
{

std::uint64_t bitsOf(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

bool sameBits(const ClosestPoint& a, const ClosestPoint& b)
{
  const auto same = [](double x, double y) { return bitsOf(x) == bitsOf(y); };
  return a.entity == b.entity &&
         std::equal(a.point.begin(), a.point.end(), b.point.begin(), same) &&
         std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), same) &&
         same(a.distance, b.distance) && a.converged == b.converged;
}

TEST(Ties, borderNamesEdgeAndEndNamesVertex)
{
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch search(model);
  EXPECT_EQ(search.nearest({ 0.3, -2.0, 0.0 }).entity, (EntityId{ 1, 0 }));
  EXPECT_EQ(search.nearest({ 0.3, -2.0, 0.7 }).entity, (EntityId{ 1, 0 }));
  EXPECT_EQ(search.nearest({ 2.0, 2.0, 0.0 }).entity, (EntityId{ 0, 2 }));
  EXPECT_EQ(search.nearest({ 2.0, 2.0, -3.0 }).entity, (EntityId{ 0, 2 }));
  EXPECT_EQ(search.nearest({ 1.0, 0.0, 0.0 }).entity, (EntityId{ 1, 4 }));
  EXPECT_EQ(search.nearest({ 0.6, 0.8, 0.0 }).entity, (EntityId{ 1, 4 }));
  EXPECT_EQ(search.nearest({ 1.5, 0.0, 0.0 }).entity, (EntityId{ 2, 0 }));
  const ClosestPoint corner = search.nearest({ 3.0, 3.0, 0.0 });
  EXPECT_TRUE(std::isnan(corner.parameters[0]) && std::isnan(corner.parameters[1]));
}

TEST(Ties, smallestIndexAmongFaces)
{
  // Two equal plates, one above the other: in the middle both are equally near.
  NurbsModel model;
  for (const double z : { 1.0, -1.0 })
  {
    NurbsFace face;
    face.patchesU = face.patchesV = 1;
    face.patches = { { 1, 1, 0, 1, 0, 1,
      { { 0, 0, z, 1 }, { 0, 1, z, 1 }, { 1, 0, z, 1 }, { 1, 1, z, 1 } } } };
    model.faces.push_back(face);
  }
  const ClosestPointSearch search(model);
  for (const double z : { 0.0, 1e-14, -1e-14 })
  {
    EXPECT_EQ(search.nearest({ 0.3, 0.4, z }).entity, (EntityId{ 2, 0 }));
  }
  EXPECT_EQ(search.nearest({ 0.3, 0.4, -1e-9 }).entity, (EntityId{ 2, 1 }));
}

TEST(Masks, chooseDimensions)
{
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch search(model);
  SearchScope scope;
  scope.vertices = false;
  EXPECT_EQ(search.nearest({ 3, 3, 0 }, scope).entity.dimension, 1);
  scope = {};
  scope.faces = false;
  EXPECT_EQ(search.nearest({ 1.4, 0.1, 0.2 }, scope).entity, (EntityId{ 1, 4 }));
  scope.edges = scope.sharpEdges = false;
  EXPECT_EQ(search.nearest({ 1.4, 1.3, 0.2 }, scope).entity, (EntityId{ 0, 2 }));
  scope.vertices = false;
  EXPECT_FALSE(static_cast<bool>(search.nearest({ 1.4, 1.3, 0.2 }, scope).entity));
}

TEST(Masks, borderBelongsToFaceWithoutEdges)
{
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch search(model);
  SearchScope scope;
  scope.edges = scope.sharpEdges = scope.vertices = false;
  const Point3 q = { 0.3, 0.4, 0.6 };
  const ClosestPoint answer = search.nearest(q, scope);
  EXPECT_EQ(answer.entity, (EntityId{ 2, 0 }));
  EXPECT_NEAR(answer.distance, std::hypot(0.5, 0.6), 1e-9);
  EXPECT_NEAR(answer.parameters[0], 0.6, 1e-9);
  EXPECT_NEAR(answer.parameters[1], 0.8, 1e-9);
}

TEST(Masks, onlySharpEdges)
{
  NurbsModel model = shapes::plateWithHole();
  model.edges[4].sharp = false;
  const ClosestPointSearch search(model);
  SearchScope scope;
  scope.edges = false;
  EXPECT_EQ(search.nearest({ 0.3, 0.4, 0.0 }, scope).entity, (EntityId{ 2, 0 }));
  EXPECT_EQ(search.nearest({ 2.5, 0.4, 0.0 }, scope).entity, (EntityId{ 1, 1 }));
  scope.faces = false;
  EXPECT_EQ(search.nearest({ 0.3, 0.4, 0.0 }, scope).entity, (EntityId{ 1, 2 }));
}

TEST(Limits, maximumDistance)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  SearchScope scope;
  scope.maximumDistance = 0.5;
  EXPECT_FALSE(static_cast<bool>(search.nearest({ 0.0, 0.1, 0.2 }, scope).entity));
  EXPECT_FALSE(static_cast<bool>(search.nearest({ 3.0, 0.1, 0.2 }, scope).entity));
  const ClosestPoint near = search.nearest({ 2.3, 0.0, 0.0 }, scope);
  EXPECT_EQ(near.entity, (EntityId{ 2, 0 }));
  EXPECT_NEAR(near.distance, 0.3, 1e-12);
}

/// A plate with a hole, a bumpy face, and a torus.
NurbsModel threeFaces()
{
  NurbsModel model = shapes::plateWithHole();
  model.faces.push_back(shapes::bumpyFace(2, 0.8, 31));
  model.faces.push_back(shapes::torus(3.0, 1.0));
  return model;
}

TEST(Limits, withinDistance)
{
  const NurbsModel model = threeFaces();
  const ClosestPointSearch search(model);
  shapes::Random random(33);
  for (int i = 0; i < 1000; ++i)
  {
    const Point3 q = random.point(i % 10 == 0 ? 1e10 : 4.0);
    const double away = search.nearest(q).distance;
    const auto isWithin = [&](double distance)
    {
      SearchScope scope;
      scope.maximumDistance = distance;
      return search.isWithinDistance(q, scope);
    };
    EXPECT_TRUE(isWithin(1.000001 * away)) << i;
    EXPECT_TRUE(isWithin(100 * away)) << i;
    EXPECT_FALSE(isWithin(0.999999 * away)) << i;
  }
  EXPECT_FALSE(search.isWithinDistance({ std::nan(""), 0, 0 }, {}));
}

TEST(NearestOn, staysOnTheEntity)
{
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch search(model);
  EXPECT_EQ(search.nearestOn({ 1, 4 }, { 1.9, 0.1, 0.0 }).entity, (EntityId{ 1, 4 }));
  EXPECT_EQ(search.nearestOn({ 1, 0 }, { 9.0, 0.1, 0.0 }).entity, (EntityId{ 0, 1 }));
  EXPECT_EQ(search.nearestOn({ 0, 3 }, { 9.0, 0.1, 0.0 }).entity, (EntityId{ 0, 3 }));
  EXPECT_EQ(search.nearestOn({ 2, 0 }, { 0.2, 0.1, 0.0 }).entity, (EntityId{ 1, 4 }));
  EXPECT_EQ(search.nearestOn({ 2, 0 }, { 3.0, 3.0, 1.0 }).entity, (EntityId{ 0, 2 }));
  EXPECT_EQ(search.nearestOn({ 2, 0 }, { 1.2, 1.0, 1.0 }).entity, (EntityId{ 2, 0 }));
  EXPECT_FALSE(static_cast<bool>(search.nearestOn({ 2, 1 }, { 0, 0, 0 }).entity));
  EXPECT_FALSE(static_cast<bool>(search.nearestOn({}, { 0, 0, 0 }).entity));
}

TEST(NearestOn, nearestOfAllEntitiesIsNearestOfTheModel)
{
  const NurbsModel model = threeFaces();
  const ClosestPointSearch search(model);
  shapes::Random random(32);
  for (int i = 0; i < 300; ++i)
  {
    const Point3 q = random.point(4.0);
    ClosestPoint best;
    for (int dimension = 0; dimension < 3; ++dimension)
    {
      for (int index = 0; index < model.count(dimension); ++index)
      {
        const EntityId id = { static_cast<std::int8_t>(dimension), index };
        const ClosestPoint on = search.nearestOn(id, q);
        reference::expectConsistent(model, search.modelSize(), q, on);
        best = on.distance < best.distance ? on : best;
      }
    }
    EXPECT_NEAR(search.nearest(q).distance, best.distance, 1e-9 * search.modelSize());
  }
}

TEST(Purity, sameBitsInAnyOrderAndOnAnyThread)
{
  NurbsModel model = shapes::modelOf(shapes::bumpyFace(3, 0.6, 5));
  model.faces.push_back(shapes::sphere(1.0));
  const ClosestPointSearch search(model);
  constexpr int count = 400;
  std::vector<Point3> points;
  points.reserve(count);
  shapes::Random random(6);
  for (int i = 0; i < count; ++i)
  {
    points.push_back(random.point(3.0));
  }
  points[7] = { 0.0, 0.0, 0.0 };
  std::vector<ClosestPoint> forward(count);
  std::vector<ClosestPoint> backward(count);
  std::thread first(
    [&]
    {
      for (int i = 0; i < count; ++i)
      {
        forward[i] = search.nearest(points[i]);
      }
    });
  std::thread second(
    [&]
    {
      for (int i = count - 1; i >= 0; --i)
      {
        backward[i] = search.nearest(points[i]);
      }
    });
  first.join();
  second.join();
  const ClosestPointSearch again(model);
  for (int i = 0; i < count; ++i)
  {
    EXPECT_TRUE(sameBits(forward[i], backward[i]));
    EXPECT_TRUE(sameBits(forward[i], again.nearest(points[i])));
  }
}

/// Points at `offset` from `on`, straight out and to either side of the plane y = 0.
std::vector<Point3> pointsAbout(const Point3& on, const Vector3& outward)
{
  std::vector<Point3> points;
  for (const double offset : { -0.3, -1e-6, 0.0, 1e-6, 0.4 })
  {
    for (const double side : { -1e-14, 0.0, 1e-14 })
    {
      points.push_back(on + offset * outward + Vector3{ 0.0, side, 0.0 });
    }
  }
  return points;
}

TEST(Canonical, seamHasTheLowerParameter)
{
  // u counts quarter turns: the half plane y = 0, x > 0 holds the seam u = 0 = 4.
  for (const bool isTorus : { false, true })
  {
    const NurbsModel model =
      shapes::modelOf(isTorus ? shapes::torus(3.0, 1.0) : shapes::cylinder(1.0, 0.0, 3.0));
    const ClosestPointSearch search(model);
    const Point3 on = isTorus ? Point3{ 3.6, 0.0, 0.8 } : Point3{ 1.0, 0.0, 1.3 };
    const Vector3 outward = isTorus ? Vector3{ 0.6, 0.0, 0.8 } : Vector3{ 1.0, 0.0, 0.0 };
    for (const Point3& q : pointsAbout(on, outward))
    {
      const ClosestPoint answer = search.nearest(q);
      reference::expectConsistent(model, search.modelSize(), q, answer);
      EXPECT_EQ(answer.parameters[0], 0.0);
    }
    const ClosestPoint beside = search.nearest(on - Vector3{ 0.0, 1e-9, 0.0 });
    EXPECT_GT(beside.parameters[0], 3.9); // not on the seam: not moved
  }
}

TEST(Canonical, seamOfTheSecondParameter)
{
  const NurbsModel model = shapes::modelOf(shapes::torus(3.0, 1.0)); // v = 0 = 4 where z = 0, r = 4
  const ClosestPointSearch search(model);
  for (const double z : { -1e-14, 0.0, 1e-14 })
  {
    const Point3 q = { 4.2 * 0.6, 4.2 * 0.8, z };
    EXPECT_EQ(search.nearest(q).parameters[1], 0.0);
  }
}

TEST(Canonical, poleHasTheLowestParameter)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  for (const double z : { 1.0, 1.9, 2.0, 2.1, 5.0 })
  {
    for (const double side : { -1e-14, 0.0, 1e-14 })
    {
      for (const double pole : { -1.0, 1.0 })
      {
        const Point3 q = { 0.5 * side, side, pole * z };
        const ClosestPoint answer = search.nearest(q);
        reference::expectConsistent(model, search.modelSize(), q, answer);
        EXPECT_EQ(answer.parameters[0], 0.0) << z;
        EXPECT_NEAR(answer.point[2], 2.0 * pole, 1e-12 * search.modelSize()) << z;
      }
    }
  }
}

TEST(Canonical, closedEdgeStartsAtItsLowerParameter)
{
  NurbsModel model;
  model.edges.push_back(shapes::circle(2.0, 0.5));
  const ClosestPointSearch search(model);
  for (const Point3& q : pointsAbout({ 2.0, 0.0, 0.5 }, { 1.0, 0.0, 0.0 }))
  {
    EXPECT_EQ(search.nearest(q).parameters[0], model.edges[0].segments.front().t0);
  }
}

/// A power of two scales without rounding. (Once, Newton's method on curves crept where segments
/// were shorter than 3e-12.)
TEST(Sizes, answersOnCurvesScaleWithTheModel)
{
  NurbsModel unit;
  unit.edges.push_back(shapes::circle(1.0, 0.5));
  const double factor = std::ldexp(1.0, -45);
  NurbsModel small;
  small.edges.push_back(shapes::circle(factor, 0.5 * factor));
  const ClosestPointSearch searchUnit(unit);
  const ClosestPointSearch searchSmall(small);
  shapes::Random random(33);
  for (int i = 0; i < 100; ++i)
  {
    const Point3 q = random.point(2.0);
    ClosestPoint expected = searchUnit.nearest(q);
    expected.point = factor * expected.point;
    expected.distance *= factor;
    EXPECT_TRUE(sameBits(searchSmall.nearest(factor * q), expected));
  }
}

TEST(BadInput, isReported)
{
  NurbsModel model = shapes::modelOf(shapes::sphere(1.0));
  model.faces[0].patches[3].points.pop_back();
  EXPECT_THROW(ClosestPointSearch search(model), Error);
  model = shapes::modelOf(shapes::sphere(1.0));
  model.faces[0].patches[3].points[1][3] = 0.0;
  EXPECT_THROW(ClosestPointSearch search(model), Error);
  NurbsModel high;
  NurbsEdge edge;
  edge.segments = { { 0, 1, std::vector<ControlPoint>(27, ControlPoint{ 0, 0, 0, 1 }) } };
  high.edges.push_back(edge);
  EXPECT_THROW(ClosestPointSearch search(high), Error);
}

TEST(BadInput, nothingToFind)
{
  const NurbsModel empty;
  const ClosestPointSearch search(empty);
  EXPECT_FALSE(static_cast<bool>(search.nearest({ 0, 0, 0 }).entity));
  EXPECT_EQ(search.modelSize(), 0.0);
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch plate(model);
  EXPECT_FALSE(static_cast<bool>(plate.nearest({ std::nan(""), 0, 0 }).entity));
}

TEST(Degenerate, zeroLengthEdgeAndCollapsedPatch)
{
  NurbsModel model;
  model.vertices = { { { 1, 0, 0 }, {}, 0 }, { { 1, 0, 0 }, {}, 0 } };
  shapes::addLine(model, 0, 1);
  NurbsFace face; // all of it in one point
  face.patchesU = face.patchesV = 1;
  face.patches = { { 1, 1, 0, 1, 0, 1, std::vector<ControlPoint>(4, { 0, 0, 0, 1 }) } };
  model.faces.push_back(face);
  const ClosestPointSearch search(model);
  EXPECT_EQ(search.nearest({ 2, 1, 0 }).entity, (EntityId{ 0, 0 }));
  EXPECT_EQ(search.nearest({ -1, 0, 0 }).entity, (EntityId{ 2, 0 }));
  EXPECT_NEAR(search.nearest({ -1, 0, 0 }).distance, 1.0, 1e-12);
}

} // namespace
TEST(FirstFace, ofAVertexIsThatOfItsFirstEdgeWithOne)
{
  NurbsModel model;
  model.edges.resize(2);
  model.edges[1].faces = { 3 };
  model.vertices.resize(2);
  model.vertices[0].edges = { 0, 1 };
  EXPECT_EQ(firstFaceAt(model, { 0, 0 }), 3);
  EXPECT_EQ(firstFaceAt(model, { 0, 1 }), -1);
  EXPECT_EQ(firstFaceAt(model, { 1, 0 }), -1);
  EXPECT_EQ(firstFaceAt(model, { 2, 5 }), 5);
}

} // namespace cadrefine
