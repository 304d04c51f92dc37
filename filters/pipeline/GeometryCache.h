// The last result of a filter, for input with the same geometry.
#pragma once

#include "comm/RankExchange.h"
#include "pipeline/PipelineResult.h"

#include <cadrefine/cad/model/CADModel.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace cadrefine
{

/// A hash of the content, of 128 bits (XXH3 by Y. Collet): two contents that differ have the same
/// with a probability of 2^-128, if nobody made them to.
using ContentHash = std::array<std::uint64_t, 2>;

/// In a time series on a mesh that stays, only the fields change: what was made of the geometry is
/// kept, so that it is not made again. One result is kept. Memory: the mapping of the arrays (see
/// FieldMapping); the mesh is shared with the filter's output as long as that is there.
class GeometryCache
{
public:
  using Make = std::function<PipelineResult(vtkPointSet*)>;

  /// What `make` gives for this geometry: the kept result if on all ranks the geometry has the same
  /// content as last time, and the model and the properties are the same. `properties` is a number
  /// that changes with the filter's properties. Collective; one reduction, and a
  /// pass over the bytes, at about 8 GB/s a thread.
  const PipelineResult& get(RankExchange& exchange, vtkPointSet* geometry,
    std::shared_ptr<const CADModel> model, std::uint64_t properties, const Make& make);

private:
  struct Entry
  {
    ContentHash hash;
    std::shared_ptr<const CADModel> model; ///< Held, so that no other one gets its address.
    std::uint64_t properties;
    PipelineResult result;
  };
  std::optional<Entry> last_;
};

} // namespace cadrefine
