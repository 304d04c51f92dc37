// Whether the parameters of an IGES entity can be what they should. Private to geom/cad.
#pragma once

#include <cadrefine/cad/readers/iges/IgesText.h>

#include <string>

namespace cadrefine
{

/// Why the parameters of a geometry entity are broken, in one line; empty where they seem sound,
/// and for types that are no geometry. Whether they have an end is not looked at.
std::string checkIgesParameters(int type, const IgesParameters& parameters);

} // namespace cadrefine
