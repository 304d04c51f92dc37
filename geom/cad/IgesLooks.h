// Names and colours in an IGES file. Private to geom/cad.
#pragma once

#include "EntityLooks.h"

#include <XSControl_WorkSession.hxx>

namespace cadrefine
{

/// Of all entities that gave a shape: the name property (406, form 15) or else the label and its
/// subscript; the colour number or colour definition (314).
LookMap collectIgesLooks(const Handle(XSControl_WorkSession) & session);

} // namespace cadrefine
