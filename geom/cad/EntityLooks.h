// Names and colours of faces and edges. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <TopoDS_Shape.hxx>

#include <string>
#include <unordered_map>
#include <vector>

namespace cadrefine
{

/// Looks of the faces and edges of a shape while it is worked on. A face that stands in several
/// places has one look.
class LookMap
{
public:
  /// Gives the faces of `shape`, or its edges where it has no face, what they lack of `look`.
  void add(const TopoDS_Shape& shape, const EntityLook& look);
  /// `to` has come out of `from`, a face or an edge: its faces or edges take over its look.
  void follow(const TopoDS_Shape& from, const TopoDS_Shape& to);
  EntityLook of(const TopoDS_Shape& entity) const;
  bool empty() const { return looks_.empty(); }

private:
  struct Known
  {
    TopoDS_Shape shape; ///< Keeps the key alive.
    EntityLook look;
  };
  std::unordered_map<const void*, Known> looks_;
};

/// A name or a colour that a file gives to something with this shape.
struct FoundLook
{
  TopoDS_Shape shape;
  EntityLook look;
};

/// The look of each face and edge: what the file says of the entity itself, or else of the smallest
/// whole (shell, solid) that it is a part of.
LookMap sortLooks(std::vector<FoundLook> found);

} // namespace cadrefine
