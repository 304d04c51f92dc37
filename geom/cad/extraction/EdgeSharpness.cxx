// Creases: the outward normals of the two sides of an edge are compared at points along it.

#include <cadrefine/cad/extraction/NurbsExtraction.h>

#include <cadrefine/base/Vector3.h>

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopLoc_Location.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include <cmath>

namespace cadrefine
{
namespace
{

/// One side of an edge, to be sampled.
struct Side
{
  Handle(Geom2d_Curve) curve;
  Handle(Geom_Surface) surface;
  TopLoc_Location location;
  double first = 0;
  double last = 0;
  double sign = 1;
};

/// The sign makes the normals of two sides comparable also where the faces' orientations do not
/// agree: an edge is used forward on one side and reversed on the other.
Side makeSide(const EdgeUse& use)
{
  Side side;
  side.curve = BRep_Tool::CurveOnSurface(use.edge, use.face, side.first, side.last);
  side.surface = BRep_Tool::Surface(use.face, side.location);
  side.sign = use.face.Orientation() == TopAbs_REVERSED ? -1 : 1;
  return side;
}

/// Zero where the surface has no normal.
Vector3 normalAt(const Side& side, double t)
{
  const gp_Pnt2d uv = side.curve->Value(t);
  gp_Pnt point;
  gp_Vec du, dv;
  side.surface->D1(uv.X(), uv.Y(), point, du, dv);
  const gp_Vec n = side.sign * du.Crossed(dv).Transformed(side.location.Transformation());
  const double scale = du.Magnitude() * dv.Magnitude();
  return du.Crossed(dv).Magnitude() > 1e-9 * scale ? normalized({ n.X(), n.Y(), n.Z() })
                                                   : Vector3{};
}

bool normalsDiffer(const Side& a, const Side& b)
{
  constexpr int samples = 24;
  const double cosine = std::cos(NurbsModel::creaseAngle);
  for (int i = 0; i <= samples; ++i)
  {
    // Not quite to the ends, where a vertex may be a singular point of a surface.
    const double t = a.first + (a.last - a.first) * (0.001 + 0.998 * i / samples);
    const Vector3 na = normalAt(a, t);
    const Vector3 nb = normalAt(b, t);
    if (squaredNorm(na) > 0 && squaredNorm(nb) > 0 && dot(na, nb) < cosine)
    {
      return true;
    }
  }
  return false;
}

} // namespace

bool isSharp(const std::vector<EdgeUse>& uses)
{
  if (uses.size() != 2)
  {
    return true;
  }
  const Side a = makeSide(uses[0]);
  Side b = makeSide(uses[1]);
  if (a.curve.IsNull() || b.curve.IsNull())
  {
    return true;
  }
  if (uses[0].edge.Orientation() == uses[1].edge.Orientation())
  {
    b.sign = -b.sign;
  }
  return normalsDiffer(a, b);
}

} // namespace cadrefine
