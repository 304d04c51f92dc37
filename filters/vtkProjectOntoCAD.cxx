#include "vtkProjectOntoCAD.h"

#include "ArrayTransfer.h"
#include "Error.h"
#include "InitialProjection.h"
#include "MeshSummary.h"

#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <string>

vtkStandardNewMacro(vtkProjectOntoCAD);

vtkProjectOntoCAD::vtkProjectOntoCAD() : vtkSimplexMeshAlgorithm(true) {}

vtkProjectOntoCAD::~vtkProjectOntoCAD() = default;

void vtkProjectOntoCAD::Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
  const cadrefine::CADModel* model, vtkPointSet* output)
{
  using namespace cadrefine;
  ProjectionOptions options;
  options.maximumDistance = this->MaximumDistance;
  if (this->UseRegion)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!(this->Region[2 * axis] <= this->Region[2 * axis + 1]))
      {
        throw Error("the region is empty (Region): a lower bound is above its upper one");
      }
    }
    std::copy_n(this->Region, 6, options.region.emplace().begin());
  }

  DistributedMesh mesh = makeDistributedMesh(exchange, input);
  ProjectionResult result;
  if (mesh.mesh().dimension == 0)
  {
    result = projectPoints(exchange, mesh, *model, options);
  }
  else
  {
    const DistributedBoundary boundary = findBoundary(exchange, mesh, *model);
    const BoundaryProjector projector(*model, boundary.kind);
    const std::string warning = warningOfInvalidCells(exchange, mesh);
    options.mendCells = !warning.empty();
    if (options.mendCells && exchange.rank() == 0)
    {
      vtkWarningMacro(<< warning);
    }
    result = projectBoundary(exchange, mesh, projector, boundary, options);
  }

  recordBalance(*this->Statistics, "points", result.balance);
  this->Statistics->set("points that gave up", static_cast<double>(result.slowPoints));

  output->ShallowCopy(makePointSet(input, mesh.mesh()));
  copyArrays(input, mesh.converted, output);
  writeClassification(output, result.classification);
  writeConflicts(output, result.conflicts);
  summariseMesh(exchange, mesh, summariseQuality(exchange, mesh), output);
  summariseProjection(exchange, mesh, result.classification, result.projectedPoints, output);
  summariseConflicts(exchange, mesh, result.conflicts, output);
}

void vtkProjectOntoCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseRegion: " << this->UseRegion << "\n";
  os << indent << "Region:";
  for (const double bound : this->Region)
  {
    os << " " << bound;
  }
  os << "\n" << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
}
