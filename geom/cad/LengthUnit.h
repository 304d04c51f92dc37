// Names of length units. Private to geom/cad.
#pragma once

#include <string>

namespace cadrefine
{

/// The usual short form ("mm", "in", ...) of a unit's name in a file ("MILLIMETRE", "'INCH'");
/// a name that is not known comes back in lower case.
std::string shortUnitName(const std::string& name);

/// Short name of a unit by its length in millimetres; empty where it is not a usual one.
std::string shortUnitName(double millimetres);

} // namespace cadrefine
