// Names and colours in a STEP file. Private to geom/cad.
#pragma once

#include <cadrefine/cad/readers/EntityAttributes.h>

#include <XSControl_WorkSession.hxx>

namespace cadrefine
{

/// The entity of this number in Open CASCADE's model: its instance number, and its type.
FileEntity stepEntity(const XSControl_WorkSession& session, int number);

/// The attributes of all representation items that gave a shape: their names, and the colours of
/// the styled items that refer to them.
AttributeMap collectStepAttributes(const Handle(XSControl_WorkSession) & session);

} // namespace cadrefine
