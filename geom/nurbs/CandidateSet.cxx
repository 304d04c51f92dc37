#include "CandidateSet.h"

#include <algorithm>

namespace cadrefine
{

void CandidateSet::offer(const Candidate& candidate)
{
  if (!(candidate.distance <= limit()))
  {
    return;
  }
  for (int i = 0; i < size_; ++i)
  {
    if (!precedes(candidate, kept_[i]) && kept_[i].distance <= candidate.distance)
    {
      return;
    }
  }
  nearest_ = std::min(nearest_, candidate.distance);
  const auto hopeless = [&](const Candidate& other)
  {
    return other.distance > limit() ||
           (!precedes(other, candidate) && candidate.distance <= other.distance);
  };
  size_ = static_cast<int>(
    std::remove_if(kept_.begin(), kept_.begin() + size_, hopeless) - kept_.begin());
  if (size_ < capacity) // more than this many different distances within the tie tolerance: never
  {
    kept_[size_++] = candidate;
  }
}

const Candidate* CandidateSet::winner() const
{
  const auto* end = kept_.begin() + size_;
  const auto* first = std::min_element(kept_.begin(), end, precedes);
  return first == end ? nullptr : first;
}

} // namespace cadrefine
