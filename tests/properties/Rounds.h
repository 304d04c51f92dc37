// Randomised tests: rounds, each from a seed of its own, which a failure names.
#pragma once

#include <cstdint>
#include <functional>
#include <random>

namespace propertytest
{

/// Random numbers of one round, the same for the same seed.
class Random
{
public:
  explicit Random(std::uint64_t seed) : seed_(seed), engine_(seed) {}

  std::uint64_t seed() const { return seed_; }
  std::mt19937_64& engine() { return engine_; }

  double between(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Both ends included.
  int among(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return between(0, 1) < probability; }
  /// Of either sign and any order of magnitude from 10^-digits to 1.
  double anyMagnitude(double digits);

private:
  std::uint64_t seed_;
  std::mt19937_64 engine_;
};

/// Runs `body` for as many seeds as the environment variable CADREFINE_ROUNDS says, or `rounds`,
/// from CADREFINE_SEED, or 1, on. A failure names its seed; the other seeds are run all the same.
/// An exception is a failure.
void forEachSeed(int rounds, const std::function<void(Random&)>& body);

} // namespace propertytest
