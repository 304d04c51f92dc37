// What Open CASCADE's readers noted, and made, while they loaded and transferred a file. Private to
// geom/cad.
#pragma once

#include <Interface_CheckIterator.hxx>
#include <Standard_Handle.hxx>
#include <Standard_Transient.hxx>
#include <TopoDS_Shape.hxx>
#include <XSControl_Reader.hxx>
#include <XSControl_WorkSession.hxx>

#include <map>
#include <set>
#include <string>

namespace cadrefine
{

/// The first failure noted for each entity, by its number in the reader's model (0: the file).
using FailureMap = std::map<int, std::string>;

/// Failures of the load (syntax) and of the transfer (geometry), warnings left out.
FailureMap collectFailures(const Handle(XSControl_WorkSession) & session);

/// True where the transfer made a shape with something in it out of `entity`.
bool hasShape(
  const Handle(XSControl_WorkSession) & session, const Handle(Standard_Transient) & entity);

/// True where `entity` or anything that it refers to, directly or not, is among `numbers`.
bool refersToAny(const Handle(XSControl_WorkSession) & session,
  const Handle(Standard_Transient) & entity, const std::set<int>& numbers);

/// All shapes that the reader has made, as one.
TopoDS_Shape joinShapes(const XSControl_Reader& reader);

} // namespace cadrefine
