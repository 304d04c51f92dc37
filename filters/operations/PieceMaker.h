// A piece put together anew after operations on its blocks.
#pragma once

#include "operations/BlockMesh.h"

#include <cadrefine/operations/Operations.h>
#include <cadrefine/refinement/Split.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// A simplex of the new mesh and what it comes from.
template<std::size_t Corners>
struct Descendant
{
  Index parent;
  std::array<Index, Corners> corners;
};

/// Takes what is in no block, and what the blocks have become.
class PieceMaker
{
public:
  explicit PieceMaker(const SimplexMesh& mesh) : mesh_(mesh), points_(mesh.points) {}

  /// What is in no block.
  void keep(const Members& others);
  /// A block of this number, to which these vertices were added.
  void add(const BlockMesh& block, const std::vector<AddedVertex>& added, std::int64_t number);

  /// Of the new vertices, in the order of their numbers.
  const std::vector<std::array<Index, 2>>& parents() const { return parents_; }
  const std::vector<ClosestPoint>& places() const { return places_; }
  const std::vector<std::int64_t>& blocks() const { return blocks_; }

  /// With all vertices, also those that no cell has any more; no ids of new ones.
  SimplexMesh make(ChildRanges& firstChildren);

private:
  bool comesBefore(Index a, Index b) const;

  const SimplexMesh& mesh_;
  std::vector<Point3> points_;
  std::vector<std::array<Index, 2>> parents_;
  std::vector<ClosestPoint> places_;
  std::vector<std::int64_t> blocks_;
  std::vector<Descendant<4>> tetrahedra_;
  std::vector<Descendant<3>> triangles_;
  std::vector<Descendant<2>> segments_;
};

} // namespace cadrefine
