#include "vtkMeshReader.h"

#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "formats/MeshFile.h"

#include <cadrefine/base/Error.h>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkMeshReader);
vtkCxxSetObjectMacro(vtkMeshReader, Controller, vtkMultiProcessController);

vtkMeshReader::vtkMeshReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkMeshReader::~vtkMeshReader()
{
  this->SetFileName(nullptr);
  this->SetController(nullptr);
}

int vtkMeshReader::CanReadFile(const char* file)
{
  try
  {
    return file && cadrefine::canReadMeshFile(file) ? 1 : 0;
  }
  catch (const cadrefine::Error&) // reading it will say the same
  {
    return 1;
  }
}

int vtkMeshReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  outputs->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkMeshReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  using SDDP = vtkStreamingDemandDrivenPipeline;
  vtkInformation* information = outputs->GetInformationObject(0);
  auto* output = vtkUnstructuredGrid::GetData(information);
  const bool isFirst = !information->Has(SDDP::UPDATE_PIECE_NUMBER()) ||
                       information->Get(SDDP::UPDATE_PIECE_NUMBER()) == 0;
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    cadrefine::agreeOnFailure(exchange,
      [&]
      {
        if (!this->FileName || !*this->FileName)
        {
          throw cadrefine::Error("no mesh file is given (FileName)");
        }
        if (isFirst)
        {
          cadrefine::readMeshFile(this->FileName, output);
        }
      });
    return 1;
  }
  catch (...)
  {
    output->Initialize();
    cadrefine::reportOnce(this, this->Controller);
    return 0;
  }
}

void vtkMeshReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
