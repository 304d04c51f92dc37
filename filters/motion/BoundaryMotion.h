// Moving vertices onto the CAD over all ranks without inverting a cell.
#pragma once

#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/Classification.h>
#include <cadrefine/motion/MoveGuard.h>

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// What moveOntoCAD needs to know beside the mesh.
struct MoveSettings
{
  const BoundaryProjector& projector;
  /// Over all ranks, 1 for vertices of the boundary, which do not make way unless they slide, or
  /// are at the end of a layer: only at facets between two cells, off the CAD and beside it. 2 for
  /// other vertices that do not make way.
  const std::vector<unsigned char>& fixed;
  /// Hashes of the tags of the cells of the mesh's own dimension (none on any rank: there are no
  /// tags). What they tell apart makes no way (see verticesBetweenTags).
  const std::vector<std::uint64_t>& tags;
  /// Cells that are inverted or flat at the start are to be mended too.
  bool mendCells = false;
  /// Cells that lost much of their shape are smoothed even if all vertices are at their targets.
  bool smoothCells = false;
  /// At a vertex where local operations have nothing to do, smoothing improves the worst cell;
  /// elsewhere the sum over the cells, even if some get worse.
  bool smoothWorst = false;
  /// The ends of the lines in whose middles the last vertices are; null: there are no such
  /// vertices.
  const std::vector<std::array<Index, 2>>* parents = nullptr;
};

/// What a motion did to the vertices of a piece.
struct MotionTrace
{
  std::vector<Point3> before; ///< Where all vertices were.
  /// Vertices inside the mesh that moved, but for those of layers, which go along with a wall;
  /// ascending.
  std::vector<Index> inside;
};

/// Moves the vertices of `moves` as far to their targets as all cells stay valid, on all ranks;
/// writes the new positions into the mesh, and the distances that are left into the classification.
///
///   1. The moves are made straight, and halved where cells do not accept them (see MoveGuard).
///   2. Where vertices stopped on the way: they are put to their targets in mind, and the interior
///      vertices of the cells round them are moved to where all cells are valid and well shaped
///      (see PatchOptimiser). From where they are, all go there, guarded as before.
///   3. Again, with more rings of cells round what is left, and from the third round on with the
///      vertices of the CAD sliding on their own faces and edges: until all are there, or nothing
///      has come of a few rounds.
///   4. Interior vertices round cells that have lost more than a tenth of their mean ratio move to
///      where these are better, if vertices are left on the way, or `smoothCells` asks for it. What
///      is left stays where it stopped.
///
/// The result does not depend on the partition: decisions are minima over the cells at a vertex,
/// and vertices are moved in an order that their ids give. It ends: a vertex's way is halved a few
/// times at most, and rounds and sweeps are limited.
///
/// Collective. Where nothing stops: one look at each cell, one reduction, and one exchange of 8
/// bytes a shared vertex. A halving costs as much, but for cells whose vertices move only. A round:
/// a look at all cells for each ring and one more, and a few sweeps over those of the region (see
/// untangle).
MotionTrace moveOntoCAD(RankExchange& exchange, DistributedMesh& mesh, Moves moves,
  Classification& classification, const MoveSettings& settings);

/// Where the vertices are wanted: those off the CAD at their places (see placeToReach), the layers
/// over them along with them (see LayerColumns), all others where they are. `fixed`: see
/// MoveSettings. Collective. Work: where vertices are off the CAD, that of nearestOn for each, and
/// of LayerColumns.
std::vector<Point3> wantedPoints(RankExchange& exchange, const DistributedMesh& mesh,
  const BoundaryProjector& projector, const Classification& classification,
  const std::vector<unsigned char>& fixed);

} // namespace cadrefine
