#include "classification/FacetsOffCAD.h"

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/classification/FaceFinder.h>

#include <algorithm>
#include <array>

namespace cadrefine
{
namespace
{

/// The faces (of a planar mesh, edges) of the CAD that a facet covers: those that its corners are
/// within, or where none is, those that bound all of them.
std::vector<std::int32_t> findCovered(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const Facet& facet)
{
  const int dimension = task.boundary.facetDimension();
  std::vector<std::int32_t> covered;
  std::array<EntityId, 4> entities{};
  for (int k = 0; k < facet.corners(); ++k)
  {
    entities[k] = hits[facet.vertices[k]].entity;
    if (entities[k].dimension == dimension)
    {
      covered.push_back(entities[k].index);
    }
  }
  return !covered.empty() ? covered
         : task.ofFaces() ? commonFaces(task.model().nurbs(), entities, facet.corners())
                          : commonEntities(task.model().nurbs(), entities[0], entities[1], 1);
}

/// Whether a vertex is on the CAD already, but for rounding.
bool liesOnCAD(const ProjectionTask& task, const std::vector<ClosestPoint>& hits, Index vertex)
{
  return hits[vertex].distance <= task.rounded(vertex);
}

bool liesOnCAD(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const Facet& facet)
{
  return std::all_of(
    facet.begin(), facet.end(), [&](Index vertex) { return liesOnCAD(task, hits, vertex); });
}

/// Cosine between the normals of a facet and of a face (of a planar mesh, between the directions of
/// a segment and of an edge) where this is nearest to its middle; 0 where an edge ends there.
double cosineOn(
  const ProjectionTask& task, const Facet& facet, const FacetRecord& record, std::int32_t entity)
{
  const Point3 middle = centroidOf(task.mesh.mesh(), facet);
  if (task.ofFaces())
  {
    return dot(task.model().normalNear(entity, middle), record.normal);
  }
  const Vector3 way = task.points()[facet.vertices[1]] - task.points()[facet.vertices[0]];
  const ClosestPoint where = task.model().nearestOn({ 1, entity }, middle);
  return where.entity.dimension == 1
           ? dot(task.model().tangent(entity, where.parameters[0]), normalized(way))
           : 0;
}

/// For each face (of a planar mesh, edge) of the CAD the way that facets on it face, 1 as it does,
/// -1 the other, where nearly all that face so lie on it with all corners; else 0.
FaceSides findExactSides(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const std::vector<FacetRecord>& records)
{
  const auto& facets = task.boundary.facets;
  const std::size_t count = task.model().count(task.boundary.facetDimension());
  const auto forAllCovered = [&](const auto& use)
  {
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
      if (records[f].onCAD && !facets[f].isInside)
      {
        const bool isExact = liesOnCAD(task, hits, facets[f]);
        for (const std::int32_t entity : findCovered(task, hits, facets[f]))
        {
          use(f, entity, isExact);
        }
      }
    }
  };
  std::vector<std::int64_t> has(2 * count, 0); // exact facets; others
  forAllCovered([&](std::size_t, std::int32_t entity, bool isExact)
    { has[entity + (isExact ? 0 : count)] = 1; });
  has = task.exchange.max(has);
  std::vector<std::int64_t> exact(2 * count, 0); // the CAD's way, and the other
  std::vector<std::int64_t> others(2 * count, 0);
  forAllCovered(
    [&](std::size_t f, std::int32_t entity, bool isExact)
    {
      if (has[entity] && has[entity + count])
      {
        const bool isOther = cosineOn(task, facets[f], records[f], entity) < 0;
        ++(isExact ? exact : others)[entity + (isOther ? count : 0)];
      }
    });
  exact = task.exchange.sum(exact);
  others = task.exchange.sum(others);
  FaceSides sides(count, 0);
  for (std::size_t entity = 0; entity < count; ++entity)
  {
    const bool alike = exact[entity] >= exact[entity + count];
    const std::size_t place = entity + (alike ? 0 : count);
    const auto all = static_cast<double>(exact[entity] + exact[entity + count] + others[place]);
    const bool isMost =
      static_cast<double>(exact[place]) >= ClassificationTolerances::sideMajority * all;
    sides[entity] = exact[place] > 0 && isMost ? (alike ? 1 : -1) : 0;
  }
  return sides;
}

} // namespace

void leaveEndsOfLayers(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  std::vector<FacetRecord>& records)
{
  constexpr std::int64_t byInside = 1;
  constexpr std::int64_t byOuter = 2;
  const auto& facets = task.boundary.facets;
  const int dimension = task.boundary.facetDimension();
  const auto isThere = [&](Index vertex) { return liesOnCAD(task, hits, vertex); };
  std::vector<std::int64_t> covers(task.model().count(dimension), 0);
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    if (records[f].onCAD && (!facets[f].isInside || liesOnCAD(task, hits, facets[f])))
    {
      for (const std::int32_t entity : findCovered(task, hits, facets[f]))
      {
        covers[entity] = std::max(covers[entity], facets[f].isInside ? byInside : byOuter);
      }
    }
  }
  covers = task.exchange.max(covers);
  const auto isOf = [&](Index vertex, std::int32_t entity)
  {
    const auto around = entitiesAround(task.model().nurbs(), hits[vertex].entity, dimension);
    return isThere(vertex) && std::binary_search(around.begin(), around.end(), entity);
  };
  const auto isBeside = [&](const Facet& facet, Index corner)
  {
    const EntityId entity = hits[corner].entity;
    return entity.dimension == dimension && !isThere(corner) &&
           (covers[entity.index] == byOuter ||
             (covers[entity.index] == byInside &&
               std::none_of(facet.begin(), facet.end(),
                 [&](Index vertex) { return isOf(vertex, entity.index); })));
  };
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    if (facets[f].isInside && std::any_of(facets[f].begin(), facets[f].end(),
                                [&](Index corner) { return isBeside(facets[f], corner); }))
    {
      records[f].onCAD = 0;
    }
  }
}

void leaveWalls(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  std::vector<FacetRecord>& records)
{
  using T = ClassificationTolerances;
  const DistributedBoundary& boundary = task.boundary;
  const FaceSides sides = findExactSides(task, hits, records);
  // With the way that its faces have; 1 where it has none, or exact facets are few on one of them.
  const auto largestCosine = [&](std::size_t f)
  {
    const auto covered = findCovered(task, hits, boundary.facets[f]);
    double largest = covered.empty() ? 1 : -1;
    for (const std::int32_t entity : covered)
    {
      const double cosine =
        sides[entity] == 0 ? 1
                           : sides[entity] * cosineOn(task, boundary.facets[f], records[f], entity);
      largest = std::max(largest, cosine);
    }
    return largest;
  };
  std::vector<Index> suspects;
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    const Facet& facet = boundary.facets[f];
    if (records[f].onCAD && !facet.isInside && !liesOnCAD(task, hits, facet))
    {
      const double cosine = largestCosine(f);
      records[f].onCAD = cosine < T::followingCosine ? 0 : 1;
      if (records[f].onCAD && task.ofFaces() && cosine < T::flatCosine)
      {
        suspects.push_back(static_cast<Index>(f));
      }
    }
  }
  const auto continues = [](const FacetRecord& facet, const FacetRecord& other)
  {
    return !other.onCAD && !other.free && !other.isInside && dot(facet.normal, other.normal) > 0 &&
           norm(cross(facet.normal, other.normal)) <= T::samePlane;
  };
  for (bool changes = true; task.exchange.any(changes && !suspects.empty());)
  {
    const auto ofEdges = gatherFacetRecords(task.exchange, boundary, records);
    const auto isOfWall = [&](Index f)
    {
      const auto& edges = boundary.facetEdges[f];
      return std::any_of(edges.begin(), edges.begin() + boundary.facets[f].edges(),
        [&](Index edge)
        {
          return std::any_of(ofEdges[edge].begin(), ofEdges[edge].end(),
            [&](const FacetRecord& other) { return continues(records[f], other); });
        });
    };
    const auto found = std::stable_partition(
      suspects.begin(), suspects.end(), [&](Index f) { return !isOfWall(f); });
    changes = found != suspects.end();
    std::for_each(found, suspects.end(), [&](Index f) { records[f].onCAD = 0; });
    suspects.erase(found, suspects.end());
  }
}

} // namespace cadrefine
