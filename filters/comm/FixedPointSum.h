// Sums of doubles that do not depend on the order of the addends.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace cadrefine
{

/// A sum of doubles in fixed point: addends are cut to a common unit, 2^-112 of a power of two
/// above the largest of them, and added as integers, so that neither the order nor the grouping
/// matters. Two sums with the same exponent are added limb by limb.
///
/// Error: each addend loses less than 2^-111 of the largest addend (nothing, where it is larger
/// than 2^-58 of it), and value() is rounded to within one unit in the last place. The number of
/// addends must be below 2^47.
class FixedPointSum
{
public:
  using Limbs = std::array<std::int64_t, 4>;

  static constexpr std::int64_t allZero = std::numeric_limits<std::int64_t>::min();
  static constexpr std::int64_t notFinite = std::numeric_limits<std::int64_t>::max();

  /// The smallest e with |x| < 2^e for all addends; `allZero` where none differs from zero (or
  /// there is none), `notFinite` where one is NaN or infinite. The largest of the exponents of
  /// several lists is the exponent of all of them together.
  static std::int64_t exponentOf(const std::vector<double>& addends);

  /// An empty sum of addends below 2^exponent; the exponent is neither allZero nor notFinite.
  explicit FixedPointSum(std::int64_t exponent, const Limbs& limbs = {})
    : exponent_(static_cast<int>(exponent)), limbs_(limbs)
  {
  }

  void add(double addend);

  /// Adds a sum with the same exponent.
  void add(const FixedPointSum& other);

  std::int64_t exponent() const { return exponent_; }

  /// The sum so far, most significant first; the lower three are in [0, 2^32), so that those of
  /// 2^31 sums can be added.
  Limbs limbs() const { return carried(limbs_); }

  /// The sum as a double. Never -0.0; infinite where it is beyond the largest double.
  double value() const;

private:
  static Limbs carried(Limbs limbs);

  int exponent_;
  std::int64_t addedSinceCarry_ = 0;
  Limbs limbs_;
};

} // namespace cadrefine
