#include <cadrefine/error/GeometricError.h>

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace cadrefine
{
namespace
{

int cornersOf(BoundaryKind kind, const SurfaceFacet& facet)
{
  return kind == BoundaryKind::Edges ? 2 : facet.quad < 0 ? 3 : 4;
}

int edgesOf(BoundaryKind kind, const SurfaceFacet& facet)
{
  return kind == BoundaryKind::Edges ? 1 : cornersOf(kind, facet);
}

/// The vertices that refinement would make in the middle of the edges and quadrilaterals.
std::vector<SurfacePoint> newPoints(
  const ClassifiedSurface& surface, const std::vector<ClosestPoint>& midpoints)
{
  std::vector<SurfacePoint> points;
  points.reserve(midpoints.size());
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    const auto [a, b] = surface.edges[e].ends;
    const ClosestPoint& where = midpoints[e];
    const Point3 middle = 0.5 * (surface.points[a].point + surface.points[b].point);
    points.push_back({ where.entity ? where.point : middle, where.entity });
  }
  for (std::size_t m = surface.edges.size(); m < midpoints.size(); ++m)
  {
    points.push_back({ midpoints[m].point, midpoints[m].entity });
  }
  return points;
}

/// What is between a facet and its children on either side of it, by heights over the facet that
/// are linear between their places. In a sum with signs the two cancel.
class BothSides
{
public:
  /// Adds what is over a segment of this length, with heights a and b at its ends.
  void add(double length, double a, double b)
  {
    const double whole = length * (a + b) / 2;
    const double atA = a * b < 0 ? length * a * (a / (a - b)) / 2 : 0;
    add(atA);
    add(whole - atA);
  }

  /// Adds what is over a triangle of this area, with heights a, b and c at its corners.
  void add(double area, double a, double b, double c)
  {
    if (b * c < 0) // so that, where one is alone on its side, that is the first
    {
      std::swap(a, a * b > 0 ? c : b);
    }
    const double whole = area * (a + b + c) / 3;
    const double atA = a * b < 0 || a * c < 0 ? area * a * (a / (a - b)) * (a / (a - c)) / 3 : 0;
    add(atA);
    add(whole - atA);
  }

  double cancelled() const { return 2 * std::min(above_, below_); }

private:
  void add(double part) { (part > 0 ? above_ : below_) += std::abs(part); }

  double above_ = 0;
  double below_ = 0;
};

double areaBetween(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& m)
{
  return 0.5 * norm(twofoldAreaVector(a.point, b.point, b.place) +
                    twofoldAreaVector(a.point, b.place, m.point) +
                    twofoldAreaVector(a.point, m.point, a.place));
}

BothSides bothSidesOf(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& m)
{
  const std::array<Vector3, 3> ways{ a.place - a.point, m.point - 0.5 * (a.point + b.point),
    b.place - b.point };
  const Vector3 along = b.point - a.point;
  std::array<Vector3, 3> across;
  std::transform(ways.begin(), ways.end(), across.begin(),
    [&, direction = normalized(along)](const Vector3& way)
    { return way - dot(way, direction) * direction; });
  const Vector3 up = normalized(*std::max_element(across.begin(), across.end(),
    [](const Vector3& x, const Vector3& y) { return squaredNorm(x) < squaredNorm(y); }));
  BothSides sides;
  sides.add(norm(along) / 2, dot(across[0], up), dot(across[1], up));
  sides.add(norm(along) / 2, dot(across[1], up), dot(across[2], up));
  return sides;
}

/// Six times the volume between the origin and a triangle, or a bilinear quadrilateral: the mean of
/// both ways to cut that in two triangles.
double sixfoldVolumeOver(const Point3& origin, const Point3& x, const Point3& y, const Point3& z)
{
  return determinant(x - origin, y - origin, z - origin);
}

double sixfoldVolumeOver(
  const Point3& origin, const Point3& x, const Point3& y, const Point3& z, const Point3& w)
{
  return 0.5 * (sixfoldVolumeOver(origin, x, y, z) + sixfoldVolumeOver(origin, x, z, w) +
                 sixfoldVolumeOver(origin, x, y, w) + sixfoldVolumeOver(origin, y, z, w));
}

/// The corners of a facet (of a segment two) and the middles of its edges, and of a quadrilateral
/// its own.
struct FacetPoints
{
  int corners = 3;
  std::array<SurfacePoint, 4> c;
  std::array<SurfacePoint, 4> m;
  Point3 middle{};
};

BothSides bothSidesOf(const FacetPoints& facet)
{
  const auto& [corners, c, m, middle] = facet;
  std::array<Point3, 4> points{};
  std::transform(
    c.begin(), c.end(), points.begin(), [](const SurfacePoint& corner) { return corner.point; });
  const Vector3 up = normalized(twofoldAreaVector(points, corners));
  const Point3 centre = centroidOf(points, corners);
  std::array<Point3, 4> halves{};
  std::array<double, 4> atCorners{};
  std::array<double, 4> atHalves{};
  for (int k = 0; k < corners; ++k)
  {
    halves[k] = 0.5 * (points[k] + points[(k + 1) % corners]);
    atCorners[k] = dot(up, c[k].place - points[k]);
    atHalves[k] = dot(up, m[k].point - halves[k]);
  }
  const auto areaOf = [](const Point3& x, const Point3& y, const Point3& z)
  { return norm(twofoldAreaVector(x, y, z)) / 2; };
  const double atCentre = dot(up, middle - centre);
  BothSides sides;
  for (int k = 0; k < corners; ++k)
  {
    const int previous = (k + corners - 1) % corners;
    if (corners == 3)
    {
      sides.add(areaOf(points[k], halves[k], halves[previous]), atCorners[k], atHalves[k],
        atHalves[previous]);
    }
    else
    {
      sides.add(areaOf(points[k], halves[k], centre), atCorners[k], atHalves[k], atCentre);
      sides.add(
        areaOf(points[k], centre, halves[previous]), atCorners[k], atCentre, atHalves[previous]);
    }
  }
  if (corners == 3)
  {
    sides.add(areaOf(halves[0], halves[1], halves[2]), atHalves[0], atHalves[1], atHalves[2]);
  }
  return sides;
}

/// The volume of the polyhedron between the facet and its children.
double volumeBetween(const FacetPoints& facet)
{
  const auto& [corners, c, m, middle] = facet;
  const Point3& origin = c[0].point;
  const auto over = [&](const auto&... points) { return sixfoldVolumeOver(origin, points...); };
  // A flat triangle itself passes through the origin.
  double volume = corners == 4 ? -over(c[0].point, c[1].point, c[2].point, c[3].point)
                               : over(m[0].point, m[1].point, m[2].point);
  for (int k = 0; k < corners; ++k)
  {
    const int next = (k + 1) % corners;
    const int previous = (k + corners - 1) % corners;
    volume += corners == 4 ? over(c[k].place, m[k].point, middle, m[previous].point)
                           : over(c[k].place, m[k].point, m[previous].point);
    volume += over(c[k].point, c[next].point, m[k].point); // the side over edge k
    volume += over(c[k].point, m[k].point, c[k].place);
    volume += over(c[next].point, c[next].place, m[k].point);
  }
  return std::abs(volume) / 6;
}

FacetPoints pointsOf(const ClassifiedSurface& surface, const std::vector<SurfacePoint>& middles,
  const SurfaceFacet& facet)
{
  FacetPoints points;
  points.corners = cornersOf(surface.kind, facet);
  for (int k = 0; k < points.corners; ++k)
  {
    points.c[k] = surface.points[facet.corners[k]];
  }
  for (int k = 0; k < edgesOf(surface.kind, facet); ++k)
  {
    points.m[k] = middles[facet.edges[k]];
  }
  if (facet.quad >= 0)
  {
    points.middle = middles[surface.edges.size() + facet.quad].point;
  }
  return points;
}

double cancelledAt(const FacetPoints& facet)
{
  const auto& [corners, c, m, middle] = facet;
  return (corners == 2 ? bothSidesOf(c[0], c[1], m[0]) : bothSidesOf(facet)).cancelled();
}

/// The error of a facet at one level.
FacetError errorOf(const ClassifiedSurface& surface, const std::vector<ClosestPoint>& midpoints,
  const std::vector<SurfacePoint>& middles, const SurfaceFacet& facet)
{
  FacetError error;
  const FacetPoints points = pointsOf(surface, middles, facet);
  const auto& [corners, c, m, middle] = points;
  for (int k = 0; k < corners; ++k)
  {
    error.largestDistance = std::max(error.largestDistance, distance(c[k].point, c[k].place));
  }
  const auto meet = [&](std::size_t e)
  {
    const ClosestPoint& where = midpoints[e];
    error.chordError = std::max(error.chordError, where.entity ? where.distance : 0);
  };
  for (int k = 0; k < edgesOf(surface.kind, facet); ++k)
  {
    meet(facet.edges[k]);
  }
  if (facet.quad >= 0)
  {
    meet(surface.edges.size() + facet.quad);
  }
  error.largestDistance = std::max(error.largestDistance, error.chordError);
  error.measure = corners == 2 ? areaBetween(c[0], c[1], m[0]) : volumeBetween(points);
  error.lastLevel = error.measure;
  return error;
}

/// The half of edge e at this end of it.
Index halfAt(const ClassifiedSurface& surface, Index e, Index end)
{
  return 2 * e + (surface.edges[e].ends[0] == end ? 0 : 1);
}

/// The children of all facets, those of each in a row: at its corners, then in a triangle's middle.
/// Points: the places of the surface's, then `middles`. Edges: the halves of the surface's, then
/// three in each triangle, of which edge k cuts corner k off, and four in each quadrilateral, of
/// which edge k ends in the middle of edge k.
ClassifiedSurface subdivide(
  const ClassifiedSurface& surface, const std::vector<SurfacePoint>& middles)
{
  ClassifiedSurface children;
  children.kind = surface.kind;
  const bool ofFaces = surface.kind == BoundaryKind::Faces;
  const auto firstMiddle = static_cast<Index>(surface.points.size());
  const auto firstInner = static_cast<Index>(2 * surface.edges.size());
  children.points.reserve(surface.points.size() + middles.size());
  for (const SurfacePoint& p : surface.points)
  {
    children.points.push_back({ p.place, p.placeEntity });
  }
  children.points.insert(children.points.end(), middles.begin(), middles.end());
  children.edges.reserve(firstInner + (ofFaces ? 3 * surface.facets.size() : 0));
  Index quads = 0;
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    const auto& [ends, edgeClass] = surface.edges[e];
    const Index middle = firstMiddle + static_cast<Index>(e);
    children.edges.push_back({ { ends[0], middle }, edgeClass });
    children.edges.push_back({ { middle, ends[1] }, edgeClass });
  }
  children.facets.reserve((ofFaces ? 4 : 2) * surface.facets.size());
  for (const SurfaceFacet& facet : surface.facets)
  {
    const auto& [corners, edges, face, quad] = facet;
    if (!ofFaces)
    {
      const Index middle = firstMiddle + edges[0];
      children.facets.push_back(
        { { corners[0], middle }, { halfAt(surface, edges[0], corners[0]) } });
      children.facets.push_back(
        { { middle, corners[1] }, { halfAt(surface, edges[0], corners[1]) } });
      continue;
    }
    const auto inner = static_cast<Index>(children.edges.size());
    if (quad >= 0)
    {
      const Index centre = firstMiddle + static_cast<Index>(surface.edges.size()) + quad;
      for (int k = 0; k < 4; ++k)
      {
        const int previous = (k + 3) % 4;
        const Index m = firstMiddle + edges[k];
        children.edges.push_back({ { m, centre }, { EdgeClass::Smooth, face } });
        children.facets.push_back({ { corners[k], m, centre, firstMiddle + edges[previous] },
          { halfAt(surface, edges[k], corners[k]), inner + k, inner + previous,
            halfAt(surface, edges[previous], corners[k]) },
          face, quads++ });
      }
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      const int previous = (k + 2) % 3;
      const Index m = firstMiddle + edges[k];
      const Index n = firstMiddle + edges[previous];
      children.edges.push_back({ { m, n }, { EdgeClass::Smooth, face } });
      children.facets.push_back({ { corners[k], m, n },
        { halfAt(surface, edges[k], corners[k]), inner + k,
          halfAt(surface, edges[previous], corners[k]) },
        face });
    }
    children.facets.push_back(
      { { firstMiddle + edges[0], firstMiddle + edges[1], firstMiddle + edges[2] },
        { inner + 1, inner + 2, inner }, face });
  }
  return children;
}

std::vector<FacetError> errorsOf(const ClassifiedSurface& surface,
  const std::vector<ClosestPoint>& midpoints, const std::vector<SurfacePoint>& middles, int depth,
  const ProjectMidpoints& project)
{
  std::vector<FacetError> errors;
  errors.reserve(surface.facets.size());
  for (const SurfaceFacet& facet : surface.facets)
  {
    errors.push_back(errorOf(surface, midpoints, middles, facet));
  }
  if (depth <= 1)
  {
    return errors;
  }
  const ClassifiedSurface children = subdivide(surface, middles);
  const auto ofEdges = project(children.allEdges());
  const auto ofChildren =
    errorsOf(children, ofEdges, newPoints(children, ofEdges), depth - 1, project);
  auto child = ofChildren.begin();
  for (FacetError& error : errors)
  {
    error.lastLevel = 0;
    for (const auto end = child + (surface.kind == BoundaryKind::Faces ? 4 : 2); child != end;
         ++child)
    {
      error.measure += child->measure;
      error.lastLevel += child->lastLevel;
      error.largestDistance = std::max(error.largestDistance, child->largestDistance);
    }
  }
  return errors;
}

/// Numbers what is asked for in the order in which it comes.
class Renumbering
{
public:
  explicit Renumbering(std::size_t count) : numbers_(count, -1) {}

  Index operator()(Index old)
  {
    if (numbers_[old] < 0)
    {
      numbers_[old] = static_cast<Index>(order_.size());
      order_.push_back(old);
    }
    return numbers_[old];
  }
  const std::vector<Index>& order() const { return order_; }
  void clear()
  {
    for (const Index old : order_)
    {
      numbers_[old] = -1;
    }
    order_.clear();
  }

private:
  std::vector<Index> numbers_;
  std::vector<Index> order_;
};

} // namespace

BoundaryEdge ClassifiedSurface::edge(std::size_t e) const
{
  const auto& [ends, edgeClass] = edges[e];
  const SurfacePoint& a = points[ends[0]];
  const SurfacePoint& b = points[ends[1]];
  return { edgeClass, { a.point, b.point }, { a.entity, b.entity } };
}

std::vector<BoundaryEdge> ClassifiedSurface::allEdges() const
{
  std::vector<BoundaryEdge> all;
  all.reserve(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    all.push_back(edge(e));
  }
  for (const SurfaceFacet& facet : facets)
  {
    if (facet.quad >= 0)
    {
      std::array<Point3, 4> corners;
      std::array<EntityId, 4> entities;
      for (int k = 0; k < 4; ++k)
      {
        corners[k] = points[facet.corners[k]].point;
        entities[k] = points[facet.corners[k]].entity;
      }
      all.push_back(middleOfQuad(corners, entities, facet.face));
    }
  }
  return all;
}

BoundaryEdge middleOfQuad(
  const std::array<Point3, 4>& points, const std::array<EntityId, 4>& entities, std::int32_t face)
{
  return { { EdgeClass::Smooth, face },
    { 0.5 * (points[0] + points[1]), 0.5 * (points[2] + points[3]) },
    { entities[0], entities[2] } };
}

double extrapolatedMeasure(const FacetError& error)
{
  return std::max(0.0, error.measure + error.lastLevel / 3);
}

std::vector<FacetError> geometricErrors(const ClassifiedSurface& surface,
  const std::vector<ClosestPoint>& midpoints, int depth, std::size_t parts,
  const ProjectMidpoints& project)
{
  std::vector<FacetError> errors;
  errors.reserve(surface.facets.size());
  Renumbering points(surface.points.size());
  Renumbering edges(surface.edges.size());
  for (std::size_t i = 0; i < parts; ++i)
  {
    ClassifiedSurface part;
    part.kind = surface.kind;
    const std::size_t end = surface.facets.size() * (i + 1) / parts;
    std::vector<ClosestPoint> middlesOfQuads;
    for (std::size_t f = errors.size(); f < end; ++f)
    {
      SurfaceFacet facet = surface.facets[f];
      std::transform(facet.corners.begin(), facet.corners.begin() + cornersOf(surface.kind, facet),
        facet.corners.begin(), std::ref(points));
      std::transform(facet.edges.begin(), facet.edges.begin() + edgesOf(surface.kind, facet),
        facet.edges.begin(), std::ref(edges));
      if (facet.quad >= 0)
      {
        middlesOfQuads.push_back(midpoints[surface.edges.size() + facet.quad]);
        facet.quad = static_cast<Index>(middlesOfQuads.size() - 1);
      }
      part.facets.push_back(facet);
    }
    std::vector<ClosestPoint> midpointsOfPart;
    for (const Index e : edges.order())
    {
      const auto& [ends, edgeClass] = surface.edges[e];
      part.edges.push_back({ { points(ends[0]), points(ends[1]) }, edgeClass });
      midpointsOfPart.push_back(midpoints[e]);
    }
    midpointsOfPart.insert(midpointsOfPart.end(), middlesOfQuads.begin(), middlesOfQuads.end());
    for (const Index p : points.order())
    {
      part.points.push_back(surface.points[p]);
    }
    points.clear();
    edges.clear();
    const auto middles = newPoints(part, midpointsOfPart);
    const auto ofPart = errorsOf(part, midpointsOfPart, middles, depth, project);
    for (std::size_t f = 0; f < ofPart.size(); ++f)
    {
      errors.push_back(ofPart[f]);
      errors.back().measure += cancelledAt(pointsOf(part, middles, part.facets[f]));
    }
  }
  return errors;
}

} // namespace cadrefine
