// Linked into a test program, it makes floating point exceptions of ours failures of the test that
// they come from (see FloatingPointTraps.h, and FloatingPointPause.h for tests that mean them). CAD
// files are then read by a program that ends at one.

#include "FloatingPointTraps.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

namespace cadtest
{

namespace
{

class FloatingPointListener : public testing::EmptyTestEventListener
{
public:
  void OnTestProgramStart(const testing::UnitTest& /*program*/) override
  {
    setenv("CADREFINE_READER", CADREFINE_TEST_READER, 1);
    traps_ = std::make_unique<FloatingPointTraps>("/libCADRefine");
  }

  void OnTestEnd(const testing::TestInfo& /*test*/) override
  {
    for (const std::string& finding : traps_->takeFindings())
    {
      ADD_FAILURE() << "floating point exception: " << finding;
    }
  }

  void OnTestProgramEnd(const testing::UnitTest& /*program*/) override { traps_.reset(); }

private:
  std::unique_ptr<FloatingPointTraps> traps_;
};

// The list owns it.
const bool isListening = []
{
  testing::UnitTest::GetInstance()->listeners().Append(new FloatingPointListener);
  return true;
}();

} // namespace

} // namespace cadtest
