#include "ClosestPointTable.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace cadbenchmark
{

void RateReporter::ReportRuns(const std::vector<Run>& runs)
{
  benchmark::ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs)
  {
    const auto counter = run.counters.find("items_per_second");
    if (run.aggregate_name == "median" && counter != run.counters.end())
    {
      rates_[run.run_name.function_name] = counter->second;
    }
  }
}

double RateReporter::rate(const std::string& name, const std::string& method) const
{
  const auto found = rates_.find(name + "/" + method);
  return found == rates_.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

void printTable(const std::vector<std::unique_ptr<const Case>>& cases, const RateReporter& rates)
{
  std::printf(
    "\nPoints a second, in thousands (medians of processor time), and ratios of nearest to the "
    "peers, of known and surface to nearest\n"
    "%-24s %6s %7s | %8s %8s %8s %8s %8s | %8s %8s %8s %8s %8s\n",
    "", "faces", "patches", "nearest", "known", "surface", "GenLoc", "as read", "/GenLoc",
    "/as read", "/BRepEx", "known", "surface");
  for (const auto& c : cases)
  {
    const auto rate = [&](const char* method) { return rates.rate(c->name, method); };
    const double nearest = rate("nearest");
    if (std::isnan(nearest)) // left out by --benchmark_filter
    {
      continue;
    }
    std::printf("%-24s %6d %7zu | %8.1f %8.1f %8.1f %8.1f %8.1f | %8.2f %8.2f %8.0f %8.2f %8.2f\n",
      c->name.c_str(), c->nurbs.count(2), c->preparation.patches, nearest / 1e3,
      rate("known") / 1e3, rate("surface") / 1e3, rate("GenLocateExtPS") / 1e3,
      rate("GenLocateAsRead") / 1e3, nearest / rate("GenLocateExtPS"),
      nearest / rate("GenLocateAsRead"), nearest / rate("DistShapeShape"), rate("known") / nearest,
      rate("surface") / nearest);
  }
  std::printf("\nPreparation\n%-24s %8s %8s %10s %8s %12s\n", "", "read s", "build s", "build/read",
    "MB", "bytes/patch");
  for (const auto& c : cases)
  {
    const Preparation& p = c->preparation;
    std::printf("%-24s %8.3f %8.3f %10.2f %8.2f %12.0f\n", c->name.c_str(), p.readSeconds,
      p.buildSeconds, p.buildSeconds / p.readSeconds, 1e-6 * static_cast<double>(p.bytes),
      static_cast<double>(p.bytes) / static_cast<double>(p.patches));
  }
}

} // namespace cadbenchmark
