// Shapes whose closest points are known in closed form, in every format.

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <gp_Ax2.hxx>

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

namespace
{

using namespace cadrefine;

class AnalyticShapes : public testing::TestWithParam<const char*>
{
protected:
  std::shared_ptr<const CADModel> roundTrip(const TopoDS_Shape& shape) const
  {
    const std::string path = this->folder.file(std::string("shape") + GetParam());
    cadtest::writeShape(shape, path);
    return readCADFile(path);
  }

  cadtest::TemporaryFolder folder;
};

INSTANTIATE_TEST_SUITE_P(Formats, AnalyticShapes, testing::Values(".brep", ".step", ".igs"),
  [](const auto& format) { return std::string(format.param + 1); });

void expectDistances(const CADModel& model, const Point3& low, const Point3& high,
  const std::function<double(const Point3&)>& distanceTo)
{
  // IGES keeps approximated trim curves of circles; the edges' tolerances tell how good they are.
  double tolerance = 1e-9 * model.size();
  for (const NurbsEdge& edge : model.nurbs().edges)
  {
    tolerance = std::max(tolerance, edge.tolerance > 1e-7 ? edge.tolerance : 0);
  }
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i)
  {
    Point3 p;
    for (int k = 0; k < 3; ++k)
    {
      p[k] = low[k] + unit(generator) * (high[k] - low[k]);
    }
    const ClosestPoint closest = model.nearest(p);
    EXPECT_NEAR(closest.distance, distanceTo(p), tolerance) << "point " << i;
    EXPECT_NEAR(distance(closest.point, p), closest.distance, 1e-12 * model.size());
    if (closest.entity.dimension > 0)
    {
      const Point3 again = model.evaluate(closest.entity, closest.parameters);
      EXPECT_LT(distance(again, closest.point), 1e-12 * model.size()) << "point " << i;
    }
  }
}

int countSharp(const CADModel& model)
{
  int count = 0;
  for (const NurbsEdge& edge : model.nurbs().edges)
  {
    count += edge.sharp ? 1 : 0;
  }
  return count;
}

void expectCounts(const CADModel& model, int faces, int edges, int vertices)
{
  EXPECT_EQ(model.count(2), faces);
  EXPECT_EQ(model.count(1), edges);
  EXPECT_EQ(model.count(0), vertices);
  EXPECT_TRUE(model.unread().empty());
}

TEST_P(AnalyticShapes, sphere)
{
  const Point3 center{ 1, 2, 3 };
  const double radius = 2.5;
  const auto model = this->roundTrip(BRepPrimAPI_MakeSphere(gp_Pnt(1, 2, 3), radius).Shape());
  expectCounts(*model, 1, 1, 2);
  EXPECT_EQ(countSharp(*model), 0);
  EXPECT_TRUE(model->nurbs().faces[0].loops.empty()) << "a whole sphere needs no trimming";
  EXPECT_NEAR(model->size(), 2 * radius * std::sqrt(3.0), 1e-5);
  expectDistances(*model, { -4, -3, -2 }, { 6, 7, 8 },
    [&](const Point3& p) { return std::abs(distance(p, center) - radius); });
}

TEST_P(AnalyticShapes, sphereNormalsPointOutwardAlsoAtThePoles)
{
  const Point3 center{ 1, 2, 3 };
  const auto model = this->roundTrip(BRepPrimAPI_MakeSphere(gp_Pnt(1, 2, 3), 2.5).Shape());
  const NurbsFace& face = model->nurbs().faces.at(0);
  const BezierPatch& first = face.patches.front();
  const BezierPatch& last = face.patches.back();
  for (const double s : { 0.0, 0.1, 0.5, 0.77, 1.0 })
  {
    for (const double t : { 0.0, 0.2, 0.5, 0.9, 1.0 })
    {
      const double u = first.u0 + s * (last.u1 - first.u0);
      const double v = first.v0 + t * (last.v1 - first.v0);
      const Vector3 expected = normalized(model->evaluate({ 2, 0 }, { u, v }) - center);
      EXPECT_LT(norm(model->normal(0, { u, v }) - expected), 1e-5) << s << " " << t;
    }
  }
}

TEST_P(AnalyticShapes, torus)
{
  const auto model = this->roundTrip(BRepPrimAPI_MakeTorus(3, 1).Shape());
  expectCounts(*model, 1, 2, 1);
  EXPECT_EQ(countSharp(*model), 0);
  expectDistances(*model, { -5, -5, -2 }, { 5, 5, 2 },
    [](const Point3& p) { return std::abs(std::hypot(std::hypot(p[0], p[1]) - 3, p[2]) - 1); });
}

TEST_P(AnalyticShapes, cylinderWithSharpRims)
{
  const auto model = this->roundTrip(BRepPrimAPI_MakeCylinder(2, 5).Shape());
  expectCounts(*model, 3, 3, 2);
  EXPECT_EQ(countSharp(*model), 2);
  expectDistances(*model, { -4, -4, -2 }, { 4, 4, 7 },
    [](const Point3& p)
    {
      const double r = std::hypot(p[0], p[1]) - 2;
      const double z = std::max(-p[2], p[2] - 5);
      return r <= 0 && z <= 0 ? -std::max(r, z) : std::hypot(std::max(r, 0.0), std::max(z, 0.0));
    });
}

TEST_P(AnalyticShapes, coneWithApex)
{
  const auto model = this->roundTrip(BRepPrimAPI_MakeCone(2, 0, 2).Shape());
  expectCounts(*model, 2, 2, 2);
  const ClosestPoint tip = model->nearest({ 0, 0, 3 });
  EXPECT_EQ(tip.entity.dimension, 0);
  EXPECT_NEAR(tip.distance, 1, 1e-12);
  const ClosestPoint side = model->nearest({ 2, 0, 2 });
  EXPECT_NEAR(side.distance, std::sqrt(2.0), 1e-9);
}

TEST_P(AnalyticShapes, boxWithHole)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  const gp_Ax2 axis(gp_Pnt(5, 5, -1), gp_Dir(0, 0, 1));
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(axis, 2, 12).Shape();
  const auto model = this->roundTrip(BRepAlgoAPI_Cut(box, drill).Shape());
  expectCounts(*model, 7, 15, 10);
  EXPECT_EQ(countSharp(*model), 14) << "all but the hole's seam";
  EXPECT_NEAR(model->nearest({ 5.5, 5, 5 }).distance, 1.5, 1e-9);
  EXPECT_NEAR(model->nearest({ 5, 5, 13 }).distance, std::hypot(3, 2), 1e-9) << "over the hole";
  EXPECT_NEAR(model->nearest({ 1, 1, 12 }).distance, 2, 1e-12);
  EXPECT_NEAR(model->nearest({ -1, -1, -1 }).distance, std::sqrt(3.0), 1e-12);
  for (int f = 0; f < model->count(2); ++f)
  {
    const auto& patches = model->nurbs().faces[f].patches;
    const double u = patches.front().u0 + 0.3 * (patches.back().u1 - patches.front().u0);
    const double v = patches.front().v0 + 0.02 * (patches.back().v1 - patches.front().v0);
    const Point3 p = model->evaluate({ 2, f }, { u, v });
    const Vector3 n = model->normal(f, { u, v });
    const bool inHole = std::hypot(p[0] - 5, p[1] - 5) < 2.001;
    const Vector3 outward = inHole ? Point3{ 5, 5, p[2] } - p : p - Point3{ 5, 5, 5 };
    EXPECT_GT(dot(n, outward), 0) << "face " << f;
  }
}

TEST_P(AnalyticShapes, closureFollowsTheTopology)
{
  const auto model = this->roundTrip(BRepPrimAPI_MakeBox(1, 2, 3).Shape());
  expectCounts(*model, 6, 12, 8);
  for (const NurbsFace& face : model->nurbs().faces)
  {
    std::set<std::int32_t> vertices;
    for (const std::int32_t e : face.edges)
    {
      const NurbsEdge& edge = model->nurbs().edges[e];
      vertices.insert({ edge.firstVertex, edge.lastVertex });
    }
    EXPECT_EQ(face.edges.size(), 4u);
    EXPECT_EQ(vertices.size(), 4u);
  }
  for (const NurbsEdge& edge : model->nurbs().edges)
  {
    EXPECT_EQ(edge.faces.size(), 2u);
    EXPECT_TRUE(edge.sharp);
  }
  for (const NurbsVertex& vertex : model->nurbs().vertices)
  {
    EXPECT_EQ(vertex.edges.size(), 3u);
  }
}

} // namespace
