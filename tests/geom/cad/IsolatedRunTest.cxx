// What happens in the child process comes back as bytes or as an Error.

#include <cadrefine/cad/import/IsolatedRun.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
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

TEST(IsolatedRun, bringsBackManyBytes)
{
  std::vector<char> bytes(3000001);
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    bytes[i] = static_cast<char>(i % 251);
  }
  EXPECT_EQ(runIsolated("file", { 60 }, [&] { return bytes; }), bytes);
  EXPECT_TRUE(runIsolated("file", { 60 }, [] { return std::vector<char>(); }).empty());
}

TEST(IsolatedRun, keepsItsOutputToItself)
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

TEST(IsolatedRun, passesErrorsOn)
{
  EXPECT_EQ(
    errorOf({ 60 }, []() -> std::vector<char> { throw cadrefine::Error("reason"); }), "reason");
  EXPECT_EQ(
    errorOf({ 60 }, []() -> std::vector<char> { throw std::runtime_error("why"); }), "file: why");
  EXPECT_NE(errorOf({ 60 }, []() -> std::vector<char> { throw 1; }), "");
}

TEST(IsolatedRun, survivesACrash)
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

TEST(IsolatedRun, tellsWhereItDied)
{
  try
  {
    runIsolated("file", { 60 },
      []
      {
        cadrefine::noteStep(3, 17);
        cadrefine::noteProgress();
        std::raise(SIGSEGV);
        return std::vector<char>();
      });
    FAIL();
  }
  catch (const cadrefine::RunFailure& failure)
  {
    EXPECT_EQ(failure.place().step, 3);
    EXPECT_EQ(failure.place().item, 17);
    EXPECT_EQ(failure.what(), "file: " + failure.cause());
  }
}

TEST(IsolatedRun, tellsThatItWasKilled)
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

TEST(IsolatedRun, endsWhatTakesTooMuchMemory)
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

TEST(IsolatedRun, endsWhatStandsStill)
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

TEST(IsolatedRun, endsWhatNeverEnds)
{
  const std::string error = errorOf({ 1 }, [] { return compute(forEver, false); });
  EXPECT_NE(error.find("did not finish within 1 s"), std::string::npos) << error;
}

TEST(IsolatedRun, endsAStepThatNeverEnds)
{
  const std::string error = errorOf({ 60, 0, 20, 1 }, [] { return compute(forEver, false); });
  EXPECT_NE(error.find("one step did not finish within 1 s"), std::string::npos) << error;
}

TEST(IsolatedRun, givesEachStepItsTime)
{
  EXPECT_EQ(errorOf({ 60, 0, 20, 1 }, [] { return compute(2.5, true); }), "");
  const std::string error = errorOf({ 2, 0, 20, 1 }, [] { return compute(forEver, true); });
  EXPECT_NE(error.find("did not finish within 2 s"), std::string::npos) << error;
}

TEST(ReadAttempts, leaveOutTheItemThatCrashesAmongThreads)
{
  const auto work = [](const cadrefine::ReadOptions& options)
  {
    std::vector<char> result(8, 'x');
    cadrefine::forEachIndex(cadrefine::forOnOwnThreads(options.threads), result.size(), 1,
      [&](std::size_t i)
      {
        const int item = static_cast<int>(i);
        options.noteItem(cadrefine::ReadStep::Drawing, item);
        const bool leftOut = options.withoutDrawings.count(item) > 0;
        if (item == 3 && !leftOut)
        {
          std::abort();
        }
        result[i] = leftOut ? '-' : 'x';
      });
    return result;
  };
  const std::vector<char> result = cadrefine::runAttempts("file", { 60 }, 2, work);
  EXPECT_EQ(std::string(result.begin(), result.end()), "xxx-xxxx");
}

/// The notes of an attempt, which fails on several threads, or over item 0.
std::string notesOf(bool alsoOnOne)
{
  const auto work = [&](const cadrefine::ReadOptions& options)
  {
    options.noteItem(cadrefine::ReadStep::Conversion, 0);
    if (options.threads > 1 || (alsoOnOne && options.withoutConversions.empty()))
    {
      throw std::bad_alloc();
    }
    const std::string note = options.notes().empty() ? "none" : options.notes().front();
    return std::vector<char>(note.begin(), note.end());
  };
  const std::vector<char> note = cadrefine::runAttempts("file", { 60, 1000 }, 2, work);
  return { note.begin(), note.end() };
}

TEST(ReadAttempts, tellOfAFailureThatOnlyThreadsHave)
{
  const std::string note = notesOf(false);
  EXPECT_NE(note.find("on several it failed"), std::string::npos) << note;
  EXPECT_NE(note.find("memory"), std::string::npos) << note;
  EXPECT_EQ(notesOf(true), "none") << "the item is left out, which is told";
}

} // namespace
