// What happens in the child process comes back as bytes or as an Error.

#include "IsolatedRun.h"

#include "Error.h"

#include <gtest/gtest.h>

#include <csignal>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <unistd.h>

namespace
{

using cadrefine::runIsolated;
using cadrefine::RunLimits;

std::string errorOf(const RunLimits& limits, const std::function<std::vector<char>()>& work)
{
  try
  {
    runIsolated("file", limits, work);
  }
  catch (const cadrefine::Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(IsolatedRun, BringsBackManyBytes)
{
  std::vector<char> bytes(3000001);
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    bytes[i] = static_cast<char>(i % 251);
  }
  EXPECT_EQ(runIsolated("file", { 60 }, [&] { return bytes; }), bytes);
  EXPECT_TRUE(runIsolated("file", { 60 }, [] { return std::vector<char>(); }).empty());
}

TEST(IsolatedRun, KeepsItsOutputToItself)
{
  testing::internal::CaptureStdout();
  runIsolated("file", { 60 },
    []
    {
      std::cout << "chatter" << std::endl;
      return std::vector<char>(1);
    });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(IsolatedRun, PassesErrorsOn)
{
  EXPECT_EQ(
    errorOf({ 60 }, []() -> std::vector<char> { throw cadrefine::Error("reason"); }), "reason");
  EXPECT_EQ(errorOf({ 60 }, []() -> std::vector<char> { throw std::runtime_error("why"); }),
    "file: the file is damaged: why");
  EXPECT_NE(errorOf({ 60 }, []() -> std::vector<char> { throw 1; }), "");
}

TEST(IsolatedRun, SurvivesACrash)
{
  const std::string error = errorOf({ 60 },
    []
    {
      std::raise(SIGSEGV);
      return std::vector<char>();
    });
  EXPECT_EQ(error.find("file: "), 0u) << error;
  EXPECT_NE(error.find("signal 11"), std::string::npos) << error;
}

TEST(IsolatedRun, TellsThatItWasKilled)
{
  for (const int signal : { SIGKILL, SIGTERM })
  {
    const std::string error = errorOf({ 60 },
      [signal]
      {
        kill(getpid(), signal);
        return std::vector<char>();
      });
    EXPECT_EQ(error.find("file: cannot be read: the process that reads it was killed"), 0u)
      << error;
  }
}

TEST(IsolatedRun, EndsWhatTakesTooMuchMemory)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer's allocator ends the process where memory runs out";
#endif
  const auto fill = []
  {
    const std::vector<std::vector<char>> blocks(300, std::vector<char>(1 << 20, 'x'));
    return blocks.back();
  };
  const std::string error = errorOf({ 60, 100 }, fill);
  EXPECT_NE(error.find("more than 100 MiB of memory"), std::string::npos) << error;
  EXPECT_EQ(errorOf({ 60, 1000 }, fill), "");
}

TEST(IsolatedRun, EndsWhatStandsStill)
{
  const std::string error = errorOf({ 60, 0, 1 },
    []
    {
      pause();
      return std::vector<char>();
    });
  EXPECT_NE(error.find("stands still"), std::string::npos) << error;
}

/// Computes for so many seconds, and tells so all the time or never.
std::vector<char> compute(double seconds, bool withNotes)
{
  while (static_cast<double>(std::clock()) < seconds * CLOCKS_PER_SEC)
  {
    if (withNotes)
    {
      cadrefine::noteProgress();
    }
  }
  return {};
}

constexpr double forEver = 1e9;

TEST(IsolatedRun, EndsWhatNeverEnds)
{
  const std::string error = errorOf({ 1 }, [] { return compute(forEver, false); });
  EXPECT_NE(error.find("no end within 1 s"), std::string::npos) << error;
}

TEST(IsolatedRun, EndsAStepThatNeverEnds)
{
  const std::string error = errorOf({ 60, 0, 20, 1 }, [] { return compute(forEver, false); });
  EXPECT_NE(error.find("one step came to no end within 1 s"), std::string::npos) << error;
}

TEST(IsolatedRun, GivesEachStepItsTime)
{
  EXPECT_EQ(errorOf({ 60, 0, 20, 1 }, [] { return compute(2.5, true); }), "");
  const std::string error = errorOf({ 2, 0, 20, 1 }, [] { return compute(forEver, true); });
  EXPECT_NE(error.find("no end within 2 s"), std::string::npos) << error;
}

} // namespace
