#include "aeroplane_splines.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BSplCLib.hxx>
#include <ShapeAnalysis_FreeBounds.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>

#include <cmath>
#include <stdexcept>

namespace aeroplane
{
namespace
{

constexpr int degree = 3;
constexpr double sewingTolerance = 1e-6;

/// Parameter and order of derivative of each condition of the interpolation.
struct Condition
{
  double parameter;
  int derivative;
};

std::vector<Condition> conditions(const Stations& knots)
{
  std::vector<Condition> list{ { knots.front(), 0 }, { knots.front(), 1 } };
  for (std::size_t i = 1; i + 1 < knots.size(); ++i)
  {
    list.push_back({ knots[i], 0 });
  }
  list.push_back({ knots.back(), 1 });
  list.push_back({ knots.back(), 0 });
  return list;
}

/// Turns values and derivatives under `conditions(knots)` into poles.
void solve(const Stations& knots, TColgp_Array1OfPnt& data)
{
  const std::vector<Condition> list = conditions(knots);
  const int count = static_cast<int>(list.size());
  TColStd_Array1OfReal parameters(1, count), flat(1, count + degree + 1);
  TColStd_Array1OfInteger derivatives(1, count);
  for (int i = 1; i <= count; ++i)
  {
    parameters(i) = list[i - 1].parameter;
    derivatives(i) = list[i - 1].derivative;
  }
  for (int i = 1; i <= flat.Upper(); ++i)
  {
    const int last = static_cast<int>(knots.size()) - 1;
    flat(i) = knots[std::min(std::max(i - 1 - degree, 0), last)];
  }
  int problem = 0;
  BSplCLib::Interpolate(degree, flat, parameters, derivatives, data, problem);
  if (problem != 0)
  {
    throw std::runtime_error("a spline cannot be interpolated");
  }
}

/// Derivative of `function` by central differences; the step is small beside the stations'.
gp_XYZ evaluate(const SurfaceFunction& function, const Condition& u, const Condition& v)
{
  constexpr double step = 1e-4;
  if (u.derivative == 1)
  {
    return (evaluate(function, { u.parameter + step, 0 }, v) -
             evaluate(function, { u.parameter - step, 0 }, v)) /
           (2 * step);
  }
  if (v.derivative == 1)
  {
    return (function(u.parameter, v.parameter + step) - function(u.parameter, v.parameter - step)) /
           (2 * step);
  }
  return function(u.parameter, v.parameter);
}

TColStd_Array1OfReal knotArray(const Stations& knots)
{
  TColStd_Array1OfReal array(1, static_cast<int>(knots.size()));
  for (int i = 1; i <= array.Upper(); ++i)
  {
    array(i) = knots[i - 1];
  }
  return array;
}

TColStd_Array1OfInteger clamped(const Stations& knots)
{
  TColStd_Array1OfInteger multiplicities(1, static_cast<int>(knots.size()));
  multiplicities.Init(1);
  multiplicities(1) = degree + 1;
  multiplicities(multiplicities.Upper()) = degree + 1;
  return multiplicities;
}

TopoDS_Shape sew(const std::vector<TopoDS_Shape>& shapes)
{
  BRepBuilderAPI_Sewing sewing(sewingTolerance);
  for (const TopoDS_Shape& shape : shapes)
  {
    sewing.Add(shape);
  }
  sewing.Perform();
  return sewing.SewedShape();
}

/// Planar faces over the closed loops of free edges.
std::vector<TopoDS_Shape> caps(const TopoDS_Shape& shell)
{
  std::vector<TopoDS_Shape> faces;
  const ShapeAnalysis_FreeBounds bounds(shell);
  for (TopExp_Explorer wire(bounds.GetClosedWires(), TopAbs_WIRE); wire.More(); wire.Next())
  {
    constexpr bool onlyPlane = true;
    faces.push_back(BRepBuilderAPI_MakeFace(TopoDS::Wire(wire.Current()), onlyPlane).Face());
  }
  return faces;
}

} // namespace

Stations spaced(double first, double last, int count)
{
  Stations stations(count + 1);
  for (int i = 0; i <= count; ++i)
  {
    stations[i] = first + (last - first) * i / count;
  }
  return stations;
}

// The tensor product of two interpolations of curves: first along u, then along v.
Handle(Geom_BSplineSurface)
  interpolate(const SurfaceFunction& function, const Stations& u, const Stations& v)
{
  const std::vector<Condition> alongU = conditions(u), alongV = conditions(v);
  const int rows = static_cast<int>(alongU.size()), columns = static_cast<int>(alongV.size());
  TColgp_Array2OfPnt poles(1, rows, 1, columns);
  for (int j = 1; j <= columns; ++j)
  {
    TColgp_Array1OfPnt column(1, rows);
    for (int i = 1; i <= rows; ++i)
    {
      column(i) = gp_Pnt(evaluate(function, alongU[i - 1], alongV[j - 1]));
    }
    solve(u, column);
    for (int i = 1; i <= rows; ++i)
    {
      poles(i, j) = column(i);
    }
  }
  for (int i = 1; i <= rows; ++i)
  {
    TColgp_Array1OfPnt row(1, columns);
    for (int j = 1; j <= columns; ++j)
    {
      row(j) = poles(i, j);
    }
    solve(v, row);
    for (int j = 1; j <= columns; ++j)
    {
      poles(i, j) = row(j);
    }
  }
  return new Geom_BSplineSurface(
    poles, knotArray(u), knotArray(v), clamped(u), clamped(v), degree, degree);
}

std::vector<gp_XYZ> interpolateCurve(const std::vector<gp_XYZ>& points, const Stations& knots,
  const gp_XYZ& startTangent, const gp_XYZ& endTangent)
{
  TColgp_Array1OfPnt data(1, static_cast<int>(points.size()) + 2);
  data(1) = gp_Pnt(points.front());
  data(2) = gp_Pnt(startTangent);
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
  {
    data(static_cast<int>(i) + 2) = gp_Pnt(points[i]);
  }
  data(data.Upper() - 1) = gp_Pnt(endTangent);
  data(data.Upper()) = gp_Pnt(points.back());
  solve(knots, data);
  std::vector<gp_XYZ> poles;
  for (const gp_Pnt& pole : data)
  {
    poles.push_back(pole.XYZ());
  }
  return poles;
}

// The rational quadratic arc: its middle pole lies where the tangents of its ends meet, with the
// cosine of half the angle as weight (Piegl & Tiller, The NURBS Book, 7.3).
Handle(Geom_BSplineSurface)
  revolve(const std::vector<gp_XYZ>& poles, const Stations& knots, double start, double angle)
{
  constexpr int arcPoles = 3;
  const double middle = std::cos(angle / 2);
  const int count = static_cast<int>(poles.size());
  TColgp_Array2OfPnt net(1, count, 1, arcPoles);
  TColStd_Array2OfReal weights(1, count, 1, arcPoles);
  for (int i = 1; i <= count; ++i)
  {
    for (int j = 1; j <= arcPoles; ++j)
    {
      const double weight = j == 2 ? middle : 1.0;
      const double radius = poles[i - 1].Y() / weight;
      const double turned = start + angle * (j - 1) / 2;
      net(i, j) = gp_Pnt(poles[i - 1].X(), radius * std::cos(turned), radius * std::sin(turned));
      weights(i, j) = weight;
    }
  }
  TColStd_Array1OfReal ends(1, 2);
  TColStd_Array1OfInteger full(1, 2);
  ends(1) = 0;
  ends(2) = 1;
  full.Init(arcPoles);
  return new Geom_BSplineSurface(
    net, weights, knotArray(knots), ends, clamped(knots), full, degree, arcPoles - 1);
}

void cut(const Handle(Geom_BSplineSurface) & surface, int strideU, int strideV, Patches& patches)
{
  const int lastU = surface->NbUKnots(), lastV = surface->NbVKnots();
  for (int i = 1; i < lastU; i += strideU)
  {
    for (int j = 1; j < lastV; j += strideV)
    {
      const Handle(Geom_BSplineSurface) patch =
        Handle(Geom_BSplineSurface)::DownCast(surface->Copy());
      patch->Segment(surface->UKnot(i), surface->UKnot(std::min(i + strideU, lastU)),
        surface->VKnot(j), surface->VKnot(std::min(j + strideV, lastV)));
      patches.push_back(patch);
    }
  }
}

TopoDS_Shape solidOf(const Patches& patches)
{
  std::vector<TopoDS_Shape> faces;
  for (const auto& patch : patches)
  {
    faces.push_back(BRepBuilderAPI_MakeFace(patch, sewingTolerance).Face());
  }
  TopoDS_Shape shell = sew(faces);
  const std::vector<TopoDS_Shape> ends = caps(shell);
  if (!ends.empty())
  {
    faces.insert(faces.end(), ends.begin(), ends.end());
    shell = sew(faces);
  }
  if (shell.ShapeType() != TopAbs_SHELL || !BRep_Tool::IsClosed(shell))
  {
    throw std::runtime_error("the patches of a part do not close");
  }
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

} // namespace aeroplane
