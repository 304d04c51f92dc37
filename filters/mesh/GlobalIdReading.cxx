#include "mesh/GlobalIdReading.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/RadixOrder.h>

#include <vtkArrayDispatch.h>
#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

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

/// The result of numberByIds if the ids ascend from point to point; none if they do not.
std::optional<std::vector<Index>> numberAscending(
  const std::vector<GlobalId>& ids, const std::function<bool(std::size_t)>& isUsed)
{
  std::vector<Index> vertexOf(ids.size(), -1);
  Index next = 0;
  GlobalId last = -1;
  for (std::size_t p = 0; p < ids.size(); ++p)
  {
    if (isUsed(p))
    {
      if (ids[p] <= last)
      {
        return {};
      }
      last = ids[p];
      vertexOf[p] = next++;
    }
  }
  return vertexOf;
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
                "); global ids are whole numbers from 0 to 2^62 - 1. Remove the array to have "
                "CADRefine make its own ids");
  }
}

std::vector<Index> numberByIds(
  const std::vector<GlobalId>& ids, const std::function<bool(std::size_t)>& isUsed)
{
  if (auto vertexOf = numberAscending(ids, isUsed))
  {
    return *std::move(vertexOf);
  }
  std::vector<PlacedKey> keys;
  keys.reserve(ids.size());
  for (std::size_t p = 0; p < ids.size(); ++p)
  {
    if (isUsed(p))
    {
      keys.push_back({ orderedBits(ids[p]), static_cast<std::uint32_t>(p) });
    }
  }
  radixSort(keys);
  std::vector<Index> firstWithId(ids.size(), -1);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    const bool again = k > 0 && keys[k - 1].key == keys[k].key;
    firstWithId[keys[k].place] =
      again ? firstWithId[keys[k - 1].place] : static_cast<Index>(keys[k].place);
  }
  std::vector<Index> vertexOf = std::move(firstWithId);
  Index next = 0;
  for (std::size_t p = 0; p < vertexOf.size(); ++p)
  {
    if (vertexOf[p] >= 0)
    {
      vertexOf[p] = vertexOf[p] == static_cast<Index>(p) ? next++ : vertexOf[vertexOf[p]];
    }
  }
  return vertexOf;
}

} // namespace cadrefine
