// A block of a piece's cells as a mesh that can be operated on.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/Classification.h>
#include <cadrefine/operations/EditableMesh.h>
#include <cadrefine/operations/FieldRows.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace cadrefine
{

/// The labels of a piece's cells, and of its listed facets and segments: those of different labels
/// must not be mixed.
struct CellLabels
{
  std::vector<Index> ofTetrahedra;
  std::vector<Index> ofTriangles;
  std::vector<Index> ofSegments;
};

/// Numbers, in the piece, of what belongs to a block.
struct Members
{
  std::vector<Index> cells;     ///< Cells of the mesh's own dimension.
  std::vector<Index> facets;    ///< Facets of the boundary.
  std::vector<Index> triangles; ///< Listed triangles.
  std::vector<Index> segments;
};

/// The cells of a block in the order of their ids, with its facets and segments: what the
/// operations do to them does not depend on how the piece is numbered.
class BlockMesh
{
public:
  /// `wanted`: where the vertices are wanted. `plane`: see planeNormal. `blocksOfVertices`:
  /// negative for those that stay, `besideOthers` for those of cells that are not simplices.
  BlockMesh(const DistributedMesh& mesh, const std::vector<Point3>& wanted, const Vector3& plane,
    const std::vector<std::int64_t>& blocksOfVertices, const Classification& classification,
    const ClassifiedBoundary& boundary, const CellLabels& labels);

  void fill(const Members& members, const std::vector<GlobalId>& cellIds);

  /// The block before operations. To be called after `fill`, and before the mesh is changed.
  MeshBefore before() const;

  EditableMesh& mesh() { return block_; }
  const EditableMesh& mesh() const { return block_; }
  /// For each vertex of the block, its number in the whole piece.
  const std::vector<Index>& vertices() const { return vertices_; }

private:
  template<std::size_t Corners>
  void addVertices(const Cells<Corners>& all, const std::vector<Index>& cells);
  EditableMesh::Vertex vertexOf(Index v) const;
  template<std::size_t Corners>
  std::array<Index, Corners> localCorners(std::array<Index, Corners> corners) const;
  void addFacets(const Members& members);
  void addTriangles(const Members& members, const std::vector<Index>& cells);
  void addSegments(const Members& members);
  Index lineOf(const EdgeClass& edgeClass, const std::array<Index, 2>& ends) const;
  Index lineOf(const std::array<Index, 2>& ends) const;
  void keepEndsOfTags();

  const Mesh& mesh_;
  const std::vector<Point3>& wanted_;
  const std::vector<std::int64_t>& blocksOfVertices_;
  const Classification& classification_;
  const ClassifiedBoundary& boundary_;
  const CellLabels& labels_;
  EditableMesh block_;
  std::vector<Index> vertices_;
  std::map<Index, Index> numbers_;
};

} // namespace cadrefine
