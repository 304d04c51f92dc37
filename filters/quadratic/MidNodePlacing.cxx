#include "quadratic/MidNodePlacing.h"

#include "classification/EdgeMidpoints.h"
#include "comm/Threads.h"
#include "mesh/MeshPlane.h"
#include "motion/LayerColumns.h"

#include <cadrefine/quadratic/MidNodeGuard.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace cadrefine
{
namespace
{

/// A node on a wall that moves by less than this part of the height of the first cell does so
/// alone.
constexpr double leastMove = 0.25;
/// A node that is to move by less than this part of the length of its edge is where it is to go.
constexpr double negligible = 1e-9;

/// Makes the mesh one of second order, given its edges, whose table is taken.
void makeMidNodes(RankExchange& exchange, DistributedMesh& mesh, MarkedEdges& edges)
{
  auto ids =
    numberMidpoints(exchange, mesh.shared, mesh.mesh().ids, mesh.vertexIdBound, edges.table.edges);
  MidNodes& nodes = mesh.converted.midNodes.emplace();
  nodes.ids = std::move(ids);
  nodes.table = std::move(edges.table);
  nodes.points = middlesOf(mesh.mesh(), nodes.table.edges);
  mesh.sharedPoints = findSharedPoints(mesh, edges.sharedEdges);
}

/// Mid nodes on their way onto the CAD, and those over them that go along.
class Placing
{
public:
  Placing(RankExchange& exchange, const DistributedMesh& mesh, const SharedEdges& sharedEdges,
    const ClassifiedBoundary& classified)
    : exchange_(exchange), mesh_(mesh), sharedEdges_(sharedEdges), classified_(classified),
      nodes_(*mesh.converted.midNodes), plane_(planeNormal(exchange, mesh.mesh(),
                                          classified.projector.kind() == BoundaryKind::Edges)),
      moves_(nodes_.points)
  {
  }

  /// Returns the places of all mid nodes; those with hits go there as far as all cells stay valid.
  /// The hits of nodes that slide on the CAD to go along become the places where they are to be.
  /// Sets `tooCurved` (see PlacedMidNodes). Collective.
  std::vector<Point3> place(std::vector<MidpointOnCAD>& hits, std::vector<unsigned char>& tooCurved)
  {
    std::vector<EntityId> entities(nodes_.points.size());
    for (const MidpointOnCAD& hit : hits)
    {
      entities[hit.place] = hit.where.entity;
      if (!isThere(hit))
      {
        moves_.add(static_cast<Index>(hit.place), hit.where.point);
      }
    }
    const std::vector<unsigned char> held = findHeld();
    LayerColumns columns(exchange_, mesh_,
      { nodes_.points, nodes_.ids, sharedEdges_, entities, held, leastMove, &nodes_.table }, moves_,
      classified_.projector, { classified_.boundary.onBoundary, {} }, plane_);
    if (columns.any())
    {
      columns.follow(exchange_, moves_);
    }
    takeHits(held, hits);
    std::transform(moves_.fractions.begin(), moves_.fractions.end(), held.begin(),
      moves_.fractions.begin(), [](double fraction, bool stays) { return stays ? 0 : fraction; });
    tooCurved = settle(columns);
    std::vector<Point3> places(nodes_.points.size());
    for (std::size_t e = 0; e < places.size(); ++e)
    {
      places[e] = moves_.position(nodes_.points, static_cast<Index>(e));
    }
    return places;
  }

private:
  bool isThere(const MidpointOnCAD& hit) const
  {
    const auto& [a, b] = nodes_.table.edges[hit.place];
    const std::vector<Point3>& points = mesh_.mesh().points;
    return distance(hit.where.point, nodes_.points[hit.place]) <=
           negligible * distance(points[a], points[b]);
  }

  std::vector<unsigned char> findHeld()
  {
    auto held = midNodesOfPyramids(nodes_.table);
    combineFlags(exchange_, sharedEdges_, held);
    return held;
  }

  /// Sends nodes on the CAD that no column has moved to their hits, and others to the place nearest
  /// to where the column moves them. One that is held and at its hit, but for rounding, is on the
  /// CAD where it is.
  void takeHits(const std::vector<unsigned char>& held, std::vector<MidpointOnCAD>& hits)
  {
    for (MidpointOnCAD& hit : hits)
    {
      auto& [edge, where] = hit;
      if (held[edge] && isThere(hit))
      {
        where.point = nodes_.points[edge];
      }
      else if (moves_.fractions[edge] > 0 && moves_.targets[edge] != where.point)
      {
        where = classified_.projector.nearestOn(where.entity, moves_.targets[edge]);
      }
      moves_.add(static_cast<Index>(edge), where.point);
    }
  }

  /// Takes the moves back until all cells of all ranks are valid. Returns for which cells.
  std::vector<unsigned char> settle(const LayerColumns& columns)
  {
    const auto tie = [&]
    {
      combineSmallest(exchange_, sharedEdges_, moves_.fractions);
      if (columns.any())
      {
        columns.tie(exchange_, moves_);
      }
    };
    tie(); // also with nodes that are held
    MidNodeGuard guard(
      mesh_.mesh(), nodes_.table, nodes_.points, moves_, plane_, forOnThreads(exchange_));
    while (exchange_.any(guard.stepBack(moves_)))
    {
      tie();
    }
    return guard.tooCurved();
  }

  RankExchange& exchange_;
  const DistributedMesh& mesh_;
  const SharedEdges& sharedEdges_;
  const ClassifiedBoundary& classified_;
  const MidNodes& nodes_; ///< The mid nodes, in the middle of their edges.
  const Vector3 plane_;
  Moves moves_;
};

/// The edges of a cell that are on the CAD; or the others, if all edges at a corner are on it. All
/// edges, where there are none such.
template<class Shape, class Edges, class IsOnCAD>
std::vector<Index> edgesAtCAD(Shape, const Edges& edges, const IsOnCAD& isOnCAD)
{
  std::array<bool, Shape::corners> meetInside{};
  for (std::size_t k = 0; k < edges.size(); ++k)
  {
    const auto& [a, b] = Shape::edges[k];
    meetInside[a] = meetInside[a] || !isOnCAD(edges[k]);
    meetInside[b] = meetInside[b] || !isOnCAD(edges[k]);
  }
  const bool wanted = std::find(meetInside.begin(), meetInside.end(), false) == meetInside.end();
  std::vector<Index> result;
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(result),
    [&](Index edge) { return isOnCAD(edge) == wanted; });
  return result.empty() ? std::vector<Index>(edges.begin(), edges.end()) : result;
}

} // namespace

void addMidNodes(RankExchange& exchange, DistributedMesh& mesh)
{
  MarkedEdges edges = findEdges(exchange, mesh, 1);
  makeMidNodes(exchange, mesh, edges);
}

PlacedMidNodes placeMidNodes(RankExchange& exchange, DistributedMesh& mesh,
  const ClassifiedBoundary& classified, Classification& classification, bool move,
  RunStatistics& statistics)
{
  const RunStatistics::Stopwatch watch(statistics, "seconds mid nodes");
  MarkedEdges edges = findEdges(exchange, mesh, 1);
  auto hits = projectMidpoints(exchange, mesh.mesh(), edges,
    classesOfEdges(exchange, edges, classified), classified, classification, statistics);
  makeMidNodes(exchange, mesh, edges);
  std::vector<Point3>& nodes = mesh.converted.midNodes->points;
  PlacedMidNodes placed;
  if (move)
  {
    nodes = Placing(exchange, mesh, edges.sharedEdges, classified).place(hits, placed.tooCurved);
  }
  const std::size_t vertices = mesh.mesh().points.size();
  classifyMidpoints(hits, mesh.pointCount(), classification);
  for (const MidpointOnCAD& hit : hits)
  {
    classification.distances[vertices + hit.place] = distance(nodes[hit.place], hit.where.point);
  }
  placed.projected = countHits(exchange, mesh.sharedPoints, vertices, hits);
  return placed;
}

void removeMidNodes(DistributedMesh& mesh, Classification& classification, GlobalId idBound)
{
  mesh.converted.midNodes.reset();
  mesh.sharedPoints = {};
  mesh.vertexIdBound = idBound;
  classification.resize(mesh.mesh().points.size());
}

EdgeMarks edgesOfTooCurved(const DistributedMesh& mesh, const Classification& classification,
  const std::vector<unsigned char>& tooCurved, bool atCAD)
{
  const EdgeTable& table = mesh.converted.midNodes->table;
  const EdgeOrder order(table);
  const auto isOnCAD = [&](Index edge)
  { return static_cast<bool>(classification.entities[mesh.mesh().points.size() + edge]); };
  EdgeMarks marks(table.edges.size(), 0);
  auto isTooCurved = tooCurved.begin();
  visitOwnShapes(mesh.mesh(),
    [&](auto shape, const auto&)
    {
      for (const auto& edges : table.*edgesOfCells(shape))
      {
        if (*isTooCurved++)
        {
          marks[atCAD ? order.longest(edgesAtCAD(shape, edges, isOnCAD)) : order.longest(edges)] =
            1;
        }
      }
    });
  return marks;
}

} // namespace cadrefine
