#include "mesh/MidNodeReading.h"

#include <cadrefine/base/Error.h>

#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

/// The mid nodes of all edges, and their points after those of the vertices.
class MidNodeReader
{
public:
  MidNodeReader(
    const std::vector<Point3>& points, const std::vector<GlobalId>& ids, ConvertedMesh& result)
    : points_(points), ids_(ids), result_(result)
  {
  }

  void read(const NodesOfCells& nodes)
  {
    EdgeTable table = buildEdgeTable(result_.mesh);
    pointOf_.assign(table.edges.size(), -1);
    takeAll(table.ofSegments, nodes[1]);
    takeAll(table.ofTriangles, nodes[2]);
    takeAll(table.ofTetrahedra, nodes[3]);
    MidNodes& result = result_.midNodes.emplace();
    result.table = std::move(table);
    for (const vtkIdType point : pointOf_)
    {
      result_.pointOf.push_back(point);
      result.points.push_back(points_[point]);
      result.ids.push_back(ids_[point]);
    }
  }

private:
  template<std::size_t Edges>
  void takeAll(
    const std::vector<std::array<Index, Edges>>& cells, const std::vector<vtkIdType>& nodes)
  {
    auto node = nodes.begin();
    for (const auto& edges : cells)
    {
      for (const Index edge : edges)
      {
        take(edge, *node++);
      }
    }
  }

  void take(Index edge, vtkIdType point)
  {
    vtkIdType& known = pointOf_[edge];
    if (known >= 0 && known != point && points_[known] != points_[point])
    {
      throw Error("cells of the mesh have different mid nodes on an edge that they share (points " +
                  std::to_string(known) + " and " + std::to_string(point) + ")");
    }
    known = known < 0 ? point : known;
  }

  const std::vector<Point3>& points_;
  const std::vector<GlobalId>& ids_;
  ConvertedMesh& result_;
  std::vector<vtkIdType> pointOf_; ///< Of each edge's node.
};

} // namespace

bool isOfSecondOrder(
  RankExchange& exchange, const ConvertedMesh& converted, const NodesOfCells& nodes)
{
  constexpr int edges[4] = { 0, 1, 3, 6 };
  bool first = false;
  bool second = false;
  for (int d = 1; d < 4; ++d)
  {
    first = first || edges[d] * converted.cellOf[d].size() > nodes[d].size();
    second = second || !nodes[d].empty();
  }
  first = exchange.any(first);
  second = exchange.any(second);
  if (first && second)
  {
    throw Error("the mesh mixes linear and quadratic cells, which do not conform");
  }
  return second;
}

void readMidNodes(const std::vector<Point3>& points, const std::vector<GlobalId>& ids,
  const NodesOfCells& nodes, ConvertedMesh& mesh)
{
  MidNodeReader(points, ids, mesh).read(nodes);
}

} // namespace cadrefine
