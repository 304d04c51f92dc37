#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/base/DisjointSets.h>

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <utility>

namespace cadrefine
{
namespace
{

/// Rounding error of coordinates that files hold and placements transform, as a part of the box of
/// all vertices.
constexpr double rounding = 1e-11;

std::vector<Point3> pointsOf(const std::vector<TopoDS_Vertex>& vertices)
{
  std::vector<Point3> points;
  for (const TopoDS_Vertex& vertex : vertices)
  {
    const gp_Pnt p = BRep_Tool::Pnt(vertex);
    points.push_back({ p.X(), p.Y(), p.Z() });
  }
  return points;
}

/// For each point the first one of those that are the same. They are sorted along an oblique
/// direction, in which few points of a drawing fall together.
std::vector<std::int32_t> findFirstCoincident(const std::vector<Point3>& points)
{
  const double step = rounding * boxOf(points).diagonal();
  constexpr Vector3 oblique{ 0.48, 0.6, 0.64 };
  std::vector<std::pair<double, std::int32_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    order.emplace_back(dot(oblique, points[i]), static_cast<std::int32_t>(i));
  }
  std::sort(order.begin(), order.end());
  DisjointSets sets(points.size());
  for (auto a = order.begin(); a != order.end(); ++a)
  {
    for (auto b = a + 1; b != order.end() && b->first - a->first <= 2 * step; ++b)
    {
      if (distance(points[a->second], points[b->second]) <= step)
      {
        sets.join(a->second, b->second);
      }
    }
  }
  return sets.representatives();
}

} // namespace

TopTools_IndexedMapOfShape entitiesOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type)
{
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, type, map);
  return map;
}

ShapeIndex::ShapeIndex(const TopoDS_Shape& shape) : vertexMap_(entitiesOf(shape, TopAbs_VERTEX))
{
  const auto faces = entitiesOf(shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i)
  {
    this->faces_.push_back(TopoDS::Face(faces(i)));
  }
  const auto edges = entitiesOf(shape, TopAbs_EDGE);
  for (int i = 1; i <= edges.Extent(); ++i)
  {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i));
    if (!BRep_Tool::Degenerated(edge))
    {
      this->edges_.push_back(edge);
      this->edgeMap_.Add(edge);
    }
  }
  for (int i = 1; i <= this->vertexMap_.Extent(); ++i)
  {
    this->vertices_.push_back(TopoDS::Vertex(this->vertexMap_(i)));
  }
  this->firstCoincident_ = findFirstCoincident(pointsOf(this->vertices_));
}

int ShapeIndex::edge(const TopoDS_Shape& edge) const
{
  return edge.IsNull() ? -1 : this->edgeMap_.FindIndex(edge) - 1;
}

int ShapeIndex::vertex(const TopoDS_Shape& vertex) const
{
  const int number = vertex.IsNull() ? 0 : this->vertexMap_.FindIndex(vertex);
  return number == 0 ? -1 : this->firstCoincident_[number - 1];
}

} // namespace cadrefine
