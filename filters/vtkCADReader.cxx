#include "vtkCADReader.h"

#include "Agreement.h"
#include "CADDrawing.h"
#include "CADFile.h"
#include "Error.h"
#include "FileStamp.h"
#include "RankExchange.h"
#include "vtkCADModelCache.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataAssembly.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <sstream>
#include <string>
#include <vector>

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

using Lines = std::vector<std::string>;

Lines EntityLines(const std::vector<cadrefine::UnreadEntity>& entities)
{
  Lines lines;
  for (const auto& entity : entities)
  {
    const char* prefix = entity.type.rfind("IGES", 0) == 0 ? "DE " : "#"; // as the formats do
    const std::string number =
      entity.entity > 0 ? prefix + std::to_string(entity.entity) : std::string("file");
    lines.push_back(number + ": " + entity.type + ": " + entity.reason);
  }
  return lines;
}

/// Width, place and the two edges.
vtkSmartPointer<vtkDoubleArray> GapArray(const std::vector<cadrefine::Gap>& gaps)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName("CADGaps");
  array->SetNumberOfComponents(6);
  for (const cadrefine::Gap& gap : gaps)
  {
    const auto& p = gap.point;
    const double tuple[6] = { gap.width, p[0], p[1], p[2], static_cast<double>(gap.edges[0]),
      static_cast<double>(gap.edges[1]) };
    array->InsertNextTuple(tuple);
  }
  return array;
}

void AddReport(vtkDataObject* output, const cadrefine::CADReport& report)
{
  AddStrings(output, "CADUnit", { report.unit });
  AddStrings(output, "CADUnread", EntityLines(report.unread));
  AddStrings(output, "CADLeftOut", EntityLines(report.leftOut));
  AddStrings(output, "CADRepairs", report.repairs);
  vtkNew<vtkDoubleArray> tolerance;
  tolerance->SetName("CADSewingTolerance");
  tolerance->InsertNextValue(report.sewingTolerance);
  output->GetFieldData()->AddArray(tolerance);
  output->GetFieldData()->AddArray(GapArray(report.gaps));
}

std::string Section(const char* heading, const Lines& lines)
{
  std::string text;
  for (const std::string& line : lines)
  {
    text += "\n  " + line;
  }
  return lines.empty() ? text : std::string("\n") + heading + text;
}

Lines GapLines(const cadrefine::CADReport& report)
{
  Lines lines;
  if (!report.gaps.empty())
  {
    const cadrefine::Gap& widest = report.gaps.front();
    std::ostringstream line;
    line << report.gaps.size() << " gaps wider than " << report.sewingTolerance
         << ", the widest of " << widest.width << " near (" << widest.point[0] << ", "
         << widest.point[1] << ", " << widest.point[2] << ")";
    lines.push_back(line.str());
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

int vtkCADReader::ComputePipelineMTime(vtkInformation* request, vtkInformationVector** inputs,
  vtkInformationVector* outputs, int port, vtkMTimeType* time)
{
  const bool isAlone = !this->Controller || this->Controller->GetNumberOfProcesses() <= 1;
  if (isAlone && this->FileName && !this->StampRead.empty() &&
      cadrefine::fileStamp(this->FileName) != this->StampRead)
  {
    this->StampRead.clear(); // Modified once for each change.
    this->Modified();
  }
  return this->Superclass::ComputePipelineMTime(request, inputs, outputs, port, time);
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
        this->StampRead = cadrefine::fileStamp(this->FileName); // before: it may change meanwhile
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

void vtkCADReader::Say(double progress, const std::string& text)
{
  this->SetProgressText(text.c_str());
  this->UpdateProgress(progress);
}

void vtkCADReader::Warn(const cadrefine::CADReport& report)
{
  const std::string text = Section("not read:", EntityLines(report.unread)) +
                           Section("repaired:", report.repairs) +
                           Section("faces that are not joined:", GapLines(report));
  if (!text.empty())
  {
    vtkWarningMacro(<< this->FileName << ":" << text
                    << Section(
                         "left out by the rules of the format:", EntityLines(report.leftOut)));
  }
}

void vtkCADReader::Read(cadrefine::RankExchange& exchange, vtkPartitionedDataSetCollection* output)
{
  this->Say(0, "reading the CAD file");
  const auto model = this->ReadModel(exchange, output);
  if (exchange.rank() == 0)
  {
    this->Warn(model->report());
  }
  AddReport(output, model->report());
  for (unsigned int part = 0; part < 3; ++part)
  {
    const int dimension = PartDimensions[part];
    this->Say(0.7 + 0.1 * part, std::string("drawing ") + PartNames[dimension]);
    const cadrefine::DrawingShare share{ exchange.rank(), exchange.size(),
      this->TessellationTolerance };
    vtkNew<vtkPartitionedDataSet> partitions;
    partitions->SetPartition(0, cadrefine::draw(*model, dimension, share));
    output->SetPartitionedDataSet(part, partitions);
    output->GetMetaData(part)->Set(vtkCompositeDataSet::NAME(), PartNames[dimension]);
  }
}

int vtkCADReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  auto* output = vtkPartitionedDataSetCollection::GetData(outputs);
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    cadrefine::runTogether(exchange, [&] { this->Read(exchange, output); });
    return 1;
  }
  catch (...)
  {
    output->Initialize();
    if (!this->Controller || this->Controller->GetLocalProcessId() == 0)
    {
      vtkErrorMacro(<< cadrefine::caughtReason());
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
