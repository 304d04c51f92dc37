// Patches of analytic surfaces agree with Open CASCADE's surfaces, parameter for parameter.

#include <cadrefine/cad/extraction/SurfaceConversion.h>

#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <gp_Ax3.hxx>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;

const gp_Ax3 rightHanded(gp_Pnt(1, -2, 3), gp_Dir(1, 2, -1), gp_Dir(0, 1, 2));

gp_Ax3 leftHanded()
{
  gp_Ax3 axes = rightHanded;
  axes.YReverse();
  return axes;
}

const BezierPatch& patchAt(const PatchGrid& grid, double u, double v)
{
  constexpr double rounding = 1e-12;
  for (const BezierPatch& patch : grid.patches)
  {
    if (u >= patch.u0 - rounding && u <= patch.u1 + rounding && v >= patch.v0 - rounding &&
        v <= patch.v1 + rounding)
    {
      return patch;
    }
  }
  throw std::runtime_error("no patch");
}

double largestDifference(const Handle(Geom_Surface) & surface, const ParameterBox& window)
{
  const ConvertedSurface converted = convertSurface(surface, window);
  constexpr int samples = 23;
  double largest = 0;
  for (int i = 0; i <= samples; ++i)
  {
    for (int j = 0; j <= samples; ++j)
    {
      const double u = window.u0 + (window.u1 - window.u0) * i / samples;
      const double v = window.v0 + (window.v1 - window.v0) * j / samples;
      const gp_Pnt expected = surface->Value(u, v);
      const double mappedU = converted.mapU(u);
      const double mappedV = converted.mapV(v);
      const Point3 p = evaluate(patchAt(converted.grid, mappedU, mappedV), mappedU, mappedV);
      largest = std::max(largest, distance(p, { expected.X(), expected.Y(), expected.Z() }));
    }
  }
  return largest;
}

void expectSame(
  const Handle(Geom_Surface) & surface, const ParameterBox& window, double tolerance = 2e-13)
{
  EXPECT_LT(largestDifference(surface, window), tolerance)
    << surface->DynamicType()->Name() << " over " << window.u0 << ".." << window.u1 << " x "
    << window.v0 << ".." << window.v1;
}

TEST(SurfaceConversion, elementary)
{
  for (const gp_Ax3& axes : { rightHanded, leftHanded() })
  {
    expectSame(new Geom_Plane(axes), { -3, 4, -1, 7 });
    expectSame(new Geom_CylindricalSurface(axes, 2), { 0.3, 2 * M_PI + 0.3, -1, 7 });
    expectSame(new Geom_CylindricalSurface(axes, 2), { -1, 0.4, -1, 7 });
    expectSame(new Geom_ConicalSurface(axes, 0.4, 2), { 1, 6, 0, 4 });
    expectSame(new Geom_SphericalSurface(axes, 3), { 0, 2 * M_PI, -M_PI / 2, M_PI / 2 });
    expectSame(new Geom_SphericalSurface(axes, 3), { 5, 7.5, -0.3, 1.1 });
    expectSame(new Geom_ToroidalSurface(axes, 4, 1), { 0, 2 * M_PI, 0, 2 * M_PI });
    expectSame(new Geom_ToroidalSurface(axes, 4, 1), { 2, 3, -1, 4 });
  }
}

TEST(SurfaceConversion, swept)
{
  TColgp_Array1OfPnt poles(1, 4);
  poles(1) = gp_Pnt(1, 0, 0);
  poles(2) = gp_Pnt(2, 0, 1);
  poles(3) = gp_Pnt(1, 1, 2);
  poles(4) = gp_Pnt(3, 0, 3);
  const Handle(Geom_Curve) spline = new Geom_BezierCurve(poles);
  const Handle(Geom_Curve) ellipse = new Geom_Ellipse(rightHanded.Ax2(), 3, 1);
  const gp_Ax1 axis(gp_Pnt(-6, 0, 0), gp_Dir(0, 0.1, 1));
  expectSame(new Geom_SurfaceOfRevolution(spline, axis), { -1, 4, 0.2, 1 });
  expectSame(new Geom_SurfaceOfRevolution(ellipse, axis), { 0, 2 * M_PI, 0.5, 5 });
  expectSame(new Geom_SurfaceOfLinearExtrusion(spline, gp_Dir(1, 1, 1)), { 0, 1, -2, 5 });
  expectSame(new Geom_SurfaceOfLinearExtrusion(ellipse, gp_Dir(1, 1, 1)), { 1, 7, -2, 5 });
}

TEST(SurfaceConversion, approximatedWhereThereIsNoExactForm)
{
  const Handle(Geom_Curve) hyperbola = new Geom_Hyperbola(rightHanded.Ax2(), 2, 1);
  expectSame(new Geom_SurfaceOfLinearExtrusion(hyperbola, gp_Dir(1, 1, 1)), { -1, 1, -2, 5 }, 1e-8);
  TColgp_Array1OfPnt poles(1, 3);
  poles(1) = gp_Pnt(0, 0, 0);
  poles(2) = gp_Pnt(2, 0, 1);
  poles(3) = gp_Pnt(4, 0, 0);
  const Handle(Geom_Surface) arch =
    new Geom_SurfaceOfLinearExtrusion(new Geom_BezierCurve(poles), gp_Dir(0, 1, 0));
  expectSame(new Geom_OffsetSurface(arch, 0.2), { 0, 1, 0, 3 }, 1e-8);
}

TEST(SurfaceConversion, loopsFollowTheMaps)
{
  const ParameterMap angles = ParameterMap::ofAngles({ 0, 1.2, 2.4, 3.6 });
  const TrimLoop slanted{ { { { 0.1, 0, 1 }, { 3.5, 2, 1 } } } };
  const auto mapped = mapLoops({ slanted }, angles, {});
  ASSERT_EQ(mapped.size(), 1u);
  Point2 last{ angles(0.1), 0 };
  for (const BezierCurve2& piece : mapped[0])
  {
    const auto& front = piece.points.front();
    EXPECT_EQ(front[0], last[0]);
    EXPECT_EQ(front[1], last[1]);
    last = { piece.points.back()[0], piece.points.back()[1] };
    double u = 0;
    double v = 0; // the value in the middle
    const double binomial[8] = { 1, 7, 21, 35, 35, 21, 7, 1 };
    for (int i = 0; i < 8; ++i)
    {
      u += binomial[i] / 128 * piece.points[i][0];
      v += binomial[i] / 128 * piece.points[i][1];
    }
    EXPECT_NEAR(u, angles(0.1 + 3.4 * v / 2), 1e-9);
  }
  EXPECT_EQ(last[0], angles(3.5));
  EXPECT_LT(mapped[0].size(), 20u);
}

TEST(SurfaceConversion, loopsAlongParameterLinesStayStraight)
{
  const ParameterMap angles = ParameterMap::ofAngles({ 0, 1.2, 2.4 });
  const TrimLoop loop{ { { { 0, 0, 1 }, { 2.4, 0, 1 } } }, { { { 2.4, 0, 1 }, { 2.4, 5, 1 } } },
    { { { 2.4, 5, 1 }, { 0, 5, 1 } } }, { { { 0, 5, 1 }, { 0, 0, 1 } } } };
  const auto mapped = mapLoops({ loop }, angles, {});
  EXPECT_EQ(mapped[0].size(), 4u);
  EXPECT_TRUE(followsBorder(mapped, { 0, 2.4, 0, 5 }));
}

} // namespace
