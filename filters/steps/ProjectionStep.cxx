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
#include <cmath>
#include <limits>
#include <sstream>
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

/// Diagonal of the box round the vertices of all ranks.
double findSize(RankExchange& exchange, const std::vector<Point3>& points)
{
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> low(3, infinity);
  std::vector<double> high(3, -infinity);
  for (const Point3& point : points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = std::min(low[axis], point[axis]);
      high[axis] = std::max(high[axis], point[axis]);
    }
  }
  low = exchange.min(low);
  high = exchange.max(high);
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

/// A mesh in other units, or elsewhere, would look like one that is exact: its error is 0.
void warnOfNothingProjected(
  const StepContext& context, const DistributedMesh& mesh, const ProjectionOptions& options)
{
  const double size = findSize(context.exchange, mesh.mesh().points);
  if (context.exchange.rank() == 0)
  {
    std::ostringstream text;
    text << "no vertex of the mesh" << (options.region ? " in the region" : "")
         << " lies on the CAD. The mesh measures " << size << " across, the CAD "
         << context.model.size() << "; are they in the same unit and place?";
    context.warn(text.str());
  }
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
  summariseConflicts(exchange, mesh, result.conflicts, output);
  if (output->GetFieldData()->GetArray("CADVertices")->GetTuple1(0) == 0)
  {
    warnOfNothingProjected(context, mesh, options);
  }
  return { output, std::move(route) };
}

} // namespace cadrefine
