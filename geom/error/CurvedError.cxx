#include <cadrefine/error/CurvedError.h>

#include <cadrefine/quadratic/CurvedCells.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// A point of the facet and its place on the CAD.
struct Sample
{
  std::array<double, 3> where; ///< Barycentric coordinates in the facet.
  Point3 point;
  Point3 place;
  EntityId entity;
};

/// An edge of a part of the facet.
struct PartEdge
{
  EdgeClass edgeClass;
  bool ofFacet = false;
};

double areaBetween(const Sample& a, const Sample& b)
{
  const Vector3 mean = 0.5 * ((a.place - a.point) + (b.place - b.point));
  return norm(cross(mean, 0.5 * ((b.point - a.point) + (b.place - a.place))));
}

double volumeBetween(const std::array<Sample, 3>& s)
{
  const auto way = [&](int k) { return s[k].place - s[k].point; };
  const Vector3 mean = (1.0 / 3) * (way(0) + way(1) + way(2));
  const Vector3 e1 = s[1].point - s[0].point;
  const Vector3 e2 = s[2].point - s[0].point;
  const Vector3 f1 = way(1) - way(0);
  const Vector3 f2 = way(2) - way(0);
  const Vector3 area =
    cross(e1, e2) + 0.5 * (cross(e1, f2) + cross(f1, e2)) + (1.0 / 3) * cross(f1, f2);
  return std::abs(dot(mean, area)) / 2;
}

class CurvedFacetError
{
public:
  CurvedFacetError(const BoundaryProjector& projector, const CurvedErrorFacet& facet)
    : projector_(projector), facet_(facet)
  {
    const int corners = projector.kind() == BoundaryKind::Segments ? 2 : 3;
    const int edges = corners == 2 ? 1 : 3;
    for (int k = 0; k < corners; ++k)
    {
      nodes_[k] = facet.straight.corners.points[k];
      corners_[k] =
        nodeSample(nodes_[k], facet.straight.corners.entities[k], facet.straight.offCAD[k]);
      corners_[k].where[k] = 1;
    }
    for (int k = 0; k < edges; ++k)
    {
      nodes_[3 + k] = facet.nodes[k];
      middles_[k] = nodeSample(facet.nodes[k], facet.entities[k], facet.offCAD[k]);
      middles_[k].where[k] = middles_[k].where[(k + 1) % 3] = 0.5;
      count(middles_[k], true);
    }
  }

  FacetError measure(int depth)
  {
    const auto edge = [&](int k) { return PartEdge{ facet_.straight.edges[k], true }; };
    if (projector_.kind() == BoundaryKind::Segments)
    {
      addSegment(corners_[0], middles_[0], edge(0), depth);
      addSegment(middles_[0], corners_[1], edge(0), depth);
    }
    else
    {
      addChildren(corners_, middles_, { edge(0), edge(1), edge(2) }, depth);
    }
    error_.lastLevel = error_.measure - coarser_;
    return error_;
  }

private:
  Sample nodeSample(const Point3& point, EntityId entity, bool offCAD)
  {
    Sample sample{ {}, point, point, entity };
    if (offCAD)
    {
      const ClosestPoint where = projector_.nearestOn(entity, point);
      sample.place = where.point;
      sample.entity = where.entity;
      error_.largestDistance = std::max(error_.largestDistance, where.distance);
    }
    return sample;
  }

  /// The point in the middle of the parameters of `a` and `b`.
  Sample between(const Sample& a, const Sample& b, const PartEdge& edge)
  {
    Sample sample{ 0.5 * (a.where + b.where), {}, {}, {} };
    sample.point = sample.place = pointAt(nodes_, sample.where);
    const ClosestPoint where =
      projector_.project(edge.edgeClass, sample.point, { a.entity, b.entity });
    if (where.entity)
    {
      sample.place = where.point;
      sample.entity = where.entity;
    }
    count(sample, edge.ofFacet);
    return sample;
  }

  void count(const Sample& sample, bool onEdge)
  {
    const double away = distance(sample.point, sample.place);
    error_.largestDistance = std::max(error_.largestDistance, away);
    error_.chordError = onEdge ? std::max(error_.chordError, away) : error_.chordError;
  }

  void addSegment(const Sample& a, const Sample& b, const PartEdge& edge, int depth)
  {
    if (depth == 0)
    {
      error_.measure += areaBetween(a, b);
      return;
    }
    coarser_ += depth == 1 ? areaBetween(a, b) : 0;
    const Sample middle = between(a, b, edge);
    addSegment(a, middle, edge, depth - 1);
    addSegment(middle, b, edge, depth - 1);
  }

  void addTriangle(const std::array<Sample, 3>& c, const std::array<PartEdge, 3>& edges, int depth)
  {
    if (depth == 0)
    {
      error_.measure += volumeBetween(c);
      return;
    }
    coarser_ += depth == 1 ? volumeBetween(c) : 0;
    addChildren(c,
      { between(c[0], c[1], edges[0]), between(c[1], c[2], edges[1]),
        between(c[2], c[0], edges[2]) },
      edges, depth - 1);
  }

  void addChildren(const std::array<Sample, 3>& c, const std::array<Sample, 3>& m,
    const std::array<PartEdge, 3>& edges, int depth)
  {
    const PartEdge inner{ { EdgeClass::Smooth, -1 }, false };
    addTriangle({ c[0], m[0], m[2] }, { edges[0], inner, edges[2] }, depth);
    addTriangle({ m[0], c[1], m[1] }, { edges[0], edges[1], inner }, depth);
    addTriangle({ m[2], m[1], c[2] }, { inner, edges[1], edges[2] }, depth);
    addTriangle(m, { inner, inner, inner }, depth);
  }

  const BoundaryProjector& projector_;
  const CurvedErrorFacet& facet_;
  CurvedTriangle nodes_{}; ///< Of a segment 0, 1 and 3.
  std::array<Sample, 3> corners_{};
  std::array<Sample, 3> middles_{};
  FacetError error_;
  double coarser_ = 0; ///< The measure of one level less.
};

} // namespace

FacetError curvedError(const BoundaryProjector& projector, const CurvedErrorFacet& facet, int depth)
{
  return CurvedFacetError(projector, facet).measure(depth);
}

} // namespace cadrefine
