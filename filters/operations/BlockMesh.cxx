#include "operations/BlockMesh.h"

#include "operations/VertexBlocks.h"

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/classification/CADAdjacency.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace cadrefine
{
namespace
{

/// Label of boundary off the CAD without tags.
constexpr Index wallLabel = -2;

EditableMesh::Kind kindOf(const Mesh& mesh, BoundaryKind boundary)
{
  if (mesh.dimension == 3)
  {
    return EditableMesh::Kind::Solid;
  }
  return boundary == BoundaryKind::Edges ? EditableMesh::Kind::Plane : EditableMesh::Kind::Surface;
}

} // namespace

BlockMesh::BlockMesh(const DistributedMesh& mesh, const std::vector<Point3>& wanted,
  const Vector3& plane, const std::vector<std::int64_t>& blocksOfVertices,
  const Classification& classification, const ClassifiedBoundary& boundary,
  const CellLabels& labels)
  : mesh_(mesh.mesh()), wanted_(wanted), blocksOfVertices_(blocksOfVertices),
    classification_(classification), boundary_(boundary), labels_(labels),
    block_(kindOf(mesh.mesh(), boundary.boundary.kind), plane)
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
  visitOwnSimplices(mesh_, [&](const auto& all) { addVertices(all, cells); });
  if (mesh_.dimension == 3)
  {
    for (const Index cell : cells)
    {
      block_.addCell({ localCorners(mesh_.tetrahedra[cell]), labels_.ofTetrahedra[cell], cell });
    }
    addFacets(members);
  }
  else
  {
    addTriangles(members, cells);
  }
  addSegments(members);
  keepEndsOfTags();
  block_.closeFacets();
}

template<std::size_t Corners>
void BlockMesh::addVertices(const Cells<Corners>& all, const std::vector<Index>& cells)
{
  for (const Index cell : cells)
  {
    vertices_.insert(vertices_.end(), all[cell].begin(), all[cell].end());
  }
  std::sort(vertices_.begin(), vertices_.end(),
    [&](Index a, Index b) { return mesh_.ids[a] < mesh_.ids[b]; });
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  for (std::size_t v = 0; v < vertices_.size(); ++v)
  {
    numbers_.emplace(vertices_[v], static_cast<Index>(v));
    block_.addVertex(vertexOf(vertices_[v]));
  }
}

MeshBefore BlockMesh::before() const
{
  MeshBefore result;
  result.points.reserve(vertices_.size());
  for (const Index vertex : vertices_)
  {
    result.points.push_back(mesh_.points[vertex]);
  }
  result.cells = block_.dimension() == 3 ? block_.cells().size() : block_.facets().size();
  return result;
}

EditableMesh::Vertex BlockMesh::vertexOf(Index v) const
{
  return { mesh_.points[v], wanted_[v], classification_.entities[v],
    classification_.entities[v].dimension == 0, blocksOfVertices_[v] < 0,
    blocksOfVertices_[v] == besideOthers };
}

/// Adds the facets in the order of their corners. Labels tell their tags apart, and those that are
/// not on the CAD, whose labels are below 0. Listed facets inside the mesh have labels of their
/// own, so that they stay.
void BlockMesh::addFacets(const Members& members)
{
  std::map<std::array<Index, 3>, LabelledSimplex<3>> facets;
  for (const Index f : members.facets)
  {
    const auto& [a, b, c, none] = boundary_.boundary.facets[f].vertices;
    const auto corners = localCorners(std::array<Index, 3>{ a, b, c });
    const bool onCAD = boundary_.classes.facets[f].onCAD != 0;
    facets[sorted(corners)] = { corners, onCAD ? 0 : wallLabel, -1 };
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

/// Adds the cells of a mesh of triangles. Those of which no surface is known, of a surface off the
/// CAD or of a mesh in space whose CAD has no faces, have labels of their own, so that they stay.
void BlockMesh::addTriangles(const Members& members, const std::vector<Index>& cells)
{
  const bool isOfCurves = block_.kind() == EditableMesh::Kind::Plane && block_.plane() == Vector3{};
  std::set<Index> staying;
  for (const Index f : members.facets)
  {
    if (boundary_.boundary.ofSurface && boundary_.classes.facets[f].onCAD == 0)
    {
      staying.insert(boundary_.boundary.facets[f].cell);
    }
  }
  for (const Index cell : cells)
  {
    const bool stays = isOfCurves || staying.count(cell) > 0;
    block_.addFacet(
      { localCorners(mesh_.triangles[cell]), stays ? -2 - cell : labels_.ofTriangles[cell], cell });
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
      if (e < 0)
      {
        continue; // the second and third of a segment
      }
      const EdgeClass& edgeClass = boundary_.classes.ofEdges[e];
      const bool onCAD = boundary_.classes.facets[f].onCAD != 0;
      const bool isOnWall = edgeClass.kind == EdgeClass::Straight && !onCAD;
      const auto corners = sorted(localCorners(edges.edges()[e]));
      if (boundary_.boundary.kind == BoundaryKind::Edges)
      {
        segments[corners] = { corners, onCAD ? lineOf(edges.edges()[e]) : wallLabel, -1,
          edgeClass };
      }
      else if (edgeClass.kind != EdgeClass::Smooth && !isOnWall)
      {
        segments[corners] = { corners, lineOf(edgeClass, edges.edges()[e]), -1, edgeClass };
      }
    }
  }
  for (const Index s : members.segments)
  {
    const auto corners = sorted(localCorners(mesh_.segments[s]));
    segments
      .try_emplace(
        corners, LabelledSimplex<2>{ corners, -1, s, block_.classBeside(corners[0], corners[1]) })
      .first->second.parent = s;
  }
  for (const auto& [key, segment] : segments)
  {
    block_.addSegment(segment);
  }
}

/// The line of CAD edges that a mesh edge of this class lies on; -1: none.
Index BlockMesh::lineOf(const EdgeClass& edgeClass, const std::array<Index, 2>& ends) const
{
  if (edgeClass.kind != EdgeClass::OnEdge)
  {
    return -1;
  }
  return edgeClass.entity < 0 ? lineOf(ends) : boundary_.projector.lines()[edgeClass.entity];
}

/// The line of CAD edges that both ends are on; -1 where there is none, or more than one.
Index BlockMesh::lineOf(const std::array<Index, 2>& ends) const
{
  const BoundaryProjector& projector = boundary_.projector;
  const auto linesAt = [&](Index vertex)
  {
    std::vector<std::int32_t> lines =
      entitiesAround(projector.model().nurbs(), classification_.entities[vertex], 1);
    std::transform(lines.begin(), lines.end(), lines.begin(),
      [&](std::int32_t edge) { return projector.lines()[edge]; });
    sortUniquely(lines);
    return lines;
  };
  const auto first = linesAt(ends[0]);
  const auto second = linesAt(ends[1]);
  std::vector<std::int32_t> common;
  std::set_intersection(
    first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(common));
  return common.size() == 1 ? common.front() : -1;
}

/// Makes vertices stay between segments of which only one is listed, or that have different tags.
void BlockMesh::keepEndsOfTags()
{
  const auto tagOf = [&](Index segment)
  {
    const Index parent = block_.segments()[segment].parent;
    return parent < 0 ? -1 : labels_.ofSegments[parent];
  };
  for (std::size_t v = 0; v < block_.vertexCount(); ++v)
  {
    const auto& segments = block_.segments().at(static_cast<Index>(v));
    if (std::any_of(segments.begin(), segments.end(),
          [&](Index segment) { return tagOf(segment) != tagOf(segments.front()); }))
    {
      EditableMesh::Vertex vertex = block_.vertex(static_cast<Index>(v));
      vertex.stays = true;
      block_.setVertex(static_cast<Index>(v), vertex);
    }
  }
}

} // namespace cadrefine
