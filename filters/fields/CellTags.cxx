#include "fields/CellTags.h"

#include "fields/CADArrays.h"
#include "mesh/PointSetConversion.h"

#include <cadrefine/base/MixedBits.h>
#include <cadrefine/base/SortUniquely.h>

#include <vtkCellData.h>
#include <vtkDataArray.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr std::int64_t mostKinds = 32;  // that are taken for tags, however few cells there are
constexpr std::int64_t manyKinds = 256; // for tags, with fewer cells each, on average, than
constexpr std::int64_t fewCells = 100;  // two levels of refinement make of one

/// A value that a tag has somewhere.
struct TagValue
{
  std::uint64_t name;
  std::uint64_t value;

  friend bool operator<(const TagValue& a, const TagValue& b)
  {
    return std::pair(a.name, a.value) < std::pair(b.name, b.value);
  }
  friend bool operator==(const TagValue& a, const TagValue& b)
  {
    return a.name == b.name && a.value == b.value;
  }
};

struct ValueCount
{
  std::uint64_t name;
  std::int64_t count;
};

std::uint64_t hashOf(const std::string& name)
{
  std::uint64_t hash = name.size();
  for (const char letter : name)
  {
    hash = mixedBits(hash ^ static_cast<unsigned char>(letter));
  }
  return hash;
}

std::uint64_t hashOf(const std::vector<double>& tuple)
{
  std::uint64_t hash = tuple.size();
  for (const double value : tuple)
  {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    hash = mixedBits(hash ^ bits);
  }
  return hash;
}

template<class Visit>
void forEachTag(vtkCellData* data, const Visit& visit)
{
  for (int a = 0; a < data->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = data->GetArray(a);
    if (array && isTag(array))
    {
      visit(array);
    }
  }
}

/// Calls visit(c, tuple) for the cells of the range, from c = 0 on.
template<class Visit>
void forEachTuple(vtkDataArray* array, const CellRange& cells, const Visit& visit)
{
  std::vector<double> tuple(array->GetNumberOfComponents());
  for (std::size_t c = 0; c < cells.count; ++c)
  {
    array->GetTuple(cells.first + static_cast<vtkIdType>(c), tuple.data());
    visit(c, tuple);
  }
}

/// How many values each tag has over all ranks, by the hashes of their names: each value is counted
/// by the rank that its hash gives.
std::map<std::uint64_t, std::int64_t> countValues(
  RankExchange& exchange, const std::vector<TagValue>& values)
{
  std::vector<std::vector<TagValue>> toRank(exchange.size());
  for (const TagValue& value : values)
  {
    toRank[mixedBits(value.name ^ value.value) % toRank.size()].push_back(value);
  }
  std::vector<TagValue> here;
  for (const auto& list : exchange.allToAll(toRank))
  {
    here.insert(here.end(), list.begin(), list.end());
  }
  sortUniquely(here);
  std::map<std::uint64_t, std::int64_t> counts;
  for (const TagValue& value : here)
  {
    ++counts[value.name];
  }
  std::vector<ValueCount> mine;
  mine.reserve(counts.size());
  for (const auto& [name, count] : counts)
  {
    mine.push_back({ name, count });
  }
  counts.clear();
  for (const auto& list :
    exchange.allToAll(std::vector<std::vector<ValueCount>>(exchange.size(), mine)))
  {
    for (const auto& [name, count] : list)
    {
      counts[name] += count;
    }
  }
  return counts;
}

} // namespace

bool isTag(vtkDataArray* array)
{
  const std::string name = array->GetName() ? array->GetName() : "";
  const int type = array->GetDataType();
  const bool isOwn =
    name == arrays::validity || name == arrays::dimension || name == arrays::entity;
  return type != VTK_FLOAT && type != VTK_DOUBLE && !name.empty() && name.rfind("vtk", 0) != 0 &&
         !isOwn;
}

CellRange cellsOf(const Mesh& mesh, int dimension)
{
  return { firstCellOfDimension(mesh, dimension), mesh.cellCount(dimension) };
}

std::vector<std::uint64_t> findNumberings(
  RankExchange& exchange, vtkCellData* data, const CellRange& cells)
{
  std::vector<TagValue> values;
  forEachTag(data,
    [&](vtkDataArray* array)
    {
      std::vector<TagValue> own;
      const std::uint64_t name = hashOf(array->GetName());
      forEachTuple(array, cells,
        [&](std::size_t, const std::vector<double>& tuple) {
          own.push_back({ name, hashOf(tuple) });
        });
      sortUniquely(own);
      values.insert(values.end(), own.begin(), own.end());
    });
  const std::int64_t cellCount = exchange.sum(cells.count);
  std::vector<std::uint64_t> names; // also of arrays that this rank, without cells, does not have
  for (const auto& [name, count] : countValues(exchange, values))
  {
    const std::int64_t cellsOfOne = count > manyKinds ? fewCells : 2;
    if (count > mostKinds && cellsOfOne * count > cellCount)
    {
      names.push_back(name);
    }
  }
  return names;
}

std::vector<std::uint64_t> tagHashesOf(
  vtkCellData* data, const CellRange& cells, const std::vector<std::uint64_t>& numberings)
{
  std::vector<std::uint64_t> hashes(cells.count, 0);
  forEachTag(data,
    [&](vtkDataArray* array)
    {
      const std::uint64_t name = hashOf(array->GetName());
      if (!std::binary_search(numberings.begin(), numberings.end(), name))
      {
        forEachTuple(array, cells,
          [&](std::size_t c, const std::vector<double>& tuple)
          { hashes[c] += mixedBits(name ^ hashOf(tuple)); }); // in whatever order arrays are
      }
    });
  return hashes;
}

std::vector<Index> labelsOf(
  vtkCellData* data, const CellRange& cells, const std::vector<std::uint64_t>& numberings)
{
  std::vector<Index> labels;
  labels.reserve(cells.count);
  std::map<std::uint64_t, Index> numbers;
  for (const std::uint64_t hash : tagHashesOf(data, cells, numberings))
  {
    labels.push_back(numbers.emplace(hash, static_cast<Index>(numbers.size())).first->second);
  }
  return labels;
}

} // namespace cadrefine
