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

int cornersOf(BoundaryKind kind)
{
  return kind == BoundaryKind::Segments ? 2 : 3;
}

int edgesOf(BoundaryKind kind)
{
  return kind == BoundaryKind::Segments ? 1 : 3;
}

/// The vertices that refinement would make in the middle of the edges.
std::vector<SurfacePoint> newPoints(
  const ClassifiedSurface& surface, const std::vector<ClosestPoint>& midpoints)
{
  std::vector<SurfacePoint> points;
  points.reserve(midpoints.size());
  for (std::size_t e = 0; e < midpoints.size(); ++e)
  {
    const auto [a, b] = surface.edges[e].ends;
    const ClosestPoint& where = midpoints[e];
    const Point3 middle = 0.5 * (surface.points[a].point + surface.points[b].point);
    points.push_back({ where.entity ? where.point : middle, where.entity });
  }
  return points;
}

double areaBetween(const SurfacePoint& a, const SurfacePoint& b, const SurfacePoint& m)
{
  return 0.5 * norm(twofoldAreaVector(a.point, b.point, b.place) +
                    twofoldAreaVector(a.point, b.place, m.point) +
                    twofoldAreaVector(a.point, m.point, a.place));
}

/// The volume of the polyhedron between the triangle and its children.
double volumeBetween(const std::array<SurfacePoint, 3>& c, const std::array<SurfacePoint, 3>& m)
{
  const Point3& origin = c[0].point;
  const auto over = [&](const Point3& x, const Point3& y, const Point3& z)
  { return dot(x - origin, cross(y - origin, z - origin)); };
  double volume = over(m[0].point, m[1].point, m[2].point);
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    const int previous = (k + 2) % 3;
    volume += over(c[k].place, m[k].point, m[previous].point); // the child at corner k
    volume += over(c[k].point, c[next].point, m[k].point);     // the side over edge k
    volume += over(c[k].point, m[k].point, c[k].place);
    volume += over(c[next].point, c[next].place, m[k].point);
  }
  return std::abs(volume) / 6; // the flat triangle itself passes through the origin
}

/// Of one level.
FacetError errorOf(const ClassifiedSurface& surface, const std::vector<ClosestPoint>& midpoints,
  const std::vector<SurfacePoint>& middles, const SurfaceFacet& facet)
{
  FacetError error;
  std::array<SurfacePoint, 3> c;
  for (int k = 0; k < cornersOf(surface.kind); ++k)
  {
    c[k] = surface.points[facet.corners[k]];
    error.largestDistance = std::max(error.largestDistance, distance(c[k].point, c[k].place));
  }
  std::array<SurfacePoint, 3> m;
  for (int k = 0; k < edgesOf(surface.kind); ++k)
  {
    m[k] = middles[facet.edges[k]];
    const ClosestPoint& where = midpoints[facet.edges[k]];
    error.chordError = std::max(error.chordError, where.entity ? where.distance : 0);
  }
  error.largestDistance = std::max(error.largestDistance, error.chordError);
  error.measure =
    surface.kind == BoundaryKind::Segments ? areaBetween(c[0], c[1], m[0]) : volumeBetween(c, m);
  error.lastLevel = error.measure;
  return error;
}

/// The half of edge e at this end of it.
Index halfAt(const ClassifiedSurface& surface, Index e, Index end)
{
  return 2 * e + (surface.edges[e].ends[0] == end ? 0 : 1);
}

/// The children of all facets, those of each in a row: at its corners, then in its middle. Points:
/// the places of the surface's, then `middles`. Edges: the halves of the surface's, then three in
/// each triangle, of which edge k cuts corner k off.
ClassifiedSurface subdivide(
  const ClassifiedSurface& surface, const std::vector<SurfacePoint>& middles)
{
  ClassifiedSurface children;
  children.kind = surface.kind;
  const bool areTriangles = surface.kind == BoundaryKind::Triangles;
  const auto firstMiddle = static_cast<Index>(surface.points.size());
  const auto firstInner = static_cast<Index>(2 * surface.edges.size());
  children.points.reserve(surface.points.size() + middles.size());
  for (const SurfacePoint& p : surface.points)
  {
    children.points.push_back({ p.place, p.placeEntity });
  }
  children.points.insert(children.points.end(), middles.begin(), middles.end());
  children.edges.reserve(firstInner + (areTriangles ? 3 * surface.facets.size() : 0));
  for (std::size_t e = 0; e < surface.edges.size(); ++e)
  {
    const auto& [ends, edgeClass] = surface.edges[e];
    const Index middle = firstMiddle + static_cast<Index>(e);
    children.edges.push_back({ { ends[0], middle }, edgeClass });
    children.edges.push_back({ { middle, ends[1] }, edgeClass });
  }
  children.facets.reserve((areTriangles ? 4 : 2) * surface.facets.size());
  for (const auto& [corners, edges] : surface.facets)
  {
    if (!areTriangles)
    {
      const Index middle = firstMiddle + edges[0];
      children.facets.push_back(
        { { corners[0], middle }, { halfAt(surface, edges[0], corners[0]) } });
      children.facets.push_back(
        { { middle, corners[1] }, { halfAt(surface, edges[0], corners[1]) } });
      continue;
    }
    const auto inner = static_cast<Index>(children.edges.size());
    for (int k = 0; k < 3; ++k)
    {
      const int previous = (k + 2) % 3;
      const Index m = firstMiddle + edges[k];
      const Index n = firstMiddle + edges[previous];
      children.edges.push_back({ { m, n }, { EdgeClass::Smooth, -1 } });
      children.facets.push_back(
        { { corners[k], m, n }, { halfAt(surface, edges[k], corners[k]), inner + k,
                                  halfAt(surface, edges[previous], corners[k]) } });
    }
    children.facets.push_back(
      { { firstMiddle + edges[0], firstMiddle + edges[1], firstMiddle + edges[2] },
        { inner + 1, inner + 2, inner } });
  }
  return children;
}

std::vector<FacetError> errorsOf(const ClassifiedSurface& surface,
  const std::vector<ClosestPoint>& midpoints, int depth, const ProjectMidpoints& project)
{
  const auto middles = newPoints(surface, midpoints);
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
  const auto ofChildren = errorsOf(children, project(children.allEdges()), depth - 1, project);
  auto child = ofChildren.begin();
  for (FacetError& error : errors)
  {
    error.lastLevel = 0;
    for (const auto end = child + (surface.kind == BoundaryKind::Triangles ? 4 : 2); child != end;
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
  return all;
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
    for (std::size_t f = errors.size(); f < end; ++f)
    {
      SurfaceFacet facet = surface.facets[f];
      std::transform(facet.corners.begin(), facet.corners.begin() + cornersOf(surface.kind),
        facet.corners.begin(), std::ref(points));
      std::transform(facet.edges.begin(), facet.edges.begin() + edgesOf(surface.kind),
        facet.edges.begin(), std::ref(edges));
      part.facets.push_back(facet);
    }
    std::vector<ClosestPoint> midpointsOfPart;
    for (const Index e : edges.order())
    {
      const auto& [ends, edgeClass] = surface.edges[e];
      part.edges.push_back({ { points(ends[0]), points(ends[1]) }, edgeClass });
      midpointsOfPart.push_back(midpoints[e]);
    }
    for (const Index p : points.order())
    {
      part.points.push_back(surface.points[p]);
    }
    points.clear();
    edges.clear();
    const auto ofPart = errorsOf(part, midpointsOfPart, depth, project);
    errors.insert(errors.end(), ofPart.begin(), ofPart.end());
  }
  return errors;
}

} // namespace cadrefine
