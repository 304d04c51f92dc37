// The last result of a filter, for input with the same geometry.
#pragma once

#include "CADModel.h"
#include "ContentHash.h"
#include "StepResult.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace cadrefine
{

/// Of a time series on a mesh that stays, only the fields change: what was made of the geometry is
/// kept, so that it is not made again. One result is kept. Memory: the route of the arrays (see
/// ArrayRoute); the mesh is shared with the filter's output as long as that is there.
class GeometryMemory
{
public:
  using Make = std::function<StepResult(vtkPointSet*)>;

  /// What `make` gives for this geometry: the kept result if on all ranks the geometry has the same
  /// content as last time, and the model and the properties are the same. `properties` is a number
  /// that changes with the filter's properties. Collective; one reduction, and the work of
  /// hashContent.
  const StepResult& get(RankExchange& exchange, vtkPointSet* geometry,
    std::shared_ptr<const CADModel> model, std::uint64_t properties, const Make& make);

private:
  struct Entry
  {
    ContentHash hash;
    std::shared_ptr<const CADModel> model; ///< Held, so that no other one gets its address.
    std::uint64_t properties;
    StepResult result;
  };
  std::optional<Entry> last_;
};

} // namespace cadrefine
