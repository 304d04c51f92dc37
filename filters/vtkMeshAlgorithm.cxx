#include "vtkMeshAlgorithm.h"

#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "comm/RunStatistics.h"
#include "mesh/InputCheck.h"
#include "pipeline/BoundaryMesh.h"
#include "pipeline/FitReport.h"
#include "pipeline/GeometryCache.h"
#include "pipeline/InputSplit.h"
#include "pipeline/PipelineContext.h"
#include "pipeline/PropertyCheck.h"
#include "vtkCADModelCache.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/model/CADModel.h>

#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkPointSet.h>
#include <vtkTable.h>

#include <utility>

vtkCxxSetObjectMacro(vtkMeshAlgorithm, Controller, vtkMultiProcessController);

vtkMeshAlgorithm::vtkMeshAlgorithm(bool needsCAD)
  : Statistics(std::make_unique<cadrefine::RunStatistics>()),
    Cache(std::make_unique<cadrefine::GeometryCache>())
{
  this->SetNumberOfInputPorts(needsCAD ? 2 : 1);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkMeshAlgorithm::~vtkMeshAlgorithm()
{
  this->SetController(nullptr);
}

int vtkMeshAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // VTK's own complaint has a line a pass
    return 1;
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

namespace
{

/// The CAD of the algorithm, or of the nearest one above it that has one; null without.
vtkDataObject* findCAD(vtkAlgorithm* algorithm)
{
  const auto* filter = vtkMeshAlgorithm::SafeDownCast(algorithm);
  if (filter && algorithm->GetNumberOfInputPorts() == 2 &&
      algorithm->GetNumberOfInputConnections(1) > 0)
  {
    return algorithm->GetInputDataObject(1, 0);
  }
  vtkDataObject* cad = nullptr;
  if (algorithm->GetNumberOfInputPorts() > 0)
  {
    for (int i = 0; !cad && i < algorithm->GetNumberOfInputConnections(0); ++i)
    {
      cad = findCAD(algorithm->GetInputAlgorithm(0, i));
    }
  }
  return cad;
}

} // namespace

std::shared_ptr<const cadrefine::CADModel> vtkMeshAlgorithm::FindModel(
  cadrefine::RankExchange& exchange)
{
  std::shared_ptr<const cadrefine::CADModel> model;
  cadrefine::agreeOnFailure(exchange,
    [&]
    {
      vtkDataObject* cad = findCAD(this);
      if (!cad)
      {
        throw cadrefine::Error("no CAD model is chosen: open the .step, .iges or .brep file, and "
                               "set the property CAD to its CAD Reader");
      }
      model = vtkCADModelCache::Get(cad);
    });
  return model;
}

cadrefine::PipelineContext vtkMeshAlgorithm::MakeContext(
  cadrefine::RankExchange& exchange, const cadrefine::CADModel& model)
{
  return { exchange, model, *this->Statistics,
    [this, isFirst = exchange.rank() == 0](const std::string& warning)
    {
      if (isFirst)
      {
        vtkWarningMacro(<< warning);
      }
    } };
}

void vtkMeshAlgorithm::AddFace(const char* face)
{
  if (face && *face)
  {
    this->Faces.emplace_back(face);
    this->Modified();
  }
}

void vtkMeshAlgorithm::ClearFaces()
{
  if (!this->Faces.empty())
  {
    this->Faces.clear();
    this->Modified();
  }
}

void vtkMeshAlgorithm::AddConservedArray(const char* name)
{
  if (name && *name)
  {
    this->ConservedArrays.emplace_back(name);
    this->Modified();
  }
}

void vtkMeshAlgorithm::ClearConservedArrays()
{
  if (!this->ConservedArrays.empty())
  {
    this->ConservedArrays.clear();
    this->Modified();
  }
}

cadrefine::PipelineResult vtkMeshAlgorithm::MakeResult(
  const cadrefine::PipelineContext& context, cadrefine::MeshState state) const
{
  if (!this->BoundaryCells)
  {
    return cadrefine::resultOf(std::move(state));
  }
  auto [mesh, selection] = cadrefine::makeDataSetWithBoundary(context, state);
  state.mapping.convert(std::move(selection));
  return { mesh, std::move(state.mapping) };
}

struct vtkMeshAlgorithm::Outputs
{
  const cadrefine::InputSplit& parts;
  cadrefine::OutputJoin join;
  vtkInformationVector* ports;
};

void vtkMeshAlgorithm::Fill(cadrefine::RankExchange& exchange, vtkPointSet* mesh,
  const cadrefine::FieldMapping& mapping, const cadrefine::ArraySelection& selection,
  vtkTable* table, const std::string& fitReport)
{
  if (!fitReport.empty())
  {
    cadrefine::removeFit(this->Filled->parts.fields.ofMesh);
  }
  const cadrefine::RunStatistics::Stopwatch stopwatch(*this->Statistics, "seconds copying fields");
  this->Filled->join.fill(
    exchange, mesh, mapping, selection, vtkPointSet::GetData(this->Filled->ports));
  this->FitReport = fitReport;
  if (table)
  {
    vtkTable::GetData(this->Filled->ports, 1)->ShallowCopy(table);
  }
}

void vtkMeshAlgorithm::ShowStep(cadrefine::RankExchange& exchange, vtkPointSet* mesh,
  const cadrefine::FieldMapping& mapping, const cadrefine::ArraySelection& selection,
  vtkTable* table, const std::string& fitReport)
{
  this->Fill(exchange, mesh, mapping, selection, table, fitReport);
  exchange.agree(""); // so that all have it, or none goes on
}

void vtkMeshAlgorithm::Run(
  cadrefine::RankExchange& exchange, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::shared_ptr<const cadrefine::CADModel> model;
  if (this->GetNumberOfInputPorts() == 2)
  {
    model = this->FindModel(exchange);
  }
  vtkPointSet* input = vtkPointSet::GetData(inputs[0]);
  const std::vector<std::string> cellArrays = this->GetCellArraysRead();
  cadrefine::agreeOnFailure(exchange,
    [&]
    {
      cadrefine::checkInput(input);
      cadrefine::checkCellArrays(input, cellArrays);
      cadrefine::checkConservedArrays(input, this->ConservedArrays);
    });
  const cadrefine::InputSplit parts =
    cadrefine::splitInput(input, cellArrays, this->ChangesCells() && this->FindMinimumQuality());
  if (this->ChangesMesh())
  {
    cadrefine::removeMeasured(parts.fields.ofCells, parts.fields.ofMesh);
  }
  this->HasMeans = exchange.any(cadrefine::hasMeans(parts));
  Outputs filled{ parts, cadrefine::OutputJoin(parts), outputs };
  this->Filled = &filled;
  bool isReused = true;
  const cadrefine::PipelineResult& result =
    this->Cache->get(exchange, parts.geometry, model, 2 * this->GetMTime() + this->HasMeans,
      [&](vtkPointSet* geometry)
      {
        isReused = false;
        return this->Execute(exchange, geometry, model.get());
      });
  this->Statistics->set("geometry reused", isReused);
  this->Fill(exchange, result.mesh, result.mapping, {}, result.table, result.fitReport);
  this->Filled = nullptr;
}

std::optional<double> vtkMeshAlgorithm::FindMinimumQuality() const
{
  cadrefine::checkProperty("Operations", this->Operations, ALL_OPERATIONS, CUT_ONLY);
  cadrefine::checkProperty("MinimumQuality", this->MinimumQuality, 0, 1);
  return this->Operations == ALL_OPERATIONS ? std::optional(this->MinimumQuality) : std::nullopt;
}

cadrefine::FieldNeeds vtkMeshAlgorithm::FindFieldNeeds() const
{
  return { this->HasMeans, this->ConservedArrays };
}

int vtkMeshAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Statistics->clear();
  this->StatisticsText = "{}";
  this->FitReport.clear();
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    exchange.progress().tell(
      [this](double fraction, const std::string& text)
      {
        this->SetProgressText(text.c_str());
        this->UpdateProgress(fraction);
      });
    cadrefine::runCollectively(exchange,
      [&]
      {
        this->Run(exchange, inputs, outputs);
        this->Statistics->gather(exchange);
        this->StatisticsText = this->Statistics->json();
      });
    return 1;
  }
  catch (...)
  {
    this->Filled = nullptr;
    this->FitReport.clear();
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      vtkDataObject::GetData(outputs, port)->Initialize();
    }
    cadrefine::reportOnce(this, this->Controller);
    return 0;
  }
}

void vtkMeshAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Faces:";
  for (const std::string& face : this->Faces)
  {
    os << " " << face;
  }
  os << "\n" << indent << "ConservedArrays:";
  for (const std::string& name : this->ConservedArrays)
  {
    os << " " << name;
  }
  os << "\n" << indent << "BoundaryCells: " << this->BoundaryCells << "\n";
  os << indent << "Operations: " << this->Operations << "\n";
  os << indent << "MinimumQuality: " << this->MinimumQuality << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
