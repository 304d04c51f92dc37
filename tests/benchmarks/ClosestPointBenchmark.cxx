// Closest point queries against Open CASCADE's, in one run, on one thread, interleaved:
//   nearest         the nearest point of the whole trimmed model
//   known           the nearest point of the entity that `nearest` found
//   surface         the nearest point of the untrimmed surface of the face
//   GenLocateExtPS  Open CASCADE's Newton method with the right face, as NURBS, and a good start
//   GenLocateAsRead the same on the surface that the file has: a plane, a cylinder, ...
//   DistShapeShape  Open CASCADE's search of the whole model (few points: it is slow)
// Arguments are CAD files to measure besides the models below, each under its name without the
// extension, and Google Benchmark's options, for example --benchmark_filter=bearing.

#include "ClosestPointCase.h"
#include "ClosestPointPeer.h"
#include "ClosestPointTable.h"

#include <cadrefine/base/Error.h>

#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace
{

using namespace cadbenchmark;

constexpr int pointsOfCase = 4096;
constexpr int pointsOfSlowPeer = 16;
const std::string data = CADREFINE_DATA "/";
const std::string occ = "/usr/share/opencascade/data/";
const std::string deal = "/usr/share/doc/libdeal.ii-doc/examples/step-54/input/";

const std::vector<std::string> aeroplane = { data + "aeroplane.igs", data + "aeroplane.step",
  data + "aeroplane.brep" };

const std::vector<CaseSource> sources = {
  { "bearing", { occ + "iges/bearing.iges" }, {} },
  { "hammer", { occ + "iges/hammer.iges" }, {} },
  { "bow", { deal + "DTMB-5415_bulbous_bow.iges" }, {} },
  { "naca_sharp", { data + "naca0012_sharp.igs" }, {} },
  { "naca_blunt", { data + "naca0012_blunt.igs" }, {} },
  { "ball", { occ + "occ/Ball.brep" }, {} },
  { "top", { occ + "occ/Top.brep" }, {} },
  { "motor", { occ + "occ/Motor-c.brep" }, {} },
  { "aeroplane", aeroplane, {} },
  { "nose", aeroplane, Region{ { 0.05, -0.25, -0.2 }, { 0.2, 0.25, 0.2 } } },
};

/// Runs `query(i)` over the points of the case, round and round.
template<typename Query>
void measure(benchmark::State& state, std::size_t points, const Query& query)
{
  std::size_t i = 0;
  for (auto _ : state)
  {
    double distance = query(i);
    benchmark::DoNotOptimize(distance);
    i = i + 1 == points ? 0 : i + 1;
  }
  state.SetItemsProcessed(state.iterations());
}

template<typename Query>
benchmark::internal::Benchmark* add(
  const Case& c, const std::string& method, std::size_t points, const Query& query)
{
  return benchmark::RegisterBenchmark((c.name + "/" + method).c_str(),
    [points, query](benchmark::State& state) { measure(state, points, query); });
}

void addBenchmarks(
  const Case& c, const OpenCascadePeer& peer, std::vector<cadrefine::EntityId>& known)
{
  const auto& search = *c.search;
  const auto& points = c.scattered;
  const std::size_t count = points.size();
  for (const Sample& sample : points)
  {
    known.push_back(search.nearest(sample.point).entity);
  }
  add(c, "nearest", count, [&](std::size_t i) { return search.nearest(points[i].point).distance; });
  add(c, "known", count,
    [&](std::size_t i) { return search.nearestOn(known[i], points[i].point).distance; });
  add(c, "surface", count,
    [&](std::size_t i)
    { return search.nearestOnSurface(points[i].face, points[i].point).distance; });
  add(c, "GenLocateExtPS", count, [&](std::size_t i) { return peer.locate(i); });
  add(c, "GenLocateAsRead", count, [&](std::size_t i) { return peer.locateAsRead(i); });
  add(c, "DistShapeShape", pointsOfSlowPeer, [&](std::size_t i) { return peer.search(i); })
    ->Iterations(pointsOfSlowPeer)
    ->Repetitions(3);
}

/// Of the models above those that are there, then of the files.
std::vector<std::unique_ptr<const Case>> loadCases(const std::vector<std::string>& files)
{
  std::vector<std::unique_ptr<const Case>> cases;
  for (const CaseSource& source : sources)
  {
    if (auto loaded = loadCase(source, pointsOfCase))
    {
      cases.push_back(std::move(loaded));
    }
  }
  for (const std::string& file : files)
  {
    auto loaded =
      loadCase({ std::filesystem::path(file).stem().string(), { file }, {} }, pointsOfCase);
    if (!loaded)
    {
      throw cadrefine::Error(file + ": no such file");
    }
    cases.push_back(std::move(loaded));
  }
  return cases;
}

void run(const std::vector<std::string>& files)
{
  const std::vector<std::unique_ptr<const Case>> cases = loadCases(files);
  std::vector<std::unique_ptr<const OpenCascadePeer>> peers;
  std::vector<std::vector<cadrefine::EntityId>> known(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
  {
    peers.push_back(std::make_unique<const OpenCascadePeer>(*cases[i]));
    addBenchmarks(*cases[i], *peers[i], known[i]);
  }
  RateReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  printTable(cases, reporter);
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<char*> arguments(argv, argv + argc);
  std::string defaults[] = { "--benchmark_repetitions=5", "--benchmark_min_time=0.2",
    "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true" };
  for (std::string& argument : defaults)
  {
    arguments.insert(arguments.begin() + 1, argument.data());
  }
  argc = static_cast<int>(arguments.size());
  benchmark::Initialize(&argc, arguments.data());
  try
  {
    run({ arguments.begin() + 1, arguments.begin() + argc });
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
