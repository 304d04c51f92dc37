// Puts a piece together again after operations on its blocks.
#pragma once

#include "operations/BlockMesh.h"

#include <cadrefine/operations/FieldRows.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/refinement/RefinementTrace.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// A simplex that a block has made, and what it comes from.
template<std::size_t Corners>
struct Descendant
{
  Index parent;
  std::array<Index, Corners> corners;
  Index row = -1; ///< Its row among the rows of cells; -1: it has none.
};

/// Makes a piece of what is in no block, and of what the blocks have become.
class PieceMaker
{
public:
  /// `others` is in no block. Keeps references.
  PieceMaker(const Mesh& mesh, const Members& others)
    : mesh_(mesh), others_(others), points_(mesh.points)
  {
  }

  /// Adds the block of this number, to which these vertices were added, and whose fields follow
  /// these rows.
  void add(const BlockMesh& block, const std::vector<AddedVertex>& added, const FieldRows& rows,
    std::int64_t number);

  /// For each new vertex, in the order of their numbers: its place on the CAD, whether it is on the
  /// boundary, and the block that made it.
  const std::vector<ClosestPoint>& places() const { return places_; }
  const std::vector<unsigned char>& onBoundary() const { return onBoundary_; }
  const std::vector<std::int64_t>& blocks() const { return blocks_; }

  /// Makes the piece, with all vertices, also those that no cell has any more, and without the ids
  /// of new ones. Writes where cells and fields come from into the trace. To be called once. Work:
  /// one look at each cell.
  Mesh make(RefinementTrace& trace);

private:
  bool comesBefore(Index a, Index b) const;
  void placeRows(const Mesh& made, RefinementTrace& trace) const;
  void addRows(const BlockMesh& block, const std::vector<Index>& vertices, const FieldRows& rows);

  const Mesh& mesh_;
  const Members& others_;
  std::vector<Point3> points_;
  std::vector<std::array<Index, 2>> parents_;
  std::vector<ClosestPoint> places_;
  std::vector<unsigned char> onBoundary_;
  std::vector<std::int64_t> blocks_;
  std::vector<Descendant<4>> tetrahedra_;
  std::vector<Descendant<3>> triangles_;
  std::vector<Descendant<2>> segments_;
  /// Rows of the blocks; those of cells are in any order, without targets, from parents.
  FieldRows rows_;
};

} // namespace cadrefine
