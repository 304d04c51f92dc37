#include "pipeline/GeometryCache.h"

#include "comm/Threads.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#define XXH_INLINE_ALL // nothing to link
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

class Hasher
{
public:
  explicit Hasher(const ParallelFor& parallelFor)
    : state_(XXH3_createState(), XXH3_freeState), parallelFor_(parallelFor)
  {
    XXH3_128bits_reset(state_.get());
  }

  /// Adds an item. Texts have an end, and what stands before other data tells its length, so that
  /// no two rows of items look alike.
  void add(const std::string& text)
  {
    add(reinterpret_cast<const unsigned char*>(text.c_str()), text.size() + 1);
  }

  void add(vtkDataArray* array)
  {
    if (!array || array->GetNumberOfValues() == 0)
    {
      return add("empty");
    }
    const vtkIdType count = array->GetNumberOfValues();
    std::ostringstream header;
    header << array->GetDataType() << " " << array->GetNumberOfComponents() << " " << count;
    add(header.str());
    const bool isBits = array->GetDataType() == VTK_BIT;
    const auto bytes =
      static_cast<std::size_t>(isBits ? (count + 7) / 8 : count * array->GetDataTypeSize());
    if (array->HasStandardMemoryLayout())
    {
      return addBlocks(static_cast<const unsigned char*>(array->GetVoidPointer(0)), bytes);
    }
    std::vector<unsigned char> copy(bytes);
    array->ExportToVoidPointer(copy.data());
    addBlocks(copy.data(), bytes);
  }

  void add(vtkCellArray* cells)
  {
    add(cells ? cells->GetOffsetsArray() : nullptr);
    add(cells ? cells->GetConnectivityArray() : nullptr);
  }

  void add(vtkDataSetAttributes* attributes)
  {
    for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
    {
      if (vtkDataArray* array = attributes->GetArray(a))
      {
        add(array->GetName() ? array->GetName() : "");
        add(std::to_string(attributes->IsArrayAnAttribute(a)));
        add(array);
      }
    }
    add("end");
  }

  ContentHash result() const
  {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return { hash.low64, hash.high64 };
  }

private:
  /// Adds the hashes of blocks of the data instead of the data itself, on threads.
  void addBlocks(const unsigned char* data, std::size_t bytes)
  {
    constexpr std::size_t block = std::size_t{ 1 } << 20;
    std::vector<XXH128_hash_t> hashes((bytes + block - 1) / block);
    forEachIndex(parallelFor_, hashes.size(), 1,
      [&](std::size_t b)
      { hashes[b] = XXH3_128bits(data + b * block, std::min(block, bytes - b * block)); });
    add(reinterpret_cast<const unsigned char*>(hashes.data()), hashes.size() * sizeof(hashes[0]));
  }

  void add(const unsigned char* data, std::size_t bytes)
  {
    XXH3_128bits_update(state_.get(), data, bytes);
  }

  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
  const ParallelFor& parallelFor_;
};

void addCells(vtkPointSet* data, Hasher& hasher)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    hasher.add(grid->GetCellTypesArray());
    hasher.add(grid->GetCells());
  }
  else if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    for (vtkCellArray* cells :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      hasher.add(cells);
    }
  }
}

/// The hash of the class, points, cells and arrays of points and cells, with their types, names and
/// attributes; field data and arrays that are no numbers are left out.
ContentHash hashContent(vtkPointSet* data, const ParallelFor& parallelFor)
{
  Hasher hasher(parallelFor);
  hasher.add(data->GetClassName());
  hasher.add(data->GetPoints() ? data->GetPoints()->GetData() : nullptr);
  addCells(data, hasher);
  hasher.add(data->GetPointData());
  hasher.add(data->GetCellData());
  return hasher.result();
}

} // namespace

const PipelineResult& GeometryCache::get(RankExchange& exchange, vtkPointSet* geometry,
  std::shared_ptr<const CADModel> model, std::uint64_t properties, const Make& make)
{
  const ContentHash hash = hashContent(geometry, forOnThreads(exchange));
  const bool isNew =
    !last_ || last_->hash != hash || last_->model != model || last_->properties != properties;
  if (exchange.any(isNew))
  {
    last_.reset(); // first, so that no two are in memory
    last_ = Entry{ hash, std::move(model), properties, make(geometry) };
  }
  return last_->result;
}

} // namespace cadrefine
