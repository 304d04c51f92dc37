// The entities of a shape and their indices. Private to geom/cad.
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// The entities of `shape`; unlike TopExp_Explorer, each once.
TopTools_IndexedMapOfShape entitiesOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum type);

/// Entities of `shape` in the order in which TopExp::MapShapes meets them, which depends on the
/// shape alone; degenerated edges are left out (they are only their vertex). Vertices that are the
/// same but for rounding, as those of bodies that touch, count as the first one of them.
class ShapeIndex
{
public:
  explicit ShapeIndex(const TopoDS_Shape& shape);

  const std::vector<TopoDS_Face>& faces() const { return this->faces_; }
  const std::vector<TopoDS_Edge>& edges() const { return this->edges_; }
  const std::vector<TopoDS_Vertex>& vertices() const { return this->vertices_; }

  /// Index of an edge or vertex whatever its orientation; -1 for one that is not in the model. A
  /// vertex that coincides with others has the index of the first one.
  int edge(const TopoDS_Shape& edge) const;
  int vertex(const TopoDS_Shape& vertex) const;

private:
  std::vector<TopoDS_Face> faces_;
  std::vector<TopoDS_Edge> edges_;
  std::vector<TopoDS_Vertex> vertices_;
  std::vector<std::int32_t> firstCoincident_; ///< The first vertex that coincides with each one.
  TopTools_IndexedMapOfShape edgeMap_;
  TopTools_IndexedMapOfShape vertexMap_;
};

} // namespace cadrefine
