#include "comm/Progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace cadrefine
{
namespace
{

/// The number with separators, such as "12,345".
std::string grouped(std::int64_t number)
{
  std::string text = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > 0; place -= 3)
  {
    text.insert(static_cast<std::size_t>(place), ",");
  }
  return text;
}

std::string inMillions(std::int64_t number)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", static_cast<double>(number) / 1e6);
  return text;
}

} // namespace

void Progress::say(double fraction, const std::string& text) const
{
  if (listener_)
  {
    listener_(begin_ + length_ * std::clamp(fraction, 0.0, 1.0), prefix_ + text);
  }
}

void Progress::count(const CountedWork& work, std::int64_t done, std::int64_t total) const
{
  if (!listener_ || total <= 0)
  {
    return;
  }
  const bool isMillions = total >= 1000000;
  const std::string numbers = isMillions
                                ? inMillions(done) + " of " + inMillions(total) + " million"
                                : grouped(done) + " of " + grouped(total);
  say(static_cast<double>(done) / static_cast<double>(total),
    std::string(work.doing) + " " + numbers + " " + work.things);
}

Progress::Part::Part(Progress& progress, double begin, double end, const std::string& prefix)
  : progress_(progress), begin_(progress.begin_), length_(progress.length_),
    prefixLength_(progress.prefix_.size())
{
  progress_.begin_ += begin * length_;
  progress_.length_ *= end - begin;
  progress_.prefix_ += prefix;
}

Progress::Part::~Part()
{
  progress_.begin_ = begin_;
  progress_.length_ = length_;
  progress_.prefix_.resize(prefixLength_);
}

void forCounted(const ParallelFor& parallelFor, const Progress& progress, const CountedWork& work,
  std::int64_t total, std::size_t count, const RangeBody& body)
{
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t firstBatch = 4096;
  constexpr std::chrono::milliseconds shortest(100);

  const bool isCounted = progress.isHeard() && *work.doing != '\0';
  std::size_t batch = isCounted ? firstBatch : count;
  for (std::size_t begin = 0; begin < count;)
  {
    const std::size_t size = std::min(batch, count - begin);
    if (isCounted)
    {
      const double part = static_cast<double>(begin) / static_cast<double>(count);
      progress.count(work, std::llround(part * static_cast<double>(total)), total);
    }
    const auto start = Clock::now();
    parallelFor(size, coarseGrain,
      [&](std::size_t first, std::size_t last) { body(begin + first, begin + last); });
    batch *= Clock::now() - start < shortest ? 2 : 1;
    begin += size;
  }
}

} // namespace cadrefine
