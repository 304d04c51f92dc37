// The way of arrays from a data set to the mesh that was made from it.
#pragma once

#include "fields/ArrayDelivery.h"

#include <cadrefine/refinement/RefinementTrace.h>

#include <array>
#include <variant>
#include <vector>

namespace cadrefine
{

/// What has become of points and cells, step by step: enough to take any array along, but no
/// coordinates, cells or CAD. Memory: four bytes a cell and eight a new vertex for each refinement;
/// eight a vertex and cell where a mesh is not its data set in the same order, or was
/// redistributed.
class FieldMapping
{
public:
  /// A data set was converted to a mesh that has this part of it.
  void convert(ArraySelection selection);
  /// Cells went to other ranks.
  void redistribute(Delivery delivery);
  /// The mesh was refined.
  void refine(RefinementTrace trace);
  /// The mesh became one of second order, with a mid node on each edge.
  void addMidNodes(std::vector<std::array<Index, 2>> edges);
  /// All that happened on another mapping, which starts where this one ends.
  void append(FieldMapping next);

  /// The arrays at the end of the way, given those after its first `done` legs. Collective where
  /// cells went to other ranks.
  MeshArrays follow(RankExchange& exchange, MeshArrays arrays, std::size_t done = 0) const;

  std::size_t stageCount() const { return stages_.size(); }

private:
  using Edges = std::vector<std::array<Index, 2>>;
  using Stage = std::variant<ArraySelection, Delivery, RefinementTrace, Edges>;
  std::vector<Stage> stages_;
};

} // namespace cadrefine
