#include "classification/FacetClassification.h"

#include "comm/CollectiveErrors.h"
#include "comm/LoadBalancedMap.h"
#include "comm/Threads.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <array>
#include <map>

namespace cadrefine
{
namespace
{

/// Whether the facet looks alike on the CAD: no edge shorter than half of it or longer than twice,
/// not less than a quarter of its area, if all corners come onto edges, and, where the user sets no
/// limit, no corner farther away than half of the longest edge. Facets of walls and of the far
/// field collapse when their corners are projected, and so do those beside a face, in its plane, as
/// on a plane of symmetry.
bool keepsItsShape(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const Facet& facet)
{
  const auto& points = task.points();
  const int corners = facet.corners();
  double longest = 0;
  double farthest = 0;
  for (int k = 0; k < corners; ++k)
  {
    const Index a = facet.vertices[k];
    const Index b = facet.vertices[(k + 1) % corners];
    const double before = distance(points[a], points[b]);
    const double after = distance(hits[a].point, hits[b].point);
    if (after < ClassificationTolerances::leastShrinking * before ||
        before < ClassificationTolerances::leastShrinking * after)
    {
      return false;
    }
    longest = std::max(longest, before);
    farthest = std::max(farthest, hits[a].distance);
  }
  const bool isAlongEdges = std::all_of(
    facet.begin(), facet.end(), [&](Index vertex) { return hits[vertex].entity.dimension < 2; });
  if (corners > 2 && isAlongEdges)
  {
    std::array<Point3, 4> projected{};
    std::transform(facet.begin(), facet.end(), projected.begin(),
      [&](Index vertex) { return hits[vertex].point; });
    if (norm(twofoldAreaVector(projected, corners)) <
        ClassificationTolerances::leastArea *
          norm(twofoldAreaVector(pointsOf(task.mesh.mesh(), facet), corners)))
    {
      return false;
    }
  }
  return task.options.maximumDistance ||
         farthest <= ClassificationTolerances::farthestCorner * longest;
}

std::vector<FacetRecord> makeRecords(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const ParallelFor& parallelFor)
{
  std::vector<EntityId> entities(hits.size());
  std::transform(
    hits.begin(), hits.end(), entities.begin(), [](const ClosestPoint& hit) { return hit.entity; });
  const auto recordOf = [&](const Facet& facet)
  {
    FacetRecord record =
      makeRecord(task.projector, classifiedFacet(task.mesh.mesh(), entities, facet));
    record.onCAD = record.onCAD && keepsItsShape(task, hits, facet);
    record.free = std::any_of(facet.begin(), facet.end(),
      [&](Index vertex) { return !task.options.inRegion(task.points()[vertex]); });
    return record;
  };
  const auto& facets = task.boundary.facets;
  std::vector<FacetRecord> records(facets.size());
  forEachIndex(parallelFor, facets.size(), coarseGrain,
    [&](std::size_t f) { records[f] = recordOf(facets[f]); });
  return records;
}

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
  return hits[vertex].distance <= roundedDistance(task.model(), task.boundary.shortestEdge[vertex]);
}

/// Takes facets between two cells off the CAD where outer ones are on the same face of it (of a
/// planar mesh, edge), or others whose corners are there, but for rounding, while none of theirs
/// is.
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
    if (records[f].onCAD &&
        (!facets[f].isInside || std::all_of(facets[f].begin(), facets[f].end(), isThere)))
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

/// Cosine between the normals of a facet and of a face (of a planar mesh, between the directions of
/// a segment and of an edge) where this is nearest to its middle; 0 where an edge ends there.
double cosineOn(const ProjectionTask& task, const Facet& facet, std::int32_t entity)
{
  const std::array<Point3, 4> p = pointsOf(task.mesh.mesh(), facet);
  if (task.ofFaces())
  {
    const Vector3 normal = normalized(twofoldAreaVector(p, facet.corners()));
    return dot(task.model().normalNear(entity, centroidOf(p, facet.corners())), normal);
  }
  const ClosestPoint where = task.model().nearestOn({ 1, entity }, 0.5 * (p[0] + p[1]));
  return where.entity.dimension == 1
           ? dot(task.model().tangent(entity, where.parameters[0]), normalized(p[1] - p[0]))
           : 0;
}

/// An outer facet on the CAD, not all of whose corners are there.
bool isInexact(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const FacetRecord& record, const Facet& facet)
{
  return record.onCAD && !facet.isInside &&
         !std::all_of(
           facet.begin(), facet.end(), [&](Index vertex) { return liesOnCAD(task, hits, vertex); });
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
        const bool isExact = !isInexact(task, hits, records[f], facets[f]);
        for (const std::int32_t entity : findCovered(task, hits, facets[f]))
        {
          use(facets[f], entity, isExact);
        }
      }
    }
  };
  std::vector<std::int64_t> has(2 * count, 0); // exact facets; others
  forAllCovered([&](const Facet&, std::int32_t entity, bool isExact)
    { has[entity + (isExact ? 0 : count)] = 1; });
  has = task.exchange.max(has);
  std::vector<std::int64_t> exact(2 * count, 0); // the CAD's way, and the other
  std::vector<std::int64_t> others(2 * count, 0);
  forAllCovered(
    [&](const Facet& facet, std::int32_t entity, bool isExact)
    {
      if (has[entity] && has[entity + count])
      {
        ++(isExact ? exact : others)[entity + (cosineOn(task, facet, entity) < 0 ? count : 0)];
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

/// Takes outer facets off the CAD that are no part of a face whose own facets lie exactly on it
/// (see findExactSides): walls that turn from it by more than 30 degrees, where they meet it, or
/// that face the other way, beyond a gap that is narrower than facets are long; and what is left of
/// plane walls, which turns by more than 10 degrees, and continues facets that are off the CAD.
/// Collective; an exchange of records for each ring of such facets.
void leaveWalls(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  std::vector<FacetRecord>& records)
{
  using T = ClassificationTolerances;
  const DistributedBoundary& boundary = task.boundary;
  const FaceSides sides = findExactSides(task, hits, records);
  const auto turnsBy = [&](std::size_t f, double cosine)
  {
    const auto covered = findCovered(task, hits, boundary.facets[f]);
    return !covered.empty() &&
           std::all_of(covered.begin(), covered.end(),
             [&](std::int32_t entity)
             {
               return sides[entity] != 0 &&
                      sides[entity] * cosineOn(task, boundary.facets[f], entity) < cosine;
             });
  };
  const auto inexact = indicesWhere(records.size(),
    [&](std::size_t f) { return isInexact(task, hits, records[f], boundary.facets[f]); });
  std::vector<Index> suspects;
  for (const Index f : inexact)
  {
    records[f].onCAD = turnsBy(f, T::followingCosine) ? 0 : 1;
    if (records[f].onCAD && task.ofFaces() && turnsBy(f, T::flatCosine))
    {
      suspects.push_back(f);
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

/// 1 for vertices that are, like all vertices that share a boundary edge with them, nearest to one
/// face.
std::vector<unsigned char> findThoseAmongTheirOwn(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits)
{
  std::vector<unsigned char> result(hits.size());
  std::transform(hits.begin(), hits.end(), result.begin(),
    [](const ClosestPoint& hit) { return hit.entity.dimension == 2; });
  for (const auto& [a, b] : task.boundary.edges.edges())
  {
    if (hits[a].entity != hits[b].entity)
    {
      result[a] = 0;
      result[b] = 0;
    }
  }
  combineSmallest(task.exchange, task.mesh.shared, result);
  return result;
}

FaceSides findSides(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const std::vector<FacetRecord>& records)
{
  const std::size_t faces = task.model().nurbs().faces.size();
  std::vector<std::int64_t> votes(2 * faces, 0); // alike, opposite
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (!records[f].onCAD || records[f].isInside)
    {
      continue;
    }
    for (const Index vertex : task.boundary.facets[f])
    {
      const ClosestPoint& hit = hits[vertex];
      if (hit.entity.dimension != 2)
      {
        continue;
      }
      const Vector3 normal = task.model().normal(hit.entity.index, hit.parameters);
      if (fitsEitherWay(normal, records[f].normal))
      {
        const bool isOpposite = dot(normal, records[f].normal) < 0;
        ++votes[hit.entity.index + (isOpposite ? faces : 0)];
      }
    }
  }
  votes = task.exchange.sum(votes);
  const auto opposite = votes.begin() + static_cast<std::ptrdiff_t>(faces);
  return decideSides({ votes.begin(), opposite }, { opposite, votes.end() });
}

std::vector<FaceMatch> findFaces(
  const ProjectionTask& task, const std::vector<ClosestPoint>& hits, const FacetClasses& classes)
{
  const auto& records = classes.records;
  const auto amongTheirOwn = findThoseAmongTheirOwn(task, hits);
  const FaceFinder finder(task.model(), classes.sides);
  std::vector<CornerHits> queries;
  std::vector<std::size_t> facets;
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (!records[f].onCAD)
    {
      continue;
    }
    CornerHits query;
    query.exact = 1;
    query.isInside = records[f].isInside;
    query.corners = task.boundary.facets[f].corners();
    for (int k = 0; k < query.corners; ++k)
    {
      const Index vertex = task.boundary.facets[f].vertices[k];
      query.points[k] = task.points()[vertex];
      query.hits[k] = hits[vertex];
      query.amongItsOwn[k] = amongTheirOwn[vertex];
      query.exact = query.exact && hits[vertex].distance <= task.exact(vertex);
    }
    queries.push_back(query);
    facets.push_back(f);
  }
  const auto answers = mapBalanced<FaceMatch>(task.exchange, std::move(queries),
    [&](const CornerHits& query) { return finder.find(query); },
    { "finding the CAD faces of", "facets" });
  std::vector<FaceMatch> matches(records.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
  {
    matches[facets[i]] = answers.values[i];
  }
  return matches;
}

/// The face that most of these neighbours of `facet` have; of several its own or the first.
std::int32_t majority(const FacetRecord& facet, const std::vector<FacetRecord>& neighbours)
{
  const double smooth = ClassificationTolerances::smoothFacetsCosine();
  std::map<std::int32_t, int> votes;
  for (const FacetRecord& neighbour : neighbours)
  {
    if (neighbour.face >= 0 && dot(neighbour.normal, facet.normal) >= smooth)
    {
      ++votes[neighbour.face];
    }
  }
  std::int32_t best = facet.face;
  for (const auto& [face, count] : votes)
  {
    best = count > votes[best] ? face : best;
  }
  return best;
}

/// Only the sure ones are asked, so that the order of the facets does not matter.
void askNeighbours(const ProjectionTask& task, const std::vector<FaceMatch>& matches,
  std::vector<FacetRecord>& records)
{
  std::vector<FacetRecord> sure = records;
  for (std::size_t f = 0; f < sure.size(); ++f)
  {
    sure[f].face = matches[f].certain ? records[f].face : -1;
  }
  const auto ofEdges = gatherFacetRecords(task.exchange, task.boundary, sure);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (records[f].onCAD && !matches[f].certain)
    {
      std::vector<FacetRecord> neighbours;
      for (int k = 0; k < task.boundary.facets[f].edges(); ++k)
      {
        const auto& ofEdge = ofEdges[task.boundary.facetEdges[f][k]];
        neighbours.insert(neighbours.end(), ofEdge.begin(), ofEdge.end());
      }
      records[f].face = majority(records[f], neighbours);
    }
  }
}

} // namespace

FacetClasses classifyFacets(const ProjectionTask& task, const std::vector<ClosestPoint>& hits)
{
  FacetClasses classes;
  auto& records = classes.records;
  const ParallelFor parallelFor = forOnThreads(task.exchange);
  agreeOnFailure(task.exchange, [&] { records = makeRecords(task, hits, parallelFor); });
  leaveEndsOfLayers(task, hits, records);
  leaveWalls(task, hits, records);
  if (!task.ofFaces())
  {
    return classes;
  }
  classes.sides = findSides(task, hits, records);
  const auto matches = findFaces(task, hits, classes);
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    records[f].face = matches[f].face;
  }
  askNeighbours(task, matches, records);
  return classes;
}

} // namespace cadrefine
