// Reading the global ids of data sets.
#pragma once

#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/base/ParallelFor.h>

#include <vtkType.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

class vtkDataArray;

namespace cadrefine
{

/// The values of `array`, of any type of number; -1 for those that are no ids. Empty without an
/// array. Ids are whole numbers from 0 to 2^62 - 1, so that there is room above them for the ids of
/// new points. Work: linear.
std::vector<GlobalId> readGlobalIds(vtkDataArray* array, const ParallelFor& parallelFor);

/// Throws Error where the value at `place` is no id: where `id`, which readGlobalIds made of it, is
/// negative; `item` is what has it ("point", "cell").
void checkGlobalId(GlobalId id, vtkDataArray* array, vtkIdType place, const std::string& item);

/// The vertex that each point becomes, numbered in the order of the points: one for each id; -1 for
/// points that are not used. Work: linear.
std::vector<Index> numberByIds(
  const std::vector<GlobalId>& ids, const std::function<bool(std::size_t)>& isUsed);

} // namespace cadrefine
