// Which IGES entities an entity is made of. Private to geom/cad.
#pragma once

#include <cadrefine/cad/readers/iges/IgesText.h>

#include <vector>

namespace cadrefine
{

/// Directory entry numbers of the curves, surfaces, loops, ... that an entity of the model
/// (geometry, a group, a subfigure) is made of, as its parameters give them; empty for other
/// types. The transformation (directory field 7) is not among them.
std::vector<int> igesParts(const IgesEntry& entry, const IgesParameters& parameters);

/// How many parameters, the type counted in, an entity must have at least, all defaults left out;
/// 0 where this is not known.
std::size_t igesParameterCount(const IgesEntry& entry, const IgesParameters& parameters);

} // namespace cadrefine
