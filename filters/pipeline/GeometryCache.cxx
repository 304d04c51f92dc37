#include "pipeline/GeometryCache.h"

#include "comm/Threads.h"

#include <vtkPointSet.h>

#include <utility>

namespace cadrefine
{

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
