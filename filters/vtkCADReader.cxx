#include "vtkCADReader.h"

#include "Agreement.h"
#include "CADDrawing.h"
#include "CADFile.h"
#include "Error.h"
#include "RankExchange.h"
#include "vtkCADModelCache.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataAssembly.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <string>

namespace
{

constexpr const char* PartNames[3] = { "Vertices", "Edges", "Faces" };
constexpr int PartDimensions[3] = { 2, 1, 0 }; ///< Faces first: the order of the output.

void AddStrings(vtkDataObject* output, const char* name, const std::vector<std::string>& values)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& value : values)
  {
    array->InsertNextValue(value);
  }
  output->GetFieldData()->AddArray(array);
}

std::vector<std::string> UnreadLines(const cadrefine::CADModel& model)
{
  std::vector<std::string> lines;
  for (const auto& unread : model.unread())
  {
    const char* prefix = unread.type.rfind("IGES", 0) == 0 ? "DE " : "#"; // as the formats do
    const std::string number =
      unread.entity > 0 ? prefix + std::to_string(unread.entity) : std::string("file");
    lines.push_back(number + ": " + unread.type + ": " + unread.reason);
  }
  return lines;
}

} // namespace

vtkStandardNewMacro(vtkCADReader);
vtkCxxSetObjectMacro(vtkCADReader, Controller, vtkMultiProcessController);

vtkCADReader::vtkCADReader()
{
  this->SetNumberOfInputPorts(0);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkCADReader::~vtkCADReader()
{
  this->SetFileName(nullptr);
  this->SetController(nullptr);
}

int vtkCADReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  outputs->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

std::shared_ptr<const cadrefine::CADModel> vtkCADReader::ReadModel(
  cadrefine::RankExchange& exchange, vtkPartitionedDataSetCollection* output)
{
  std::vector<char> bytes;
  cadrefine::attempt(exchange,
    [&]
    {
      if (!this->FileName || !*this->FileName)
      {
        throw cadrefine::Error("no CAD file is given (FileName)");
      }
      if (exchange.rank() == 0)
      {
        bytes = cadrefine::readCADFile(this->FileName)->toBytes();
      }
    });
  bytes = exchange.broadcast(bytes, 0);
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(vtkCADModelCache::ModelArrayName());
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  output->GetFieldData()->AddArray(array);
  std::shared_ptr<const cadrefine::CADModel> model;
  cadrefine::attempt(exchange, [&] { model = vtkCADModelCache::Get(output); });
  return model;
}

void vtkCADReader::WarnOfUnread(const cadrefine::CADModel& model)
{
  std::string text;
  for (const std::string& line : UnreadLines(model))
  {
    text += "\n  " + line;
  }
  if (!text.empty())
  {
    vtkWarningMacro(<< this->FileName << ": not everything could be read:" << text);
  }
}

int vtkCADReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  auto* output = vtkPartitionedDataSetCollection::GetData(outputs);
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    const auto model = this->ReadModel(exchange, output);
    if (exchange.rank() == 0)
    {
      this->WarnOfUnread(*model);
    }
    AddStrings(output, "CADUnit", { model->unit() });
    AddStrings(output, "CADUnread", UnreadLines(*model));
    for (unsigned int part = 0; part < 3; ++part)
    {
      const int dimension = PartDimensions[part];
      const cadrefine::DrawingShare share{ exchange.rank(), exchange.size(),
        this->TessellationTolerance };
      vtkNew<vtkPartitionedDataSet> partitions;
      cadrefine::attempt(
        exchange, [&] { partitions->SetPartition(0, cadrefine::draw(*model, dimension, share)); });
      output->SetPartitionedDataSet(part, partitions);
      output->GetMetaData(part)->Set(vtkCompositeDataSet::NAME(), PartNames[dimension]);
    }
    return 1;
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
    {
      vtkErrorMacro(<< error.what());
    }
    return 0;
  }
}

void vtkCADReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "TessellationTolerance: " << this->TessellationTolerance << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
