#include "EdgeMidpoints.h"

#include "EvenWork.h"
#include "GlobalNumbering.h"
#include "LargeMemory.h"
#include "VertexNumbering.h"

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

/// Class of an edge and whether it lies on the boundary, as one number that ranks can combine by
/// the maximum: a rank without a facet at the edge has 0.
std::int64_t encode(const EdgeClass& edgeClass)
{
  return 1 + edgeClass.kind + 4 * static_cast<std::int64_t>(edgeClass.edge + 1);
}

EdgeClass decode(std::int64_t code)
{
  return code == 0 ? EdgeClass{}
                   : EdgeClass{ static_cast<EdgeClass::Kind>((code - 1) % 4),
                       static_cast<std::int32_t>((code - 1) / 4 - 1) };
}

/// The middle of an edge, which looks for its place on the CAD.
struct MidpointQuestion
{
  EdgeClass edgeClass;
  std::array<Point3, 2> points;
  std::array<EntityId, 2> entities;
};

} // namespace

MarkedEdges findEdges(RankExchange& exchange, const DistributedMesh& mesh, unsigned char mark)
{
  MarkedEdges edges;
  edges.table = buildEdgeTable(mesh.mesh());
  edges.sharedEdges = findSharedEdges(exchange, mesh.shared, mesh.mesh().ids, edges.table.edges);
  edges.marks.assign(edges.table.edges.size(), mark);
  return edges;
}

std::vector<GlobalId> numberMidpoints(RankExchange& exchange, DistributedMesh& mesh,
  const std::vector<std::array<Index, 2>>& parentEdges)
{
  const auto& ids = mesh.mesh().ids;
  std::vector<VertexKey<1>> keys;
  resizeLong(keys, parentEdges.size());
  std::transform(parentEdges.begin(), parentEdges.end(), keys.begin(),
    [&](const std::array<Index, 2>& ends) {
      return VertexKey<1>{ ends[0], { ids[ends[1]] } };
    });
  Numbering numbering = numberAtVertices(exchange, mesh.shared, ids, keys);
  for (GlobalId& number : numbering.numbers)
  {
    number += mesh.vertexIdBound;
  }
  mesh.vertexIdBound += numbering.count;
  return std::move(numbering.numbers);
}

std::vector<std::int64_t> edgeCodes(
  RankExchange& exchange, const MarkedEdges& edges, const ClassifiedBoundary& classified)
{
  std::vector<std::int64_t> codes(edges.table.edges.size(), 0);
  const auto& ends = classified.boundary.edges.edges();
  for (std::size_t e = 0; e < ends.size(); ++e)
  {
    codes[edges.table.find(ends[e][0], ends[e][1])] = encode(classified.classes.ofEdges[e]);
  }
  combineShared(exchange, edges.sharedEdges, codes,
    [](std::int64_t a, std::int64_t b) { return std::max(a, b); });
  return codes;
}

std::vector<MidpointOnCAD> projectMidpoints(RankExchange& exchange, const SimplexMesh& mesh,
  const MarkedEdges& edges, const std::vector<std::int64_t>& codes,
  const BoundaryProjector& projector, const Classification& classification,
  RunStatistics& statistics)
{
  std::vector<std::size_t> places;
  std::vector<MidpointQuestion> questions;
  std::size_t place = 0;
  for (std::size_t e = 0; e < codes.size(); ++e)
  {
    const EdgeClass edgeClass = decode(codes[e]);
    if (edges.marks[e] && edgeClass.kind != EdgeClass::Straight)
    {
      const auto [a, b] = edges.table.edges[e];
      places.push_back(place);
      questions.push_back({ edgeClass, { mesh.points[a], mesh.points[b] },
        { classification.entities[a], classification.entities[b] } });
    }
    place += edges.marks[e];
  }
  const auto answers = answerEvenly<ClosestPoint>(exchange, std::move(questions),
    [&](const MidpointQuestion& question)
    { return projector.projectMidpoint(question.edgeClass, question.points, question.entities); },
    { "projecting", "new vertices" });
  recordBalance(statistics, "new points", answers.balance);
  std::vector<MidpointOnCAD> hits;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (answers.values[i].entity)
    {
      hits.push_back({ places[i], answers.values[i] });
    }
  }
  return hits;
}

void classifyMidpoints(
  const std::vector<MidpointOnCAD>& hits, std::size_t count, Classification& classification)
{
  const std::size_t oldCount = classification.entities.size();
  classification.resize(count);
  for (const MidpointOnCAD& hit : hits)
  {
    classification.set(static_cast<Index>(oldCount + hit.place), hit.where);
    classification.distances[oldCount + hit.place] = hit.where.distance;
  }
}

std::int64_t countHits(RankExchange& exchange, const SharedVertices& shared, std::size_t vertices,
  const std::vector<MidpointOnCAD>& hits)
{
  return exchange.sum(std::count_if(hits.begin(), hits.end(),
    [&](const MidpointOnCAD& hit)
    { return shared.owner(static_cast<Index>(vertices + hit.place)) == exchange.rank(); }));
}

} // namespace cadrefine
