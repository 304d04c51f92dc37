// What happens in the program that reads comes back as bytes or as an Error. The jobs are those of
// TestReader.cxx.

#include <cadrefine/cad/import/IsolatedRun.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/import/ReaderPath.h>

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>

namespace
{

using cadrefine::RunLimits;
using Bytes = std::vector<char>;

/// While it lives, another program reads.
class OtherReader
{
public:
  explicit OtherReader(const std::string& path) : before_(cadrefine::readerPath())
  {
    setenv("CADREFINE_READER", path.c_str(), 1);
  }
  ~OtherReader() { setenv("CADREFINE_READER", before_.c_str(), 1); }
  OtherReader(const OtherReader&) = delete;
  OtherReader& operator=(const OtherReader&) = delete;

private:
  std::string before_;
};

template<typename... Numbers>
Bytes inputOf(Numbers... numbers)
{
  cadrefine::ByteWriter writer;
  (writer.number(numbers), ...);
  return writer.bytes;
}

class IsolatedRun : public testing::Test
{
protected:
  OtherReader reader{ CADREFINE_TEST_READER };

  static Bytes run(
    const std::string& job, const RunLimits& limits = { 60 }, const Bytes& input = {})
  {
    return cadrefine::runIsolated(job, "file", limits, input);
  }

  static std::string errorOf(
    const std::string& job, const RunLimits& limits = { 60 }, const Bytes& input = {})
  {
    try
    {
      run(job, limits, input);
    }
    catch (const cadrefine::Error& error)
    {
      return error.what();
    }
    return "";
  }

  static void expectError(const std::string& error, const std::string& part)
  {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
};

TEST_F(IsolatedRun, bringsBackManyBytes)
{
  Bytes bytes(3000001);
  for (std::size_t i = 0; i < bytes.size(); ++i)
  {
    bytes[i] = static_cast<char>(i % 251);
  }
  cadrefine::ByteWriter input;
  input.array(bytes);
  EXPECT_EQ(run("echo", { 60 }, input.bytes), bytes);
  EXPECT_TRUE(run("echo", { 60 }, inputOf(std::uint64_t{ 0 })).empty());
}

TEST_F(IsolatedRun, keepsItsOutputToItself)
{
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  run("chatter");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(IsolatedRun, passesErrorsOn)
{
  EXPECT_EQ(errorOf("throw error"), "reason");
  EXPECT_EQ(errorOf("throw exception"), "file: why");
  EXPECT_NE(errorOf("throw number"), "");
}

TEST_F(IsolatedRun, survivesACrash)
{
  const std::string error = errorOf("crash", { 60 }, inputOf(0, -1));
  EXPECT_EQ(error.find("file: "), 0u) << error;
  expectError(error, "signal 11");
}

TEST_F(IsolatedRun, tellsWhereItDied)
{
  try
  {
    run("crash", { 60 }, inputOf(3, 17));
    FAIL();
  }
  catch (const cadrefine::RunFailure& failure)
  {
    EXPECT_EQ(failure.place().step, 3);
    EXPECT_EQ(failure.place().item, 17);
    EXPECT_EQ(failure.what(), "file: " + failure.cause());
  }
}

TEST_F(IsolatedRun, tellsThatItWasKilled)
{
  for (const int signal : { SIGKILL, SIGTERM })
  {
    const std::string error = errorOf("kill itself", { 60 }, inputOf(signal));
    EXPECT_EQ(error.find("file: cannot be read: the process that reads it was killed"), 0u)
      << error;
  }
}

/// A terminal sends them to the parent as well, which decides.
TEST_F(IsolatedRun, leavesTheSignalsOfTheTerminalToItsParent)
{
  EXPECT_EQ(errorOf("kill itself", { 60 }, inputOf(SIGINT)), "");
  EXPECT_EQ(errorOf("kill itself", { 60 }, inputOf(SIGHUP)), "");
}

TEST_F(IsolatedRun, hasNoneOfTheSignalsThatItsParentIgnoresOrBlocks)
{
  sigset_t blocked;
  sigset_t before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = std::signal(SIGTERM, SIG_IGN);
  expectError(errorOf("kill itself", { 60 }, inputOf(SIGTERM)), "was killed");
  std::signal(SIGTERM, handler);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST_F(IsolatedRun, endsWhatTakesTooMuchMemory)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer's allocator ends the process where memory runs out";
#endif
  expectError(errorOf("fill memory", { 60, 100 }), "more than 100 MiB of memory");
  EXPECT_EQ(errorOf("fill memory", { 60, 1000 }), "");
}

TEST_F(IsolatedRun, endsWhatStandsStill)
{
  expectError(errorOf("stand still", { 60, 0, 1 }), "makes no progress");
}

constexpr double forEver = 1e9;

TEST_F(IsolatedRun, endsWhatNeverEnds)
{
  expectError(errorOf("compute", { 1 }, inputOf(forEver, false)), "did not finish within 1 s");
}

TEST_F(IsolatedRun, endsAStepThatNeverEnds)
{
  expectError(errorOf("compute", { 60, 0, 20, 1 }, inputOf(forEver, false)),
    "one step did not finish within 1 s");
}

TEST_F(IsolatedRun, givesEachStepItsTime)
{
  EXPECT_EQ(errorOf("compute", { 60, 0, 20, 1 }, inputOf(2.5, true)), "");
  expectError(
    errorOf("compute", { 2, 0, 20, 1 }, inputOf(forEver, true)), "did not finish within 2 s");
}

/// As many at a time as there are threads that call.
TEST_F(IsolatedRun, runsOnSeveralThreads)
{
  std::vector<std::string> errors(4);
  std::vector<std::thread> threads;
  threads.reserve(errors.size());
  for (std::string& error : errors)
  {
    threads.emplace_back([&error] { error = errorOf("throw exception"); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(errors, std::vector<std::string>(4, "file: why"));
}

TEST_F(IsolatedRun, namesAProgramThatIsNotThere)
{
  const OtherReader other("/no/such/program");
  EXPECT_EQ(errorOf("echo"), "file: cannot be read: the program /no/such/program: No such file or "
                             "directory (set CADREFINE_READER to its path)");
}

TEST_F(IsolatedRun, namesAProgramThatIsAnother)
{
  const OtherReader other("/bin/true");
  EXPECT_EQ(errorOf("echo"), "file: cannot be read: the program /bin/true does not start, or "
                             "belongs to another version of CADRefine");
}

#ifdef __SSE2__
TEST_F(IsolatedRun, endsInTestsAtFloatingPointExceptions)
{
  expectError(errorOf("divide by zero"), "signal 8");
}
#endif

class ReadAttempts : public IsolatedRun
{
protected:
  static std::string answerOf(const std::string& job, const RunLimits& limits, const Bytes& input)
  {
    const Bytes answer = cadrefine::runAttempts(job, "file", limits, 2, input);
    return { answer.begin(), answer.end() };
  }

  /// Of computing, of the programs that have ended.
  static double secondsOfChildren()
  {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  }
};

TEST_F(ReadAttempts, leaveOutTheItemThatCrashesAmongThreads)
{
  EXPECT_EQ(answerOf("draw items", { 60 }, {}), "xxx-xxxx");
}

TEST_F(ReadAttempts, leaveOutWhatTakesTooLongAStep)
{
  EXPECT_EQ(answerOf("draw for ever", { 60, 0, 20, 1 }, inputOf(2)), "--xxxxxx");
}

TEST_F(ReadAttempts, keepToOneLimitTogether)
{
  const double before = secondsOfChildren();
  std::string reason;
  try
  {
    answerOf("draw for ever", { 3, 0, 20, 1 }, inputOf(8));
  }
  catch (const cadrefine::Error& error)
  {
    reason = error.what();
  }
  EXPECT_LT(secondsOfChildren() - before, 5);
  expectError(reason, "did not finish within");
}

TEST_F(ReadAttempts, tellOfAFailureThatOnlyThreadsHave)
{
  const std::string note = answerOf("tell notes", { 60, 1000 }, inputOf(false));
  expectError(note, "because it failed on several");
  expectError(note, "memory");
  EXPECT_EQ(answerOf("tell notes", { 60, 1000 }, inputOf(true)), "none")
    << "the item is left out, which is told";
}

} // namespace
