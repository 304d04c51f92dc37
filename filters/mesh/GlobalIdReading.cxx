#include "mesh/GlobalIdReading.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>

#include <vtkArrayDispatch.h>
#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace cadrefine
{
namespace
{

constexpr GlobalId bound = GlobalId{ 1 } << 62;

template<class Value>
GlobalId idOf(Value value)
{
  if constexpr (std::is_floating_point_v<Value>)
  {
    const bool isId = std::isgreaterequal(value, Value{ 0 }) && value < static_cast<Value>(bound) &&
                      std::floor(value) == value;
    return isId ? static_cast<GlobalId>(value) : -1;
  }
  else if constexpr (std::is_unsigned_v<Value>)
  {
    return value < static_cast<std::uint64_t>(bound) ? static_cast<GlobalId>(value) : -1;
  }
  else
  {
    return value >= 0 && static_cast<GlobalId>(value) < bound ? static_cast<GlobalId>(value) : -1;
  }
}

} // namespace

std::vector<GlobalId> readGlobalIds(vtkDataArray* array, const ParallelFor& parallelFor)
{
  std::vector<GlobalId> ids;
  resizeLong(ids, array ? array->GetNumberOfValues() : 0, parallelFor);
  const auto read = [&ids](auto* typed, const ParallelFor& threads)
  {
    const auto range = vtk::DataArrayValueRange(typed);
    threads(ids.size(), fineGrain,
      [&](std::size_t begin, std::size_t end)
      {
        const auto first = range.begin() + static_cast<vtkIdType>(begin);
        std::transform(first, first + static_cast<vtkIdType>(end - begin), ids.data() + begin,
          [](auto value) { return idOf<decltype(value)>(value); });
      });
  };
  if (array && !vtkArrayDispatch::Dispatch::Execute(array, read, parallelFor))
  {
    read(array, serialFor);
  }
  return ids;
}

void checkGlobalId(GlobalId id, vtkDataArray* array, vtkIdType place, const std::string& item)
{
  if (id < 0)
  {
    throw Error(item + " " + std::to_string(place) + " of the mesh has " +
                array->GetVariantValue(place).ToString() + " as global id (array " +
                (array->GetName() ? array->GetName() : "without a name") +
                "); global ids are whole numbers from 0 to 2^62 - 1. Without that array CADRefine "
                "makes ids of its own");
  }
}

} // namespace cadrefine
