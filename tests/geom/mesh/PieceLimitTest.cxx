#include <cadrefine/base/PieceLimit.h>

#include <gtest/gtest.h>

namespace
{

using namespace cadrefine;

std::string reasonOf(std::size_t count)
{
  try
  {
    requireAtMost(count, "cells");
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(PieceLimit, isWhatAnIndexCanCount)
{
  EXPECT_EQ(reasonOf(0), "");
  EXPECT_EQ(reasonOf(2147483647), "");
  EXPECT_EQ(reasonOf(2147483648),
    "too many cells for one rank: 2147483648; the limit is 2147483647, use more ranks");
}

} // namespace
