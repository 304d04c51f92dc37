// The ratios that the benchmarks are run for.
#pragma once

#include "ClosestPointCase.h"

#include <benchmark/benchmark.h>

#include <map>
#include <string>

namespace cadbenchmark
{

/// Prints what Google Benchmark prints, and keeps the median rate of each benchmark.
class RateReporter : public benchmark::ConsoleReporter
{
public:
  void ReportRuns(const std::vector<Run>& runs) override;
  /// Points a second; NaN where the benchmark "case/method" was not run.
  double rate(const std::string& name, const std::string& method) const;

private:
  std::map<std::string, double> rates_;
};

/// One row for each case: rates, their ratios to those of the peers, and what preparing it took.
void printTable(const std::vector<std::unique_ptr<const Case>>& cases, const RateReporter& rates);

} // namespace cadbenchmark
