// What tests on several ranks have in common.
#pragma once

#include "comm/RankExchange.h"

#include <gtest/gtest.h>

#include <random>

class vtkMultiProcessController;

namespace cadrefine
{

/// The controller of all ranks, from MPI's start to its end.
vtkMultiProcessController* worldController();

/// A test that all ranks run together. It fails on all ranks if it fails on one. Within a test,
/// use EXPECT where ranks may differ: a rank that leaves early makes the others wait.
class ParallelTest : public testing::Test
{
protected:
  void TearDown() override
  {
    EXPECT_FALSE(exchange.any(HasFailure())) << "the test failed on some rank";
  }

  RankExchange exchange{ worldController() };

  /// The same on all ranks, and another on each.
  std::mt19937_64 commonRandom{ 20240229 };
  std::mt19937_64 ownRandom{ 7000 + static_cast<std::uint64_t>(exchange.rank()) };
};

} // namespace cadrefine
