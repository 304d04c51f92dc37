// Names and colours in a STEP file. Private to geom/cad.
#pragma once

#include "EntityLooks.h"

#include <XSControl_WorkSession.hxx>

namespace cadrefine
{

/// Of all representation items that gave a shape: their names, and the colours of the styled items
/// that refer to them.
LookMap collectStepLooks(const Handle(XSControl_WorkSession) & session);

} // namespace cadrefine
