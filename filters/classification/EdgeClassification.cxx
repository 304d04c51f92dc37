#include "classification/EdgeClassification.h"

#include "comm/LoadBalancedMap.h"

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// Faces with a seam: mesh edges inside of them may run along it.
std::vector<unsigned char> findSeamedFaces(const NurbsModel& nurbs)
{
  std::vector<unsigned char> seamed(nurbs.faces.size(), 0);
  for (const NurbsEdge& edge : nurbs.edges)
  {
    if (isSeam(edge))
    {
      seamed[edge.faces[0]] = 1;
    }
  }
  return seamed;
}

std::vector<EdgeMatch> matchMeshEdges(const ProjectionTask& task,
  const std::vector<ClosestPoint>& hits, const std::vector<FacetRecord>& records,
  const std::vector<unsigned char>& settled)
{
  const auto ofEdges = gatherFacetRecords(task.exchange, task.boundary, records);
  const auto seamed = findSeamedFaces(task.model().nurbs());
  const auto& edges = task.boundary.edges.edges();
  NumberedQueries<MeshEdge> asked;
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const auto [a, b] = edges[e];
    if (!hits[a].entity || !hits[b].entity)
    {
      continue;
    }
    for (MeshEdge edge : meshEdges({ task.points()[a], task.points()[b] }, facetsOnCAD(ofEdges[e])))
    {
      const std::int32_t face = edge.facets[0].face;
      const bool inside = edge.facetCount == 2 && face == edge.facets[1].face;
      if (hasAngle(edge) || !inside || (face >= 0 && seamed[face]))
      {
        edge.settled = { settled[a], settled[b] };
        asked.add(e, edge);
      }
    }
  }
  const EdgeFinder finder(task.model());
  std::vector<EdgeMatch> best(edges.size());
  answerBalanced<EdgeMatch>(
    task.exchange, std::move(asked), [&](const MeshEdge& edge) { return finder.find(edge); },
    [&](std::size_t e, const EdgeMatch& match) { best[e] = std::min(best[e], match); },
    { "finding the CAD edges of", "mesh edges" });
  return best;
}

/// For each CAD edge the length of the mesh edges that run along it, in whole numbers of 2^-40 of
/// the model's size, so that the sum does not depend on the order.
std::vector<std::int64_t> sumLengths(
  const ProjectionTask& task, const std::vector<std::int32_t>& ofMeshEdges)
{
  const auto& edges = task.boundary.edges.edges();
  const auto owned = task.boundary.sharedEdges.ownedHere(static_cast<Index>(edges.size()));
  std::vector<std::int64_t> lengths(task.model().nurbs().edges.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (owned[e] && ofMeshEdges[e] >= 0)
    {
      const auto [a, b] = edges[e];
      const double length = distance(task.points()[a], task.points()[b]) / task.model().size();
      lengths[ofMeshEdges[e]] += std::llround(std::ldexp(length, 40));
    }
  }
  return task.exchange.sum(lengths);
}

/// The CAD edges along at least half of which these mesh edges run.
std::vector<unsigned char> findCovered(
  const ProjectionTask& task, const std::vector<std::int32_t>& ofMeshEdges)
{
  const auto lengths = sumLengths(task, ofMeshEdges);
  std::vector<unsigned char> covered(lengths.size(), 0);
  for (std::size_t edge = 0; edge < lengths.size(); ++edge)
  {
    const double length = std::ldexp(static_cast<double>(lengths[edge]), -40);
    const EntityId entity{ 1, static_cast<std::int32_t>(edge) };
    covered[edge] =
      lengths[edge] > 0 && length * task.model().size() >=
                             ClassificationTolerances::coveredPart * task.model().measure(entity);
  }
  return covered;
}

/// For each mesh edge whose ends lie exactly on a CAD edge that it follows, that; -1 otherwise.
std::vector<std::int32_t> findExact(const ProjectionTask& task,
  const std::vector<ClosestPoint>& hits, const std::vector<unsigned char>& settled)
{
  const EdgeFinder finder(task.model());
  const auto& edges = task.boundary.edges.edges();
  std::vector<std::int32_t> exact(edges.size(), -1);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    const auto [a, b] = edges[e];
    if (!settled[a] || !settled[b] || hits[a].entity.dimension > 1 || hits[b].entity.dimension > 1)
    {
      continue;
    }
    for (const std::int32_t edge :
      commonEntities(task.model().nurbs(), hits[a].entity, hits[b].entity, 1))
    {
      if (finder.follows(edge, { task.points()[a], task.points()[b] }))
      {
        exact[e] = edge;
      }
    }
  }
  return exact;
}

/// Forgets mesh edges that would take vertices on the CAD to a CAD edge along which others run
/// exactly: those are it. Vertices that lie on creases which continue the CAD edge stay there.
void dropInconsistentMatches(const ProjectionTask& task, const std::vector<ClosestPoint>& hits,
  const std::vector<unsigned char>& settled, std::vector<EdgeMatch>& matches)
{
  const auto covered = findCovered(task, findExact(task, hits, settled));
  const auto& lines = task.projector.lines();
  const auto isElsewhere = [&](Index v, std::int32_t edge)
  {
    const EntityId entity = hits[v].entity;
    const auto around = entitiesAround(task.model().nurbs(), entity, 1);
    return settled[v] && std::none_of(around.begin(), around.end(),
                           [&](std::int32_t other) { return lines[other] == lines[edge]; });
  };
  const auto& edges = task.boundary.edges.edges();
  for (std::size_t e = 0; e < matches.size(); ++e)
  {
    const auto [a, b] = edges[e];
    const EdgeMatch& match = matches[e];
    if (match.unsettles && covered[match.edge] &&
        (isElsewhere(a, match.edge) || isElsewhere(b, match.edge)))
    {
      matches[e] = {};
    }
  }
}

/// Forgets smooth CAD edges along less than half of which the mesh runs: it does not know of them.
void dropPartialMatches(const ProjectionTask& task, std::vector<std::int32_t>& ofMeshEdges)
{
  const auto& edges = task.model().nurbs().edges;
  const auto followed = findCovered(task, ofMeshEdges);
  for (std::int32_t& edge : ofMeshEdges)
  {
    edge = edge >= 0 && (edges[edge].sharp || followed[edge]) ? edge : -1;
  }
}

std::vector<std::int32_t> edgesOfMeshEdges(const ProjectionTask& task,
  const std::vector<ClosestPoint>& hits, const std::vector<FacetRecord>& records,
  const std::vector<unsigned char>& settled)
{
  auto matches = matchMeshEdges(task, hits, records, settled);
  dropInconsistentMatches(task, hits, settled, matches);
  std::vector<std::int32_t> result(matches.size());
  std::transform(matches.begin(), matches.end(), result.begin(),
    [](const EdgeMatch& match) { return match.edge; });
  dropPartialMatches(task, result);
  return result;
}

std::vector<std::int32_t> edgesOfSegments(
  const ProjectionTask& task, const std::vector<FacetRecord>& records)
{
  std::vector<std::int32_t> result(task.boundary.edges.edges().size(), -1);
  NumberedQueries<Point3> asked;
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    if (records[f].onCAD && !records[f].free)
    {
      const auto& ends = task.boundary.facets[f].vertices;
      asked.add(
        task.boundary.facetEdges[f][0], 0.5 * (task.points()[ends[0]] + task.points()[ends[1]]));
    }
  }
  answerBalanced<ClosestPoint>(
    task.exchange, std::move(asked),
    [&](const Point3& middle)
    { return task.projector.nearest(middle, std::numeric_limits<double>::infinity()); },
    [&](std::size_t e, const ClosestPoint& where)
    { result[e] = where.entity.dimension == 1 ? where.entity.index : -1; });
  return result;
}

} // namespace

std::vector<std::int32_t> findCADEdges(const ProjectionTask& task,
  const std::vector<ClosestPoint>& hits, const std::vector<FacetRecord>& records,
  const std::vector<unsigned char>& settled)
{
  return task.ofFaces() ? edgesOfMeshEdges(task, hits, records, settled)
                        : edgesOfSegments(task, records);
}

} // namespace cadrefine
