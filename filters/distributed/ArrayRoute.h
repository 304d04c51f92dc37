// The way of arrays from a data set to the mesh that was made from it.
#pragma once

#include "ArrayDelivery.h"
#include "DistributedRefinement.h"

#include <array>
#include <variant>
#include <vector>

namespace cadrefine
{

/// What has become of points and cells, step by step: enough to take any array along, but no
/// coordinates, cells or CAD. Memory: four bytes a cell and eight a new vertex for each refinement;
/// eight a vertex and cell where a mesh is not its data set in the same order, or was
/// redistributed.
class ArrayRoute
{
public:
  /// `mesh` was converted from `input`.
  void convert(vtkPointSet* input, const ConvertedMesh& mesh);
  /// Cells went to other ranks.
  void redistribute(Delivery delivery);
  /// The mesh was refined.
  void refine(RefinementTrace trace);
  /// The mesh became one of second order, with a mid node on each edge.
  void addMidNodes(std::vector<std::array<Index, 2>> edges);
  /// All that happened on another route, which starts where this one ends.
  void append(ArrayRoute next);

  /// The arrays at the end of the way. Collective where cells went to other ranks.
  MeshArrays follow(RankExchange& exchange, MeshArrays arrays) const;

private:
  using Edges = std::vector<std::array<Index, 2>>;
  using Leg = std::variant<ArraySelection, Delivery, RefinementTrace, Edges>;
  std::vector<Leg> legs_;
};

} // namespace cadrefine
