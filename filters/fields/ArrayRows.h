// Values of arrays as weighted sums.
#pragma once

#include <cadrefine/base/WeightedRows.h>

class vtkAbstractArray;

namespace cadrefine
{

enum class Sums
{
  AsTheyAre,
  WithinValues ///< Not beyond the smallest and largest value that has a weight: a mean, whatever
               ///< the rounding of its weights; values that are all the same stay.
};

/// Whether rows apply to an array: if it is of floating point.
bool isReal(vtkAbstractArray* array);

/// Gives the tuples of `to` that the rows name the sums of those of `from`, an array of the same
/// type, in double precision, component by component, in the order of the sources. Returns whether
/// it did (see isReal): other arrays stay as they are.
bool applyRows(vtkAbstractArray* from, const WeightedRows& rows, Sums sums, vtkAbstractArray* to);

} // namespace cadrefine
