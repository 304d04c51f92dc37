#include <cadrefine/cad/extraction/ShapeIndex.h>

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>

namespace cadrefine
{

ShapeIndex::ShapeIndex(const TopoDS_Shape& shape)
{
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, TopAbs_FACE, map);
  for (int i = 1; i <= map.Extent(); ++i)
  {
    this->faces_.push_back(TopoDS::Face(map(i)));
  }
  map.Clear();
  TopExp::MapShapes(shape, TopAbs_EDGE, map);
  for (int i = 1; i <= map.Extent(); ++i)
  {
    const TopoDS_Edge edge = TopoDS::Edge(map(i));
    if (!BRep_Tool::Degenerated(edge))
    {
      this->edges_.push_back(edge);
      this->edgeMap_.Add(edge);
    }
  }
  TopExp::MapShapes(shape, TopAbs_VERTEX, this->vertexMap_);
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
