#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>

namespace cadrefine
{

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
}

int ShapeIndex::edge(const TopoDS_Shape& edge) const
{
  return edge.IsNull() ? -1 : this->edgeMap_.FindIndex(edge) - 1;
}

int ShapeIndex::vertex(const TopoDS_Shape& vertex) const
{
  return vertex.IsNull() ? -1 : this->vertexMap_.FindIndex(vertex) - 1;
}

} // namespace cadrefine
