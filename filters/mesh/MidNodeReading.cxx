#include "mesh/MidNodeReading.h"

#include <cadrefine/base/Error.h>

#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

/// Gives a mesh the mid nodes of all edges, and their points after those of the vertices.
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
    auto ofShape = nodes.begin();
    visitShapes(result_.mesh,
      [&](auto shape, const auto&)
      {
        if constexpr (decltype(shape)::dimension > 0)
        {
          takeAll(shape, table.*edgesOfCells(shape), *ofShape);
        }
        ++ofShape;
      });
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
  template<class Shape, std::size_t Edges>
  void takeAll(
    Shape, const std::vector<std::array<Index, Edges>>& cells, const std::vector<vtkIdType>& nodes)
  {
    auto node = nodes.begin();
    for (const auto& edges : cells)
    {
      for (std::size_t e = 0; e < Edges; ++e)
      {
        take(edges[placeOfEdge(Shape{}, e)], *node++);
      }
    }
  }

  /// The local edge of the mesh's cell that is this edge of the data set's cell.
  template<class Shape>
  std::size_t placeOfEdge(Shape, std::size_t edge) const
  {
    if constexpr (Shape::corners == 6)
    {
      return result_.mesh.wedgesAsDocumented ? edgesOfTurned[edge] : edge;
    }
    else
    {
      return edge;
    }
  }

  void take(Index edge, vtkIdType point)
  {
    vtkIdType& known = pointOf_[edge];
    if (known >= 0 && known != point && points_[known] != points_[point])
    {
      throw Error(
        "cells of the mesh have different mid-edge nodes on an edge that they share (points " +
        std::to_string(known) + " and " + std::to_string(point) + ")");
    }
    known = known < 0 ? point : known;
  }

  const std::vector<Point3>& points_;
  const std::vector<GlobalId>& ids_;
  ConvertedMesh& result_;
  std::vector<vtkIdType> pointOf_; ///< The data set's point of each edge's mid node.
};

} // namespace

bool isOfSecondOrder(
  RankExchange& exchange, const ConvertedMesh& converted, const NodesOfCells& nodes)
{
  bool first = false;
  bool second = false;
  auto ofShape = nodes.begin();
  visitShapes(converted.mesh,
    [&](auto shape, const auto& cells)
    {
      first = first || nodesOf(shape) * cells.size() > ofShape->size();
      second = second || !ofShape->empty();
      ++ofShape;
    });
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
