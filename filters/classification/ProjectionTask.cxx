#include "classification/ProjectionTask.h"

#include <algorithm>

namespace cadrefine
{

void SmallEntitySet::add(std::int32_t index)
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

void SmallEntitySet::add(const SmallEntitySet& other)
{
  for (const std::int32_t index : other)
  {
    add(index);
  }
}

bool SmallEntitySet::has(std::int32_t index) const
{
  return std::find(begin(), end(), index) != end();
}

const std::int32_t* SmallEntitySet::end() const
{
  return std::find(indices_.begin(), indices_.end(), none);
}

} // namespace cadrefine
