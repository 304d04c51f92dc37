#include "operations/BlockMesh.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
std::array<Index, Corners> sorted(std::array<Index, Corners> corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

} // namespace

BlockMesh::BlockMesh(const DistributedMesh& mesh, const std::vector<std::int64_t>& blocksOfVertices,
  const Classification& classification, const ClassifiedBoundary& boundary,
  const CellLabels& labels)
  : mesh_(mesh.mesh()), blocksOfVertices_(blocksOfVertices), classification_(classification),
    boundary_(boundary), labels_(labels)
{
}

template<std::size_t Corners>
std::array<Index, Corners> BlockMesh::localCorners(std::array<Index, Corners> corners) const
{
  for (Index& vertex : corners)
  {
    vertex = numbers_.at(vertex);
  }
  return corners;
}

void BlockMesh::fill(const Members& members, const std::vector<GlobalId>& cellIds)
{
  std::vector<Index> cells = members.cells;
  std::sort(cells.begin(), cells.end(), [&](Index a, Index b) { return cellIds[a] < cellIds[b]; });
  for (const Index cell : cells)
  {
    const auto& corners = mesh_.tetrahedra[cell];
    vertices_.insert(vertices_.end(), corners.begin(), corners.end());
  }
  std::sort(vertices_.begin(), vertices_.end(),
    [&](Index a, Index b) { return mesh_.ids[a] < mesh_.ids[b]; });
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  for (std::size_t v = 0; v < vertices_.size(); ++v)
  {
    numbers_.emplace(vertices_[v], static_cast<Index>(v));
    block_.addVertex(vertexOf(vertices_[v]));
  }
  for (const Index cell : cells)
  {
    block_.addCell({ localCorners(mesh_.tetrahedra[cell]), labels_.ofTetrahedra[cell], cell });
  }
  addFacets(members);
  addSegments(members);
  block_.closeFacets();
}

EditableMesh::Vertex BlockMesh::vertexOf(Index v) const
{
  EditableMesh::Vertex vertex{ mesh_.points[v], mesh_.points[v], classification_.entities[v],
    classification_.entities[v].dimension == 0, blocksOfVertices_[v] < 0 };
  if (classification_.distances[v] > 0)
  {
    vertex.wanted = boundary_.projector.nearestOn(vertex.entity, vertex.point).point;
  }
  return vertex;
}

/// In the order of their corners. Labels tell their tags apart, and those that are not on the CAD,
/// whose labels are below 0. Listed ones inside the mesh have labels of their own, so that they
/// stay.
void BlockMesh::addFacets(const Members& members)
{
  std::map<std::array<Index, 3>, LabelledSimplex<3>> facets;
  for (const Index f : members.facets)
  {
    const auto corners = localCorners(boundary_.boundary.facets[f].vertices);
    const bool onCAD = boundary_.classes.facets[f].onCAD != 0;
    facets[sorted(corners)] = { corners, onCAD ? 0 : -2, -1 };
  }
  for (const Index t : members.triangles)
  {
    const auto corners = localCorners(mesh_.triangles[t]);
    const auto found = facets.find(sorted(corners));
    if (found == facets.end())
    {
      facets[sorted(corners)] = { corners, -3 - 2 * t, t };
      continue;
    }
    const Index tag = 1 + labels_.ofTriangles[t];
    found->second.parent = t;
    found->second.label += found->second.label < 0 ? -2 * tag : tag;
  }
  for (const auto& [key, facet] : facets)
  {
    block_.addFacet(facet);
  }
}

void BlockMesh::addSegments(const Members& members)
{
  const EdgeList& edges = boundary_.boundary.edges;
  std::map<std::array<Index, 2>, LabelledSimplex<2>> segments;
  for (const Index f : members.facets)
  {
    for (const Index e : boundary_.boundary.facetEdges[f])
    {
      const EdgeClass& edgeClass = boundary_.classes.ofEdges[e];
      const bool isOnWall =
        edgeClass.kind == EdgeClass::Straight && boundary_.classes.facets[f].onCAD == 0;
      if (edgeClass.kind != EdgeClass::Smooth && !isOnWall)
      {
        const auto corners = sorted(localCorners(edges.edges()[e]));
        const bool isOnEdge = edgeClass.kind == EdgeClass::OnEdge;
        segments[corners] = { corners, isOnEdge ? edgeClass.edge : -1, -1 };
      }
    }
  }
  for (const Index s : members.segments)
  {
    const auto corners = sorted(localCorners(mesh_.segments[s]));
    const auto [place, isNew] = segments.try_emplace(corners, LabelledSimplex<2>{ corners, -1, s });
    place->second.parent = s;
  }
  for (const auto& [key, segment] : segments)
  {
    block_.addSegment(segment);
  }
}

} // namespace cadrefine
