// Moving interior vertices out of the way of boundary vertices that could not reach the CAD.
#pragma once

#include "Relocation.h"
#include "SimplexMesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Weighted sums of the positions that the cells round a vertex propose for it. Whole numbers, so
/// that sums over cells and ranks do not depend on the order.
struct Proposal
{
  std::array<std::int64_t, 3> weightedPosition{};
  std::int64_t weight = 0;

  friend Proposal operator+(Proposal a, const Proposal& b)
  {
    for (int k = 0; k < 3; ++k)
    {
      a.weightedPosition[k] += b.weightedPosition[k];
    }
    a.weight += b.weight;
    return a;
  }
};

/// The grid of whole numbers for positions: the same on every rank.
struct ProposalGrid
{
  Point3 origin;
  double size = 1; ///< Largest extent of the whole mesh.
  Point3 position(const Proposal& sum) const;
  std::array<std::int64_t, 3> steps(const Point3& point) const;
};

/// Each cell with a stuck vertex proposes for each of its interior vertices the apex of the
/// equilateral cell over the opposite side, that side with its vertices at their targets; worse
/// cells weigh more (a simplified form of D. Vartziotis, J. Wipper, "The geometric element
/// transformation method for mixed mesh smoothing", Eng. with Computers 25, 2009). One sum for each
/// vertex; `interior` and `stuck` have an entry for each vertex. Work linear in the number of
/// cells.
std::vector<Proposal> proposeInteriorPositions(const SimplexMesh& mesh,
  const std::vector<Point3>& wanted, const std::vector<unsigned char>& interior,
  const std::vector<unsigned char>& stuck, const ProposalGrid& grid);

} // namespace cadrefine
