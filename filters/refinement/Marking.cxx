#include "refinement/Marking.h"

#include "comm/CollectiveErrors.h"
#include "mesh/ArrayAccess.h"
#include "refinement/BulkMarking.h"

#include <cadrefine/base/Error.h>

#include <vtkCellData.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace cadrefine
{
namespace
{

using Strategy = MarkingCriterion::Strategy;

/// Whether the criterion's value is a part, not a value of the array.
bool isFraction(const MarkingCriterion& criterion)
{
  return criterion.strategy == Strategy::FractionOfLargest || criterion.strategy == Strategy::Bulk;
}

/// Values of the array for the cells of the mesh's own dimension. A rank without any need not have
/// the array.
std::vector<double> valuesOf(
  const MarkingCriterion& criterion, const DistributedMesh& mesh, const MeshArrays& arrays)
{
  const int dimension = mesh.mesh().dimension;
  if (mesh.converted.cellIds[dimension].empty())
  {
    return {};
  }
  vtkDataArray* array = arrays.ofCells->GetArray(criterion.array.c_str());
  if (!array)
  {
    throw Error("the mesh has no numeric cell array " + criterion.array + " to mark cells by");
  }
  if (array->GetNumberOfComponents() != 1)
  {
    throw Error("the marking array " + criterion.array + " has " +
                std::to_string(array->GetNumberOfComponents()) + " components instead of one");
  }
  std::vector<double> values(array->GetNumberOfTuples());
  copyValues(array, values.data());
  values.erase(values.begin(), values.begin() + firstCellOfDimension(mesh.mesh(), dimension));
  if (std::any_of(values.begin(), values.end(), [](double x) { return std::isnan(x); }))
  {
    throw Error("the marking array " + criterion.array + " contains NaN");
  }
  if (isFraction(criterion) && !std::all_of(values.begin(), values.end(),
                                 [](double x) { return std::isfinite(x) && x >= 0; }))
  {
    throw Error("the marking array " + criterion.array +
                " has a value that is negative or not finite; marking by Fraction of Largest or "
                "Bulk needs finite values of at least 0");
  }
  return values;
}

void checkFraction(const MarkingCriterion& criterion)
{
  if (isFraction(criterion) && !(std::isgreater(criterion.value, 0.0) && criterion.value <= 1))
  {
    throw Error(
      "the fraction by which " + criterion.array + " marks cells must be above 0 and at most 1");
  }
}

std::vector<unsigned char> marksOf(RankExchange& exchange, const MarkingCriterion& criterion,
  const std::vector<double>& values, const std::vector<GlobalId>& ids)
{
  if (criterion.strategy == Strategy::Bulk)
  {
    return markBulk(exchange, values, ids, criterion.value);
  }
  std::vector<unsigned char> marks(values.size());
  if (criterion.strategy == Strategy::Threshold)
  {
    std::transform(values.begin(), values.end(), marks.begin(),
      [&](double value) { return std::isgreater(value, criterion.value); });
    return marks;
  }
  if (criterion.strategy == Strategy::AtLeast)
  {
    std::transform(values.begin(), values.end(), marks.begin(),
      [&](double value) { return std::isgreaterequal(value, criterion.value); });
    return marks;
  }
  const double largest =
    exchange.max(values.empty() ? 0 : *std::max_element(values.begin(), values.end()));
  std::transform(values.begin(), values.end(), marks.begin(),
    [&](double value) { return value > 0 && value >= criterion.value * largest; });
  return marks;
}

} // namespace

std::string describeLargest(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const std::vector<MarkingCriterion>& criteria)
{
  std::ostringstream text;
  for (const MarkingCriterion& criterion : criteria)
  {
    const std::vector<double> values = valuesOf(criterion, mesh, arrays);
    const double none = -std::numeric_limits<double>::infinity();
    const double largest =
      exchange.max(values.empty() ? none : *std::max_element(values.begin(), values.end()));
    text << (&criterion == &criteria.front() ? "" : "; ") << "the largest " << criterion.array
         << " is " << largest;
    if (criterion.strategy == Strategy::Threshold)
    {
      text << ", the threshold " << criterion.value;
    }
  }
  return text.str();
}

std::vector<unsigned char> markCells(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const std::vector<MarkingCriterion>& criteria)
{
  const auto& ids = mesh.converted.cellIds[mesh.mesh().dimension];
  std::vector<unsigned char> marks(ids.size(), criteria.empty() ? 1 : 0);
  for (const MarkingCriterion& criterion : criteria)
  {
    std::vector<double> values;
    agreeOnFailure(exchange,
      [&]
      {
        checkFraction(criterion);
        values = valuesOf(criterion, mesh, arrays);
      });
    const auto more = marksOf(exchange, criterion, values, ids);
    std::transform(marks.begin(), marks.end(), more.begin(), marks.begin(),
      [](unsigned char a, unsigned char b) { return a | b; });
  }
  return marks;
}

MarkingCriterion asThreshold(RankExchange& exchange, const DistributedMesh& mesh,
  const MeshArrays& arrays, const MarkingCriterion& criterion)
{
  MarkingCriterion threshold{ criterion.array, Strategy::AtLeast, criterion.value };
  if (isFraction(criterion))
  {
    const auto marks = markCells(exchange, mesh, arrays, { criterion });
    const auto values = valuesOf(criterion, mesh, arrays);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < marks.size(); ++c)
    {
      least = marks[c] ? std::min(least, values[c]) : least;
    }
    threshold.value = exchange.min(least);
  }
  return threshold;
}

} // namespace cadrefine
