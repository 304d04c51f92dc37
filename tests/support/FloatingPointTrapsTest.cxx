// The traps themselves, in a program that has no listener.

#include "FloatingPointTraps.h"
#include "FloatingPointPause.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace
{

using cadtest::FloatingPointTraps;

// Computed when the program runs.
volatile double zero = 0;
volatile double huge = 1e300;
volatile double notANumber = std::numeric_limits<double>::quiet_NaN();
volatile double result = 0;

std::size_t countOf(const std::function<void()>& work)
{
  FloatingPointTraps traps("/libCADRefine");
  work();
  return traps.takeFindings().size();
}

TEST(FloatingPointTraps, noteEachKindAndGoOn)
{
  FloatingPointTraps traps("/libCADRefine");
  result = 1 / zero;
  EXPECT_EQ(result, std::numeric_limits<double>::infinity());
  const std::vector<std::string> divisions = traps.takeFindings();
  result = huge * huge;
  const std::vector<std::string> overflows = traps.takeFindings();
  result = zero / zero;
  EXPECT_TRUE(std::isnan(result));
  const std::vector<std::string> invalid = traps.takeFindings();
  ASSERT_EQ(divisions.size(), 1u);
  EXPECT_EQ(divisions[0].find("division by zero, 1 times"), 0u) << divisions[0];
  ASSERT_EQ(overflows.size(), 1u);
  EXPECT_EQ(overflows[0].find("overflow, 1 times"), 0u) << overflows[0];
  ASSERT_EQ(invalid.size(), 1u);
  EXPECT_EQ(invalid[0].find("invalid operation, 1 times"), 0u) << invalid[0];
}

TEST(FloatingPointTraps, countEachInstruction)
{
  FloatingPointTraps traps("/libCADRefine");
  for (int i = 0; i < 1000; ++i)
  {
    result = 1 / zero;
  }
  const std::vector<std::string> findings = traps.takeFindings();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].find(", 1000 times"), std::string::npos) << findings[0];
}

TEST(FloatingPointTraps, noteComparisonsOfWhatIsNoNumber)
{
  EXPECT_EQ(countOf([] { result = notANumber < 1 ? 1 : 0; }), 1u);
  EXPECT_EQ(countOf([] { result = std::isnan(notANumber) ? 1 : 0; }), 0u);
  EXPECT_EQ(countOf([] { result = std::isless(notANumber, 1.0) ? 1 : 0; }), 0u);
}

TEST(FloatingPointTraps, noteFunctionsOfTheLibraryThatWeCall)
{
  EXPECT_GE(countOf([] { result = std::exp(huge); }), 1u);
}

TEST(FloatingPointTraps, noteThreadsAndForkedProcesses)
{
  EXPECT_EQ(countOf([] { std::thread([] { result = 1 / zero; }).join(); }), 1u);
  EXPECT_EQ(countOf(
              []
              {
                const pid_t child = fork();
                if (child == 0)
                {
                  result = 1 / zero;
                  _exit(0);
                }
                int status = -1;
                ASSERT_EQ(waitpid(child, &status, 0), child);
                EXPECT_EQ(status, 0);
              }),
    1u);
}

TEST(FloatingPointTraps, noteNothingElse)
{
  EXPECT_EQ(countOf([] { result = std::sqrt(2 + zero) / 3; }), 0u);
  EXPECT_EQ(countOf(
              []
              {
                const cadtest::FloatingPointPause pause;
                result = 1 / zero;
              }),
    0u);
  result = 1 / zero; // nobody listens
}

} // namespace
