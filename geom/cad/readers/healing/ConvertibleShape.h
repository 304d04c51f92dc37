// Faces and edges that become no NURBS are set apart. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/ReadSteps.h>
#include <cadrefine/cad/readers/EntityAttributes.h>

#include <TopoDS_Shape.hxx>

#include <string>
#include <vector>

namespace cadrefine
{

struct ConvertibleShape
{
  TopoDS_Shape shape; ///< Null where nothing is left.
  std::vector<UnreadEntity> unread;
  std::vector<std::string> repairs; ///< What had to be healed by itself, and why.
};

/// The shape without the faces and edges whose conversion to NURBS fails, also after they were
/// healed by themselves, or is left out by `options`. An edge of a face is lost as an edge alone:
/// the face keeps its trim curve. Work: one conversion. The items of ReadStep::Conversion are the
/// index of a face, and the number of faces plus the index of an edge.
ConvertibleShape keepConvertible(
  const TopoDS_Shape& shape, AttributeMap& attributeMap, const ReadOptions& options);

} // namespace cadrefine
