// A block of a piece's cells as a mesh that can be operated on.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>
#include <cadrefine/operations/EditableMesh.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace cadrefine
{

/// What must not be mixed: cells, and listed facets, whose labels differ stay apart.
struct CellLabels
{
  std::vector<Index> ofTetrahedra;
  std::vector<Index> ofTriangles;
};

/// Numbers of things that belong to a block.
struct Members
{
  std::vector<Index> cells;
  std::vector<Index> facets; ///< Of the boundary.
  std::vector<Index> triangles;
  std::vector<Index> segments;
};

/// The cells of a block in the order of their ids, with its facets and segments: what the
/// operations do to them does not depend on how the piece is numbered.
class BlockMesh
{
public:
  /// `blocksOfVertices`: negative for those that stay.
  BlockMesh(const DistributedMesh& mesh, const std::vector<std::int64_t>& blocksOfVertices,
    const Classification& classification, const ClassifiedBoundary& boundary,
    const CellLabels& labels);

  void fill(const Members& members, const std::vector<GlobalId>& cellIds);

  EditableMesh& mesh() { return block_; }
  const EditableMesh& mesh() const { return block_; }
  /// Of the whole piece, by those here.
  const std::vector<Index>& vertices() const { return vertices_; }

private:
  EditableMesh::Vertex vertexOf(Index v) const;
  template<std::size_t Corners>
  std::array<Index, Corners> localCorners(std::array<Index, Corners> corners) const;
  void addFacets(const Members& members);
  void addSegments(const Members& members);

  const SimplexMesh& mesh_;
  const std::vector<std::int64_t>& blocksOfVertices_;
  const Classification& classification_;
  const ClassifiedBoundary& boundary_;
  const CellLabels& labels_;
  EditableMesh block_;
  std::vector<Index> vertices_;
  std::map<Index, Index> numbers_;
};

} // namespace cadrefine
