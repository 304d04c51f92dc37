#include "OccOracle.h"

#include "BoundingBlocks.h"

#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Extrema_ExtPC.hxx>
#include <Extrema_ExtPS.hxx>
#include <ShapeAnalysis_Curve.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cmath>

namespace exacttest
{

using namespace cadrefine;

namespace
{

gp_Pnt toOcc(const Point3& p)
{
  return { p[0], p[1], p[2] };
}

Point3 fromOcc(const gp_Pnt& p)
{
  return { p.X(), p.Y(), p.Z() };
}

/// An extremum on a face's surface.
struct Foot
{
  double distance = 0;
  double u = 0;
  double v = 0;
  Point3 point{};
};

/// A face's blocks, with Open CASCADE's search over each, made when first needed.
class FaceOracle
{
public:
  /// Extrema are wanted to `accuracy`, a length.
  FaceOracle(const TopoDS_Face& face, double accuracy)
    : face_(face), surface_(face, false), accuracy_(accuracy), blocks_(blocksOf(face)),
      searches_(blocks_.size())
  {
  }

  const std::vector<SurfaceBlock>& blocks() const { return blocks_; }

  /// Extrema over one block that are not farther than `limit`, the nearest first.
  std::vector<Foot> feet(std::size_t block, const Point3& q, double limit) const;

  /// Of the same point of the surface, whichever turn of a periodic one the parameters are on.
  bool isInside(const Foot& foot) const;
  bool isInsideOrOn(const Foot& foot) const;

  /// Within the tolerance of one of the face's vertices: there the two are the same.
  bool isAtVertex(const Point3& p) const;

  /// The surface's point at `p`, by a search of its own that also ends at poles.
  Foot footAt(const Point3& p) const;

private:
  Extrema_ExtPS& searchOver(std::size_t i) const;
  std::vector<gp_Pnt2d> turnsOf(const Foot& foot) const;
  void polish(Foot& foot, const Point3& p) const;
  TopAbs_State classify(const gp_Pnt2d& uv) const
  {
    return BRepClass_FaceClassifier(face_, uv, BRep_Tool::Tolerance(face_)).State();
  }

  TopoDS_Face face_;
  BRepAdaptor_Surface surface_;
  double accuracy_;
  std::vector<SurfaceBlock> blocks_;
  mutable std::vector<std::unique_ptr<Extrema_ExtPS>> searches_;
};

std::vector<Foot> FaceOracle::feet(std::size_t block, const Point3& q, double limit) const
{
  Extrema_ExtPS& search = searchOver(block);
  search.Perform(toOcc(q));
  std::vector<Foot> feet;
  for (int i = 1; search.IsDone() && i <= search.NbExt(); ++i)
  {
    Foot foot;
    foot.distance = std::sqrt(search.SquareDistance(i));
    if (foot.distance <= limit)
    {
      search.Point(i).Parameter(foot.u, foot.v);
      foot.point = fromOcc(search.Point(i).Value());
      feet.push_back(foot);
    }
  }
  std::sort(
    feet.begin(), feet.end(), [](const Foot& a, const Foot& b) { return a.distance < b.distance; });
  return feet;
}

Extrema_ExtPS& FaceOracle::searchOver(std::size_t i) const
{
  if (!searches_[i])
  {
    const SurfaceBlock& b = blocks_[i];
    searches_[i] = std::make_unique<Extrema_ExtPS>();
    searches_[i]->SetFlag(Extrema_ExtFlag_MIN);
    searches_[i]->Initialize(surface_, b.u0, b.u1, b.v0, b.v1, surface_.UResolution(accuracy_),
      surface_.VResolution(accuracy_));
  }
  return *searches_[i];
}

std::vector<gp_Pnt2d> FaceOracle::turnsOf(const Foot& foot) const
{
  const SurfaceBlock& low = blocks_.front();
  const SurfaceBlock& high = blocks_.back();
  const double periodU = surface_.IsUPeriodic() ? surface_.UPeriod() : 0;
  const double periodV = surface_.IsVPeriodic() ? surface_.VPeriod() : 0;
  std::vector<gp_Pnt2d> turns;
  for (int i = periodU > 0 ? -2 : 0; i <= (periodU > 0 ? 2 : 0); ++i)
  {
    for (int j = periodV > 0 ? -2 : 0; j <= (periodV > 0 ? 2 : 0); ++j)
    {
      const gp_Pnt2d uv(foot.u + i * periodU, foot.v + j * periodV);
      const bool within =
        uv.X() >= low.u0 && uv.X() <= high.u1 && uv.Y() >= low.v0 && uv.Y() <= high.v1;
      if (within || (i == 0 && j == 0))
      {
        turns.push_back(uv);
      }
    }
  }
  return turns;
}

bool FaceOracle::isInside(const Foot& foot) const
{
  const std::vector<gp_Pnt2d> turns = turnsOf(foot);
  return std::any_of(
    turns.begin(), turns.end(), [&](const gp_Pnt2d& uv) { return classify(uv) == TopAbs_IN; });
}

bool FaceOracle::isInsideOrOn(const Foot& foot) const
{
  BRepTopAdaptor_FClass2d other(face_, BRep_Tool::Tolerance(face_));
  const std::vector<gp_Pnt2d> turns = turnsOf(foot);
  return std::any_of(turns.begin(), turns.end(),
    [&](const gp_Pnt2d& uv)
    { return classify(uv) != TopAbs_OUT || other.Perform(uv) != TopAbs_OUT; });
}

bool FaceOracle::isAtVertex(const Point3& p) const
{
  for (TopExp_Explorer vertices(face_, TopAbs_VERTEX); vertices.More(); vertices.Next())
  {
    const TopoDS_Vertex& vertex = TopoDS::Vertex(vertices.Current());
    if (distance(fromOcc(BRep_Tool::Pnt(vertex)), p) <= BRep_Tool::Tolerance(vertex))
    {
      return true;
    }
  }
  return false;
}

/// Gauss-Newton steps, damped until the distance falls (Levenberg-Marquardt).
void FaceOracle::polish(Foot& foot, const Point3& p) const
{
  double damping = 1e-12;
  for (int step = 0; step < 60 && damping < 1e6; ++step)
  {
    gp_Pnt at;
    gp_Vec du, dv;
    surface_.D1(foot.u, foot.v, at, du, dv);
    const gp_Vec rest(at, toOcc(p));
    const double a = du.Dot(du) * (1 + damping);
    const double d = dv.Dot(dv) * (1 + damping);
    const double b = du.Dot(dv);
    const double determinant = a * d - b * b;
    if (!(determinant > 0))
    {
      damping = 100 * damping;
      continue;
    }
    Foot next = foot;
    next.u += (d * rest.Dot(du) - b * rest.Dot(dv)) / determinant;
    next.v += (a * rest.Dot(dv) - b * rest.Dot(du)) / determinant;
    next.v = std::clamp(next.v, blocks_.front().v0, blocks_.back().v1);
    next.point = fromOcc(surface_.Value(next.u, next.v));
    next.distance = distance(next.point, p);
    damping *= next.distance < foot.distance ? 0.1 : 100;
    foot = next.distance < foot.distance ? next : foot;
  }
}

Foot FaceOracle::footAt(const Point3& p) const
{
  ShapeAnalysis_Surface search(BRep_Tool::Surface(face_));
  const gp_Pnt2d uv = search.ValueOfUV(toOcc(p), accuracy_);
  Foot foot;
  foot.u = uv.X();
  foot.v = uv.Y();
  foot.point = fromOcc(surface_.Value(foot.u, foot.v));
  foot.distance = distance(foot.point, p);
  polish(foot, p);
  return foot;
}

/// An edge's curve in space, or its trim curve on a face, with Open CASCADE's search over it.
struct CurveOracle
{
  CurveOracle(
    const BRepAdaptor_Curve& given, EntityId named, const Bnd_Box& around, double accuracy)
    : curve(given), entity(named), box(around)
  {
    search.Initialize(
      curve, curve.FirstParameter(), curve.LastParameter(), curve.Resolution(accuracy));
  }

  BRepAdaptor_Curve curve;
  EntityId entity; ///< What a point of it is named.
  Extrema_ExtPC search;
  Bnd_Box box;
};

/// Round a trim curve on its face, from points of it, by the largest step between them.
Bnd_Box boxOf(const BRepAdaptor_Curve& curve)
{
  constexpr int steps = 200;
  Bnd_Box box;
  double longest = 0;
  gp_Pnt before = curve.Value(curve.FirstParameter());
  for (int i = 0; i <= steps; ++i)
  {
    const double part = static_cast<double>(i) / steps;
    const gp_Pnt p =
      curve.Value((1 - part) * curve.FirstParameter() + part * curve.LastParameter());
    box.Add(p);
    longest = std::max(longest, p.Distance(before));
    before = p;
  }
  box.Enlarge(longest);
  return box;
}

/// A curve (of these) or a block of a face that is near enough.
struct Part
{
  EntityId entity;
  std::size_t number = 0;
  double bound = 0;
};

} // namespace

struct OccOracle::Implementation
{
  Implementation(const TopoDS_Shape& whole, double size) : shape(whole), index(whole)
  {
    const double accuracy = 1e-12 * size;
    for (const TopoDS_Edge& edge : index.edges())
    {
      const EntityId entity{ 1, static_cast<std::int32_t>(curves.size()) };
      curves.push_back(
        std::make_unique<CurveOracle>(BRepAdaptor_Curve(edge), entity, boxOf(edge), accuracy));
    }
    for (const TopoDS_Face& face : index.faces())
    {
      const EntityId entity{ 2, static_cast<std::int32_t>(faces.size()) };
      faces.push_back(std::make_unique<FaceOracle>(face, accuracy));
      for (TopExp_Explorer border(face, TopAbs_EDGE); border.More(); border.Next())
      {
        const TopoDS_Edge& edge = TopoDS::Edge(border.Current());
        double first = 0;
        double last = 0;
        if (!BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull())
        {
          const BRepAdaptor_Curve trim(edge, face);
          curves.push_back(std::make_unique<CurveOracle>(trim, entity, boxOf(trim), accuracy));
        }
      }
    }
  }

  std::vector<Part> partsWithin(const Point3& q, double limit) const;
  void nearestVertex(const Point3& q, double limit, Nearest& best) const;
  void nearestOnCurve(std::size_t curve, const Point3& q, double limit, Nearest& best) const;
  void nearestOnBlock(const Part& part, const Point3& q, double limit, Nearest& best) const;

  TopoDS_Shape shape;
  cadrefine::ShapeIndex index;
  std::vector<std::unique_ptr<CurveOracle>> curves; ///< Of edges, then of faces' borders.
  std::vector<std::unique_ptr<FaceOracle>> faces;
};

std::vector<Part> OccOracle::Implementation::partsWithin(const Point3& q, double limit) const
{
  std::vector<Part> parts;
  const auto add = [&](const Bnd_Box& box, EntityId entity, std::size_t number)
  {
    const double bound = boxDistance(box, q);
    if (bound <= limit)
    {
      parts.push_back({ entity, number, bound });
    }
  };
  for (std::size_t c = 0; c < curves.size(); ++c)
  {
    add(curves[c]->box, { 1, 0 }, c);
  }
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    for (std::size_t b = 0; b < faces[f]->blocks().size(); ++b)
    {
      add(faces[f]->blocks()[b].box, { 2, static_cast<std::int32_t>(f) }, b);
    }
  }
  return parts;
}

void OccOracle::Implementation::nearestVertex(const Point3& q, double limit, Nearest& best) const
{
  for (std::size_t v = 0; v < index.vertices().size(); ++v)
  {
    const Point3 p = fromOcc(BRep_Tool::Pnt(index.vertices()[v]));
    const double away = distance(p, q);
    if (away <= limit && away < best.distance)
    {
      best = { { 0, static_cast<std::int32_t>(v) }, p, away };
    }
  }
}

void OccOracle::Implementation::nearestOnCurve(
  std::size_t number, const Point3& q, double limit, Nearest& best) const
{
  Extrema_ExtPC& search = curves[number]->search;
  const BRepAdaptor_Curve& curve = curves[number]->curve;
  search.Perform(toOcc(q));
  for (int i = 1; search.IsDone() && i <= search.NbExt(); ++i)
  {
    const double t =
      std::clamp(search.Point(i).Parameter(), curve.FirstParameter(), curve.LastParameter());
    const Point3 p = fromOcc(curve.Value(t));
    const double away = distance(p, q);
    if (away <= limit && away < best.distance)
    {
      best = { curves[number]->entity, p, away };
    }
  }
}

void OccOracle::Implementation::nearestOnBlock(
  const Part& part, const Point3& q, double limit, Nearest& best) const
{
  const FaceOracle& face = *faces[part.entity.index];
  for (const Foot& foot : face.feet(part.number, q, std::min(limit, best.distance)))
  {
    if (face.isInside(foot))
    {
      best = { part.entity, foot.point, foot.distance };
      return;
    }
  }
}

OccOracle::OccOracle(const TopoDS_Shape& shape, double size)
  : implementation_(std::make_unique<Implementation>(shape, size))
{
}

OccOracle::~OccOracle() = default;

OccOracle::Nearest OccOracle::nearest(const Point3& q, double limit) const
{
  Nearest best;
  implementation_->nearestVertex(q, limit, best);
  std::vector<Part> parts = implementation_->partsWithin(q, limit);
  std::stable_sort(
    parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.bound < b.bound; });
  for (const Part& part : parts)
  {
    if (part.bound > best.distance)
    {
      break;
    }
    if (part.entity.dimension == 1)
    {
      implementation_->nearestOnCurve(part.number, q, limit, best);
    }
    else
    {
      implementation_->nearestOnBlock(part, q, limit, best);
    }
  }
  return best;
}

bool OccOracle::liesOn(EntityId entity, const Point3& p, double tolerance) const
{
  if (entity.dimension == 0)
  {
    return distance(fromOcc(BRep_Tool::Pnt(implementation_->index.vertices()[entity.index])), p) <=
           tolerance;
  }
  if (entity.dimension == 1)
  {
    gp_Pnt foot;
    double t = 0;
    return ShapeAnalysis_Curve().Project(implementation_->curves[entity.index]->curve, toOcc(p),
             tolerance, foot, t) <= tolerance;
  }
  const FaceOracle& face = *implementation_->faces[entity.index];
  std::vector<Foot> feet{ face.footAt(p) };
  for (std::size_t b = 0; b < face.blocks().size(); ++b)
  {
    if (boxDistance(face.blocks()[b].box, p) <= tolerance)
    {
      const std::vector<Foot> more = face.feet(b, p, tolerance);
      feet.insert(feet.end(), more.begin(), more.end());
    }
  }
  return face.isAtVertex(p) ||
         std::any_of(feet.begin(), feet.end(),
           [&](const Foot& foot) { return foot.distance <= tolerance && face.isInsideOrOn(foot); });
}

} // namespace exacttest
