#include <cadrefine/cad/readers/drawing/ShapeTessellation.h>

#include <cadrefine/cad/import/OccGuard.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom2d_Curve.hxx>
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

/// Outward normals of a face.
class FaceNormals
{
public:
  explicit FaceNormals(const TopoDS_Face& face)
    : face_(face), surface_(BRep_Tool::Surface(face, location_))
  {
  }

  /// The normal at a point of the face; at a singular point the limit from inside the face: the
  /// parameters are moved towards its middle until there is a normal. Zero where there is none.
  Vector3 at(const gp_Pnt2d& uv) const
  {
    Vector3 n = this->regular(uv);
    for (double step = 1e-6; squaredNorm(n) == 0 && step < 1e-2; step *= 10)
    {
      n = this->regular({ (1 - step) * uv.XY() + step * this->middle() });
    }
    return n;
  }

private:
  Vector3 regular(const gp_Pnt2d& uv) const
  {
    gp_Pnt point;
    gp_Vec du, dv;
    surface_->D1(uv.X(), uv.Y(), point, du, dv);
    du.Transform(location_.Transformation());
    dv.Transform(location_.Transformation());
    const gp_Vec n = face_.Orientation() == TopAbs_REVERSED ? dv.Crossed(du) : du.Crossed(dv);
    const double square = std::max(du.SquareMagnitude(), dv.SquareMagnitude());
    return n.Magnitude() > 1e-10 * square ? normalized({ n.X(), n.Y(), n.Z() }) : Vector3{};
  }

  gp_XY middle() const
  {
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    BRepTools::UVBounds(face_, u0, u1, v0, v1);
    return { 0.5 * (u0 + u1), 0.5 * (v0 + v1) };
  }

  const TopoDS_Face& face_;
  TopLoc_Location location_;
  Handle(Geom_Surface) surface_;
};

void addTriangles(const Poly_Triangulation& mesh, bool reversed, Tessellation& result)
{
  for (int i = 1; i <= mesh.NbTriangles(); ++i)
  {
    int a = 0, b = 0, c = 0;
    mesh.Triangle(i).Get(a, b, c);
    result.triangles.push_back({ a - 1, (reversed ? c : b) - 1, (reversed ? b : c) - 1 });
  }
}

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
  const FaceNormals normals(face);
  for (int i = 1; i <= mesh->NbNodes(); ++i)
  {
    result.points.push_back(toPoint(mesh->Node(i).Transformed(location.Transformation())));
    result.normals.push_back(normals.at(mesh->UVNode(i)));
  }
  addTriangles(*mesh, reversed, result);
  return result;
}

void addNormals(const TopoDS_Edge& edge, const TopoDS_Face& face,
  const GCPnts_TangentialDeflection& polyline, Tessellation& result)
{
  double first = 0;
  double last = 0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
  if (curve.IsNull())
  {
    return;
  }
  const FaceNormals normals(face);
  for (int i = 1; i <= polyline.NbPoints(); ++i)
  {
    result.normals.push_back(normals.at(curve->Value(polyline.Parameter(i))));
  }
}

Tessellation tessellateEdge(const TopoDS_Edge& edge, const TopoDS_Face& face, double deflection)
{
  const BRepAdaptor_Curve curve(edge);
  const GCPnts_TangentialDeflection polyline(curve, angularDeflection, allowed(deflection));
  Tessellation result;
  for (int i = 1; i <= polyline.NbPoints(); ++i)
  {
    result.points.push_back(toPoint(polyline.Value(i)));
    result.line.push_back(i - 1);
  }
  if (!face.IsNull())
  {
    addNormals(edge, face, polyline, result);
  }
  return result;
}

Tessellation tessellateShape(const ShapeIndex& index, const DrawnEntity& drawn, double deflection)
{
  const TopoDS_Face face = drawn.face < 0 ? TopoDS_Face() : index.faces()[drawn.face];
  switch (drawn.entity.dimension)
  {
    case 2:
      return tessellateFace(face, deflection);
    case 1:
      return tessellateEdge(index.edges()[drawn.entity.index], face, deflection);
    default:
      return {};
  }
}

} // namespace

Tessellation tessellate(
  const ShapeIndex& index, const LengthScale& scale, const DrawnEntity& drawn, double deflection)
{
  return guardOcc("drawing the CAD model",
    [&]
    {
      Tessellation drawing = tessellateShape(index, drawn, scale.back()(deflection));
      for (Point3& point : drawing.points)
      {
        point = scale(point);
      }
      return drawing;
    });
}

} // namespace cadrefine
