#include "comm/FixedPointSum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cadrefine
{

namespace
{

constexpr int topBits = 16;                          // of an addend in the first limb
constexpr std::int64_t limbBase = 1ll << 32;         // of the others
constexpr std::int64_t addsBetweenCarries = 1 << 30; // so that no limb overflows

} // namespace

std::int64_t FixedPointSum::exponentOf(const std::vector<double>& addends)
{
  std::int64_t largest = allZero;
  for (const double addend : addends)
  {
    if (!std::isfinite(addend))
    {
      return notFinite;
    }
    if (addend == 0)
    {
      continue;
    }
    int exponent = 0;
    std::frexp(addend, &exponent);
    largest = std::max<std::int64_t>(largest, exponent);
  }
  return largest;
}

void FixedPointSum::add(double addend)
{
  double rest = std::scalbn(addend, topBits - exponent_);
  for (std::int64_t& limb : limbs_)
  {
    const double whole = std::trunc(rest);
    limb += static_cast<std::int64_t>(whole);
    rest = (rest - whole) * static_cast<double>(limbBase); // exact
  }
  if (++addedSinceCarry_ == addsBetweenCarries)
  {
    limbs_ = carried(limbs_);
    addedSinceCarry_ = 0;
  }
}

void FixedPointSum::add(const FixedPointSum& other)
{
  limbs_ = carried(limbs_);
  const Limbs addend = other.limbs();
  for (std::size_t i = 0; i < limbs_.size(); ++i)
  {
    limbs_[i] += addend[i];
  }
  addedSinceCarry_ = 1;
}

FixedPointSum::Limbs FixedPointSum::carried(Limbs limbs)
{
  for (std::size_t i = limbs.size() - 1; i > 0; --i)
  {
    std::int64_t carry = limbs[i] / limbBase;
    std::int64_t rest = limbs[i] % limbBase;
    if (rest < 0)
    {
      rest += limbBase;
      --carry;
    }
    limbs[i] = rest;
    limbs[i - 1] += carry;
  }
  return limbs;
}

double FixedPointSum::value() const
{
  Limbs limbs = carried(limbs_);
  const bool negative = limbs[0] < 0;
  if (negative)
  {
    for (std::int64_t& limb : limbs)
    {
      limb = -limb;
    }
    limbs = carried(limbs);
  }
  double magnitude = 0;
  for (std::size_t i = limbs.size(); i-- > 0;)
  {
    magnitude = magnitude / static_cast<double>(limbBase) + static_cast<double>(limbs[i]);
  }
  const double scaled = std::scalbn(magnitude, exponent_ - topBits);
  return negative ? 0.0 - scaled : scaled;
}

} // namespace cadrefine
