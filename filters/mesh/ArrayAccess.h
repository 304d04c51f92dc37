// Fast access to the values of VTK's arrays, whatever their type.
#pragma once

#include <vtkArrayDispatch.h>
#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>

#include <algorithm>

namespace cadrefine
{

/// Copies all values of `array`, tuple by tuple, converted to T, to `values` on.
template<class T>
void copyValues(vtkDataArray* array, T* values)
{
  const auto copy = [values](auto* typed)
  {
    const auto range = vtk::DataArrayValueRange(typed);
    std::transform(
      range.begin(), range.end(), values, [](auto value) { return static_cast<T>(value); });
  };
  if (!vtkArrayDispatch::Dispatch::Execute(array, copy))
  {
    copy(array);
  }
}

} // namespace cadrefine
