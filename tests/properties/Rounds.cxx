#include "Rounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>

namespace propertytest
{

namespace
{

std::uint64_t fromEnvironment(const char* name, std::uint64_t otherwise)
{
  const char* text = std::getenv(name);
  return text ? std::stoull(text) : otherwise;
}

} // namespace

double Random::anyMagnitude(double digits)
{
  return (chance(0.5) ? 1 : -1) * std::pow(10.0, between(-digits, 0));
}

void forEachSeed(int rounds, const std::function<void(Random&)>& body)
{
  const std::uint64_t first = fromEnvironment("CADREFINE_SEED", 1);
  const std::uint64_t count =
    fromEnvironment("CADREFINE_ROUNDS", static_cast<std::uint64_t>(rounds));
  testing::Test::RecordProperty("first_seed", std::to_string(first));
  testing::Test::RecordProperty("rounds", std::to_string(count));
  ASSERT_GT(count, 0u) << "no round was asked for";
  for (std::uint64_t seed = first; seed - first < count; ++seed)
  {
    SCOPED_TRACE("CADREFINE_SEED=" + std::to_string(seed) + " CADREFINE_ROUNDS=1");
    Random random(seed);
    try
    {
      body(random);
    }
    catch (const std::exception& error)
    {
      ADD_FAILURE() << error.what();
    }
  }
}

} // namespace propertytest
