#include "CADModel.h"

#include "CADModelBuilder.h"
#include "ModelBytes.h"
#include "ModelCheck.h"
#include "NurbsExtraction.h"
#include "OccGuard.h"
#include "ShapeIndex.h"
#include "ShapeTessellation.h"

#include <algorithm>
#include <cmath>
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
    throw Error(
      size == 0 ? "CAD model: all of it lies in one point" : "CAD model: its size is not finite");
  }
}

/// The segment that holds parameter t, the first or last one for a t beyond them.
const BezierCurve& segmentAt(const NurbsEdge& edge, double t)
{
  const auto after = std::upper_bound(edge.segments.begin(), edge.segments.end(), t,
    [](double value, const BezierCurve& segment) { return value < segment.t0; });
  return after == edge.segments.begin() ? *after : *(after - 1);
}

const BezierPatch& patchAt(const NurbsFace& face, double u, double v)
{
  int i = 0;
  while (i + 1 < face.patchesU && face.patches[(i + 1) * face.patchesV].u0 <= u)
  {
    ++i;
  }
  int j = 0;
  while (j + 1 < face.patchesV && face.patches[j + 1].v0 <= v)
  {
    ++j;
  }
  return face.patches[i * face.patchesV + j];
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

/// At a singular point the limit from inside the patch: the parameters are moved towards its
/// middle until there is a normal.
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

bool endsAt(const NurbsEdge& edge, int vertex)
{
  return edge.firstVertex == vertex || edge.lastVertex == vertex;
}

} // namespace

struct CADModel::Implementation
{
  Implementation(std::vector<char> source, const ModelContent& content)
    : bytes(std::move(source)), index(content.shape), nurbs(extractNurbs(index)),
      size(content.size),
      report(content.report), looks{ { {}, content.edgeLooks, content.faceLooks } }
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

  std::vector<char> bytes;
  ShapeIndex index;
  NurbsModel nurbs;
  double size = 0;
  CADReport report;
  std::array<std::vector<EntityLook>, 3> looks; ///< By dimension; empty where none has any.
  mutable std::once_flag searchOnce;
  mutable std::unique_ptr<const ClosestPointSearch> lazySearch;
};

std::shared_ptr<const CADModel> CADModelBuilder::build(std::vector<char> bytes)
{
  const ModelContent content = decodeModel(bytes);
  auto implementation = guardOcc("rebuilding the CAD model",
    [&] { return std::make_unique<const CADModel::Implementation>(std::move(bytes), content); });
  return std::shared_ptr<const CADModel>(new CADModel(std::move(implementation)));
}

CADModel::CADModel(std::unique_ptr<const Implementation> implementation)
  : implementation_(std::move(implementation))
{
}

CADModel::~CADModel() = default;

std::shared_ptr<const CADModel> CADModel::fromBytes(const std::vector<char>& bytes)
{
  return CADModelBuilder::build(bytes);
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

const CADReport& CADModel::report() const
{
  return implementation_->report;
}

const EntityLook& CADModel::look(EntityId entity) const
{
  static const EntityLook none;
  checkIndex(nurbs(), entity);
  const auto& looks = implementation_->looks[entity.dimension];
  const auto index = static_cast<std::size_t>(entity.index);
  return index < looks.size() ? looks[index] : none;
}

ClosestPoint CADModel::nearest(const Point3& point, const SearchScope& scope) const
{
  return implementation_->search().nearest(point, scope);
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

bool CADModel::inClosure(EntityId entity, EntityId of) const
{
  checkIndex(nurbs(), entity);
  checkIndex(nurbs(), of);
  if (entity == of || entity.dimension >= of.dimension)
  {
    return entity == of;
  }
  const NurbsModel& model = nurbs();
  if (of.dimension == 1)
  {
    return endsAt(model.edges[of.index], entity.index);
  }
  const auto& edges = model.faces[of.index].edges;
  return entity.dimension == 1
           ? std::binary_search(edges.begin(), edges.end(), entity.index)
           : std::any_of(edges.begin(), edges.end(),
               [&](std::int32_t e) { return endsAt(model.edges[e], entity.index); });
}

Tessellation CADModel::tessellate(EntityId entity, double deflection) const
{
  checkIndex(nurbs(), entity);
  if (!(deflection > 0))
  {
    throw Error("the deflection of a tessellation must be positive");
  }
  const ShapeIndex& index = implementation_->index;
  return guardOcc("drawing the CAD model",
    [&]
    {
      return entity.dimension == 2   ? tessellateFace(index.faces()[entity.index], deflection)
             : entity.dimension == 1 ? tessellateEdge(index.edges()[entity.index], deflection)
                                     : Tessellation();
    });
}

} // namespace cadrefine
