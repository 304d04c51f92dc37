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
  /// Barycentric coordinates in a triangle or segment, the two parameters of a quadrilateral.
  std::array<double, 3> where;
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

/// The volume between a part and the places of its corners: positive on one side of the facet,
/// negative on the other.
double signedVolumeBetween(const Sample& a, const Sample& b, const Sample& c)
{
  const auto way = [](const Sample& s) { return s.place - s.point; };
  const Vector3 mean = (1.0 / 3) * (way(a) + way(b) + way(c));
  const Vector3 e1 = b.point - a.point;
  const Vector3 e2 = c.point - a.point;
  const Vector3 f1 = way(b) - way(a);
  const Vector3 f2 = way(c) - way(a);
  const Vector3 area =
    cross(e1, e2) + 0.5 * (cross(e1, f2) + cross(f1, e2)) + (1.0 / 3) * cross(f1, f2);
  return dot(mean, area) / 2;
}

double volumeBetween(const std::array<Sample, 3>& s)
{
  return std::abs(signedVolumeBetween(s[0], s[1], s[2]));
}

double volumeBetween(const std::array<Sample, 4>& s)
{
  return std::abs(signedVolumeBetween(s[0], s[1], s[2]) + signedVolumeBetween(s[0], s[2], s[3]) +
                  signedVolumeBetween(s[0], s[1], s[3]) + signedVolumeBetween(s[1], s[2], s[3])) /
         2;
}

class CurvedFacetError
{
public:
  CurvedFacetError(const BoundaryProjector& projector, const CurvedErrorFacet& facet)
    : projector_(projector), facet_(facet), innerEdge_{ { EdgeClass::Smooth, facet.face }, false },
      count_(projector.kind() == BoundaryKind::Edges ? 2 : facet.straight.corners.corners)
  {
    constexpr Point2 ofSquare[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    for (int k = 0; k < count_; ++k)
    {
      const Point3& point = facet.straight.corners.points[k];
      corners_[k] = nodeSample(point, facet.straight.corners.entities[k], facet.straight.offCAD[k]);
      if (count_ == 4)
      {
        quadrilateral_[k] = point;
        quadrilateral_[4 + k] = facet.nodes[k];
        corners_[k].where = { ofSquare[k][0], ofSquare[k][1], 0 };
      }
      else
      {
        triangle_[k] = point;
        triangle_[3 + k] = facet.nodes[k];
        corners_[k].where[k] = 1;
      }
    }
    for (int k = 0; k < (count_ == 2 ? 1 : count_); ++k)
    {
      middles_[k] = nodeSample(facet.nodes[k], facet.entities[k], facet.offCAD[k]);
      middles_[k].where = 0.5 * (corners_[k].where + corners_[(k + 1) % count_].where);
      count(middles_[k], true);
    }
  }

  FacetError measure(int depth)
  {
    const auto edge = [&](int k) { return PartEdge{ facet_.straight.edges[k], true }; };
    const auto& [a, b, c, d] = corners_;
    const auto& [e, f, g, h] = middles_;
    if (count_ == 2)
    {
      addSegment(a, e, edge(0), depth);
      addSegment(e, b, edge(0), depth);
    }
    else if (count_ == 3)
    {
      addChildren<3>({ a, b, c }, { e, f, g }, { edge(0), edge(1), edge(2) }, depth);
    }
    else
    {
      addChildren(corners_, middles_, { edge(0), edge(1), edge(2), edge(3) }, depth);
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

  Point3 facetAt(const std::array<double, 3>& where) const
  {
    return count_ == 4 ? pointAt(quadrilateral_, Point2{ where[0], where[1] })
                       : pointAt(triangle_, where);
  }

  /// The point in the middle of the parameters of `a` and `b`.
  Sample between(const Sample& a, const Sample& b, const PartEdge& edge)
  {
    Sample sample{ 0.5 * (a.where + b.where), {}, {}, {} };
    sample.point = sample.place = facetAt(sample.where);
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

  /// Adds the measure of a part with these corners.
  template<std::size_t Corners>
  void addPart(
    const std::array<Sample, Corners>& c, const std::array<PartEdge, Corners>& edges, int depth)
  {
    if (depth == 0)
    {
      error_.measure += volumeBetween(c);
      return;
    }
    coarser_ += depth == 1 ? volumeBetween(c) : 0;
    std::array<Sample, Corners> middles;
    for (std::size_t k = 0; k < Corners; ++k)
    {
      middles[k] = between(c[k], c[(k + 1) % Corners], edges[k]);
    }
    addChildren(c, middles, edges, depth - 1);
  }

  template<std::size_t Corners>
  void addChildren(const std::array<Sample, Corners>& c, const std::array<Sample, Corners>& m,
    const std::array<PartEdge, Corners>& edges, int depth)
  {
    if constexpr (Corners == 4)
    {
      const Sample centre = between(c[0], c[2], innerEdge_);
      for (int k = 0; k < 4; ++k)
      {
        const int previous = (k + 3) % 4;
        addPart<4>({ c[k], m[k], centre, m[previous] },
          { edges[k], innerEdge_, innerEdge_, edges[previous] }, depth);
      }
    }
    else
    {
      addPart<3>({ c[0], m[0], m[2] }, { edges[0], innerEdge_, edges[2] }, depth);
      addPart<3>({ m[0], c[1], m[1] }, { edges[0], edges[1], innerEdge_ }, depth);
      addPart<3>({ m[2], m[1], c[2] }, { innerEdge_, edges[1], edges[2] }, depth);
      addPart<3>(m, { innerEdge_, innerEdge_, innerEdge_ }, depth);
    }
  }

  const BoundaryProjector& projector_;
  const CurvedErrorFacet& facet_;
  PartEdge innerEdge_;
  int count_;                 ///< Number of corners.
  CurvedTriangle triangle_{}; ///< For a segment, only nodes 0, 1 and 3.
  CurvedQuadrilateral quadrilateral_{};
  std::array<Sample, 4> corners_{};
  std::array<Sample, 4> middles_{};
  FacetError error_;
  double coarser_ = 0; ///< The measure at one level less.
};

} // namespace

FacetError curvedError(const BoundaryProjector& projector, const CurvedErrorFacet& facet, int depth)
{
  return CurvedFacetError(projector, facet).measure(depth);
}

} // namespace cadrefine
