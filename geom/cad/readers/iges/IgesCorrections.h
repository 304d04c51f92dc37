// What Open CASCADE gets wrong in IGES files, put right before or while it reads them. Private to
// geom/cad.
#pragma once

#include <IGESControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>

#include <set>

namespace cadrefine
{

/// Replaces each matrix (124) that has a transformation by the product of both, as Open CASCADE
/// leaves out the transformation of a transformation.
void composeMatrices(const Handle(IGESData_IGESModel) & model);

/// Makes shapes for those of the entities `numbers` (in the reader's model) that Open CASCADE reads
/// wrongly or not at all; the transfer then takes them:
/// 1. Subfigures (408): it fails where they are scaled, and turns their place wrongly.
/// 2. Offset surfaces (140): where the basis is not C1 it fits this within the offset distance
///    only, so it is cut at its creases and knots; where the basis is another offset surface it
///    crashes.
void makeOwnShapes(IGESControl_Reader& reader, const std::set<int>& numbers);

} // namespace cadrefine
