#include "BoundingBlocks.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <BndLib_Add3dCurve.hxx>
#include <BndLib_AddSurface.hxx>
#include <Geom_BSplineSurface.hxx>

#include <algorithm>
#include <cmath>

namespace exacttest
{
namespace
{

constexpr int mostSpans = 4; // of a block, each way

/// [low, high], cut at every fourth knot between.
std::vector<double> cutsBetween(const std::vector<double>& knots, double low, double high)
{
  std::vector<double> cuts{ low };
  int spans = 0;
  for (const double knot : knots)
  {
    const double margin = 1e-6 * (high - low);
    if (knot > low + margin && knot < high - margin && ++spans % mostSpans == 0)
    {
      cuts.push_back(knot);
    }
  }
  cuts.push_back(high);
  return cuts;
}

struct Knots
{
  std::vector<double> u, v;
};

Knots knotsOf(const BRepAdaptor_Surface& surface)
{
  Knots knots;
  if (surface.GetType() == GeomAbs_BSplineSurface)
  {
    const Handle(Geom_BSplineSurface) spline = surface.BSpline();
    for (int i = 1; i <= spline->NbUKnots(); ++i)
    {
      knots.u.push_back(spline->UKnot(i));
    }
    for (int i = 1; i <= spline->NbVKnots(); ++i)
    {
      knots.v.push_back(spline->VKnot(i));
    }
  }
  return knots;
}

void enlarge(Bnd_Box& box, double part)
{
  box.SetGap(box.GetGap() + part * std::sqrt(box.SquareExtent()));
}

/// True where Open CASCADE's box of the part is from control points or in closed form.
bool isBoundSure(const BRepAdaptor_Surface& surface, const SurfaceBlock& block)
{
  switch (surface.GetType())
  {
    case GeomAbs_Plane:
    case GeomAbs_Cylinder:
    case GeomAbs_Cone:
    case GeomAbs_Sphere:
    case GeomAbs_Torus:
      return true;
    case GeomAbs_BSplineSurface:
    case GeomAbs_BezierSurface:
      return block.u0 >= surface.FirstUParameter() && block.u1 <= surface.LastUParameter() &&
             block.v0 >= surface.FirstVParameter() && block.v1 <= surface.LastVParameter();
    default:
      return false;
  }
}

void addBox(const BRepAdaptor_Surface& surface, double tolerance, SurfaceBlock& block)
{
  if (surface.GetType() == GeomAbs_BezierSurface)
  {
    BndLib_AddSurface::Add(surface, tolerance, block.box);
  }
  else
  {
    BndLib_AddSurface::Add(surface, block.u0, block.u1, block.v0, block.v1, tolerance, block.box);
  }
  enlarge(block.box, isBoundSure(surface, block) ? 1e-6 : 0.1);
}

} // namespace

double boxDistance(const Bnd_Box& box, const cadrefine::Point3& q)
{
  double x[3], y[3];
  box.Get(x[0], x[1], x[2], y[0], y[1], y[2]);
  double sum = 0;
  for (int k = 0; k < 3; ++k)
  {
    const double away = std::max({ x[k] - q[k], q[k] - y[k], 0.0 });
    sum += away * away;
  }
  return std::sqrt(sum);
}

std::vector<SurfaceBlock> blocksOf(const TopoDS_Face& face)
{
  const BRepAdaptor_Surface surface(face, false);
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  const Knots knots = knotsOf(surface);
  const std::vector<double> u = cutsBetween(knots.u, u0, u1);
  const std::vector<double> v = cutsBetween(knots.v, v0, v1);
  std::vector<SurfaceBlock> blocks;
  for (std::size_t i = 0; i + 1 < u.size(); ++i)
  {
    for (std::size_t j = 0; j + 1 < v.size(); ++j)
    {
      SurfaceBlock block{ u[i], u[i + 1], v[j], v[j + 1], {} };
      addBox(surface, BRep_Tool::Tolerance(face), block);
      blocks.push_back(block);
    }
  }
  return blocks;
}

Bnd_Box boxOf(const TopoDS_Edge& edge)
{
  const BRepAdaptor_Curve curve(edge);
  Bnd_Box box;
  BndLib_Add3dCurve::Add(curve, BRep_Tool::Tolerance(edge), box);
  enlarge(box, curve.GetType() == GeomAbs_OtherCurve ? 0.1 : 1e-6);
  return box;
}

} // namespace exacttest
