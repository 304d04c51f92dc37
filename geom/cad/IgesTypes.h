// Names and kinds of IGES entity types and units. Private to geom/cad.
#pragma once

#include <string>

namespace cadrefine
{

/// For example "IGES 128 (rational B-spline surface)".
std::string igesTypeName(int type);

/// True for entities that stand for a curve, a surface or a solid of the model by themselves.
bool isIgesGeometry(int type, int form);

/// True for surfaces, faces and solids.
bool isIgesSurface(int type);

/// True for entities that only gather others.
bool isIgesGroup(int type);

/// For example "mm"; `name` is what the file says beside flag 3.
std::string igesUnitName(int flag, const std::string& name);

} // namespace cadrefine
