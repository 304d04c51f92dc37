// What one run of a filter cost.
#pragma once

#include "comm/RankExchange.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace cadrefine
{

/// Figures by name, such as "seconds projection": times, bytes, how evenly work lay on the ranks.
/// They differ from run to run, so they do not belong into a filter's output.
class RunStatistics
{
public:
  /// Adds the wall clock time from its construction to its end to the figure `name`.
  class Stopwatch
  {
  public:
    Stopwatch(RunStatistics& statistics, const std::string& name);
    ~Stopwatch();
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

  private:
    double& seconds_; ///< Made in the beginning, as the end must not fail.
    std::chrono::steady_clock::time_point start_;
  };

  void clear() { figures_.clear(); }
  void set(const std::string& name, double value) { figures_[name] = value; }
  void add(const std::string& name, double value) { figures_[name] += value; }
  const std::map<std::string, double>& figures() const { return figures_; }

  /// Takes over the figures of a part of the run: those that begin with "seconds" are added, others
  /// replaced.
  void take(const RunStatistics& part);

  /// What this rank has sent up to now.
  struct Sent
  {
    double seconds = 0; ///< Time of sending, receiving and waiting.
    std::int64_t bytes = 0;
    std::int64_t messages = 0;
  };
  static Sent sentBy(const RankExchange& exchange);

  /// Makes each figure the largest of all ranks, which must have the same names, and adds what the
  /// ranks sent since `before` (default: since `exchange` was made): "seconds exchange" (which are
  /// part of the other times), "bytes sent" and "messages sent" by all ranks, and "largest bytes
  /// sent" by one. Collective; two reductions.
  void gather(RankExchange& exchange, const Sent& before);
  void gather(RankExchange& exchange) { gather(exchange, Sent{}); }

  /// The figures as a JSON object.
  std::string json() const;

private:
  std::map<std::string, double> figures_;
};

} // namespace cadrefine
