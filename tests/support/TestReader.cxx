// The program that reads CAD files, as tests want it: it also has jobs that go wrong, and floating
// point exceptions end it.

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/import/ReadJobs.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <new>
#include <stdexcept>
#include <unistd.h>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace
{

using cadrefine::ByteReader;
using cadrefine::ReadOptions;
using Bytes = std::vector<char>;

/// Its input, which is all of its answer.
Bytes echo(const std::string& /*context*/, ByteReader& input)
{
  return input.array<char>();
}

Bytes chatter(const std::string& /*context*/, ByteReader& /*input*/)
{
  std::cout << "chatter" << std::endl;
  std::cerr << "chatter" << std::endl;
  return Bytes(1);
}

Bytes throwError(const std::string& /*context*/, ByteReader& /*input*/)
{
  throw cadrefine::Error("reason");
}

Bytes throwException(const std::string& /*context*/, ByteReader& /*input*/)
{
  throw std::runtime_error("why");
}

Bytes throwNumber(const std::string& /*context*/, ByteReader& /*input*/)
{
  throw 1;
}

Bytes divideByZero(const std::string& /*context*/, ByteReader& /*input*/)
{
  volatile double zero = 0;
  const double result = 1 / zero;
  return Bytes(result > 0 ? 1 : 2);
}

/// At a place of its input.
Bytes crash(const std::string& /*context*/, ByteReader& input)
{
  const auto step = input.number<int>();
  const auto item = input.number<int>();
  cadrefine::noteStep(step, item);
  cadrefine::noteProgress();
  std::raise(SIGSEGV);
  return {};
}

Bytes killItself(const std::string& /*context*/, ByteReader& input)
{
  kill(getpid(), input.number<int>());
  return {};
}

Bytes fillMemory(const std::string& /*context*/, ByteReader& /*input*/)
{
  const std::vector<Bytes> blocks(300, Bytes(1 << 20, 'x'));
  return blocks.back();
}

Bytes standStill(const std::string& /*context*/, ByteReader& /*input*/)
{
  pause();
  return {};
}

/// For so many seconds, and tells so all the time or never.
Bytes compute(const std::string& /*context*/, ByteReader& input)
{
  const auto seconds = input.number<double>();
  const auto withNotes = input.number<bool>();
  while (static_cast<double>(std::clock()) < seconds * CLOCKS_PER_SEC)
  {
    if (withNotes)
    {
      cadrefine::noteProgress();
    }
  }
  return {};
}

/// Draws eight items, of which one crashes.
Bytes drawItems(const std::string& /*context*/, ByteReader& input)
{
  const ReadOptions options = cadrefine::takeOptions(input);
  Bytes result(8, 'x');
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
}

/// Draws eight items, of which the first come to no end, as many as its input says.
Bytes drawForEver(const std::string& /*context*/, ByteReader& input)
{
  const ReadOptions options = cadrefine::takeOptions(input);
  const auto endless = input.number<int>();
  Bytes result(8, 'x');
  for (int item = 0; item < 8; ++item)
  {
    options.noteItem(cadrefine::ReadStep::Drawing, item);
    const bool leftOut = options.withoutDrawings.count(item) > 0;
    for (volatile bool goesOn = item < endless && !leftOut; goesOn;)
    {
    }
    result[static_cast<std::size_t>(item)] = leftOut ? '-' : 'x';
  }
  return result;
}

/// The notes of an attempt, which fails on several threads, or over item 0 if its input says so.
Bytes tellNotes(const std::string& /*context*/, ByteReader& input)
{
  const ReadOptions options = cadrefine::takeOptions(input);
  const auto alsoOnOne = input.number<bool>();
  options.noteItem(cadrefine::ReadStep::Conversion, 0);
  if (options.threads > 1 || (alsoOnOne && options.withoutConversions.empty()))
  {
    throw std::bad_alloc();
  }
  const std::string note = options.notes().empty() ? "none" : options.notes().front();
  return { note.begin(), note.end() };
}

} // namespace

int main(int argc, char** argv)
{
#ifdef __SSE2__
  _mm_setcsr(_mm_getcsr() & ~(_MM_MASK_INVALID | _MM_MASK_DIV_ZERO | _MM_MASK_OVERFLOW));
#endif
  cadrefine::RunJobs jobs = cadrefine::readJobs();
  jobs.insert({ { "echo", echo }, { "chatter", chatter }, { "throw error", throwError },
    { "throw exception", throwException }, { "throw number", throwNumber },
    { "divide by zero", divideByZero }, { "crash", crash }, { "kill itself", killItself },
    { "fill memory", fillMemory }, { "stand still", standStill }, { "compute", compute },
    { "draw items", drawItems }, { "draw for ever", drawForEver }, { "tell notes", tellNotes } });
  return cadrefine::serveRun(argc, argv, jobs);
}
