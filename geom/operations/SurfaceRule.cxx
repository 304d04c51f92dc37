#include <cadrefine/operations/SurfaceRule.h>

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/classification/MidpointProjection.h>
#include <cadrefine/error/GeometricError.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

namespace cadrefine
{
namespace
{

/// Depth of the error before it is extrapolated, as where meshes are measured.
constexpr int errorDepth = 2;

/// Relative rounding error of distances from the CAD, which on a fillet are the same wherever a
/// facet is.
constexpr double distanceRounding = 1e-6;

/// A place beside the middle of an edge is at least so far to that side, in parts of its length.
constexpr double leastOpening = 0.05;

/// Cosine of the largest turn of a facet's normal (40 degrees).
const double turnCosine = ClassificationTolerances::cosineOfDegrees(40);

Vector3 normalOf(const EditableMesh& mesh, const std::array<Index, 3>& facet)
{
  return normalized(twofoldAreaVector(
    mesh.vertex(facet[0]).wanted, mesh.vertex(facet[1]).wanted, mesh.vertex(facet[2]).wanted));
}

Vector3 directionOf(const EditableMesh& mesh, const std::array<Index, 2>& segment)
{
  return normalized(mesh.vertex(segment[1]).wanted - mesh.vertex(segment[0]).wanted);
}

bool areTurnedAlike(
  const EditableMesh& mesh, const std::array<Index, 3>& a, const std::array<Index, 3>& b)
{
  return dot(normalOf(mesh, a), normalOf(mesh, b)) > 0;
}

/// Segments have no side.
bool areTurnedAlike(const EditableMesh&, const std::array<Index, 2>&, const std::array<Index, 2>&)
{
  return true;
}

/// Whether the boundary off the CAD stays as it is, or, where it may change, in its planes and
/// lines: each new part lies in one of those before, and is turned as that is.
template<class Store, class List>
bool areWallsKept(const EditableMesh& mesh, const Store& store, const std::vector<Index>& before,
  const List& after, SurfaceLimits::Walls walls)
{
  const auto isPartOf = [&](const auto& wall, const auto& old)
  {
    return old.label == wall.label && areTurnedAlike(mesh, wall.corners, old.corners) &&
           std::all_of(wall.corners.begin(), wall.corners.end(),
             [&](Index v) { return mesh.isInSpanOf(old.corners, v); });
  };
  const auto isOnWall = [&](const auto& wall)
  {
    return std::any_of(
      before.begin(), before.end(), [&](Index old) { return isPartOf(wall, store[old]); });
  };
  const auto isLeft = [&](Index vertex)
  {
    return std::any_of(after.begin(), after.end(),
      [&](const auto& part) { return part.label < 0 && hasCorner(part.corners, vertex); });
  };
  const auto stays = [&](Index old)
  {
    const auto& corners = store[old].corners;
    return store[old].label >= 0 || walls == SurfaceLimits::Walls::LoseVertices ||
           (walls == SurfaceLimits::Walls::KeepVertices &&
             std::all_of(corners.begin(), corners.end(), isLeft));
  };
  return std::all_of(before.begin(), before.end(), stays) &&
         std::all_of(after.begin(), after.end(),
           [&](const auto& part) { return part.label >= 0 || isOnWall(part); });
}

} // namespace

SurfaceRule::Fit SurfaceRule::fitOf(
  const EditableMesh& mesh, const std::vector<Index>& facets) const
{
  Fit fit;
  // Of flat facets on a plane only rounding is left.
  fit.distance = ClassificationTolerances::leastExact * projector_.model().size();
  for (const Index facet : facets)
  {
    if (mesh.facets()[facet].label >= 0)
    {
      widen(mesh, {}, mesh.facets()[facet].corners, fit);
    }
  }
  return fit;
}

/// Whether a facet is on the CAD, as when a mesh's boundary is classified: in a mesh of triangles
/// in space, if all its corners are.
bool SurfaceRule::isOnCAD(const EditableMesh& mesh, const std::array<Index, 3>& facet) const
{
  if (mesh.kind() == EditableMesh::Kind::Surface)
  {
    return std::all_of(facet.begin(), facet.end(),
      [&](Index vertex) { return static_cast<bool>(mesh.vertex(vertex).entity); });
  }
  ClassifiedFacet onCAD{};
  for (int k = 0; k < 3; ++k)
  {
    onCAD.points[k] = mesh.vertex(facet[k]).wanted;
    onCAD.entities[k] = mesh.vertex(facet[k]).entity;
  }
  return projector_.isOnCAD(onCAD);
}

bool SurfaceRule::accepts(
  const EditableMesh& mesh, const Cavity& cavity, const SurfaceLimits& limits) const
{
  const bool isPlane = mesh.kind() == EditableMesh::Kind::Plane;
  const bool keepsWalls =
    isPlane ? areWallsKept(mesh, mesh.segments(), cavity.segments, cavity.newSegments, limits.walls)
            : areWallsKept(mesh, mesh.facets(), cavity.facets, cavity.newFacets, limits.walls);
  return keepsWalls &&
         (isPlane ? acceptsSegments(mesh, cavity, limits.distance)
                  : acceptsFacets(mesh, cavity, limits.distance)) &&
         (!limits.keepsError || errorGain(mesh, cavity) <= 0);
}

bool SurfaceRule::acceptsFacets(
  const EditableMesh& mesh, const Cavity& cavity, double distance) const
{
  const auto turnsLittle = [&](const LabelledSimplex<3>& facet)
  {
    const Vector3 normal = normalOf(mesh, facet.corners);
    return std::any_of(cavity.facets.begin(), cavity.facets.end(),
      [&](Index old)
      { return dot(normal, normalOf(mesh, mesh.facets()[old].corners)) >= turnCosine; });
  };
  // What costs least comes first.
  if (!std::all_of(cavity.newFacets.begin(), cavity.newFacets.end(),
        [&](const auto& facet) { return facet.label < 0 || turnsLittle(facet); }))
  {
    return false;
  }
  std::optional<Fit> before; // looked at where the new facets alone do not tell
  return std::all_of(cavity.newFacets.begin(), cavity.newFacets.end(),
    [&](const auto& facet)
    {
      if (facet.label < 0)
      {
        return true;
      }
      if (!isOnCAD(mesh, facet.corners))
      {
        return false;
      }
      Fit fit;
      widen(mesh, cavity, facet.corners, fit);
      if (isAsGood(fit, { distance, 1 }))
      {
        return true;
      }
      before = before ? before : fitOf(mesh, cavity.facets);
      return isAsGood(fit, { std::max(before->distance, distance), before->cosine });
    });
}

/// The class of an edge of the facets before or after the operation.
EdgeClass SurfaceRule::classOf(
  const EditableMesh& mesh, const Cavity& cavity, Index a, Index b) const
{
  const auto isBetween = [&](const LabelledSimplex<2>& segment)
  { return hasCorner(segment.corners, a) && hasCorner(segment.corners, b); };
  const auto added = std::find_if(cavity.newSegments.begin(), cavity.newSegments.end(), isBetween);
  const Index there = mesh.segmentOf(a, b);
  if (added == cavity.newSegments.end() && there < 0)
  {
    return { EdgeClass::Smooth, -1 };
  }
  return there < 0 ? added->edgeClass : mesh.segments()[there].edgeClass;
}

/// A surface of one facet, or of one segment of a planar mesh.
template<std::size_t Corners>
ClassifiedSurface SurfaceRule::surfaceOf(
  const EditableMesh& mesh, const Cavity& cavity, const std::array<Index, Corners>& facet) const
{
  ClassifiedSurface surface;
  surface.kind = projector_.kind();
  surface.facets.emplace_back();
  for (std::size_t k = 0; k < Corners; ++k)
  {
    const auto here = static_cast<Index>(k);
    surface.points.push_back({ mesh.vertex(facet[k]).wanted, mesh.vertex(facet[k]).entity });
    surface.facets[0].corners[k] = here;
    if (Corners == 3 || k == 0)
    {
      const auto next = static_cast<Index>((k + 1) % Corners);
      surface.edges.push_back({ { here, next }, classOf(mesh, cavity, facet[k], facet[next]) });
      surface.facets[0].edges[k] = here;
    }
  }
  return surface;
}

double SurfaceRule::errorOf(const ClassifiedSurface& facet) const
{
  FacetKey key{};
  for (std::size_t k = 0; k < facet.points.size(); ++k)
  {
    const SurfacePoint& corner = facet.points[k];
    const EdgeClass edge = k < facet.edges.size() ? facet.edges[k].edgeClass : EdgeClass{};
    key[k] = { corner.point[0], corner.point[1], corner.point[2],
      static_cast<double>(corner.entity.dimension), static_cast<double>(corner.entity.index),
      static_cast<double>(edge.kind), static_cast<double>(edge.entity) };
  }
  const auto [error, isNew] = errors_.try_emplace(key);
  if (isNew)
  {
    const auto project = [&](const std::vector<BoundaryEdge>& edges)
    {
      std::vector<ClosestPoint> places;
      std::transform(edges.begin(), edges.end(), std::back_inserter(places),
        [&](const BoundaryEdge& edge) { return projectMidpoint(projector_, edge); });
      return places;
    };
    error->second = extrapolatedMeasure(
      geometricErrors(facet, project(facet.allEdges()), errorDepth, 1, project).front());
  }
  return error->second;
}

double SurfaceRule::errorGain(const EditableMesh& mesh, const Cavity& cavity) const
{
  double before = 0;
  double after = 0;
  double length = 0; // of the longest edge before
  const auto addOld = [&](const auto& store, const std::vector<Index>& old)
  {
    for (const Index number : old)
    {
      if (store[number].label >= 0)
      {
        const ClassifiedSurface facet = surfaceOf(mesh, cavity, store[number].corners);
        before += errorOf(facet);
        for (const auto& [ends, edgeClass] : facet.edges)
        {
          length =
            std::max(length, distance(facet.points[ends[0]].point, facet.points[ends[1]].point));
        }
      }
    }
  };
  const auto addNew = [&](const auto& added)
  {
    for (const auto& simplex : added)
    {
      after += simplex.label >= 0 ? errorOf(surfaceOf(mesh, cavity, simplex.corners)) : 0;
    }
  };
  const bool ofEdges = projector_.kind() == BoundaryKind::Edges;
  ofEdges ? addOld(mesh.segments(), cavity.segments) : addOld(mesh.facets(), cavity.facets);
  ofEdges ? addNew(cavity.newSegments) : addNew(cavity.newFacets);
  const double rounding = ClassificationTolerances::leastExact * projector_.model().size() *
                          (ofEdges ? length : length * length);
  const double gain = after - before;
  return std::abs(gain) <= rounding ? 0 : gain;
}

SurfaceRule::Fit SurfaceRule::fitAt(const EditableMesh& mesh, Index vertex) const
{
  if (mesh.kind() != EditableMesh::Kind::Plane)
  {
    return fitOf(mesh, mesh.facets().at(vertex));
  }
  Fit fit;
  fit.distance = farthestMiddle(mesh, mesh.segments().at(vertex));
  return fit;
}

bool SurfaceRule::isAsGood(const Fit& fit, const Fit& before)
{
  return fit.distance <= (1 + distanceRounding) * before.distance &&
         fit.cosine >= std::min(ClassificationTolerances::fittingCosine, before.cosine);
}

/// Largest distance of the middles of these segments from the CAD, and of their ends from where
/// they are wanted; not less than rounding errors.
double SurfaceRule::farthestMiddle(
  const EditableMesh& mesh, const std::vector<Index>& segments) const
{
  double farthest = ClassificationTolerances::leastExact * projector_.model().size();
  for (const Index segment : segments)
  {
    farthest = std::max(farthest, distanceOfMiddle(mesh, mesh.segments()[segment].corners));
    for (const Index end : mesh.segments()[segment].corners)
    {
      farthest = std::max(farthest, distance(mesh.vertex(end).point, mesh.vertex(end).wanted));
    }
  }
  return farthest;
}

bool SurfaceRule::acceptsSegments(
  const EditableMesh& mesh, const Cavity& cavity, double distance) const
{
  const double farthest = std::max(farthestMiddle(mesh, cavity.segments), distance);
  return std::all_of(cavity.newSegments.begin(), cavity.newSegments.end(),
    [&](const auto& segment)
    {
      if (segment.label < 0)
      {
        return true;
      }
      const Vector3 direction = directionOf(mesh, segment.corners);
      const bool turnsLittle = std::any_of(cavity.segments.begin(), cavity.segments.end(),
        [&](Index old)
        {
          return std::abs(dot(direction, directionOf(mesh, mesh.segments()[old].corners))) >=
                 turnCosine;
        });
      const auto& [a, b] = segment.corners;
      return turnsLittle && distanceOfMiddle(mesh, segment.corners) <= farthest &&
             projector_.isOnCAD({ { mesh.vertex(a).wanted, mesh.vertex(b).wanted }, {} });
    });
}

double SurfaceRule::distanceOfMiddle(
  const EditableMesh& mesh, const std::array<Index, 2>& segment) const
{
  const Point3 middle = 0.5 * (mesh.vertex(segment[0]).wanted + mesh.vertex(segment[1]).wanted);
  return nearest(middle).where.distance;
}

const SurfaceRule::PlaceOnCAD& SurfaceRule::nearest(const Point3& point) const
{
  const auto [place, isNew] = found_.try_emplace(point);
  if (isNew)
  {
    auto& [where, normal] = place->second;
    where = projector_.nearest(point, std::numeric_limits<double>::infinity());
    if (where.entity.dimension == 2)
    {
      normal = projector_.model().normal(where.entity.index, where.parameters);
    }
  }
  return place->second;
}

/// Includes another facet in the fit.
void SurfaceRule::widen(
  const EditableMesh& mesh, const Cavity& cavity, const std::array<Index, 3>& facet, Fit& fit) const
{
  const std::array<Point3, 3> p{ mesh.vertex(facet[0]).wanted, mesh.vertex(facet[1]).wanted,
    mesh.vertex(facet[2]).wanted };
  const Vector3 normal = normalOf(mesh, facet);
  const auto lookAt = [&](const Point3& point, bool isOnFace)
  {
    const auto& [where, ofCAD] = nearest(point);
    fit.distance = std::max(fit.distance, distance(point, where.point));
    if (where.entity.dimension == 2 && isOnFace)
    {
      fit.cosine = std::min(fit.cosine, std::abs(dot(normal, ofCAD)));
    }
    return where;
  };
  lookAt((1.0 / 3) * (p[0] + p[1] + p[2]), true);
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    const BoundaryEdge edge{ classOf(mesh, cavity, facet[k], facet[next]), { p[k], p[next] },
      { mesh.vertex(facet[k]).entity, mesh.vertex(facet[next]).entity } };
    const bool isOnFace = edge.edgeClass.kind == EdgeClass::Smooth;
    const Point3 middle = 0.5 * (p[k] + p[next]);
    const ClosestPoint where = lookAt(middle, isOnFace);
    if (isOnFace)
    {
      const ClosestPoint nose = onNose(projector_, edge, where);
      fit.distance = nose.entity ? std::max(fit.distance, nose.distance) : fit.distance;
    }
    else if (edge.edgeClass.kind == EdgeClass::OnEdge)
    {
      const Point3 place = projectMidpoint(projector_, edge).point;
      fit.distance = std::max(fit.distance, distance(middle, place));
    }
    if (mesh.dimension() == 2)
    {
      fit.distance = std::max(fit.distance, distance(mesh.vertex(facet[k]).point, p[k]));
    }
  }
}

bool SurfaceRule::isOffCAD(const EditableMesh& mesh, Index a, Index b) const
{
  const Index segment = mesh.segmentOf(a, b);
  if (segment >= 0 && mesh.segments()[segment].edgeClass.kind != EdgeClass::Straight)
  {
    return false;
  }
  const std::vector<Index> facets = mesh.facets().at(a, b);
  return mesh.kind() == EditableMesh::Kind::Solid
           ? std::all_of(facets.begin(), facets.end(),
               [&](Index facet) { return mesh.facets()[facet].label < 0; })
           : segment >= 0 && mesh.plane() != Vector3{};
}

std::optional<ClosestPoint> SurfaceRule::placeOfMiddle(
  const EditableMesh& mesh, Index a, Index b) const
{
  if (isOffCAD(mesh, a, b))
  {
    ClosestPoint halfway;
    halfway.point = 0.5 * (mesh.vertex(a).point + mesh.vertex(b).point);
    return halfway;
  }
  const Index segment = mesh.segmentOf(a, b);
  const EdgeClass edgeClass =
    segment < 0 ? EdgeClass{ EdgeClass::Smooth, -1 } : mesh.segments()[segment].edgeClass;
  if (edgeClass.kind == EdgeClass::Straight)
  {
    return std::nullopt;
  }
  const BoundaryEdge onCAD{ edgeClass, { mesh.vertex(a).wanted, mesh.vertex(b).wanted },
    { mesh.vertex(a).entity, mesh.vertex(b).entity } };
  ClosestPoint where = offBorder(projector_, onCAD, projectMidpoint(projector_, onCAD));
  for (const Index facet : mesh.facets().at(a, b))
  {
    if (mesh.kind() == EditableMesh::Kind::Solid && mesh.facets()[facet].label < 0)
    {
      const auto& [p, q, r] = mesh.facets()[facet].corners;
      where = inPlane(projector_, onCAD, where,
        normalized(
          twofoldAreaVector(mesh.vertex(p).point, mesh.vertex(q).point, mesh.vertex(r).point)));
    }
  }
  return where.entity ? std::optional(where) : std::nullopt;
}

std::optional<ClosestPoint> SurfaceRule::placeBesideMiddle(
  const EditableMesh& mesh, Index a, Index b, const Vector3& towards) const
{
  const EditableMesh::Vertex& first = mesh.vertex(a);
  const EditableMesh::Vertex& last = mesh.vertex(b);
  const BoundaryEdge edge{ { EdgeClass::Smooth, -1 }, { first.wanted, last.wanted },
    { first.entity, last.entity } };
  const Point3 middle = 0.5 * (first.wanted + last.wanted);
  const double least = leastOpening * distance(first.wanted, last.wanted);
  const ClosestPoint place = placeBeside(projector_, edge, towards, { 0.0, 0.125, 0.25, 0.5, 1.0 },
    [&](const ClosestPoint& candidate)
    {
      const EntityId entity = candidate.entity;
      const bool isInsideFace =
        entity.dimension == 2 ||
        (entity.dimension == 1 && isSeam(projector_.model().nurbs().edges[entity.index]));
      return isInsideFace && dot(candidate.point - middle, towards) > least;
    });
  return place.entity ? std::optional(place) : std::nullopt;
}

} // namespace cadrefine
