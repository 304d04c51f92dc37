#include "vtkMeshWriter.h"

#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "formats/MeshFile.h"
#include "formats/PieceGathering.h"

#include <cadrefine/base/Error.h>

#include <vtkErrorCode.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

vtkStandardNewMacro(vtkMeshWriter);
vtkCxxSetObjectMacro(vtkMeshWriter, Controller, vtkMultiProcessController);

vtkMeshWriter::vtkMeshWriter()
{
  this->SetMshVersion("2.2");
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkMeshWriter::~vtkMeshWriter()
{
  this->SetFileName(nullptr);
  this->SetMshVersion(nullptr);
  this->SetController(nullptr);
}

int vtkMeshWriter::FillInputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  information->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

vtkTypeBool vtkMeshWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using SDDP = vtkStreamingDemandDrivenPipeline;
  if (!request->Has(SDDP::REQUEST_UPDATE_EXTENT()))
  {
    return this->Superclass::ProcessRequest(request, inputs, outputs);
  }
  vtkInformation* information = inputs[0]->GetInformationObject(0);
  const bool isAlone = !this->Controller;
  information->Set(
    SDDP::UPDATE_PIECE_NUMBER(), isAlone ? 0 : this->Controller->GetLocalProcessId());
  information->Set(
    SDDP::UPDATE_NUMBER_OF_PIECES(), isAlone ? 1 : this->Controller->GetNumberOfProcesses());
  information->Set(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  return 1;
}

void vtkMeshWriter::WriteData()
{
  auto* input = vtkPointSet::SafeDownCast(this->GetInput());
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    cadrefine::runCollectively(exchange,
      [&]
      {
        const auto mesh = cadrefine::gatherPieces(this->Controller, input);
        cadrefine::agreeOnFailure(exchange,
          [&]
          {
            if (!this->FileName || !*this->FileName)
            {
              throw cadrefine::Error("no mesh file is given (FileName)");
            }
            if (exchange.rank() == 0)
            {
              cadrefine::writeMeshFile(mesh, this->FileName, this->MshVersion, this->Ascii);
            }
          });
      });
  }
  catch (...)
  {
    this->SetErrorCode(vtkErrorCode::CannotOpenFileError);
    cadrefine::reportOnce(this, this->Controller);
  }
}

void vtkMeshWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "MshVersion: " << (this->MshVersion ? this->MshVersion : "(none)") << "\n";
  os << indent << "Ascii: " << this->Ascii << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
