// Shapes whose closest points are known in closed form.
#include "Reference.h"
#include "Shapes.h"

#include <cadrefine/nurbs/TrimMeasure.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

using reference::expectConsistent;

constexpr double tolerance = 1e-9; // of the model's size

TEST(ClosedForms, sphereFromEverywhere)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  EXPECT_NEAR(search.modelSize(), 4.0 * std::sqrt(3.0), 0.4);
  shapes::Random random(1);
  for (int i = 0; i < 3000; ++i)
  {
    const Point3 q = random.point(i % 3 == 0 ? 20.0 : i % 3 == 1 ? 2.5 : 0.1);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    EXPECT_NEAR(answer.distance, std::abs(norm(q) - 2.0), tolerance * search.modelSize());
    EXPECT_TRUE(answer.converged);
  }
}

/// From where all of it is equally far away, but for rounding.
TEST(ClosedForms, sphereFromFarAway)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  shapes::Random random(1);
  for (const double away : { 1e5, 1e8, 1e10, 1e12, 1e16, 1e20, 1e50, 1e100 })
  {
    SearchScope near;
    near.maximumDistance = 0.5 * away;
    for (int i = 0; i < 20; ++i)
    {
      const Vector3 direction = normalized(random.point(1.0));
      const Point3 q = away * direction;
      const ClosestPoint answer = search.nearest(q);
      EXPECT_NEAR(dot(answer.point, direction), 2.0, 2e-8 * search.modelSize()) << away;
      EXPECT_NEAR(answer.distance / (away - 2.0), 1, 1e-12) << away;
      EXPECT_FALSE(search.nearest(q, near).entity) << away;
    }
  }
}

TEST(ClosedForms, centreOfSphere)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  for (const double offset : { 0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3 })
  {
    const Point3 q = { offset, -0.3 * offset, 0.7 * offset };
    const ClosestPoint answer = search.nearest(q);
    EXPECT_NEAR(answer.distance, 2.0 - norm(q), tolerance * search.modelSize()) << offset;
    EXPECT_TRUE(answer.converged) << offset;
  }
}

TEST(ClosedForms, polesOfSphere)
{
  const NurbsModel model = shapes::modelOf(shapes::sphere(2.0));
  const ClosestPointSearch search(model);
  for (const double offset : { 0.0, 1e-14, 1e-10, 1e-6, 1e-3, 0.05 })
  {
    for (const double z : { -5.0, -2.0, -1.9, 0.01, 1.9, 2.0, 2.1, 7.0 })
    {
      const Point3 q = { 0.6 * offset, -0.8 * offset, z };
      const ClosestPoint answer = search.nearest(q);
      EXPECT_NEAR(answer.distance, std::abs(norm(q) - 2.0), tolerance * search.modelSize())
        << offset << ' ' << z;
      EXPECT_TRUE(answer.converged) << offset << ' ' << z;
    }
  }
}

TEST(ClosedForms, axisOfCylinder)
{
  NurbsModel model = shapes::modelOf(shapes::cylinder(1.0, 0.0, 3.0));
  model.edges = { shapes::circle(1.0, 0.0), shapes::circle(1.0, 3.0) };
  model.edges[0].faces = model.edges[1].faces = { 0 };
  model.faces[0].edges = { 0, 1 };
  const ClosestPointSearch search(model);
  for (const double z : { 0.3, 1.0, 1.5, 2.123456789 })
  {
    for (const double x : { 0.0, 1e-13, 1e-9, 1e-6, 1e-3, 0.1 })
    {
      const ClosestPoint answer = search.nearest({ x, 0.5 * x, z });
      const double exact = 1.0 - std::hypot(x, 0.5 * x);
      EXPECT_NEAR(answer.distance, exact, tolerance * search.modelSize()) << x << ' ' << z;
      EXPECT_EQ(answer.entity, (EntityId{ 2, 0 }));
      EXPECT_TRUE(answer.converged) << x << ' ' << z;
    }
  }
  const ClosestPoint onRim = search.nearest({ 0.0, 0.0, 0.0 });
  EXPECT_EQ(onRim.entity, (EntityId{ 1, 0 }));
  const ClosestPoint below = search.nearest({ 0.0, 0.0, -1.0 });
  EXPECT_NEAR(below.distance, std::sqrt(2.0), tolerance * search.modelSize());
  EXPECT_EQ(below.entity, (EntityId{ 1, 0 }));
}

TEST(ClosedForms, torus)
{
  const NurbsModel model = shapes::modelOf(shapes::torus(3.0, 1.0));
  const ClosestPointSearch search(model);
  shapes::Random random(2);
  for (int i = 0; i < 2000; ++i)
  {
    const Point3 q = random.point(5.0);
    const double exact = std::abs(std::hypot(std::hypot(q[0], q[1]) - 3.0, q[2]) - 1.0);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    EXPECT_NEAR(answer.distance, exact, tolerance * search.modelSize());
  }
  for (int i = 0; i < 8; ++i) // on the circle of centres, where a whole circle is nearest
  {
    const ClosestPoint answer = search.nearest({ 3.0 * std::cos(i), 3.0 * std::sin(i), 0.0 });
    EXPECT_NEAR(answer.distance, 1.0, tolerance * search.modelSize());
    EXPECT_TRUE(answer.converged);
  }
  for (const double z : { 0.0, 0.5, 2.0 }) // and on the axis
  {
    const ClosestPoint answer = search.nearest({ 0.0, 0.0, z });
    EXPECT_NEAR(answer.distance, std::hypot(3.0, z) - 1.0, tolerance * search.modelSize());
    EXPECT_TRUE(answer.converged);
  }
}

TEST(ClosedForms, circleAlone)
{
  NurbsModel model;
  model.edges.push_back(shapes::circle(2.0, 0.5));
  const ClosestPointSearch search(model);
  shapes::Random random(3);
  for (int i = 0; i < 3000; ++i)
  {
    const Point3 q = random.point(3.0);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    const double exact = std::hypot(std::hypot(q[0], q[1]) - 2.0, q[2] - 0.5);
    EXPECT_NEAR(answer.distance, exact, tolerance * search.modelSize());
    EXPECT_EQ(answer.entity, (EntityId{ 1, 0 }));
    EXPECT_EQ(answer.parameters[1], 0.0);
  }
  const ClosestPoint centre = search.nearest({ 0.0, 0.0, 0.5 });
  EXPECT_NEAR(centre.distance, 2.0, tolerance * search.modelSize());
  EXPECT_TRUE(centre.converged);
}

TEST(ClosedForms, cusp)
{
  // (t^2, t^3) for t from -1 to 1: no speed at t = 0.
  NurbsModel model;
  NurbsEdge cusp;
  cusp.segments = { { -1, 1,
    { { 1, -1, 0, 1 }, { -1.0 / 3, 1, 0, 1 }, { -1.0 / 3, -1, 0, 1 }, { 1, 1, 0, 1 } } } };
  model.edges.push_back(cusp);
  const ClosestPointSearch search(model);
  const ClosestPoint tip = search.nearest({ -0.25, 0, 0 });
  EXPECT_NEAR(tip.distance, 0.25, tolerance * search.modelSize());
  shapes::Random random(5);
  for (int i = 0; i < 500; ++i)
  {
    const Point3 q = (i % 2 == 0 ? 1.0 : 1e-4) * random.point(1.5);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    EXPECT_TRUE(answer.converged);
    for (int k = -1000; k <= 1000; ++k)
    {
      const double t = std::copysign(std::pow(std::abs(k) * 1e-3, 2), k);
      const double sampled = distance(q, { t * t, t * t * t, 0 });
      EXPECT_LE(answer.distance, sampled + tolerance * search.modelSize());
    }
  }
}

/// Distance to the square [-2, 2]^2 at z = 0 with a hole of radius 1, and the dimension of the
/// nearest entity.
std::pair<double, int> plateDistance(const Point3& q)
{
  const double r = std::hypot(q[0], q[1]);
  if (r < 1.0)
  {
    return { std::hypot(1.0 - r, q[2]), 1 };
  }
  const double dx = std::max(std::abs(q[0]) - 2.0, 0.0);
  const double dy = std::max(std::abs(q[1]) - 2.0, 0.0);
  return { std::hypot(std::hypot(dx, dy), q[2]), dx > 0 && dy > 0 ? 0 : dx > 0 || dy > 0 ? 1 : 2 };
}

TEST(ClosedForms, plateWithHole)
{
  const NurbsModel model = shapes::plateWithHole();
  const ClosestPointSearch search(model);
  shapes::Random random(4);
  for (int i = 0; i < 5000; ++i)
  {
    Point3 q = random.point(3.0);
    q[2] *= i % 4 == 0 ? 0.0 : i % 4 == 1 ? 1e-3 : 1.0;
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    const auto [exact, dimension] = plateDistance(q);
    EXPECT_NEAR(answer.distance, exact, tolerance * search.modelSize());
    EXPECT_EQ(answer.entity.dimension, dimension);
  }
}

/// The half y >= 0 of the cylinder of radius 1 about the z axis, 1 <= z <= 2, cut by its loop out
/// of a longer full cylinder.
NurbsModel halfCylinder()
{
  NurbsModel model = shapes::modelOf(shapes::cylinder(1.0, 0.0, 4.0));
  model.faces[0].loops = { shapes::polygonLoop(
    { { 0, 0.25 }, { 2, 0.25 }, { 2, 0.5 }, { 0, 0.5 } }) };
  model.vertices = { { { 1, 0, 1 }, {}, 0 }, { { -1, 0, 1 }, {}, 0 }, { { -1, 0, 2 }, {}, 0 },
    { { 1, 0, 2 }, {}, 0 } };
  shapes::addLine(model, 0, 3);
  shapes::addLine(model, 1, 2);
  for (const double z : { 1.0, 2.0 })
  {
    NurbsEdge arc = shapes::circle(1.0, z);
    arc.segments.resize(2);
    arc.firstVertex = z < 1.5 ? 0 : 3;
    arc.lastVertex = z < 1.5 ? 1 : 2;
    model.edges.push_back(arc);
  }
  model.faces[0].edges = { 0, 1, 2, 3 };
  for (NurbsEdge& edge : model.edges)
  {
    edge.faces = { 0 };
  }
  return model;
}

TEST(ClosedForms, halfCylinderFromAllSides)
{
  const NurbsModel model = halfCylinder();
  const ClosestPointSearch search(model);
  shapes::Random random(5);
  for (int i = 0; i < 3000; ++i)
  {
    Point3 q = random.point(i % 2 == 0 ? 2.0 : 12.0);
    q[2] += 1.5;
    const double radial =
      q[1] >= 0 ? std::hypot(q[0], q[1]) - 1.0 : std::hypot(std::abs(q[0]) - 1.0, q[1]);
    const double axial = q[2] - std::clamp(q[2], 1.0, 2.0);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    EXPECT_NEAR(answer.distance, std::hypot(radial, axial), tolerance * search.modelSize());
    EXPECT_TRUE(answer.converged);
  }
}

/// The plate whose hole's edge has another radius than its trim curve. Edges know their trim
/// curves.
NurbsModel plateWithInexactHole(double edgeRadius)
{
  NurbsModel model = shapes::plateWithHole();
  model.edges[4] = shapes::circle(edgeRadius, 0);
  model.edges[4].faces = { 0 };
  for (int k = 0; k < 4; ++k)
  {
    model.faces[0].loops[0][k].edge = k;
    model.faces[0].loops[1][k].edge = 4;
  }
  for (NurbsFace& face : model.faces)
  {
    measureTrims(model, face);
  }
  return model;
}

/// The border of the face and the edge are both parts of the model, and the nearer is the answer.
TEST(ClosedForms, bordersBesideTheirEdges)
{
  for (const double edgeRadius : { 0.999, 1.001, 1 - 1e-6, 1 + 1e-6 })
  {
    const NurbsModel model = plateWithInexactHole(edgeRadius);
    EXPECT_NEAR(largestTrimDeviation(model), std::abs(edgeRadius - 1), 1e-12);
    const ClosestPointSearch search(model);
    shapes::Random random(6);
    for (int i = 0; i < 4000; ++i)
    {
      const double angle = 4 * random();
      const double radius = 1 + std::pow(10, 4 * random() - 5) * random();
      const double z = i % 3 == 0 ? 0 : std::pow(10, 4 * random() - 5) * random();
      const Point3 q{ radius * std::cos(angle), radius * std::sin(angle), z };
      const double toFace = std::hypot(std::min(radius - 1, 0.0), z);
      const double toEdge = std::hypot(radius - edgeRadius, z);
      const ClosestPoint answer = search.nearest(q);
      expectConsistent(model, search.modelSize(), q, answer);
      EXPECT_NEAR(answer.distance, std::min(toFace, toEdge), tolerance * search.modelSize());
      EXPECT_TRUE(answer.converged);
      // What lies outside by 1e-9 of the loops' extent counts as inside.
      const bool onBorder = radius < 1 - 1e-8 && toFace < toEdge - tolerance * search.modelSize();
      if (onBorder)
      {
        EXPECT_EQ(answer.entity, (EntityId{ 2, 0 }));
        EXPECT_EQ(answer.borderEdge, 4);
        EXPECT_NEAR(std::hypot(answer.parameters[0], answer.parameters[1]), 1, 1e-9);
      }
      else if (toEdge < toFace - tolerance * search.modelSize())
      {
        EXPECT_EQ(answer.entity, (EntityId{ 1, 4 }));
        EXPECT_EQ(answer.borderEdge, -1);
      }
    }
  }
}

/// On the unit sphere, where the loop is a circle of latitude and the edge lies beside it.
TEST(ClosedForms, bordersOfCurvedFacesBesideTheirEdges)
{
  const double latitude = 0.5; // z of the loop
  NurbsModel model = shapes::modelOf(shapes::sphere(1));
  NurbsFace& face = model.faces[0];
  const BezierPatch& last = face.patches.back();
  // The parameter v at which the sphere has that z, by bisection.
  double low = face.patches.front().v0;
  double high = last.v1;
  for (int i = 0; i < 100; ++i)
  {
    const double v = 0.5 * (low + high);
    (evaluate(patchAt(face, 0, v), 0, v)[2] < latitude ? low : high) = v;
  }
  face.loops = { shapes::polygonLoop({ { 0, low }, { 4, low }, { 4, last.v1 }, { 0, last.v1 } }) };
  face.loops[0][0].edge = 0;
  NurbsEdge rim = shapes::circle(std::sqrt(1 - latitude * latitude), latitude - 1e-4);
  rim.faces = { 0 };
  model.edges = { rim };
  face.edges = { 0 };
  const ClosestPointSearch search(model);
  shapes::Random random(7);
  for (int i = 0; i < 2000; ++i)
  {
    const double angle = 4 * random();
    const double z = latitude + std::pow(10, 2 * random() - 4) * random();
    const double radius = std::sqrt(1 - z * z);
    const Point3 q{ radius * std::cos(angle), radius * std::sin(angle), z };
    const double rimRadius = std::sqrt(1 - latitude * latitude);
    const double toBorder = z >= latitude ? 0 : std::hypot(radius - rimRadius, z - latitude);
    const double toEdge = std::hypot(radius - rimRadius, z - latitude + 1e-4);
    const ClosestPoint answer = search.nearest(q);
    expectConsistent(model, search.modelSize(), q, answer);
    EXPECT_NEAR(answer.distance, std::min(toBorder, toEdge), tolerance * search.modelSize());
  }
}

} // namespace
} // namespace cadrefine
