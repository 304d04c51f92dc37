// What the local operations are on a mesh of triangles alone: see Operations.h.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// The edge between two facets becomes the other diagonal of these: where it is no segment, the
/// facets turn alike, and the other diagonal is not there yet. Fills in the cavity with its sides.
bool proposeSwap(const EditableMesh& mesh, Index a, Index b, Cavity& cavity);

/// Of a cavity that a collapse has filled in. Returns false where the facets at `from` do not all
/// hang together round it beside the edge, as where two tips meet, or where what becomes of them
/// may be there already.
bool findSidesOfCollapse(const EditableMesh& mesh, Index from, Index to, Cavity& cavity);

/// Of a cavity that a split has filled in.
void findSidesOfSplit(const EditableMesh& mesh, Cavity& cavity);

} // namespace cadrefine
