// Names and kinds of IGES entity types and units. Private to geom/cad.
#pragma once

#include <string>

namespace cadrefine
{

/// The name of a type, for example "IGES 128 (rational B-spline surface)".
std::string igesTypeName(int type);

/// True for types that can stand for a point, curve, surface or solid of the model by themselves.
bool isIgesPartOfModel(int type);

/// True for associations and subfigures, which gather other entities.
bool isIgesGroup(int type);

/// The name of a unit, for example "mm"; `name` is what the file says beside flag 3.
std::string igesUnitName(int flag, const std::string& name);

} // namespace cadrefine
