// Which CAD edges the mesh edges run along, and what that means for their ends.
#pragma once

#include "classification/FacetClassification.h"
#include "classification/ProjectionTask.h"

#include <vector>

namespace cadrefine
{

/// What meets at each vertex, on whatever rank: faces of the facets on the CAD, and CAD edges that
/// mesh edges run along.
struct VertexClassification
{
  /// For each boundary edge the CAD edge that it runs along, or -1.
  std::vector<std::int32_t> ofMeshEdges;
  std::vector<SmallEntitySet> faces;
  std::vector<SmallEntitySet> edges;
  /// 1: the vertex lies on the CAD already.
  std::vector<unsigned char> settled;
  /// 1: a facet on the CAD whose face is not known has the vertex.
  std::vector<unsigned char> undecided;
  /// 1: the normal of the model at the vertex's nearest point fits none of its facets.
  std::vector<unsigned char> wrongSide;
};

/// Finds what meets at each vertex, given its nearest point and the classes of the facets.
/// Collective. Work: that of findCADEdges, a look at each corner of a facet and each end of a
/// boundary edge, and the normals of the CAD faces at a vertex for each of its facets until one
/// fits. Messages: those of findCADEdges, and four to and from each neighbour, of 66 bytes together
/// for each shared vertex.
VertexClassification classifyVertices(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const FacetClasses& facets);

/// Puts vertices of boundaries of triangles onto what meets there: the nearest of their CAD edges,
/// and of those that continue it (see findCreaseLines); of vertices without these, those whose
/// nearest point is on the wrong side of something thin onto the nearest of their faces. A point
/// beyond a vertex's limit is not taken. For segments, nothing is moved.
///
/// Collective. Work: for each such vertex one query of each of its entities, and one more of all
/// creases where its nearest edge ends; shared out evenly over ranks and threads (see mapBalanced,
/// also for the messages).
void placeVertices(
  const ProjectionTask& task, const VertexClassification& meeting, std::vector<ClosestPoint>& hits);

} // namespace cadrefine
