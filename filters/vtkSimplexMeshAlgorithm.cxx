#include "vtkSimplexMeshAlgorithm.h"

#include "Agreement.h"
#include "CADModel.h"
#include "GeometryMemory.h"
#include "InputCheck.h"
#include "InputParts.h"
#include "RankExchange.h"
#include "RunStatistics.h"
#include "StepContext.h"
#include "vtkCADModelCache.h"

#include <vtkDataObject.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkPointSet.h>
#include <vtkTable.h>

vtkCxxSetObjectMacro(vtkSimplexMeshAlgorithm, Controller, vtkMultiProcessController);

vtkSimplexMeshAlgorithm::vtkSimplexMeshAlgorithm(bool needsCAD)
  : Statistics(std::make_unique<cadrefine::RunStatistics>()),
    Memory(std::make_unique<cadrefine::GeometryMemory>())
{
  this->SetNumberOfInputPorts(needsCAD ? 2 : 1);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkSimplexMeshAlgorithm::~vtkSimplexMeshAlgorithm()
{
  this->SetController(nullptr);
}

int vtkSimplexMeshAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPartitionedDataSetCollection");
    return 1;
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

std::shared_ptr<const cadrefine::CADModel> vtkSimplexMeshAlgorithm::FindModel(
  cadrefine::RankExchange& exchange, vtkInformationVector* input) const
{
  std::shared_ptr<const cadrefine::CADModel> model;
  cadrefine::attempt(
    exchange, [&] { model = vtkCADModelCache::Get(vtkDataObject::GetData(input)); });
  return model;
}

cadrefine::StepContext vtkSimplexMeshAlgorithm::MakeContext(
  cadrefine::RankExchange& exchange, const cadrefine::CADModel& model)
{
  return { exchange, model, *this->Statistics,
    [this](const std::string& warning) { vtkWarningMacro(<< warning); } };
}

void vtkSimplexMeshAlgorithm::Run(
  cadrefine::RankExchange& exchange, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::shared_ptr<const cadrefine::CADModel> model;
  if (this->GetNumberOfInputPorts() == 2)
  {
    model = this->FindModel(exchange, inputs[1]);
  }
  cadrefine::attempt(exchange, [&] { cadrefine::checkInput(vtkPointSet::GetData(inputs[0])); });
  const cadrefine::InputParts parts =
    cadrefine::splitInput(vtkPointSet::GetData(inputs[0]), this->GetCellArraysRead());
  bool isReused = true;
  const cadrefine::StepResult& result =
    this->Memory->get(exchange, parts.geometry, model, this->GetMTime(),
      [&](vtkPointSet* geometry)
      {
        isReused = false;
        return this->Execute(exchange, geometry, model.get());
      });
  this->Statistics->set("geometry reused", isReused);
  const cadrefine::RunStatistics::Stopwatch stopwatch(*this->Statistics, "seconds copying fields");
  cadrefine::joinOutput(exchange, parts, result, vtkPointSet::GetData(outputs));
  if (result.table)
  {
    vtkTable::GetData(outputs, 1)->ShallowCopy(result.table);
  }
}

int vtkSimplexMeshAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Statistics->clear();
  this->StatisticsText = "{}";
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    exchange.progress().tell(
      [this](double fraction, const std::string& text)
      {
        this->SetProgressText(text.c_str());
        this->UpdateProgress(fraction);
      });
    cadrefine::runTogether(exchange,
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
    for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
    {
      vtkDataObject::GetData(outputs, port)->Initialize();
    }
    if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
    {
      vtkErrorMacro(<< cadrefine::caughtReason());
    }
    return 0;
  }
}

void vtkSimplexMeshAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Controller: " << this->Controller << "\n";
}
