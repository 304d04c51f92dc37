#include "fields/ArrayRows.h"

#include <vtkArrayDispatch.h>
#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

struct Summation
{
  const WeightedRows& rows;
  Sums sums;

  template<class From, class To>
  void operator()(From* from, To* to) const
  {
    const auto source = vtk::DataArrayValueRange(from);
    auto target = vtk::DataArrayValueRange(to);
    const vtkIdType components = from->GetNumberOfComponents();
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      for (vtkIdType k = 0; k < components; ++k)
      {
        target[rows.targets[r] * components + k] = static_cast<vtk::GetAPIType<To>>(
          sumOf(r, [&](Index tuple) -> double { return source[tuple * components + k]; }));
      }
    }
  }

private:
  template<class ValueOf>
  double sumOf(std::size_t row, const ValueOf& valueOf) const
  {
    double sum = 0;
    double least = std::numeric_limits<double>::infinity();
    double largest = -least;
    for (Index e = rows.firsts[row]; e < rows.firsts[row + 1]; ++e)
    {
      const double value = valueOf(rows.sources[e]);
      sum += rows.weights[e] * value;
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
    return sums == Sums::WithinValues ? std::min(std::max(sum, least), largest) : sum;
  }
};

} // namespace

bool isReal(vtkAbstractArray* array)
{
  return vtkDataArray::SafeDownCast(array) &&
         (array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT);
}

bool applyRows(vtkAbstractArray* from, const WeightedRows& rows, Sums sums, vtkAbstractArray* to)
{
  if (!isReal(from))
  {
    return false;
  }
  vtkDataArray* source = vtkDataArray::SafeDownCast(from);
  vtkDataArray* target = vtkDataArray::SafeDownCast(to);
  using Dispatch = vtkArrayDispatch::Dispatch2BySameValueType<vtkArrayDispatch::Reals>;
  const Summation summation{ rows, sums };
  if (!Dispatch::Execute(source, target, summation))
  {
    summation(source, target); // a kind of array that VTK does not know by its type
  }
  return true;
}

} // namespace cadrefine
