// Makes CADModels. Private to geom/cad.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <memory>
#include <vector>

namespace cadrefine
{

class CADModelBuilder
{
public:
  /// The model held by `bytes` of encodeModel. A model that was just read from a file goes through
  /// its bytes too, so that it has the same bits on every rank.
  static std::shared_ptr<const CADModel> build(
    std::vector<char> bytes, const ParallelFor& parallelFor);
};

} // namespace cadrefine
