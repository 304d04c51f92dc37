#include "ProjectionStep.h"

#include "ArrayTransfer.h"
#include "Error.h"
#include "InitialProjection.h"
#include "MeshSummary.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

ProjectionResult projectCells(
  const StepContext& context, DistributedMesh& mesh, ProjectionOptions options)
{
  context.exchange.progress().say(0.05, "finding the boundary");
  const Progress::Part part(context.exchange.progress(), 0.1, 1);
  const DistributedBoundary boundary = findBoundary(context.exchange, mesh, context.model);
  const BoundaryProjector projector(context.model, boundary.kind);
  const std::string warning = warningOfInvalidCells(context.exchange, mesh);
  options.mendCells = !warning.empty();
  if (options.mendCells && context.exchange.rank() == 0)
  {
    context.warn(warning);
  }
  return projectBoundary(context.exchange, mesh, projector, boundary, options);
}

/// Why no vertex lies on the CAD.
std::string reasonOfNone(std::int64_t projectedPoints, const ProjectionOptions& options)
{
  const std::string none = "no vertex was put onto the CAD: ";
  if (projectedPoints == 0)
  {
    return none + "there is no boundary in the region (Region)";
  }
  return none + (options.maximumDistance > 0
                    ? "all of the boundary is farther from it than MaximumDistance, or stands "
                      "across it"
                    : "all of the boundary is farther from it than its longest edges, or stands "
                      "across it; do mesh and CAD have the same place and unit of length "
                      "(MaximumDistance lets vertices go farther)?");
}

} // namespace

ProjectionOptions makeProjectionOptions(const double* region, double maximumDistance)
{
  ProjectionOptions options;
  options.maximumDistance = maximumDistance;
  if (region)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!(region[2 * axis] <= region[2 * axis + 1]))
      {
        throw Error("the region is empty (Region): a lower bound is above its upper one");
      }
    }
    std::copy_n(region, 6, options.region.emplace().begin());
  }
  return options;
}

StepResult projectMesh(const StepContext& context, vtkPointSet* input, ProjectionOptions options)
{
  RankExchange& exchange = context.exchange;
  exchange.progress().say(0, "reading the mesh");
  DistributedMesh mesh = makeDistributedMesh(exchange, input);
  const ProjectionResult result = mesh.mesh().dimension == 0
                                    ? projectPoints(exchange, mesh, context.model, options)
                                    : projectCells(context, mesh, options);

  recordBalance(context.statistics, "points", result.balance);
  context.statistics.set("points that gave up", static_cast<double>(result.slowPoints));

  vtkSmartPointer<vtkPointSet> output = makePointSet(input, mesh.mesh());
  ArrayRoute route;
  route.convert(input, mesh.converted);
  copyArrays(input, mesh.converted, output);
  writeClassification(output, result.classification);
  writeConflicts(output, result.conflicts);
  output->GetPointData()->SetActiveScalars(arrays::entity);
  summariseMesh(exchange, mesh, summariseQuality(exchange, mesh), output);
  summariseProjection(exchange, mesh, result.classification, result.projectedPoints, output);
  if (exchange.rank() == 0 &&
      output->GetFieldData()->GetArray("CADVertices")->GetComponent(0, 0) == 0)
  {
    context.warn(reasonOfNone(result.projectedPoints, options));
  }
  summariseConflicts(exchange, mesh, result.conflicts, output);
  return { output, std::move(route) };
}

} // namespace cadrefine
