#include "ShapeTessellation.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom_Surface.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <gp_Vec.hxx>

#include <algorithm>

namespace cadrefine
{
namespace
{

constexpr double angularDeflection = 0.35; // radians

Point3 toPoint(const gp_Pnt& p)
{
  return { p.X(), p.Y(), p.Z() };
}

/// Open CASCADE refuses a smaller one.
double allowed(double deflection)
{
  return std::max(deflection, Precision::Confusion());
}

/// Zero where the surface has none.
Vector3 normalOf(const Geom_Surface& surface, const gp_Pnt2d& uv, bool reversed)
{
  gp_Pnt point;
  gp_Vec du, dv;
  surface.D1(uv.X(), uv.Y(), point, du, dv);
  const gp_Vec n = reversed ? dv.Crossed(du) : du.Crossed(dv);
  return normalized({ n.X(), n.Y(), n.Z() });
}

void addTriangles(const Poly_Triangulation& mesh, bool reversed, Tessellation& result)
{
  for (int i = 1; i <= mesh.NbTriangles(); ++i)
  {
    int a = 0, b = 0, c = 0;
    mesh.Triangle(i).Get(a, b, c);
    result.triangles.push_back({ a - 1, (reversed ? c : b) - 1, (reversed ? b : c) - 1 });
  }
}

} // namespace

Tessellation tessellateFace(const TopoDS_Face& face, double deflection)
{
  constexpr bool copyGeometry = false;
  constexpr bool relative = false;
  constexpr bool parallel = false;
  const TopoDS_Face copy = TopoDS::Face(BRepBuilderAPI_Copy(face, copyGeometry).Shape());
  const BRepMesh_IncrementalMesh mesher(
    copy, allowed(deflection), relative, angularDeflection, parallel);
  TopLoc_Location location;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(copy, location);
  Tessellation result;
  if (mesh.IsNull())
  {
    return result;
  }
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(copy);
  for (int i = 1; i <= mesh->NbNodes(); ++i)
  {
    result.points.push_back(toPoint(mesh->Node(i).Transformed(location.Transformation())));
    result.normals.push_back(normalOf(*surface, mesh->UVNode(i), reversed));
  }
  addTriangles(*mesh, reversed, result);
  return result;
}

Tessellation tessellateEdge(const TopoDS_Edge& edge, double deflection)
{
  const BRepAdaptor_Curve curve(edge);
  const GCPnts_TangentialDeflection polyline(curve, angularDeflection, allowed(deflection));
  Tessellation result;
  for (int i = 1; i <= polyline.NbPoints(); ++i)
  {
    result.points.push_back(toPoint(polyline.Value(i)));
    result.line.push_back(i - 1);
  }
  return result;
}

} // namespace cadrefine
