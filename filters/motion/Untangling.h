// Moving interior vertices until no cell is inverted, over all ranks.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/base/EntityId.h>
#include <cadrefine/classification/BoundaryProjector.h>

#include <vector>

namespace cadrefine
{

/// What may be done with the vertices of a piece: an entry in each list for each vertex.
struct MovingVertices
{
  std::vector<unsigned char> free;       ///< 1: it may move.
  const std::vector<EntityId>& entities; ///< CAD entities to which free vertices keep.
  const std::vector<Point3>& wanted;     ///< Where the vertices are, or are to be.
  const std::vector<Point3>& start;      ///< Where the vertices were in the unmoved mesh.
  const std::vector<Index>& cells;       ///< All cells at free vertices, and others.
  double fairQuality;                    ///< See Patch.
};

/// Where a vertex of the piece is to go.
struct VertexPlace
{
  Index vertex;
  Point3 point;
};

/// Moves the free vertices to where the cells round them are valid and well shaped, in so many
/// sweeps of PatchOptimiser. Returns the places of this rank's free vertices, also of those at
/// which it has no cell.
///
///   1. Each rank takes its cells at free vertices, of others than simplices the simplices at their
///      corners (of a pyramid, at those of its base), which are to keep their shape, but for those
///      of pyramids. It sends each neighbour those at free vertices that both hold, 240 bytes each.
///   2. The holders of the vertices of these patches are found (see findSharedVertices).
///   3. The sweeps: each costs a reduction, and for every time that vertices wait for other ranks
///      an exchange of 32 bytes a shared free vertex and one reduction; the chains are O(log n)
///      long, as vertices take turns at random.
///   4. One exchange of 32 bytes a shared vertex of the mesh.
///
/// Collective.
std::vector<VertexPlace> untangle(RankExchange& exchange, const DistributedMesh& mesh,
  const MovingVertices& vertices, const Vector3& plane, const BoundaryProjector& projector,
  int sweeps);

} // namespace cadrefine
