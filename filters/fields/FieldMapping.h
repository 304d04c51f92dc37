// The way of arrays from a data set to the mesh that was made from it.
#pragma once

#include "fields/ArrayDelivery.h"
#include "fields/VertexInterpolation.h"

#include <cadrefine/refinement/RefinementTrace.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cadrefine
{

/// What a mapping needs to know of the fields that it is for.
struct FieldNeeds
{
  /// Whether there may be cell arrays of floating point, which are means where cells are exchanged;
  /// if not, all that the mapping is given are inherited.
  bool means = true;
  /// The cell arrays that are densities: where a cell's volume changes, what it holds is kept.
  std::vector<std::string> densities = {};
};

/// What has become of points and cells, step by step: enough to take any array along, but no
/// coordinates, cells or CAD. Memory: four bytes a cell and eight a new vertex for each refinement;
/// eight a vertex and cell where a mesh is not its data set in the same order, or was
/// redistributed; after local operations 8 bytes for each cell and vertex that they changed, and 12
/// for each old one that its value comes from (some seven of a cell, four of a vertex). With
/// densities 20 bytes for each cell whose volume changed, and after operations the rows of cells
/// once more. For each vertex that moved inside the mesh 8 bytes, and 12 for each corner of the
/// cell there.
class FieldMapping
{
public:
  /// Says what the fields need. To be called first of all.
  void require(FieldNeeds needs) { needs_ = std::move(needs); }
  const FieldNeeds& needs() const { return needs_; }

  /// Adds a stage: a data set was converted to a mesh that has this part of it.
  void convert(ArraySelection selection);
  /// Adds a stage: cells went to other ranks.
  void redistribute(Delivery delivery);
  /// Adds a stage: the mesh was refined, or operated on.
  void refine(RefinementTrace trace);
  /// Adds a stage: vertices moved inside the mesh.
  void interpolate(VertexInterpolation interpolation);
  /// Adds a stage: cells changed their volumes, and so their densities by these rows (none: there
  /// is no stage).
  void scale(WeightedRows densities);
  /// Adds a stage: the mesh became one of second order, with a mid node on each edge.
  void addMidNodes(std::vector<std::array<Index, 2>> edges);

  /// The arrays after all stages, given those after the first `done` of them. Collective where
  /// cells went to other ranks.
  MeshArrays follow(RankExchange& exchange, MeshArrays arrays, std::size_t done = 0) const;

  std::size_t stageCount() const { return stages_.size(); }
  /// Forgets what happened after so many stages.
  void forgetAfter(std::size_t stages)
  {
    stages_.erase(stages_.begin() + static_cast<std::ptrdiff_t>(stages), stages_.end());
  }

private:
  using Edges = std::vector<std::array<Index, 2>>;
  using Stage = std::variant<ArraySelection, Delivery, RefinementTrace, Edges, WeightedRows,
    VertexInterpolation>;
  std::vector<Stage> stages_;
  FieldNeeds needs_;
};

} // namespace cadrefine
