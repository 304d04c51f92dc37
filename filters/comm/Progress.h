// How far a run is, for the person who waits for it.
#pragma once

#include <cadrefine/base/ParallelFor.h>

#include <cstdint>
#include <functional>
#include <string>

namespace cadrefine
{

/// Work that is counted: {"projecting", "vertices"} is told as "projecting 1.2 of 4.0 million
/// vertices". Empty: nothing is told.
struct CountedWork
{
  const char* doing = "";
  const char* things = "";
};

/// Tells how far the work is, as a part of the whole and a text. Each rank tells its own listener;
/// nothing is communicated, and no result depends on it. Called by the thread that runs the filter.
class Progress
{
public:
  /// Takes a fraction from 0 to 1 and a text.
  using Listener = std::function<void(double, const std::string&)>;

  void tell(Listener listener) { listener_ = std::move(listener); }
  bool isHeard() const { return static_cast<bool>(listener_); }

  /// Tells a text, and that `fraction` of the part that is at work is done.
  void say(double fraction, const std::string& text) const;

  /// Tells that `done` of `total` things are done.
  void count(const CountedWork& work, std::int64_t done, std::int64_t total) const;

  /// As long as it exists, fractions are those of a part of what they were, and texts begin with
  /// `prefix`.
  class Part
  {
  public:
    Part(Progress& progress, double begin, double end, const std::string& prefix = "");
    ~Part();
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

  private:
    Progress& progress_;
    double begin_;
    double length_;
    std::size_t prefixLength_;
  };

private:
  Listener listener_;
  double begin_ = 0;
  double length_ = 1;
  std::string prefix_;
};

/// The loop parallelFor(count, coarseGrain, body), in pieces of some tenths of a second, after each
/// of which the progress is counted: the part of `count` that is done, as a part of `total` (of all
/// ranks, which have about the same share). In one piece where nobody listens.
void forCounted(const ParallelFor& parallelFor, const Progress& progress, const CountedWork& work,
  std::int64_t total, std::size_t count, const RangeBody& body);

} // namespace cadrefine
