// Which cells to refine.
#pragma once

#include "fields/ArrayTransfer.h"
#include "mesh/DistributedMesh.h"

#include <string>
#include <vector>

namespace cadrefine
{

/// A rule that marks cells by the values of an array.
struct MarkingCriterion
{
  enum class Strategy
  {
    Threshold,         ///< Values larger than `value`.
    FractionOfLargest, ///< Positive values of at least `value` times the largest of all ranks.
    Bulk,   ///< The fewest cells that carry `value` of the sum (W. Doerfler, SIAM J. Numer. Anal.
            ///< 33, 1996, pp. 1106-1124), see markBulk.
    AtLeast ///< Values of at least `value`.
  };

  std::string array; ///< Cell array with one component.
  Strategy strategy = Strategy::Threshold;
  double value = 0;
};

/// 1 for the cells of the mesh's own dimension that any of the criteria marks; all cells if there
/// are no criteria. Throws Error, on all ranks, where an array is missing or has several
/// components, where a value is no number, and for a fraction or bulk where one is negative or
/// infinite, or the fraction is not in (0, 1]. Collective. Work: a look at each cell a
/// criterion, and that of markBulk.
std::vector<unsigned char> markCells(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const std::vector<MarkingCriterion>& criteria);

/// The criterion as one by a value of the array: AtLeast the smallest value that a fraction or bulk
/// marks, infinity where it marks none; of the others, AtLeast their own value. Throws and costs as
/// markCells. Collective.
MarkingCriterion asThreshold(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const MarkingCriterion& criterion);

/// Why these criteria, which can be used, mark no cell: "the largest GeometricError is 2e-08, the
/// threshold 1e-07", and so on. Collective.
std::string describeLargest(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const std::vector<MarkingCriterion>& criteria);

} // namespace cadrefine
