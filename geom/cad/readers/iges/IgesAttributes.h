// Names and colours in an IGES file. Private to geom/cad.
#pragma once

#include <cadrefine/cad/readers/EntityAttributes.h>

#include <IGESData_IGESEntity.hxx>
#include <XSControl_WorkSession.hxx>

namespace cadrefine
{

/// The entity of this number in Open CASCADE's model: its directory entry, and its type.
FileEntity igesEntity(const IGESData_IGESEntity& entity, int number);

/// The attributes of all entities that gave a shape: the name property (406, form 15) or else the
/// label and its subscript; the colour number or colour definition (314).
AttributeMap collectIgesAttributes(const Handle(XSControl_WorkSession) & session);

} // namespace cadrefine
