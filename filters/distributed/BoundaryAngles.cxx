#include "BoundaryAngles.h"

#include <vtkMath.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

double degreesBetween(const Vector3& a, const Vector3& b)
{
  return vtkMath::DegreesFromRadians(std::atan2(norm(cross(a, b)), dot(a, b)));
}

std::vector<double> anglesAtEdges(const ClassifiedBoundary& classified)
{
  const auto& ofEdges = classified.classes.facetsAtEdges;
  std::vector<double> angles(ofEdges.size(), 0.0);
  for (std::size_t e = 0; e < ofEdges.size(); ++e)
  {
    const auto& facets = ofEdges[e];
    if (facets.size() == 2 && facets[0].onCAD && facets[1].onCAD &&
        isSmooth(classified.classes.ofEdges[e], classified.projector.model()))
    {
      const double angle = degreesBetween(facets[0].normal, facets[1].normal);
      angles[e] = classified.boundary.ofSurface ? std::min(angle, 180 - angle) : angle;
    }
  }
  return angles;
}

/// The segments on the CAD that end and start at a vertex.
struct Passage
{
  Vector3 in{};
  Vector3 out{};
  int ins = 0;
  int outs = 0;
};

Passage joined(const Passage& a, const Passage& b)
{
  return { a.in + b.in, a.out + b.out, a.ins + b.ins, a.outs + b.outs };
}

std::vector<double> anglesAtVertices(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification)
{
  const auto& points = mesh.mesh().points;
  std::vector<Passage> passages(points.size());
  for (std::size_t f = 0; f < classified.boundary.facets.size(); ++f)
  {
    if (classified.classes.facetOnCAD[f])
    {
      const auto& vertices = classified.boundary.facets[f].vertices;
      const Vector3 along = points[vertices[1]] - points[vertices[0]];
      Passage& start = passages[vertices[0]];
      Passage& end = passages[vertices[1]];
      start = joined(start, { {}, along, 0, 1 });
      end = joined(end, { along, {}, 1, 0 });
    }
  }
  combineShared(exchange, mesh.shared, passages, joined);
  std::vector<double> angles(points.size(), 0.0);
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    const Passage& passage = passages[v];
    if (passage.ins == 1 && passage.outs == 1 && classification.entities[v].dimension != 0)
    {
      angles[v] = degreesBetween(passage.in, passage.out);
    }
  }
  return angles;
}

} // namespace

bool isSmooth(const EdgeClass& edgeClass, const CADModel& model)
{
  return edgeClass.kind == EdgeClass::Smooth ||
         (edgeClass.kind == EdgeClass::OnEdge && edgeClass.edge >= 0 &&
           !model.nurbs().edges[edgeClass.edge].sharp);
}

std::vector<double> neighbourAngles(RankExchange& exchange, const DistributedMesh& mesh,
  const ClassifiedBoundary& classified, const Classification& classification)
{
  const DistributedBoundary& boundary = classified.boundary;
  const bool triangles = boundary.kind == BoundaryKind::Triangles;
  const auto angles = triangles ? anglesAtEdges(classified)
                                : anglesAtVertices(exchange, mesh, classified, classification);
  std::vector<double> result(boundary.facets.size(), 0.0);
  for (std::size_t f = 0; f < result.size(); ++f)
  {
    if (classified.classes.facetOnCAD[f])
    {
      const auto& sides = triangles ? boundary.facetEdges[f] : boundary.facets[f].vertices;
      for (int k = 0; k < boundary.facetCorners(); ++k)
      {
        result[f] = std::max(result[f], angles[sides[k]]);
      }
    }
  }
  return result;
}

} // namespace cadrefine
