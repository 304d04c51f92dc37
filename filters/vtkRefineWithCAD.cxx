#include "vtkRefineWithCAD.h"

#include "Agreement.h"
#include "ArrayAccess.h"
#include "ArrayTransfer.h"
#include "Balancing.h"
#include "DistributedRefinement.h"
#include "Error.h"
#include "EvenWork.h"
#include "MeshSummary.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>

namespace
{

using namespace cadrefine;

/// The refinement of one data set, level by level.
class Refiner
{
public:
  Refiner(RankExchange& exchange, vtkRefineWithCAD* settings, const CADModel& model,
    RunStatistics& statistics)
    : Exchange(exchange), Settings(settings), Model(model), Statistics(statistics)
  {
  }

  vtkSmartPointer<vtkPointSet> Run(vtkPointSet* input)
  {
    vtkSmartPointer<vtkPointSet> source = input;
    this->Load(source);
    this->LookForInvalidCells();
    RefinementPlan plan = this->MakePlan();
    if (this->Settings->GetBalance() && this->Exchange.size() > 1)
    {
      const auto balanced = this->BalanceCells(source, plan);
      if (balanced != source)
      {
        source = balanced;
        this->Load(source);
        plan = this->MakePlan();
      }
    }
    this->ReadPositions(source);
    source = nullptr;
    this->RefineOnce(plan);
    this->Statistics.set("new cells imbalance after",
      findImbalance(this->Exchange, static_cast<std::int64_t>(this->Mesh.mesh().cellCount())));
    for (int level = 1; level < this->Settings->GetLevels(); ++level)
    {
      this->RefineOnce(this->MakePlan());
    }
    return this->MakeOutput(input);
  }

private:
  RunStatistics::Stopwatch Watch(const char* name)
  {
    return RunStatistics::Stopwatch(this->Statistics, name);
  }

  void Load(vtkPointSet* source)
  {
    const auto watch = this->Watch("seconds reading cells");
    this->Mesh = makeDistributedMesh(this->Exchange, source);
    if (this->Mesh.mesh().dimension == 0)
    {
      throw Error("the mesh has no triangles or tetrahedra to refine");
    }
    this->Arrays = readArrays(source, this->Mesh.converted);
  }

  void LookForInvalidCells()
  {
    const std::string warning = warningOfInvalidCells(this->Exchange, this->Mesh);
    this->HasInvalidCells = !warning.empty();
    if (this->HasInvalidCells && this->Exchange.rank() == 0)
    {
      vtkWarningWithObjectMacro(this->Settings, << warning);
    }
  }

  NewVertices WhatBecomesOfNewVertices() const
  {
    if (!this->Settings->GetProjectNewVertices())
    {
      return NewVertices::StayStraight;
    }
    return this->HasInvalidCells ? NewVertices::MoveAndMend : NewVertices::MoveOntoCAD;
  }

  /// The data set with its cells where the plan makes equal work; `source` itself if they are.
  vtkSmartPointer<vtkPointSet> BalanceCells(vtkPointSet* source, const RefinementPlan& plan)
  {
    const auto watch = this->Watch("seconds balancing");
    std::vector<std::int64_t> weights;
    weights.reserve(this->Mesh.mesh().cellCount());
    for (const auto& firsts : countChildren(this->Mesh.mesh(), plan))
    {
      std::transform(firsts.begin() + 1, firsts.end(), firsts.begin(), std::back_inserter(weights),
        [](Index end, Index first) { return end - first; });
    }
    this->Statistics.set("new cells imbalance before",
      findImbalance(
        this->Exchange, std::accumulate(weights.begin(), weights.end(), std::int64_t{ 0 })));
    return isBalanced(this->Exchange, this->Mesh, weights)
             ? vtkSmartPointer<vtkPointSet>(source)
             : redistribute(this->Exchange, this->Mesh, source, weights);
  }

  void ReadPositions(vtkPointSet* source)
  {
    const auto watch = this->Watch("seconds projection");
    this->Classified =
      this->Settings->GetProjectNewVertices() || this->Exchange.any(hasClassification(source));
    if (this->Classified)
    {
      attempt(this->Exchange,
        [&] {
          this->Positions = readClassification(source, this->Mesh.converted.pointOf, this->Model);
        });
    }
  }

  std::vector<unsigned char> MarkCells() const
  {
    const SimplexMesh& mesh = this->Mesh.mesh();
    const std::size_t count = this->Mesh.converted.cellIds[mesh.dimension].size();
    const std::string name = this->Settings->GetMarkingArray();
    if (name.empty() || name == "None" || count == 0) // the panel's entry for no array
    {
      return std::vector<unsigned char>(count, 1);
    }
    vtkDataArray* array = this->Arrays.ofCells->GetArray(name.c_str());
    if (!array)
    {
      throw Error("the mesh has no cell array " + name + " to mark cells by (MarkingArray)");
    }
    if (array->GetNumberOfComponents() != 1)
    {
      throw Error("the marking array " + name + " has " +
                  std::to_string(array->GetNumberOfComponents()) + " components instead of one");
    }
    std::vector<double> values(array->GetNumberOfTuples());
    copyValues(array, values.data());
    std::vector<unsigned char> marks(count);
    const double threshold = this->Settings->GetThreshold();
    std::transform(values.begin() + firstCellOfDimension(mesh, mesh.dimension), values.end(),
      marks.begin(), [&](double value) { return value > threshold; });
    return marks;
  }

  RefinementPlan MakePlan()
  {
    const auto watch = this->Watch("seconds marking");
    if (this->Settings->GetMethod() == vtkRefineWithCAD::UNIFORM_BISECTION)
    {
      return planUniform(this->Exchange, this->Mesh);
    }
    std::vector<unsigned char> marks;
    attempt(this->Exchange, [&] { marks = this->MarkCells(); });
    return planLongestEdge(this->Exchange, this->Mesh, marks);
  }

  void RefineOnce(const RefinementPlan& plan)
  {
    const RefinementTrace trace =
      this->Classified ? refineOntoCAD(this->Exchange, this->Mesh, plan, this->Model,
                           this->Positions, this->WhatBecomesOfNewVertices(), this->Statistics)
                       : refine(this->Exchange, this->Mesh, plan, this->Statistics);
    this->ProjectedPoints += trace.projectedPoints;
    const auto watch = this->Watch("seconds copying fields");
    this->Arrays = refineArrays(this->Arrays, trace.parentEdges, trace.firstChildren);
  }

  /// In the class of `prototype`.
  vtkSmartPointer<vtkPointSet> MakeOutput(vtkPointSet* prototype)
  {
    vtkSmartPointer<vtkPointSet> output;
    {
      const auto watch = this->Watch("seconds writing cells");
      output = makePointSet(prototype, this->Mesh.mesh());
      setArrays(this->Arrays, this->Mesh.converted, output);
    }
    const auto watch = this->Watch("seconds summary");
    if (this->Classified)
    {
      writeClassification(output, this->Positions);
      summariseProjection(
        this->Exchange, this->Mesh, this->Positions, this->ProjectedPoints, output);
    }
    summariseMesh(this->Exchange, this->Mesh, summariseQuality(this->Exchange, this->Mesh), output);
    return output;
  }

  RankExchange& Exchange;
  vtkRefineWithCAD* Settings;
  const CADModel& Model;
  RunStatistics& Statistics;
  DistributedMesh Mesh;
  MeshArrays Arrays;
  bool Classified = false;      ///< The mesh knows its places on the CAD.
  bool HasInvalidCells = false; ///< Of the input.
  Classification Positions;
  std::int64_t ProjectedPoints = 0;
};

} // namespace

vtkStandardNewMacro(vtkRefineWithCAD);

vtkRefineWithCAD::vtkRefineWithCAD() : vtkSimplexMeshAlgorithm(true) {}

vtkRefineWithCAD::~vtkRefineWithCAD() = default;

void vtkRefineWithCAD::Execute(cadrefine::RankExchange& exchange, vtkPointSet* input,
  const cadrefine::CADModel* model, vtkPointSet* output)
{
  output->ShallowCopy(Refiner(exchange, this, *model, *this->Statistics).Run(input));
}

void vtkRefineWithCAD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Levels: " << this->Levels << "\n";
  os << indent << "MarkingArray: " << this->MarkingArray << "\n";
  os << indent << "Threshold: " << this->Threshold << "\n";
  os << indent << "ProjectNewVertices: " << this->ProjectNewVertices << "\n";
  os << indent << "Balance: " << this->Balance << "\n";
}
