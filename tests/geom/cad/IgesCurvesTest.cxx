// Curve entities of IGES, one file each, against their closed forms.

#include "IgesCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace cadtest;
using cadrefine::Point3;

double offCircle(const Point3& p, const Point3& centre, double radius)
{
  return std::hypot(std::hypot(p[0] - centre[0], p[1] - centre[1]) - radius, p[2] - centre[2]);
}

double circle(const Point3& p)
{
  return offCircle(p, { 1, 2, 3 }, 2);
}

/// Distance from the polyline (0,0,1), (2,0,1), (2,3,1).
double angle(const Point3& p)
{
  const double first = std::hypot(p[0] - std::clamp(p[0], 0.0, 2.0), p[1]);
  const double second = std::hypot(p[0] - 2, p[1] - std::clamp(p[1], 0.0, 3.0));
  return std::hypot(std::min(first, second), p[2] - 1);
}

double square(const Point3& p)
{
  const double outside =
    std::hypot(std::max(std::abs(p[0]) - 1, 0.0), std::max(std::abs(p[1]) - 1, 0.0));
  const double inside = std::max(1 - std::max(std::abs(p[0]), std::abs(p[1])), 0.0);
  return std::hypot(outside + inside, p[2] - 1);
}

const double root = std::sqrt(0.5);

class IgesCurves : public testing::TestWithParam<IgesCase>
{
};

const std::vector<IgesCase> curves{
  { "CircularArc100",
    [](IgesWriter& f) {
      addArc(f, 3, { 1, 2, 3, 2, -1, 2 });
    },
    0, 1, circle, { { { 1, 5, 3 }, 1 }, { { 1, -1, 3 }, std::hypot(2, 3) } } },
  { "FullCircle100",
    [](IgesWriter& f) {
      addArc(f, 3, { 1, 2, 3, 2, 3, 2 });
    },
    0, 1, circle, { { { 1, -1, 3 }, 1 }, { { 1, 2, 4 }, std::sqrt(5) } } },
  { "Composite102",
    [](IgesWriter& f)
    {
      const int arc = addArc(f, 3, { 1, 2, 3, 2, -1, 2 }, dependent());
      const int line = addLine(f, { -1, 2, 3 }, { -1, 0, 3 }, dependent());
      f.add(102, igesValues(2, arc, line));
    },
    0, 2,
    [](const Point3& p)
    { return p[1] > 2 ? circle(p) : std::hypot(p[0] + 1, p[2] - 3) * (p[0] > 2.9 ? 0 : 1); },
    { { { 1, 5, 3 }, 1 }, { { -3, 1, 3 }, 2 }, { { -1, -2, 3 }, 2 } } },
  { "Ellipse104",
    [](IgesWriter& f)
    {
      f.add(
        104, igesValues(1.0 / 9, 0.0, 0.25, 0.0, 0.0, -1.0, 1.0, 3.0, 0.0, 0.0, 2.0), withForm(1));
    },
    0, 1,
    [](const Point3& p)
    { return std::abs(p[0] * p[0] / 9 + p[1] * p[1] / 4 - 1) + std::abs(p[2] - 1); },
    { { { 5, 0, 1 }, 2 }, { { 0, 4, 1 }, 2 }, { { 3, -1, 1 }, 1 }, { { -2, 2, 1 }, 2 } } },
  { "Hyperbola104",
    [](IgesWriter& f)
    {
      const double x = 2 * std::cosh(1), y = std::sinh(1);
      f.add(104, igesValues(0.25, 0.0, -1.0, 0.0, 0.0, -1.0, 1.0, x, -y, x, y), withForm(2));
    },
    0, 1,
    [](const Point3& p)
    { return std::abs(p[0] * p[0] / 4 - p[1] * p[1] - 1) + std::abs(p[2] - 1); },
    { { { 1, 0, 1 }, 1 }, { { 2, 0, 3 }, 2 } } },
  { "Parabola104",
    [](IgesWriter& f) {
      f.add(104, igesValues(0.0, 0.0, 1.0, -4.0, 0.0, 0.0, 1.0, 1.0, -2.0, 1.0, 2.0), withForm(3));
    },
    0, 1, [](const Point3& p) { return std::abs(p[1] * p[1] - 4 * p[0]) + std::abs(p[2] - 1); },
    { { { -2, 0, 1 }, 2 }, { { 1, 3, 1 }, 1 } } },
  { "PlanarPath106_11",
    [](IgesWriter& f)
    { f.add(106, igesValues(1, 3, 1.0, 0.0, 0.0, 2.0, 0.0, 2.0, 3.0), withForm(11)); },
    0, 2, angle, { { { 1, -1, 1 }, 1 }, { { 2, 5, 1 }, 2 }, { { 3, 0, 1 }, 1 } } },
  { "Path106_12",
    [](IgesWriter& f)
    { f.add(106, igesValues(2, 3, 0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 3.0, 1.0), withForm(12)); },
    0, 2, angle, { { { 1, -1, 1 }, 1 }, { { 2, 5, 1 }, 2 } } },
  { "PathWithVectors106_13",
    [](IgesWriter& f)
    {
      const Point3 v{ 0, 0, 1 };
      f.add(106, igesValues(3, 3, Point3{ 0, 0, 1 }, v, Point3{ 2, 0, 1 }, v, Point3{ 2, 3, 1 }, v),
        withForm(13));
    },
    0, 2, angle, { { { 1, -1, 1 }, 1 }, { { 2, 5, 1 }, 2 } } },
  { "ClosedPath106_63",
    [](IgesWriter& f)
    {
      f.add(106, igesValues(1, 5, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0, -1.0),
        withForm(63));
    },
    0, 4, square, { { { 0, 0, 1 }, 1 }, { { -3, 0, 1 }, 2 } } },
  { "Line110",
    [](IgesWriter& f) {
      addLine(f, { 0, 1, 2 }, { 4, 1, 2 });
    },
    0, 1, [](const Point3& p) { return std::hypot(p[1] - 1, p[2] - 2); },
    { { { 2, 2, 2 }, 1 }, { { 6, 1, 2 }, 2 } } },
  { "Spline112",
    [](IgesWriter& f)
    {
      // x = s, y = s^2, z = s^3 on (0, 1), then the same cubic, from s = 1, on (1, 2).
      f.add(112, igesValues(3, 3, 3, 2, 0.0, 1.0, 2.0,                            // breakpoints
                   0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0,    // from 0
                   1.0, 1.0, 0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 3.0, 3.0, 1.0,    // from 1
                   2.0, 1.0, 0.0, 0.0, 4.0, 4.0, 1.0, 0.0, 8.0, 12.0, 6.0, 1.0)); // the end
    },
    0, 1, [](const Point3& p) { return std::hypot(p[1] - p[0] * p[0], p[2] - p[0] * p[1]); },
    { { { -1, 0, 0 }, 1 }, { { 0, 0, -3 }, 3 } } },
  { "RationalSpline126",
    [](IgesWriter& f)
    {
      f.add(126,
        igesValues(2, 2, 1, 0, 0, 0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, root, 1.0,
          Point3{ 3, 2, 3 }, Point3{ 3, 4, 3 }, Point3{ 1, 4, 3 }, 0.0, 1.0, Point3{ 0, 0, 1 }));
    },
    0, 1, circle, { { { 1 + 3 * root, 2 + 3 * root, 3 }, 1 }, { { 1, 1, 3 }, std::sqrt(5) } } },
  { "OffsetOfArc130",
    [](IgesWriter& f)
    {
      // Normal x tangent points to the centre: radius 2 is 3 less 1.
      const int arc = addArc(f, 3, { 1, 2, 4, 2, -2, 2 }, dependent());
      f.add(130,
        igesValues(arc, 1, 0, 0, 0, 1.0, 0.0, 0.0, 0.0, Point3{ 0, 0, 1 }, 0.0, std::acos(-1.0)));
    },
    0, 1, circle, { { { 1, 5, 3 }, 1 }, { { 1, -1, 3 }, std::hypot(2, 3) } } },
};

INSTANTIATE_TEST_SUITE_P(
  Entities, IgesCurves, testing::ValuesIn(curves), [](const auto& c) { return c.param.name; });

TEST_P(IgesCurves, isRead)
{
  IgesWriter file;
  GetParam().write(file);
  const auto model = readWritten(file);
  expectCase(*model, GetParam());
  EXPECT_TRUE(model->unread().empty());
}

} // namespace
