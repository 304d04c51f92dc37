#include "classification/Conflicts.h"

#include <cadrefine/base/DisjointSets.h>
#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

class ConflictFinder
{
public:
  ConflictFinder(const ProjectionTask& task, const FacetClasses& facets,
    const VertexClassification& meeting, const std::vector<unsigned char>& onCAD,
    const std::vector<unsigned char>& taken, const std::vector<ClosestPoint>& hits)
    : task_(task), nurbs_(task.model().nurbs()), records_(facets.records), meeting_(meeting),
      onCAD_(onCAD), taken_(taken), hits_(hits), conflicts_(hits.size(), 0),
      known_(findKnownEdges()), patches_(findPatches())
  {
  }

  std::vector<unsigned char> run()
  {
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      conflicts_[v] = takesPart(v) && (taken_[v] ? hasLineElsewhere(v) : isBetweenEntities(v));
    }
    if (task_.ofFaces())
    {
      lookAtFacets();
      lookAtEdges();
      lookAtRows();
    }
    combineFlags(task_.exchange, task_.mesh.shared, conflicts_);
    return std::move(conflicts_);
  }

private:
  bool takesPart(std::size_t v) const { return onCAD_[v] && hits_[v].entity; }

  /// The CAD edges along which mesh edges run.
  std::vector<unsigned char> findKnownEdges() const
  {
    std::vector<std::int64_t> counts(nurbs_.edges.size(), 0);
    for (const std::int32_t edge : meeting_.ofMeshEdges)
    {
      if (edge >= 0)
      {
        ++counts[edge];
      }
    }
    counts = task_.exchange.sum(counts);
    std::vector<unsigned char> known(counts.size());
    std::transform(
      counts.begin(), counts.end(), known.begin(), [](std::int64_t count) { return count > 0; });
    return known;
  }

  /// The patch of each face: the smallest of the faces it is joined to by smooth edges that the
  /// mesh does not follow.
  std::vector<std::int32_t> findPatches() const
  {
    DisjointSets patches(nurbs_.faces.size());
    for (std::size_t e = 0; e < nurbs_.edges.size(); ++e)
    {
      const NurbsEdge& edge = nurbs_.edges[e];
      for (const std::int32_t face : edge.faces)
      {
        if (!edge.sharp && !known_[e])
        {
          patches.join(face, edge.faces[0]);
        }
      }
    }
    return patches.representatives();
  }

  void lookAtFacets()
  {
    for (std::size_t f = 0; f < records_.size(); ++f)
    {
      if (!records_[f].onCAD || records_[f].face < 0)
      {
        continue;
      }
      for (const Index v : task_.boundary.facets[f])
      {
        conflicts_[v] = conflicts_[v] || !touches(hits_[v].entity, patches_[records_[f].face]);
      }
    }
  }

  /// Whether the entity lies in the patch or on its border.
  bool touches(EntityId entity, std::int32_t patch) const
  {
    const auto faces = entitiesAround(nurbs_, entity, 2);
    return std::any_of(
      faces.begin(), faces.end(), [&](std::int32_t face) { return patches_[face] == patch; });
  }

  bool isBetween(EntityId entity, std::int32_t one, std::int32_t other) const
  {
    return touches(entity, one) && touches(entity, other);
  }

  /// Looks at mesh edges along no CAD edge between faces of two patches: those that run between CAD
  /// edges of both continue rows, as at CAD vertices that the mesh does not know of; others
  /// contradict.
  void lookAtEdges()
  {
    const auto ofEdges = gatherFacetRecords(task_.exchange, task_.boundary, records_);
    const auto& edges = task_.boundary.edges.edges();
    joins_.assign(edges.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const auto [a, b] = edges[e];
      const auto onCAD = facetsOnCAD(ofEdges[e]);
      for (const FacetRecord& facet : onCAD)
      {
        if (meeting_.ofMeshEdges[e] >= 0 || facet.face < 0 || onCAD[0].face < 0 ||
            patches_[facet.face] == patches_[onCAD[0].face])
        {
          continue;
        }
        const std::int32_t one = patches_[onCAD[0].face];
        const std::int32_t other = patches_[facet.face];
        joins_[e] =
          isBetween(hits_[a].entity, one, other) && isBetween(hits_[b].entity, one, other);
        conflicts_[a] = conflicts_[a] || !joins_[e];
        conflicts_[b] = conflicts_[b] || !joins_[e];
      }
    }
  }

  /// 1 where all facets at the vertex are on the CAD and in the user's region.
  std::vector<unsigned char> findInside() const
  {
    std::vector<unsigned char> inside(hits_.size(), 1);
    for (std::size_t f = 0; f < records_.size(); ++f)
    {
      for (const Index v : task_.boundary.facets[f])
      {
        inside[v] = inside[v] && records_[f].onCAD && !records_[f].free;
      }
    }
    combineSmallest(task_.exchange, task_.mesh.shared, inside);
    return inside;
  }

  /// Whether this CAD edge runs through the entity, or continues one that does: along its line, or
  /// of smooth edges beyond a CAD vertex, which the mesh need not know of.
  bool continues(EntityId entity, std::int32_t edge) const
  {
    const auto& lines = task_.projector.lines();
    const NurbsEdge& one = nurbs_.edges[edge];
    const auto meets = [&](std::int32_t end)
    { return end >= 0 && (end == one.firstVertex || end == one.lastVertex); };
    const auto around = entitiesAround(nurbs_, entity, 1);
    return std::any_of(around.begin(), around.end(),
      [&](std::int32_t other)
      {
        const NurbsEdge& two = nurbs_.edges[other];
        return lines[other] == lines[edge] || (entity.dimension == 1 && !one.sharp && !two.sharp &&
                                                (meets(two.firstVertex) || meets(two.lastVertex)));
      });
  }

  /// How many mesh edges along the line of its CAD edge, or along edges of its CAD vertex, meet at
  /// each vertex.
  std::vector<std::int32_t> countRows() const
  {
    const auto& edges = task_.boundary.edges.edges();
    const auto owned = task_.boundary.sharedEdges.ownedHere(static_cast<Index>(edges.size()));
    std::vector<std::int32_t> rows(hits_.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const std::int32_t along = meeting_.ofMeshEdges[e];
      for (const Index v : edges[e])
      {
        if (owned[e])
        {
          rows[v] += along >= 0 ? continues(hits_[v].entity, along) : joins_[e] != 0;
        }
      }
    }
    combineShared(task_.exchange, task_.mesh.shared, rows,
      [](std::int32_t a, std::int32_t b) { return a + b; });
    return rows;
  }

  /// How many such mesh edges should meet at a vertex on this entity.
  std::int32_t rowsAt(EntityId entity) const
  {
    if (entity.dimension == 1)
    {
      return 2;
    }
    std::int32_t rows = 0;
    for (const std::int32_t edge : entitiesAround(nurbs_, entity, 1))
    {
      const NurbsEdge& e = nurbs_.edges[edge];
      rows += known_[edge] ? (e.firstVertex == e.lastVertex ? 2 : 1) : 0;
    }
    return rows;
  }

  /// Whether a vertex on a smooth CAD edge is less than an edge away from an end of that, which the
  /// mesh need not know of.
  bool isAtSmoothEnd(std::size_t v) const
  {
    const EntityId entity = hits_[v].entity;
    if (entity.dimension != 1 || nurbs_.edges[entity.index].sharp)
    {
      return false;
    }
    const NurbsEdge& edge = nurbs_.edges[entity.index];
    const auto isNear = [&](std::int32_t end)
    {
      return end >= 0 && distance(nurbs_.vertices[end].point, task_.points()[v]) <
                           task_.boundary.longestEdge[v];
    };
    return isNear(edge.firstVertex) || isNear(edge.lastVertex);
  }

  /// Looks for rows that end or branch, and where they end, for the vertices that may belong to
  /// what is missing.
  void lookAtRows()
  {
    const auto inside = findInside();
    const auto rows = countRows();
    std::vector<unsigned char> ends(hits_.size(), 0);
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      const EntityId entity = hits_[v].entity;
      if (!takesPart(v) || !inside[v] || entity.dimension == 2)
      {
        continue;
      }
      ends[v] = rows[v] < rowsAt(entity) && !isAtSmoothEnd(v);
      conflicts_[v] = conflicts_[v] || ends[v] || rows[v] > rowsAt(entity);
    }
    for (const Index v : findBeside(ends))
    {
      conflicts_[v] = conflicts_[v] || isCloseToCrease(v);
    }
  }

  /// The vertices of faces that share an edge with one of these.
  std::vector<Index> findBeside(const std::vector<unsigned char>& flags) const
  {
    std::vector<unsigned char> beside(flags.size(), 0);
    for (const auto& [a, b] : task_.boundary.edges.edges())
    {
      beside[a] = beside[a] || flags[b];
      beside[b] = beside[b] || flags[a];
    }
    combineFlags(task_.exchange, task_.mesh.shared, beside);
    return indicesWhere(beside.size(),
      [&](std::size_t v) { return beside[v] && takesPart(v) && hits_[v].entity.dimension == 2; });
  }

  bool isCloseToCrease(Index v) const
  {
    const double limit = ClassificationTolerances::conflictDistance * task_.boundary.longestEdge[v];
    return bool(task_.projector.nearestCrease(task_.points()[v], limit).entity);
  }

  /// Whether a CAD edge of a vertex that has taken a CAD vertex does not lead there.
  bool hasLineElsewhere(std::size_t v) const
  {
    const auto& lines = task_.projector.lines();
    const auto& there = nurbs_.vertices[hits_[v].entity.index].edges;
    const auto leadsThere = [&](std::int32_t edge)
    {
      return std::any_of(there.begin(), there.end(),
        [&](std::int32_t other) { return lines[other] == lines[edge]; });
    };
    const auto& edges = meeting_.edges[v];
    return !std::all_of(edges.begin(), edges.end(), leadsThere);
  }

  /// Whether all CAD edges of a vertex end in this CAD vertex.
  bool allEndAt(const SmallEntitySet& edges, std::int32_t vertex) const
  {
    const auto& ofVertex = nurbs_.vertices[vertex].edges;
    return std::all_of(edges.begin(), edges.end(),
      [&](std::int32_t edge)
      { return std::binary_search(ofVertex.begin(), ofVertex.end(), edge); });
  }

  bool isBetweenEntities(std::size_t v) const
  {
    const EntityId entity = hits_[v].entity;
    if (meeting_.undecided[v] || (entity.dimension == 0 && task_.projector.isCorner(entity.index)))
    {
      return true;
    }
    const auto& edges = meeting_.edges[v];
    const auto& lines = task_.projector.lines();
    if (std::all_of(edges.begin(), edges.end(),
          [&](std::int32_t edge) { return lines[edge] == lines[*edges.begin()]; }))
    {
      return false;
    }
    const NurbsEdge& first = nurbs_.edges[*edges.begin()];
    const auto isJoint = [&](std::int32_t vertex)
    { return vertex >= 0 && allEndAt(edges, vertex) && !task_.projector.isCorner(vertex); };
    return !isJoint(first.firstVertex) && !isJoint(first.lastVertex);
  }

  const ProjectionTask& task_;
  const NurbsModel& nurbs_;
  const std::vector<FacetRecord>& records_;
  const VertexClassification& meeting_;
  const std::vector<unsigned char>& onCAD_;
  const std::vector<unsigned char>& taken_;
  const std::vector<ClosestPoint>& hits_;
  std::vector<unsigned char> conflicts_;
  std::vector<unsigned char> known_;  ///< 1 for CAD edges along which mesh edges run.
  std::vector<std::int32_t> patches_; ///< The patch of each face.
  std::vector<unsigned char> joins_;  ///< 1 for mesh edges that continue rows: see lookAtEdges.
};

} // namespace

std::vector<unsigned char> findConflicts(const ProjectionTask& task, const FacetClasses& facets,
  const VertexClassification& meeting, const std::vector<unsigned char>& onCAD,
  const std::vector<unsigned char>& taken, const std::vector<ClosestPoint>& hits)
{
  return ConflictFinder(task, facets, meeting, onCAD, taken, hits).run();
}

} // namespace cadrefine
