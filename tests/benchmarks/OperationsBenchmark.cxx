// What local operations cost in each step of an adaptation, and what comes of them.
//
//   operations_benchmark CAD MESH uniform|longest-edge STEPS [cut-only]
//
// Projects the mesh and adapts it, on one rank and thread: uniformly, or by half of the geometric
// error in each step. A row a step: cells, vertices off the CAD, least mean ratio, invalid cells,
// seconds of the processor for projection or refinement (in which operations are) and for measuring
// the error before, operations, and how many a second in the kernel alone.
#include "fields/CADArrays.h"
#include "pipeline/ErrorMeasurement.h"
#include "pipeline/Projection.h"
#include "pipeline/Refinement.h"

#include <cadrefine/cad/import/CADFile.h>

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>

namespace
{

using namespace cadrefine;

constexpr double errorFraction = 0.5;

struct Settings
{
  bool isUniform = false;
  int steps = 0;
  std::optional<double> minimumQuality;
};

class Run
{
public:
  Run(RankExchange& exchange, const CADModel& model, const Settings& settings)
    : exchange_(exchange), model_(model), settings_(settings)
  {
  }

  void all(vtkPointSet* input)
  {
    MeshState state = readMesh(exchange_, input);
    state.remembers = true;
    state.mapping.require({ false, {} }); // the meshes have no fields
    ProjectionOptions projection;
    projection.minimumQuality = settings_.minimumQuality;
    RefinementOptions refinement;
    refinement.uniform = settings_.isUniform;
    refinement.minimumQuality = settings_.minimumQuality;
    refinement.cutFacets = true;
    refinement.criteria = { { arrays::error, MarkingCriterion::Strategy::Bulk, errorFraction } };
    std::printf(
      "| step | cells | off | least | invalid | refine: s | measure: s | operations | a second |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
    const auto nothing = [](const PipelineContext&) {};
    step(0, state, nothing,
      [&](const PipelineContext& context) { projectMesh(context, state, projection); });
    for (int k = 1; k <= settings_.steps; ++k)
    {
      step(
        k, state, [&](const PipelineContext& context) { measureMesh(context, state, 0, {}); },
        [&](const PipelineContext& context) { refineMesh(context, state, refinement); });
    }
  }

private:
  PipelineContext contextOf(RunStatistics& statistics) const
  {
    return { exchange_, model_, statistics, [](const std::string&) {} };
  }

  using Work = std::function<void(const PipelineContext&)>;

  static double secondsOf(const Work& work, const PipelineContext& context)
  {
    const std::clock_t start = std::clock();
    work(context);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }

  void step(int number, const MeshState& state, const Work& measure, const Work& change)
  {
    RunStatistics statistics;
    const PipelineContext context = contextOf(statistics);
    const double ofMeasuring = secondsOf(measure, context);
    const double ofChange = secondsOf(change, context);
    const auto figure = [&](const char* name)
    {
      const auto found = statistics.figures().find(name);
      return found == statistics.figures().end() ? 0 : found->second;
    };
    const auto value = [&](const char* name)
    { return state.arrays.ofMesh->GetArray(name)->GetComponent(0, 0); };
    const double operations = figure("local operations");
    std::printf("| %d | %.0f | %.0f | %.4f | %.0f | %.3f | %.3f | %.0f | %.0f |\n", number,
      value("GlobalCells"), value("UnprojectedVertices"), value("MinimumQuality"),
      value("InvalidCells"), ofChange, ofMeasuring, operations,
      operations > 0 ? operations / figure("seconds operation kernels") : 0);
    std::fflush(stdout);
  }

  RankExchange& exchange_;
  const CADModel& model_;
  const Settings settings_;
};

} // namespace

int main(int argc, char** argv)
{
  if (argc < 5)
  {
    std::fprintf(
      stderr, "usage: operations_benchmark CAD MESH uniform|longest-edge STEPS [cut-only]\n");
    return 1;
  }
  setenv("VTK_SMP_MAX_THREADS", "1", 1);
  Settings settings;
  settings.isUniform = std::strcmp(argv[3], "uniform") == 0;
  settings.steps = std::atoi(argv[4]);
  if (argc < 6)
  {
    settings.minimumQuality = 0.1;
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(argv[2]);
  reader->Update();
  const auto model = readCADFile(argv[1]);
  RankExchange exchange(nullptr);
  Run(exchange, *model, settings).all(reader->GetOutput());
  return 0;
}
