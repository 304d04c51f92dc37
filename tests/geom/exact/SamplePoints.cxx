#include "SamplePoints.h"

#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include <algorithm>
#include <cmath>
#include <random>

namespace exacttest
{

using namespace cadrefine;

namespace
{

constexpr double unknown = std::numeric_limits<double>::infinity();
constexpr std::size_t fewestPoints = 2000;

Point3 fromOcc(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

/// Numbers that are the same on every machine.
class Random
{
public:
  /// From `low` to `high`.
  double operator()(double low, double high)
  {
    return low + (high - low) * static_cast<double>(generator_()) / 4294967295.0;
  }

  std::size_t below(std::size_t count) { return generator_() % count; }

  Vector3 direction()
  {
    for (;;)
    {
      const double x = (*this)(-1, 1);
      const double y = (*this)(-1, 1);
      const double z = (*this)(-1, 1);
      const Vector3 v{ x, y, z };
      if (norm(v) > 0.1 && norm(v) <= 1)
      {
        return normalized(v);
      }
    }
  }

private:
  std::mt19937 generator_{ 20 };
};

struct Range
{
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
};

/// A face and what is needed to take points of it.
struct FaceSampler
{
  explicit FaceSampler(const TopoDS_Face& given) : face(given), surface(given, false)
  {
    BRepTools::UVBounds(face, range.u0, range.u1, range.v0, range.v1);
  }

  bool isInside(double u, double v) const
  {
    return BRepClass_FaceClassifier(face, gp_Pnt2d(u, v), BRep_Tool::Tolerance(face)).State() ==
           TopAbs_IN;
  }

  Point3 at(double u, double v) const { return fromOcc(surface.Value(u, v).XYZ()); }

  /// Zero where there is none.
  Vector3 normal(double u, double v) const
  {
    gp_Pnt p;
    gp_Vec du, dv;
    surface.D1(u, v, p, du, dv);
    return normalized(fromOcc(du.Crossed(dv).XYZ()));
  }

  TopoDS_Face face;
  BRepAdaptor_Surface surface;
  Range range;
};

/// Use of an edge by a face, with its curve in the face's parameter plane.
struct LoopCurve
{
  std::size_t face = 0;
  TopoDS_Edge edge;
  Handle(Geom2d_Curve) curve;
  double first = 0;
  double last = 0;
};

class Sampler
{
public:
  Sampler(const TopoDS_Shape& shape, double size) : index_(shape), size_(size)
  {
    BRepBndLib::Add(shape, box_, false);
    for (const TopoDS_Face& face : index_.faces())
    {
      faces_.emplace_back(face);
      addLoops(faces_.size() - 1);
    }
  }

  std::vector<SamplePoint> run()
  {
    addSurfacePoints(70);
    addLoopPoints(40);
    addBorderPoints(150);
    addEdgePoints(60);
    addVertexPoints(50);
    addSeamPoints(20);
    addPolePoints(10);
    addAxisPoints(15);
    addBends(6);
    addBoxPoints(300);
    addBoxPoints(fewestPoints - std::min(fewestPoints, points_.size()));
    return std::move(points_);
  }

private:
  void addLoops(std::size_t face);
  void add(const Point3& p, double bound, PointKind kind) { points_.push_back({ p, bound, kind }); }
  void addAround(const Point3& p, PointKind kind);
  void addSurfacePoints(int count);
  void addLoopPoints(int count);
  void addBorderPoints(int count);
  void addEdgePoints(int count);
  void addVertexPoints(int count);
  void addSeamPoints(int count);
  void addPolePoints(int count);
  void addAxisPoints(int count);
  void addBends(int count);
  void addBoxPoints(std::size_t count);
  bool choosePoint(const FaceSampler& face, double& u, double& v);
  void addAxis(const gp_Ax1& axis, double around);

  cadrefine::ShapeIndex index_;
  double size_;
  Bnd_Box box_;
  std::vector<FaceSampler> faces_;
  std::vector<LoopCurve> loops_, seams_, poles_;
  std::vector<SamplePoint> points_;
  Random random_;
};

void Sampler::addLoops(std::size_t number)
{
  const TopoDS_Face& face = faces_[number].face;
  for (TopExp_Explorer edges(face, TopAbs_EDGE); edges.More(); edges.Next())
  {
    LoopCurve use;
    use.face = number;
    use.edge = TopoDS::Edge(edges.Current());
    use.curve = BRep_Tool::CurveOnSurface(use.edge, face, use.first, use.last);
    if (!use.curve.IsNull())
    {
      const bool pole = BRep_Tool::Degenerated(use.edge);
      const bool seam = BRep_Tool::IsClosed(use.edge, face);
      (pole ? poles_ : seam ? seams_ : loops_).push_back(use);
    }
  }
}

/// `p` is on the model: it, and points off it in any direction.
void Sampler::addAround(const Point3& p, PointKind kind)
{
  add(p, 0, kind);
  for (const double away : { 1e-9, 1e-8, 1e-6, 1e-3, 1e-2, 0.3 })
  {
    add(p + (away * size_) * random_.direction(), away * size_, kind);
  }
}

bool Sampler::choosePoint(const FaceSampler& face, double& u, double& v)
{
  for (int i = 0; i < 20; ++i)
  {
    u = random_(face.range.u0, face.range.u1);
    v = random_(face.range.v0, face.range.v1);
    if (face.isInside(u, v))
    {
      return true;
    }
  }
  return false;
}

void Sampler::addSurfacePoints(int count)
{
  for (int i = 0; i < count && !faces_.empty(); ++i)
  {
    const FaceSampler& face =
      faces_[i < static_cast<int>(faces_.size()) ? (i * 7) % faces_.size()
                                                 : random_.below(faces_.size())];
    double u = 0;
    double v = 0;
    if (!choosePoint(face, u, v))
    {
      continue;
    }
    const Point3 p = face.at(u, v);
    const Vector3 n = face.normal(u, v);
    add(p, 0, PointKind::surface);
    for (const double away : { 1e-8, 1e-6, 1e-3, 1e-2, 0.3, 3.0 })
    {
      add(p + (away * size_) * n, away * size_, PointKind::surface);
      add(p - (away * size_) * n, away * size_, PointKind::surface);
    }
  }
}

void Sampler::addLoopPoints(int count)
{
  for (int i = 0; i < count && !loops_.empty(); ++i)
  {
    const LoopCurve& loop = loops_[random_.below(loops_.size())];
    const FaceSampler& face = faces_[loop.face];
    gp_Pnt2d p;
    gp_Vec2d along;
    loop.curve->D1(random_(loop.first, loop.last), p, along);
    const double extentU = face.range.u1 - face.range.u0;
    const double extentV = face.range.v1 - face.range.v0;
    // Across the loop, in parameters scaled by the face's extent.
    const Point2 across{ -along.Y() / extentV, along.X() / extentU };
    const double length = std::hypot(across[0], across[1]);
    for (const double offset : { -1e-3, -1e-6, -1e-8, 1e-8, 1e-6, 1e-3 })
    {
      const double u = p.X() + (length > 0 ? offset * extentU * across[0] / length : 0);
      const double v = p.Y() + (length > 0 ? offset * extentV * across[1] / length : 0);
      const Point3 q = face.at(u, v);
      const double bound = face.isInside(u, v) ? 0 : unknown;
      add(q, bound, PointKind::loop);
      const double height = random_(-0.01, 0.01) * size_;
      add(q + height * face.normal(u, v), bound + std::abs(height), PointKind::loop);
    }
  }
}

/// Points beside the curves in space that the loops are on their surfaces, as far as trims are
/// inexact in real files.
void Sampler::addBorderPoints(int count)
{
  for (int i = 0; i < count && !loops_.empty(); ++i)
  {
    const LoopCurve& loop = loops_[random_.below(loops_.size())];
    const gp_Pnt2d uv = loop.curve->Value(random_(loop.first, loop.last));
    const Point3 p = faces_[loop.face].at(uv.X(), uv.Y());
    add(p, 0, PointKind::border);
    const double away = std::pow(10, random_(-9, -2)) * size_;
    add(p + away * random_.direction(), away, PointKind::border);
  }
}

void Sampler::addEdgePoints(int count)
{
  for (int i = 0; i < count && !index_.edges().empty(); ++i)
  {
    const BRepAdaptor_Curve curve(index_.edges()[random_.below(index_.edges().size())]);
    const double t = random_(curve.FirstParameter(), curve.LastParameter());
    addAround(fromOcc(curve.Value(t).XYZ()), PointKind::edge);
  }
}

void Sampler::addVertexPoints(int count)
{
  for (int i = 0; i < count && !index_.vertices().empty(); ++i)
  {
    const TopoDS_Vertex& vertex = index_.vertices()[random_.below(index_.vertices().size())];
    addAround(fromOcc(BRep_Tool::Pnt(vertex).XYZ()), PointKind::vertex);
  }
}

void Sampler::addSeamPoints(int count)
{
  for (int i = 0; i < count && !seams_.empty(); ++i)
  {
    const LoopCurve& seam = seams_[random_.below(seams_.size())];
    const FaceSampler& face = faces_[seam.face];
    gp_Pnt2d p;
    gp_Vec2d along;
    seam.curve->D1(random_(seam.first, seam.last), p, along);
    const Point3 q = face.at(p.X(), p.Y());
    const Vector3 normal = face.normal(p.X(), p.Y());
    const Vector3 side = cross(normal, random_.direction());
    add(q, unknown, PointKind::seam);
    for (const double away : { 1e-9, 1e-6, 1e-3 })
    {
      add(q + (away * size_) * side, unknown, PointKind::seam);
      add(q - (away * size_) * side, unknown, PointKind::seam);
      add(q + (away * size_) * side + (1e-2 * size_) * normal, unknown, PointKind::seam);
      add(q - (away * size_) * side - (1e-2 * size_) * normal, unknown, PointKind::seam);
    }
  }
}

void Sampler::addPolePoints(int count)
{
  for (int i = 0; i < count && !poles_.empty(); ++i)
  {
    const LoopCurve& pole = poles_[random_.below(poles_.size())];
    const gp_Pnt2d p = pole.curve->Value(random_(pole.first, pole.last));
    const Point3 q = faces_[pole.face].at(p.X(), p.Y());
    add(q, unknown, PointKind::pole);
    for (const double away : { 1e-9, 1e-6, 1e-3, 1e-2, 0.3 })
    {
      add(q + (away * size_) * random_.direction(), unknown, PointKind::pole);
      add(q - (away * size_) * random_.direction(), unknown, PointKind::pole);
    }
  }
}

/// Points on the axis within half a size of its location, and where `around` is not 0, on the
/// circle of this radius round it.
void Sampler::addAxis(const gp_Ax1& axis, double around)
{
  const Point3 origin = fromOcc(axis.Location().XYZ());
  const Vector3 along = fromOcc(axis.Direction().XYZ());
  const Vector3 side = normalized(cross(along, random_.direction()));
  const Point3 foot = origin + around * side;
  add(foot, unknown, PointKind::axis);
  for (const double away : { 1e-12, 1e-9, 1e-6, 1e-3 })
  {
    add(foot + (away * size_) * random_.direction(), unknown, PointKind::axis);
  }
  for (int i = 0; i < 3 && around == 0; ++i)
  {
    add(origin + random_(-0.5, 0.5) * size_ * along, unknown, PointKind::axis);
  }
}

void Sampler::addAxisPoints(int count)
{
  for (int i = 0; i < count && !faces_.empty(); ++i)
  {
    const BRepAdaptor_Surface& surface = faces_[random_.below(faces_.size())].surface;
    switch (surface.GetType())
    {
      case GeomAbs_Cylinder:
        addAxis(surface.Cylinder().Axis(), 0);
        break;
      case GeomAbs_Cone:
        addAxis(gp_Ax1(surface.Cone().Apex(), surface.Cone().Axis().Direction()), 0);
        break;
      case GeomAbs_Sphere:
        addAxis(gp_Ax1(surface.Sphere().Location(), gp::DZ()), 0);
        break;
      case GeomAbs_Torus:
        addAxis(surface.Torus().Axis(), 0);
        addAxis(surface.Torus().Axis(), surface.Torus().MajorRadius());
        break;
      case GeomAbs_SurfaceOfRevolution:
        addAxis(surface.AxeOfRevolution(), 0);
        break;
      default:
        break;
    }
  }
}

/// Where a sphere touches the surface with one of its principal curvatures: the distance is flat.
void Sampler::addBends(int count)
{
  for (int i = 0; i < count && !faces_.empty(); ++i)
  {
    const FaceSampler& face = faces_[random_.below(faces_.size())];
    double u = 0;
    double v = 0;
    if (!choosePoint(face, u, v))
    {
      continue;
    }
    gp_Pnt p;
    gp_Vec du, dv, duu, dvv, duv;
    face.surface.D2(u, v, p, du, dv, duu, dvv, duv);
    const Vector3 n = face.normal(u, v);
    const double E = du.Dot(du), F = du.Dot(dv), G = dv.Dot(dv);
    const auto second = [&](const gp_Vec& d) { return dot(fromOcc(d.XYZ()), n); };
    const double e = second(duu), f = second(duv), g = second(dvv);
    const double determinant = E * G - F * F;
    const double mean = 0.5 * (e * G - 2 * f * F + g * E) / determinant;
    const double gauss = (e * g - f * f) / determinant;
    const double root = std::sqrt(std::max(0.0, mean * mean - gauss));
    for (const double curvature : { mean - root, mean + root })
    {
      if (std::abs(curvature) * size_ > 0.1 && std::isfinite(curvature))
      {
        add(fromOcc(p.XYZ()) + (1 / curvature) * n, 1 / std::abs(curvature), PointKind::bend);
      }
    }
  }
}

void Sampler::addBoxPoints(std::size_t count)
{
  const Point3 low = fromOcc(box_.CornerMin().XYZ());
  const Point3 high = fromOcc(box_.CornerMax().XYZ());
  for (std::size_t i = 0; i < count; ++i)
  {
    const double margin = i % 2 == 0 ? 0 : 0.2;
    Point3 p;
    for (int k = 0; k < 3; ++k)
    {
      p[k] = low[k] + random_(-margin, 1 + margin) * (high[k] - low[k]);
    }
    add(p, unknown, PointKind::box);
  }
}

} // namespace

const char* nameOf(PointKind kind)
{
  const char* names[] = { "surface", "loop", "border", "edge", "vertex", "seam", "pole", "axis",
    "bend", "box" };
  return names[static_cast<int>(kind)];
}

std::vector<SamplePoint> samplePoints(const TopoDS_Shape& shape, double size)
{
  return Sampler(shape, size).run();
}

} // namespace exacttest
