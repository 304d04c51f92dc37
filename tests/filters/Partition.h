// Meshes in pieces, and meshes put together again to be compared.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/mesh/Mesh.h>

#include <vtkSmartPointer.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

class vtkPointSet;

namespace cadtest
{

/// How a mesh is dealt out to ranks.
enum class Dealing
{
  Blocks,   ///< Cells in their order, as many to each rank.
  Random,   ///< Each cell to any rank.
  KdTree,   ///< Halved along the longest side of what is left, again and again.
  EmptyRank ///< At random, but nothing to rank 0 (unless it is alone).
};

/// The rank of each cell; the same on every rank.
std::vector<int> deal(Dealing dealing, vtkPointSet* whole, int ranks);

/// A rank's piece of `whole`: its cells, in any order, with their points and arrays. With ghosts,
/// the cells of other ranks that touch them are there too, marked as duplicates.
vtkSmartPointer<vtkPointSet> pieceOf(
  vtkPointSet* whole, const std::vector<int>& rankOfCell, int rank, bool ghosts);

/// A mesh in a form that does not depend on numbering: by global id, the bytes of each point
/// (coordinates and arrays) and cell (type, ids of points, arrays). All NaNs count as the same.
struct CanonicalMesh
{
  std::map<std::int64_t, std::string> points;
  std::map<std::int64_t, std::string> cells;
  int contradictions = 0; ///< Points that two ranks hold with different values, cells held twice.
};

/// Puts the pieces together on rank 0 (on others the result is empty). Collective.
CanonicalMesh gather(cadrefine::RankExchange& exchange, vtkPointSet* piece);

/// Cells of the mesh but for vertices, by their corners; ids are the global ids.
cadrefine::Mesh toMesh(const CanonicalMesh& canonical);

} // namespace cadtest
