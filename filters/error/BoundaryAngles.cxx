#include "error/BoundaryAngles.h"

#include <cadrefine/mesh/Quality.h>

#include <vtkMath.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// The facets on the CAD that meet at an edge or (segments) at a vertex.
struct Meeting
{
  Vector3 sum{}; ///< Sum of the unit vectors from there into each facet.
  int facets = 0;
};

Meeting joined(const Meeting& a, const Meeting& b)
{
  return { a.sum + b.sum, a.facets + b.facets };
}

/// The degrees by which the mesh turns there. Two facets in a row add up to zero, whichever way
/// each of them is turned; unit vectors u, v have |u + v| = 2 sin(angle(u, -v) / 2).
double angleAt(const Meeting& meeting)
{
  return meeting.facets == 2
           ? vtkMath::DegreesFromRadians(2 * std::asin(std::min(1.0, norm(meeting.sum) / 2)))
           : 0;
}

/// A meeting with one facet. A degenerate facet has no direction, and does not count.
Meeting meetingWith(const Vector3& intoFacet)
{
  const Vector3 direction = normalized(intoFacet);
  return { direction, norm(direction) > 0 ? 1 : 0 };
}

/// Calls `visit` with the place (an edge, of segments a vertex) and the vector into the facet, for
/// each side of each facet on the CAD.
template<class Visit>
void visitSides(
  const std::vector<Point3>& points, const ClassifiedBoundary& classified, const Visit& visit)
{
  const DistributedBoundary& boundary = classified.boundary;
  for (std::size_t f = 0; f < boundary.facets.size(); ++f)
  {
    const Facet& facet = boundary.facets[f];
    const auto& v = facet.vertices;
    if (!classified.classes.facets[f].onCAD)
    {
      continue;
    }
    if (boundary.kind == BoundaryKind::Edges)
    {
      visit(v[0], points[v[1]] - points[v[0]]);
      visit(v[1], points[v[0]] - points[v[1]]);
      continue;
    }
    std::array<Point3, 4> p;
    const int corners = facet.corners();
    std::transform(
      facet.begin(), facet.end(), p.begin(), [&](Index vertex) { return points[vertex]; });
    const Vector3 normal = twofoldAreaVector(p, corners);
    for (int k = 0; k < corners; ++k)
    {
      visit(boundary.facetEdges[f][k], cross(normal, p[(k + 1) % corners] - p[k]));
    }
  }
}

std::vector<Meeting> findMeetings(
  RankExchange& exchange, const DistributedMesh& mesh, const ClassifiedBoundary& classified)
{
  const DistributedBoundary& boundary = classified.boundary;
  const bool ofFaces = boundary.kind == BoundaryKind::Faces;
  std::vector<Meeting> meetings(
    ofFaces ? boundary.edges.edges().size() : mesh.mesh().points.size());
  visitSides(mesh.mesh().points, classified,
    [&](Index place, const Vector3& into)
    { meetings[place] = joined(meetings[place], meetingWith(into)); });
  combineShared(exchange, ofFaces ? boundary.sharedEdges : mesh.shared, meetings, joined);
  return meetings;
}

} // namespace

bool isSmooth(const EdgeClass& edgeClass, const CADModel& model)
{
  return edgeClass.kind == EdgeClass::Smooth ||
         (edgeClass.kind == EdgeClass::OnEdge && edgeClass.entity >= 0 &&
           !model.nurbs().edges[edgeClass.entity].sharp);
}

std::vector<double> neighbourAngles(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification)
{
  const DistributedBoundary& boundary = classified.boundary;
  const bool ofFaces = boundary.kind == BoundaryKind::Faces;
  const auto meetings = findMeetings(exchange, mesh, classified);
  const auto isSmoothAt = [&](Index place)
  {
    return ofFaces ? isSmooth(classified.classes.ofEdges[place], classified.projector.model())
                   : classification.entities[place].dimension != 0;
  };
  std::vector<double> result(boundary.facets.size(), 0.0);
  for (std::size_t f = 0; f < result.size(); ++f)
  {
    if (classified.classes.facets[f].onCAD)
    {
      const auto& sides = ofFaces ? boundary.facetEdges[f] : boundary.facets[f].vertices;
      for (int k = 0; k < boundary.facets[f].corners(); ++k)
      {
        if (isSmoothAt(sides[k]))
        {
          result[f] = std::max(result[f], angleAt(meetings[sides[k]]));
        }
      }
    }
  }
  return result;
}

} // namespace cadrefine
