// Triangles round a hole of three circular arcs (see data/three_arcs.py for their closed forms).

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace cadrefine;

struct Arc
{
  Point3 centre;
  double radius;
};

const std::array<Arc, 3> arcs{ { { { 2, 3.75, 0 }, 4.25 }, { { -0.8125, -2.25, 0 }, 5.3125 },
  { { 2, 1.5, 0 }, 2.5 } } };
constexpr double sizeOfModel = 5;

double distanceToArc(const Arc& arc, const Point3& point)
{
  return std::abs(distance(arc.centre, point) - arc.radius);
}

/// The arc on which all of these points lie, or null.
const Arc* arcThrough(const std::vector<Point3>& points)
{
  for (const Arc& arc : arcs)
  {
    if (std::all_of(points.begin(), points.end(),
          [&](const Point3& p) { return distanceToArc(arc, p) <= 1e-12 * sizeOfModel; }))
    {
      return &arc;
    }
  }
  return nullptr;
}

/// Whether all of these points lie on one side of the outer square.
bool onSquare(const std::vector<Point3>& side)
{
  const auto on = [&](int k, double value)
  {
    return std::all_of(
      side.begin(), side.end(), [&](const Point3& p) { return std::abs(p[k] - value) < 1e-12; });
  };
  return on(0, -3) || on(0, 6) || on(1, -4) || on(1, 5);
}

class ThreeArcs : public testing::TestWithParam<const char*>
{
protected:
  cadtest::FilterRun filters{ std::string(CADREFINE_DATA) + GetParam() };
  vtkSmartPointer<vtkUnstructuredGrid> coarse =
    cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu");

  cadtest::FilterRun::Data refined(int steps) const
  {
    auto data = filters.measure(filters.project(coarse), 4);
    for (int step = 0; step < steps; ++step)
    {
      data = filters.measure(filters.refineWhereErrorExceeds(data, 1e-5), 4);
    }
    return data;
  }

  /// Sides on the hole, as point coordinates.
  static std::vector<std::vector<Point3>> holeSides(const Mesh& mesh)
  {
    std::vector<std::vector<Point3>> sides;
    EXPECT_TRUE(cadtest::isWatertight(mesh,
      [&](const std::vector<Point3>& side)
      {
        const bool onHole = arcThrough(side) != nullptr;
        if (onHole)
        {
          sides.push_back(side);
        }
        return onHole || onSquare(side);
      }));
    return sides;
  }
};

INSTANTIATE_TEST_SUITE_P(Files, ThreeArcs,
  testing::Values("/three_arcs.igs", "/three_arcs_nurbs.igs"),
  [](const auto& file)
  { return std::string(file.param).find("nurbs") == std::string::npos ? "Arcs" : "Nurbs"; });

TEST_P(ThreeArcs, boundaryLiesOnTheArcsAfterLocalRefinement)
{
  for (const int steps : { 0, 3, 8 })
  {
    const auto data = refined(steps);
    const Mesh mesh = cadtest::toMesh(data);
    EXPECT_TRUE(cadtest::isValid(mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
    EXPECT_GE(holeSides(mesh).size(), steps == 8 ? 40u : 10u);
    EXPECT_EQ(cadtest::fieldValue(filters.refineStraight(data), "InvalidCells"), 0);
  }
}

TEST_P(ThreeArcs, cornersHaveAVertexEach)
{
  const Mesh mesh = cadtest::toMesh(filters.project(coarse));
  for (const Point3& corner : { Point3{ 0, 0, 0 }, Point3{ 4, 0, 0 }, Point3{ 0, 3, 0 } })
  {
    EXPECT_EQ(std::count_if(mesh.points.begin(), mesh.points.end(),
                [&](const Point3& p) { return distance(p, corner) < 1e-12 * sizeOfModel; }),
      1);
  }
}

/// A chord of length c of a circle of radius r cuts off r^2 (a - sin a) / 2, a = 2 asin(c / 2r).
TEST_P(ThreeArcs, errorIsTheAreaOfTheSegmentsAtDepthFour)
{
  for (const int steps : { 0, 2 })
  {
    const auto data = refined(steps);
    double area = 0;
    for (const auto& side : holeSides(cadtest::toMesh(data)))
    {
      const double radius = arcThrough(side)->radius;
      const double angle = 2 * std::asin(distance(side[0], side[1]) / (2 * radius));
      area += radius * radius * (angle - std::sin(angle)) / 2;
    }
    EXPECT_NEAR(cadtest::fieldValue(data, "GlobalGeometricError"), area, 0.01 * area);
    EXPECT_GT(area, 0);
  }
}

TEST_P(ThreeArcs, uniformRefinementQuartersTheError)
{
  auto data = filters.measure(filters.project(coarse), 4);
  for (int level = 0; level < 3; ++level)
  {
    const double before = cadtest::fieldValue(data, "GlobalGeometricError");
    data = filters.measure(filters.refineUniformly(data), 4);
    const double factor = before / cadtest::fieldValue(data, "GlobalGeometricError");
    EXPECT_GT(factor, 3.6);
    EXPECT_LT(factor, 4.4);
  }
}

} // namespace
