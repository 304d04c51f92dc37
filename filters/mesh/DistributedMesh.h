// A mesh in pieces on ranks.
#pragma once

#include "comm/RankExchange.h"
#include "comm/SharedEdges.h"
#include "comm/SharedVertices.h"
#include "mesh/PointSetConversion.h"

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/mesh/Facets.h>

namespace cadrefine
{

/// A rank's piece, with what it shares with other ranks.
struct DistributedMesh
{
  ConvertedMesh converted;
  SharedVertices shared;
  SharedVertices sharedPoints; ///< Shared vertices and mid nodes of a mesh of second order.
  GlobalId vertexIdBound = 0;  ///< All ids of vertices and mid nodes are smaller.

  Mesh& mesh() { return converted.mesh; }
  const Mesh& mesh() const { return converted.mesh; }
  /// The number of points of this rank: vertices, and mid nodes after them.
  std::size_t pointCount() const;
  /// For each point 1 if this rank owns it, else 0.
  std::vector<char> ownedPoints() const;
};

/// Reads a data set (see convert) and finds the shared vertices. Collective. Throws Error, on all
/// ranks, where the pieces do not make one mesh (see checkPieces).
DistributedMesh makeDistributedMesh(
  RankExchange& exchange, vtkPointSet* input, CellOrder order = CellOrder::First);

/// Gives the cells ids by those of their vertices. Of cells of lower dimension with the same
/// vertices, as where a line or a triangle is listed for each of two bodies, those of lower ranks
/// come first, and on a rank the first one. Collective; see numberAtVertices.
void numberCells(RankExchange& exchange, DistributedMesh& mesh);

/// Numbers of facets by the ids of their vertices: from 0 on without a gap over all ranks, the same
/// for the same vertices. Collective; see numberAtVertices.
std::vector<GlobalId> numberFacets(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<Facet>& facets);

/// The shared points of a mesh whose edges are shared like this: those of its vertices, and of the
/// mid nodes that have numbers after them. No communication.
SharedVertices findSharedPoints(const DistributedMesh& mesh, const SharedEdges& edges);

/// The shared vertices of a mesh. Collective. Ids are sent of the vertices in the boxes round other
/// ranks' pieces; where these are many and all cells are tetrahedra (which must not overlap), of
/// those on the surface of the piece alone. Six numbers are gathered from every rank. Work: a look
/// at each vertex for each box that meets this rank's, that of findOuterFacets where only the
/// surface is taken, and that of findSharedVertices.
SharedVertices findShared(RankExchange& exchange, const Mesh& mesh);

/// Flags the vertices of all cells within so many rings of cells round the flagged vertices, on all
/// ranks that have them. Collective; one exchange between neighbours for each ring and one before,
/// work: for each ring a look at each cell.
void flagRings(RankExchange& exchange, const DistributedMesh& mesh, int rings,
  std::vector<unsigned char>& flags, const ParallelFor& parallelFor);

/// The box round all ranks' boxes. Collective; two reductions of three numbers.
BoundingBox combineBoxes(RankExchange& exchange, const BoundingBox& box);
/// The box round the whole mesh. Collective; see combineBoxes.
BoundingBox findBox(RankExchange& exchange, const Mesh& mesh);

/// Counts of the whole mesh, no vertex or cell twice.
struct MeshCounts
{
  std::int64_t vertices = 0; ///< Vertices and mid nodes.
  std::int64_t cells = 0;    ///< Cells of the mesh's own dimension.
};

/// Counts the vertices and cells of the whole mesh. Collective; one reduction of two numbers, work
/// linear in the vertices of the piece.
MeshCounts countMesh(RankExchange& exchange, const DistributedMesh& mesh);

} // namespace cadrefine
