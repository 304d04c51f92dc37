#include "ClosestPointPeer.h"

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Extrema_GenLocateExtPS.hxx>
#include <Extrema_POnSurf.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopoDS.hxx>

#include <limits>
#include <random>

namespace cadbenchmark
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

gp_Pnt toOcc(const cadrefine::Point3& p)
{
  return { p[0], p[1], p[2] };
}

/// Faces, and where to start on them.
class Locator
{
public:
  Locator(const Case& of, std::vector<TopoDS_Face> faces)
    : measured_(of), faces_(std::move(faces)), surfaces_(faces_.begin(), faces_.end())
  {
    constexpr double share = 1e-3;
    std::mt19937_64 generator(2);
    std::uniform_real_distribution<double> off(-share, share);
    for (const Sample& sample : of.scattered)
    {
      const TopoDS_Face& face = faces_[sample.readFace];
      double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
      BRepTools::UVBounds(face, u0, u1, v0, v1);
      ShapeAnalysis_Surface analysis(BRep_Tool::Surface(face));
      gp_Pnt2d foot = analysis.ValueOfUV(toOcc(sample.point), 1e-9 * of.model->size());
      foot.SetX(foot.X() + off(generator) * (u1 - u0));
      foot.SetY(foot.Y() + off(generator) * (v1 - v0));
      starts_.push_back(foot);
    }
  }

  double locate(std::size_t i) const
  {
    const Sample& sample = measured_.scattered[i];
    Extrema_GenLocateExtPS locator(
      surfaces_[sample.readFace], Precision::PConfusion(), Precision::PConfusion());
    locator.Perform(toOcc(sample.point), starts_[i].X(), starts_[i].Y());
    return locator.IsDone() ? std::sqrt(locator.SquareDistance()) : infinity;
  }

private:
  const Case& measured_;
  std::vector<TopoDS_Face> faces_;
  std::vector<BRepAdaptor_Surface> surfaces_; ///< Of each face.
  std::vector<gp_Pnt2d> starts_;              ///< Of each point.
};

std::vector<TopoDS_Face> toNurbs(std::vector<TopoDS_Face> faces)
{
  for (TopoDS_Face& face : faces)
  {
    face = TopoDS::Face(BRepBuilderAPI_NurbsConvert(face, true).Shape());
  }
  return faces;
}

} // namespace

struct OpenCascadePeer::Implementation
{
  explicit Implementation(const Case& of)
    : measured(of), shape(cadrefine::decodeModel(of.model->toBytes()).shape), index(shape),
      asRead(of, index.faces()), asNurbs(of, toNurbs(index.faces()))
  {
  }

  const Case& measured;
  TopoDS_Shape shape;
  cadrefine::ShapeIndex index;
  Locator asRead;
  Locator asNurbs;
};

OpenCascadePeer::OpenCascadePeer(const Case& of)
  : implementation_(std::make_unique<const Implementation>(of))
{
}

OpenCascadePeer::~OpenCascadePeer() = default;

double OpenCascadePeer::locate(std::size_t i) const
{
  return implementation_->asNurbs.locate(i);
}

double OpenCascadePeer::locateAsRead(std::size_t i) const
{
  return implementation_->asRead.locate(i);
}

double OpenCascadePeer::search(std::size_t i) const
{
  const Implementation& own = *implementation_;
  const BRepExtrema_DistShapeShape extrema(
    BRepBuilderAPI_MakeVertex(toOcc(own.measured.scattered[i].point)).Vertex(), own.shape);
  return extrema.IsDone() ? extrema.Value() : infinity;
}

} // namespace cadbenchmark
