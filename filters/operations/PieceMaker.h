// A piece put together anew after operations on its blocks.
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
  Index row = -1; ///< Of the rows of cells; -1: it has none.
};

/// Takes what is in no block, and what the blocks have become.
class PieceMaker
{
public:
  /// `others` is in no block. Keeps references.
  PieceMaker(const Mesh& mesh, const Members& others)
    : mesh_(mesh), others_(others), points_(mesh.points)
  {
  }

  /// A block of this number, to which these vertices were added, and whose fields follow these
  /// rows.
  void add(const BlockMesh& block, const std::vector<AddedVertex>& added, const FieldRows& rows,
    std::int64_t number);

  /// Of the new vertices, in the order of their numbers.
  const std::vector<ClosestPoint>& places() const { return places_; }
  const std::vector<unsigned char>& onBoundary() const { return onBoundary_; }
  const std::vector<std::int64_t>& blocks() const { return blocks_; }

  /// With all vertices, also those that no cell has any more; no ids of new ones. Writes where
  /// cells and fields come from into the trace. Once. Work: one look at each cell.
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
  FieldRows rows_; ///< Of cells: in any order, without targets, from parents.
};

} // namespace cadrefine
