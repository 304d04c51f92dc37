// What the local operations are on a mesh of triangles alone: see Operations.h.
#pragma once

#include <cadrefine/operations/EditableMesh.h>

namespace cadrefine
{

/// Replaces the edge between two facets by their other diagonal. Possible if the edge is no
/// segment, the facets turn alike, and the other diagonal is not there yet. Fills in the cavity
/// with its sides.
bool proposeSwap(const EditableMesh& mesh, Index a, Index b, Cavity& cavity);

/// Fills in the sides of a cavity that a collapse has filled in. Returns false where a facet at
/// `from` is not connected with one at the edge by facets round `from`, as where two tips meet, or
/// where a new facet may already exist beyond this mesh.
bool findSidesOfCollapse(const EditableMesh& mesh, Index from, Index to, Cavity& cavity);

/// Fills in the sides of a cavity that a split has filled in.
void findSidesOfSplit(const EditableMesh& mesh, Cavity& cavity);

} // namespace cadrefine
