#include "ProjectionTask.h"

#include <algorithm>

namespace cadrefine
{

void FewEntities::add(std::int32_t index)
{
  for (std::int32_t& own : indices_)
  {
    if (own == index)
    {
      return;
    }
    if (index < own)
    {
      std::swap(index, own);
    }
  }
}

void FewEntities::add(const FewEntities& other)
{
  for (const std::int32_t index : other)
  {
    add(index);
  }
}

bool FewEntities::has(std::int32_t index) const
{
  return std::find(begin(), end(), index) != end();
}

const std::int32_t* FewEntities::end() const
{
  return std::find(indices_.begin(), indices_.end(), none);
}

} // namespace cadrefine
