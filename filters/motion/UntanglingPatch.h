// The cells round vertices that are to be moved, with those of other ranks.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/motion/PatchOptimiser.h>

#include <vector>

namespace cadrefine
{

/// What may be done with the vertices of a piece: an entry in each list for each vertex.
struct MovingVertices
{
  std::vector<unsigned char> free;       ///< 1: it may move.
  const std::vector<EntityId>& entities; ///< Free vertices keep to these.
  const std::vector<Point3>& wanted;     ///< Where they are, or are to be.
  const std::vector<Point3>& start;      ///< Where they were in the unmoved mesh.
  const std::vector<Index>& cells;       ///< All cells at free vertices, and others.
};

/// Where a vertex of the piece is to go.
struct VertexPlace
{
  Index vertex;
  Point3 point;
};

/// The cells of this rank round its free vertices, and those of other ranks round the free vertices
/// that it shares.
class UntanglingPatch
{
public:
  /// Collective; keeps references. Sends each neighbour the cells of this rank at free vertices
  /// that both hold, 232 bytes each, and finds the holders of the vertices (see
  /// findSharedVertices).
  UntanglingPatch(RankExchange& exchange, const DistributedMesh& mesh,
    const MovingVertices& vertices, const Vector3& plane);

  /// So many sweeps of PatchOptimiser. Returns the places of this rank's free vertices, also of
  /// those at which it has no cell. Collective; one exchange of 32 bytes a shared vertex. A sweep
  /// costs a reduction, and for every time that vertices wait for other ranks an exchange of 32
  /// bytes a shared free vertex and one reduction; the chains are O(log n) long, as vertices take
  /// turns at random.
  std::vector<VertexPlace> optimise(const BoundaryProjector& projector, int sweeps);

private:
  void addOwnCells(const SimplexMesh& mesh, const MovingVertices& vertices);
  void addCellsOfOthers(const DistributedMesh& mesh, const MovingVertices& vertices);
  void findHolders();
  std::vector<VertexPlace> placesOfFree();
  Index localVertex(Index meshVertex, const SimplexMesh& mesh, const MovingVertices& vertices);

  RankExchange& exchange_;
  const SharedVertices& sharedOfMesh_;
  const std::vector<unsigned char>& free_; ///< Of the mesh's vertices.
  Patch patch_;
  std::vector<Index> meshVertex_;  ///< Of the patch's vertices; -1 where only others hold it.
  std::vector<Index> patchVertex_; ///< Of the mesh's vertices; -1 where it is not in the patch.
  SharedItems shared_;
};

} // namespace cadrefine
