#include <cadrefine/nurbs/CandidateSet.h>

#include <algorithm>

namespace cadrefine
{

void CandidateSet::offer(const Candidate& candidate)
{
  if (!(candidate.distance <= limit()))
  {
    return;
  }
  for (const Candidate& other : kept_)
  {
    if (!precedes(candidate, other) && other.distance <= candidate.distance)
    {
      return;
    }
  }
  nearest_ = takesAny_ ? 0 : std::min(nearest_, candidate.distance);
  const auto hopeless = [&](const Candidate& other)
  {
    return other.distance > limit() ||
           (!precedes(other, candidate) && candidate.distance <= other.distance);
  };
  kept_.erase(std::remove_if(kept_.begin(), kept_.end(), hopeless), kept_.end());
  kept_.push_back(candidate);
}

const Candidate* CandidateSet::winner() const
{
  const auto first = std::min_element(kept_.begin(), kept_.end(), precedes);
  return first == kept_.end() ? nullptr : &*first;
}

} // namespace cadrefine
