// Where faces and edges stand in the file, their names and colours. Private to geom/cad.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <TopoDS_Shape.hxx>

#include <string>
#include <unordered_map>
#include <vector>

namespace cadrefine
{

/// An entity of the file: see UnreadEntity.
struct FileEntity
{
  int number = 0; ///< 0: not known.
  std::string type;
};

/// Attributes of the faces and edges of a shape while it is worked on, and the entities of the file
/// that they were read from. A face that stands in several places has one attributes.
class AttributeMap
{
public:
  /// Gives the faces of `shape`, or its edges where it has no face, what they lack of `attributes`,
  /// and `entity` if `shape` is a face or an edge itself.
  void add(
    const TopoDS_Shape& shape, const EntityAttributes& attributes, const FileEntity& entity = {});
  /// Gives the faces or edges of `to`, which has come out of `from`, a face or an edge, what `from`
  /// has.
  void follow(const TopoDS_Shape& from, const TopoDS_Shape& to);
  EntityAttributes of(const TopoDS_Shape& entity) const;
  /// A face or edge that is lost, for the report.
  UnreadEntity lost(const TopoDS_Shape& entity, const std::string& reason) const;
  bool empty() const { return attributes_.empty(); }

private:
  struct Known
  {
    TopoDS_Shape shape; ///< Keeps the key alive.
    EntityAttributes attributes;
    FileEntity entity;
  };
  Known& known(const TopoDS_Shape& shape);
  const Known* find(const TopoDS_Shape& shape) const;

  std::unordered_map<const void*, Known> attributes_;
};

/// What a file says of something with this shape.
struct FoundAttributes
{
  TopoDS_Shape shape;
  EntityAttributes attributes;
  FileEntity entity;
};

/// The attributes of each face and edge: what the file says of the entity itself, or else of the
/// smallest whole (shell, solid) that it is a part of.
AttributeMap sortAttributes(std::vector<FoundAttributes> found);

} // namespace cadrefine
