#include <cadrefine/cad/model/CADModel.h>

#include <cadrefine/cad/extraction/NurbsExtraction.h>
#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/model/CADModelBuilder.h>
#include <cadrefine/cad/model/ModelBytes.h>
#include <cadrefine/nurbs/EntityMeasure.h>
#include <cadrefine/nurbs/ModelCheck.h>
#include <cadrefine/nurbs/TrimMeasure.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>

namespace cadrefine
{
namespace
{

void checkIndex(const NurbsModel& model, EntityId entity)
{
  const bool known = entity.dimension >= 0 && entity.dimension <= 2 && entity.index >= 0 &&
                     entity.index < model.count(entity.dimension);
  if (!known)
  {
    throw Error("the CAD model has no entity " + std::to_string(entity.index) + " of dimension " +
                std::to_string(entity.dimension));
  }
}

void checkSize(double size)
{
  if (!(size > 0) || !std::isfinite(size))
  {
    throw Error(size == 0 ? "the CAD model is degenerate: a single point"
                          : "the size of the CAD model is not finite");
  }
}

/// The segment that holds parameter t, the first or last one for a t beyond them.
const BezierCurve& segmentAt(const NurbsEdge& edge, double t)
{
  const auto after = std::upper_bound(edge.segments.begin(), edge.segments.end(), t,
    [](double value, const BezierCurve& segment) { return value < segment.t0; });
  return after == edge.segments.begin() ? *after : *(after - 1);
}

/// Zero where the two directions are parallel to rounding, or one has no length.
Vector3 patchNormal(const BezierPatch& patch, double u, double v)
{
  const PatchDerivatives d = evaluateDerivatives(patch, u, v);
  const Vector3 n = cross(d.u, d.v);
  const double extentU = norm(d.u) * (patch.u1 - patch.u0);
  const double extentV = norm(d.v) * (patch.v1 - patch.v0);
  const double area = norm(n) * (patch.u1 - patch.u0) * (patch.v1 - patch.v0);
  const double extent = std::max(extentU, extentV);
  return area > 1e-9 * extent * extent ? normalized(n) : Vector3{};
}

/// The normal at a singular point, as the limit from inside the patch: the parameters are moved
/// towards its middle until there is a normal.
Vector3 limitNormal(const BezierPatch& patch, double u, double v)
{
  Vector3 n = patchNormal(patch, u, v);
  for (double step = 1e-6; squaredNorm(n) == 0 && step < 1e-2; step *= 10)
  {
    const double inwardU = 0.5 * (patch.u0 + patch.u1) - u;
    const double inwardV = 0.5 * (patch.v0 + patch.v1) - v;
    n = patchNormal(patch, u + step * inwardU, v + step * inwardV);
  }
  return n;
}

/// Parameters stay as they are.
NurbsModel scaled(NurbsModel model, const LengthScale& scale)
{
  const auto scalePoints = [&](std::vector<ControlPoint>& points)
  {
    for (ControlPoint& p : points)
    {
      p = { scale(p[0]), scale(p[1]), scale(p[2]), p[3] };
    }
  };
  for (NurbsFace& face : model.faces)
  {
    for (BezierPatch& patch : face.patches)
    {
      scalePoints(patch.points);
    }
    for (TrimLoop& loop : face.loops)
    {
      for (BezierCurve2& curve : loop)
      {
        curve.deviation = scale(curve.deviation);
      }
    }
    face.tolerance = scale(face.tolerance);
    face.fitError = scale(face.fitError);
  }
  for (NurbsEdge& edge : model.edges)
  {
    for (BezierCurve& segment : edge.segments)
    {
      scalePoints(segment.points);
    }
    edge.tolerance = scale(edge.tolerance);
  }
  for (NurbsVertex& vertex : model.vertices)
  {
    vertex.point = scale(vertex.point);
    vertex.tolerance = scale(vertex.tolerance);
  }
  return model;
}

/// Seen from far away the nearest point is the extreme one, but for less than size^2 / (2 far).
BoundingBox findBox(const ClosestPointSearch& search, double size)
{
  const double far = 1e6 * size;
  const Point3 somewhere = search.nearest({}).point;
  BoundingBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    Vector3 there{};
    there[axis] = far;
    box.low[axis] = search.nearest(somewhere - there).point[axis];
    box.high[axis] = search.nearest(somewhere + there).point[axis];
  }
  return box;
}

} // namespace

struct CADModel::Implementation
{
  Implementation(
    std::vector<char> source, const ModelContent& content, const ParallelFor& parallelFor)
    : bytes(std::move(source)), index(content.shape), scale(content.scale),
      nurbs(scaled(extractNurbs(index, parallelFor), scale)), size(content.size),
      report(content.report), allAttributes{ { {}, content.edgeAttributes,
                                content.faceAttributes } }
  {
    checkModel(nurbs);
    checkSize(size);
  }

  const ClosestPointSearch& search() const
  {
    std::call_once(
      searchOnce, [this] { lazySearch = std::make_unique<ClosestPointSearch>(nurbs); });
    return *lazySearch;
  }

  const std::vector<double>& lengths() const
  {
    std::call_once(lengthsOnce,
      [this]
      {
        std::transform(
          nurbs.edges.begin(), nurbs.edges.end(), std::back_inserter(lazyLengths), lengthOf);
      });
    return lazyLengths;
  }

  const std::vector<double>& areas() const
  {
    std::call_once(areasOnce,
      [this]
      {
        constexpr double most = 65536; // points of all faces, where there are few of these
        const double points =
          std::max(256.0, most / (1.0 + static_cast<double>(nurbs.faces.size())));
        std::transform(nurbs.faces.begin(), nurbs.faces.end(), std::back_inserter(lazyAreas),
          [&](const NurbsFace& face) { return areaOf(face, points); });
      });
    return lazyAreas;
  }

  const BoundingBox& box() const
  {
    std::call_once(boxOnce, [this] { lazyBox = findBox(search(), size); });
    return lazyBox;
  }

  std::vector<char> bytes;
  ShapeIndex index;
  LengthScale scale; ///< Leads from the coordinates of the index to those of the model.
  NurbsModel nurbs;
  double size = 0;
  CADReport report;
  std::array<std::vector<EntityAttributes>, 3>
    allAttributes; ///< Attributes of the entities, by dimension; empty where no entity has any.
  mutable std::once_flag searchOnce;
  mutable std::unique_ptr<const ClosestPointSearch> lazySearch;
  mutable std::once_flag lengthsOnce;
  mutable std::vector<double> lazyLengths;
  mutable std::once_flag areasOnce;
  mutable std::vector<double> lazyAreas;
  mutable std::once_flag boxOnce;
  mutable BoundingBox lazyBox;
};

std::shared_ptr<const CADModel> CADModelBuilder::build(
  std::vector<char> bytes, const ParallelFor& parallelFor)
{
  const ModelContent content = decodeModel(bytes);
  auto implementation = guardOcc("rebuilding the CAD model",
    [&]
    {
      return std::make_unique<const CADModel::Implementation>(
        std::move(bytes), content, parallelFor);
    });
  return std::shared_ptr<const CADModel>(new CADModel(std::move(implementation)));
}

CADModel::CADModel(std::unique_ptr<const Implementation> implementation)
  : implementation_(std::move(implementation))
{
}

CADModel::~CADModel() = default;

std::shared_ptr<const CADModel> CADModel::fromBytes(
  const std::vector<char>& bytes, const ParallelFor& parallelFor)
{
  return CADModelBuilder::build(bytes, parallelFor);
}

std::vector<char> CADModel::toBytes() const
{
  return implementation_->bytes;
}

const NurbsModel& CADModel::nurbs() const
{
  return implementation_->nurbs;
}

double CADModel::size() const
{
  return implementation_->size;
}

BoundingBox CADModel::box() const
{
  return implementation_->box();
}

double CADModel::measure(EntityId entity) const
{
  checkIndex(nurbs(), entity);
  return entity.dimension == 0   ? 0
         : entity.dimension == 1 ? implementation_->lengths()[entity.index]
                                 : implementation_->areas()[entity.index];
}

double CADModel::trimDeviation() const
{
  return largestTrimDeviation(nurbs());
}

double CADModel::fitError() const
{
  double largest = 0;
  for (const NurbsFace& face : nurbs().faces)
  {
    largest = std::max(largest, face.fitError);
  }
  return largest;
}

const CADReport& CADModel::report() const
{
  return implementation_->report;
}

const EntityAttributes& CADModel::attributes(EntityId entity) const
{
  static const EntityAttributes none;
  checkIndex(nurbs(), entity);
  const auto& allAttributes = implementation_->allAttributes[entity.dimension];
  const auto index = static_cast<std::size_t>(entity.index);
  return index < allAttributes.size() ? allAttributes[index] : none;
}

ClosestPoint CADModel::nearest(const Point3& point, const SearchScope& scope) const
{
  return implementation_->search().nearest(point, scope);
}

bool CADModel::isWithinDistance(const Point3& point, const SearchScope& scope) const
{
  return implementation_->search().isWithinDistance(point, scope);
}

ClosestPoint CADModel::nearestOn(EntityId entity, const Point3& point) const
{
  checkIndex(nurbs(), entity);
  return implementation_->search().nearestOn(entity, point);
}

Point3 CADModel::evaluate(EntityId entity, const std::array<double, 2>& parameters) const
{
  checkIndex(nurbs(), entity);
  if (entity.dimension == 0)
  {
    return nurbs().vertices[entity.index].point;
  }
  if (entity.dimension == 1)
  {
    const NurbsEdge& edge = nurbs().edges[entity.index];
    return cadrefine::evaluate(segmentAt(edge, parameters[0]), parameters[0]);
  }
  const NurbsFace& face = nurbs().faces[entity.index];
  return cadrefine::evaluate(
    patchAt(face, parameters[0], parameters[1]), parameters[0], parameters[1]);
}

Vector3 CADModel::normal(int face, const std::array<double, 2>& parameters) const
{
  checkIndex(nurbs(), { 2, face });
  const NurbsFace& f = nurbs().faces[face];
  const BezierPatch& patch = patchAt(f, parameters[0], parameters[1]);
  const double sign = f.reversed ? -1 : 1;
  return sign * limitNormal(patch, parameters[0], parameters[1]);
}

Vector3 CADModel::normalNear(int face, const Point3& point) const
{
  checkIndex(nurbs(), { 2, face });
  const ClosestPoint where = implementation_->search().nearestOnSurface(face, point);
  return where.entity ? normal(face, where.parameters) : Vector3{};
}

Vector3 CADModel::tangent(int edge, double t) const
{
  checkIndex(nurbs(), { 1, edge });
  const BezierCurve& segment = segmentAt(nurbs().edges[edge], t);
  Vector3 tangent = normalized(evaluateDerivatives(segment, t).t);
  for (double step = 1e-6; squaredNorm(tangent) == 0 && step < 1e-2; step *= 10)
  {
    const double inward = 0.5 * (segment.t0 + segment.t1) - t;
    tangent = normalized(evaluateDerivatives(segment, t + step * inward).t);
  }
  return tangent;
}

} // namespace cadrefine
