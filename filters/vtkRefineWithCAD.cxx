#include "vtkRefineWithCAD.h"

#include "Agreement.h"
#include "ArrayTransfer.h"
#include "Balancing.h"
#include "DistributedRefinement.h"
#include "Error.h"
#include "MeshSummary.h"

#include <vtkCellData.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>

#include <algorithm>

namespace
{

using namespace cadrefine;

/// The refinement of one data set, level by level.
class Refiner
{
public:
  Refiner(RankExchange& exchange, vtkRefineWithCAD* settings, const CADModel& model)
    : Exchange(exchange), Settings(settings), Model(model)
  {
  }

  vtkSmartPointer<vtkPointSet> Run(vtkPointSet* input)
  {
    this->Load(input, input);
    if (this->Settings->GetBalance() && this->Exchange.size() > 1)
    {
      this->BalanceCells();
    }
    this->Classified = this->Settings->GetProjectNewVertices() ||
                       this->Exchange.any(hasClassification(this->Current));
    if (this->Classified)
    {
      attempt(this->Exchange,
        [&]
        {
          this->Positions =
            readClassification(this->Current, this->Mesh.converted.pointOf, this->Model);
        });
    }
    for (int level = 0; level < this->Settings->GetLevels(); ++level)
    {
      this->RefineOnce();
    }
    this->Summarise();
    return this->Current;
  }

private:
  /// Makes the data set with ids, and cells in the order of their dimension, current; in the class
  /// of `prototype`.
  void Load(vtkPointSet* input, vtkPointSet* prototype)
  {
    this->Mesh = makeDistributedMesh(this->Exchange, input);
    if (this->Mesh.mesh().dimension == 0)
    {
      throw Error("the mesh has no triangles or tetrahedra to refine");
    }
    this->Current = makePointSet(prototype, this->Mesh.mesh());
    copyArrays(input, this->Mesh.converted, this->Current);
    this->NumberPointsAsVertices();
  }

  void NumberPointsAsVertices()
  {
    auto& pointOf = this->Mesh.converted.pointOf;
    pointOf.resize(this->Mesh.mesh().points.size());
    for (std::size_t v = 0; v < pointOf.size(); ++v)
    {
      pointOf[v] = static_cast<vtkIdType>(v);
    }
  }

  void BalanceCells()
  {
    const RefinementPlan plan = this->MakePlan();
    std::vector<std::int64_t> weights;
    for (const auto& children : countChildren(this->Mesh.mesh(), plan))
    {
      weights.insert(weights.end(), children.begin(), children.end());
    }
    const auto coarse = this->Current;
    this->Load(redistribute(this->Exchange, this->Mesh, coarse, weights), coarse);
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
    vtkDataArray* values = this->Current->GetCellData()->GetArray(name.c_str());
    if (!values)
    {
      throw Error("the mesh has no cell array " + name + " to mark cells by (MarkingArray)");
    }
    if (values->GetNumberOfComponents() != 1)
    {
      throw Error("the marking array " + name + " has " +
                  std::to_string(values->GetNumberOfComponents()) + " components instead of one");
    }
    std::vector<unsigned char> marks(count);
    const vtkIdType first = firstCellOfDimension(mesh, mesh.dimension);
    for (std::size_t c = 0; c < count; ++c)
    {
      marks[c] =
        values->GetTuple1(first + static_cast<vtkIdType>(c)) > this->Settings->GetThreshold();
    }
    return marks;
  }

  RefinementPlan MakePlan()
  {
    if (this->Settings->GetMethod() == vtkRefineWithCAD::UNIFORM_BISECTION)
    {
      return planUniform(this->Exchange, this->Mesh);
    }
    std::vector<unsigned char> marks;
    attempt(this->Exchange, [&] { marks = this->MarkCells(); });
    return planLongestEdge(this->Exchange, this->Mesh, marks);
  }

  void RefineOnce()
  {
    const RefinementPlan plan = this->MakePlan();
    const auto newVertices = this->Settings->GetProjectNewVertices() ? NewVertices::MoveOntoCAD
                                                                     : NewVertices::StayStraight;
    const RefinementTrace trace = this->Classified ? refineOntoCAD(this->Exchange, this->Mesh, plan,
                                                       this->Model, this->Positions, newVertices)
                                                   : refine(this->Exchange, this->Mesh, plan);
    this->ProjectedPoints += trace.projectedPoints;
    auto fine = makePointSet(this->Current, this->Mesh.mesh());
    refineArrays(this->Current, this->Mesh.converted, trace, fine);
    this->Current = fine;
    this->NumberPointsAsVertices();
  }

  void Summarise()
  {
    if (this->Classified)
    {
      writeClassification(this->Current, this->Positions);
      summariseProjection(
        this->Exchange, this->Mesh, this->Positions, this->ProjectedPoints, this->Current);
    }
    summariseMesh(
      this->Exchange, this->Mesh, measureQuality(this->Exchange, this->Mesh), this->Current);
  }

  RankExchange& Exchange;
  vtkRefineWithCAD* Settings;
  const CADModel& Model;
  DistributedMesh Mesh;
  vtkSmartPointer<vtkPointSet> Current; ///< The mesh with its arrays.
  bool Classified = false;              ///< The mesh knows its places on the CAD.
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
  output->ShallowCopy(Refiner(exchange, this, *model).Run(input));
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
