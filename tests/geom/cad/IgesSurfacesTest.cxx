// Surface entities of IGES, one file each, against their closed forms.

#include "IgesCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using namespace cadtest;
using cadrefine::Point3;

const double pi = std::acos(-1.0);
const double root = std::sqrt(0.5);

/// Cylinder of radius 2 round the z axis.
double cylinder(const Point3& p)
{
  return std::hypot(p[0], p[1]) - 2;
}

/// Radius 2 at z = 0, 1 at z = 2.
double cone(const Point3& p)
{
  return std::hypot(p[0], p[1]) - 2 + 0.5 * p[2];
}

double level(const Point3& p)
{
  return p[2] - 1;
}

double saddle(const Point3& p)
{
  return p[2] - p[0] * p[1];
}

/// Half of the cylinder, y >= 0, 0 <= z <= 3, as a rational surface: u along the arc, v along z,
/// both over (0, 1).
int addHalfCylinder(IgesWriter& f, const IgesAttributes& attributes = {})
{
  const std::array<double, 5> weights{ 1, root, 1, root, 1 };
  const std::array<double, 8> knots{ 0, 0, 0, 0.5, 0.5, 1, 1, 1 };
  std::vector<Point3> poles;
  for (const double z : { 0.0, 3.0 })
  {
    for (const Point3& p : { Point3{ 2, 0, z }, Point3{ 2, 2, z }, Point3{ 0, 2, z },
           Point3{ -2, 2, z }, Point3{ -2, 0, z } })
    {
      poles.push_back(p);
    }
  }
  return f.add(128,
    igesValues(4, 1, 2, 1, 0, 0, 0, 0, 0, knots, std::array<double, 4>{ 0, 0, 1, 1 }, weights,
      weights, poles, 0.0, 1.0, 0.0, 1.0),
    attributes);
}

/// The square -2 <= x, y <= 2 in the plane z = 1.
int addPlate(IgesWriter& f)
{
  return addBilinear(f, { { -2, -2, 1 }, { 2, -2, 1 }, { -2, 2, 1 }, { 2, 2, 1 } }, dependent());
}

/// Loop of curves on `surface` (142) given in space, in parameters, or both.
int addLoop(IgesWriter& f, int surface, int inParameters, int inSpace)
{
  const int preferred = inSpace == 0 ? 1 : inParameters == 0 ? 2 : 3;
  return f.add(142, igesValues(0, surface, inParameters, inSpace, preferred), dependent());
}

IgesAttributes inParameterSpace()
{
  IgesAttributes attributes = dependent();
  attributes.use = IgesUse::Parametric;
  return attributes;
}

/// Square of half-width `half` round the origin at height z, counterclockwise.
std::vector<Point3> corners(double half, double z)
{
  return { { -half, -half, z }, { half, -half, z }, { half, half, z }, { -half, half, z } };
}

/// The same square in the parameters of the plate.
int addParameterSquare(IgesWriter& f, double half)
{
  std::vector<Point3> points;
  for (const Point3& p : corners(half, 0))
  {
    points.push_back({ 0.25 * (p[0] + 2), 0.25 * (p[1] + 2), 0 });
  }
  return addPolygon(f, points, inParameterSpace());
}

const std::vector<IgesCase::Known> squareOne{ { { 0, 0, 2 }, 1 }, { { 3, 0, 1 }, 2 },
  { { 2, 2, 1 }, std::sqrt(2) } };
const std::vector<IgesCase::Known> halfCylinder{ { { 0, 4, 1 }, 2 }, { { 0, 0, 1 }, 2 },
  { { 0, -1, 0 }, std::sqrt(5) }, { { 0, 2, 5 }, 2 } };

/// Directrices of a half cone.
std::array<int, 2> addConeArcs(IgesWriter& f)
{
  return { addArc(f, 0, { 0, 0, 2, 0, -2, 0 }, dependent()),
    addArc(f, 2, { 0, 0, 1, 0, -1, 0 }, dependent()) };
}

const std::vector<IgesCase::Known> halfCone{ { { 0, 0, 4 }, std::sqrt(5) }, { { 0, 1.5, 1 }, 0 },
  { { 0, 5, 0 }, 3 }, { { 0, 1 + 2, 2 + 1 }, std::sqrt(5) } };

/// The unit cube as a solid with its edges, loops and faces: 502, 504, 508, 510, 514.
int addCube(IgesWriter& f, double low, double high)
{
  std::vector<Point3> vertices;
  for (int i = 0; i < 8; ++i)
  {
    const auto at = [&](int bit) { return (i >> bit & 1) ? high : low; };
    vertices.push_back({ at(0), at(1), at(2) });
  }
  const int vertexList = f.add(502, igesValues(8, vertices), dependent(1));
  IgesValues edges = igesValues(12);
  std::vector<std::array<int, 2>> ends;
  for (int a = 0; a < 8; ++a)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int b = a | 1 << axis;
      if (b != a)
      {
        const int line = addLine(f, vertices[a], vertices[b], dependent());
        appendTo(edges, line, vertexList, a + 1, vertexList, b + 1);
        ends.push_back({ a, b });
      }
    }
  }
  const int edgeList = f.add(504, edges, dependent(1));
  IgesValues shell = igesValues(6);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const int side : { 0, 1 })
    {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
      const int surface = addBilinear(f,
        { vertices[base], vertices[base | u], vertices[base | v], vertices[base | u | v] },
        dependent());
      std::vector<int> round{ base, base | u, base | u | v, base | v };
      if (side == 0)
      {
        std::reverse(round.begin(), round.end());
      }
      IgesValues loop = igesValues(4);
      for (int k = 0; k < 4; ++k)
      {
        const int from = round[k], to = round[(k + 1) % 4];
        const std::array<int, 2> edge{ std::min(from, to), std::max(from, to) };
        const auto index = std::find(ends.begin(), ends.end(), edge) - ends.begin();
        appendTo(loop, 0, edgeList, static_cast<int>(index) + 1, from < to ? 1 : 0, 0);
      }
      const int loopEntry = f.add(508, loop, dependent(1));
      appendTo(shell, f.add(510, igesValues(surface, 1, 1, loopEntry), dependent(1)), side);
    }
  }
  return f.add(514, shell, dependent(1));
}

double offCube(const Point3& p, double low, double high)
{
  double outside = 0, inside = high - low;
  for (const double x : p)
  {
    outside = std::hypot(outside, std::max({ low - x, x - high, 0.0 }));
    inside = std::min({ inside, std::abs(x - low), std::abs(x - high) });
  }
  return outside + inside;
}

class IgesSurfaces : public testing::TestWithParam<IgesCase>
{
};

const std::vector<IgesCase> surfaces{
  { "BoundedPlane108_1",
    [](IgesWriter& f)
    {
      const int polygon = addPolygon(f, corners(1, 1), dependent());
      f.add(108, igesValues(0.0, 0.0, 2.0, 2.0, polygon, 0.0, 0.0, 1.0, 0.0), withForm(1));
    },
    1, 4, level, squareOne },
  { "ParametricSplineSurface114",
    [](IgesWriter& f)
    {
      const double junk = 0;
      // x = s, y = t, z = s t over (0, 1) x (0, 2), in two patches along t.
      IgesValues values = igesValues(3, 1, 1, 2, 0.0, 1.0, 0.0, 1.0, 2.0);
      for (int i = 0; i < 2; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          std::array<double, 48> c{};
          c.fill(junk);
          const bool real = i < 1 && j < 2;
          c[0] = i; // x = i + s
          c[1] = 1;
          c[16] = j; // y = j + t
          c[20] = 1;
          c[32] = i * j; // z = (i + s)(j + t)
          c[33] = j;
          c[36] = i;
          c[37] = 1;
          appendTo(values, real ? c : std::array<double, 48>{});
        }
      }
      f.add(114, values);
    },
    1, 4, saddle, { { { 1, 3, 2 }, 1 }, { { -1, 0, 0 }, 1 } } },
  { "RuledByLength118_0", [](IgesWriter& f) { f.add(118, igesValues(addConeArcs(f), 0, 1)); }, 1, 4,
    cone, halfCone },
  { "RuledByParameter118_1",
    [](IgesWriter& f) { f.add(118, igesValues(addConeArcs(f), 0, 1), withForm(1)); }, 1, 4, cone,
    halfCone },
  { "RuledTurnedRound118_1",
    [](IgesWriter& f)
    {
      const int a = addLine(f, { 0, 0, 0 }, { 1, 0, 0 }, dependent());
      const int b = addLine(f, { 1, 1, 1 }, { 0, 1, 0 }, dependent());
      f.add(118, igesValues(a, b, 1, 0), withForm(1));
    },
    1, 4, saddle, { { { 1, 1, 3 }, 2 }, { { -1, 0, 0 }, 1 } } },
  { "Revolution120",
    [](IgesWriter& f)
    {
      const int axis = addLine(f, { 0, 0, 0 }, { 0, 0, 1 }, dependent());
      const int line = addLine(f, { 2, 0, 0 }, { 2, 0, 3 }, dependent());
      f.add(120, igesValues(axis, line, 0.0, pi));
    },
    1, 4, cylinder, halfCylinder },
  { "FullRevolution120",
    [](IgesWriter& f)
    {
      const int axis = addLine(f, { 0, 0, 0 }, { 0, 0, 1 }, dependent());
      const int line = addLine(f, { 2, 0, 0 }, { 1, 0, 2 }, dependent());
      f.add(120, igesValues(axis, line, 0.0, 2 * pi));
    },
    1, 3, cone, { { { 0, 0, 4 }, std::sqrt(5) }, { { 0, -5, 0 }, 3 } } },
  { "TabulatedCylinder122",
    [](IgesWriter& f)
    {
      const int arc = addArc(f, 0, { 0, 0, 2, 0, -2, 0 }, dependent());
      f.add(122, igesValues(arc, 2.0, 0.0, 3.0));
    },
    1, 4, cylinder, halfCylinder },
  { "RationalSplineSurface128", [](IgesWriter& f) { addHalfCylinder(f); }, 1, 4, cylinder,
    halfCylinder },
  { "OffsetSurface140",
    [](IgesWriter& f)
    {
      // The normal du x dv of the half cylinder of radius 2 points outward; the offset is inward.
      const int arc = addArc(f, 0, { 0, 0, 2, 0, -2, 0 }, dependent());
      const int base = f.add(122, igesValues(arc, 2.0, 0.0, 3.0), dependent());
      f.add(140, igesValues(Point3{ 0, 1, 0 }, -1.0, base));
    },
    1, 4, [](const Point3& p) { return std::hypot(p[0], p[1]) - 1; },
    { { { 0, 0, 1 }, 1 }, { { 0, 4, 1 }, 3 }, { { 0, 1, 5 }, 2 } } },
  { "OffsetAcrossKnots140",
    [](IgesWriter& f)
    {
      const int base = addHalfCylinder(f, dependent());
      f.add(140, igesValues(Point3{ 0, 1, 0 }, -1.0, base));
    },
    2, 7, [](const Point3& p) { return std::hypot(p[0], p[1]) - 1; },
    { { { 0, 0, 1 }, 1 }, { { 0, 4, 1 }, 3 }, { { 0, 1, 5 }, 2 } } },
  { "OffsetOfOffset140",
    [](IgesWriter& f)
    {
      const int arc = addArc(f, 0, { 0, 0, 2, 0, -2, 0 }, dependent());
      const int base = f.add(122, igesValues(arc, 2.0, 0.0, 3.0), dependent());
      const int inner = f.add(140, igesValues(Point3{ 0, 1, 0 }, 1.0, base), dependent());
      f.add(140, igesValues(Point3{ 0, 1, 0 }, -2.0, inner));
    },
    1, 4, [](const Point3& p) { return std::hypot(p[0], p[1]) - 1; },
    { { { 0, 0, 1 }, 1 }, { { 0, 4, 1 }, 3 }, { { 0, 1, 5 }, 2 } } },
  { "BoundedSurface143_1",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      const int space = addPolygon(f, corners(1, 1), dependent());
      const int parameters = addParameterSquare(f, 1);
      const int loop = f.add(141, igesValues(1, 3, plate, 1, space, 1, 1, parameters), dependent());
      f.add(143, igesValues(1, plate, 1, loop));
    },
    1, 4, level, squareOne },
  { "BoundedSurface143_0",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      const int space = addPolygon(f, corners(1, 1), dependent());
      const int loop = f.add(141, igesValues(0, 0, plate, 1, space, 1, 0), dependent());
      f.add(143, igesValues(0, plate, 1, loop));
    },
    1, 4, level, squareOne },
  { "TrimmedInSpace144",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      const int loop = addLoop(f, plate, 0, addPolygon(f, corners(1, 1), dependent()));
      f.add(144, igesValues(plate, 1, 0, loop));
    },
    1, 4, level, squareOne },
  { "TrimmedInParameters144",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      f.add(144, igesValues(plate, 1, 0, addLoop(f, plate, addParameterSquare(f, 1), 0)));
    },
    1, 4, level, squareOne },
  { "TrimmedInBoth144",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      const int space = addPolygon(f, corners(1, 1), dependent());
      f.add(144, igesValues(plate, 1, 0, addLoop(f, plate, addParameterSquare(f, 1), space)));
    },
    1, 4, level, squareOne },
  { "TrimmedWithAHole144",
    [](IgesWriter& f)
    {
      const int plate = addPlate(f);
      std::vector<Point3> hole = corners(1, 1);
      std::reverse(hole.begin(), hole.end());
      const int loop = addLoop(f, plate, 0, addPolygon(f, hole, dependent()));
      f.add(144, igesValues(plate, 0, 1, 0, loop));
    },
    1, 8, level, { { { 0, 0, 1 }, 1 }, { { 0, 0.5, 1 }, 0.5 }, { { 4, 0, 1 }, 2 } } },
  { "Cube186", [](IgesWriter& f) { f.add(186, igesValues(addCube(f, 0, 1), 1, 0), withForm(0)); },
    6, 12, [](const Point3& p) { return offCube(p, 0, 1); },
    { { { 0.5, 0.5, 0.5 }, 0.5 }, { { 2, 2, 2 }, std::sqrt(3) } } },
  { "CubeWithAVoid186",
    [](IgesWriter& f)
    {
      const int outer = addCube(f, 0, 4);
      const int inner = addCube(f, 1, 3);
      f.add(186, igesValues(outer, 1, 1, inner, 0));
    },
    12, 24, [](const Point3& p) { return std::min(offCube(p, 0, 4), offCube(p, 1, 3)); },
    { { { 2, 2, 2 }, 1 }, { { 2, 2, 0.25 }, 0.25 }, { { 6, 2, 2 }, 2 } } },
  { "Shell514", [](IgesWriter& f) { addCube(f, 0, 1); }, 6, 12,
    [](const Point3& p) { return offCube(p, 0, 1); }, { { { 0.5, 0.5, 0.5 }, 0.5 } } },
};

INSTANTIATE_TEST_SUITE_P(
  Entities, IgesSurfaces, testing::ValuesIn(surfaces), [](const auto& c) { return c.param.name; });

TEST_P(IgesSurfaces, isRead)
{
  IgesWriter file;
  GetParam().write(file);
  const auto model = readWritten(file);
  expectCase(*model, GetParam());
  EXPECT_TRUE(model->unread().empty());
}

} // namespace
