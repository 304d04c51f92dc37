#include "vtkCADReader.h"

#include "cad/CADDrawing.h"
#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "comm/Threads.h"
#include "vtkCADModelCache.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/cad/import/CADFile.h>

#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkIntArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPartitionedDataSet.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace
{

constexpr const char* PartNames[3] = { "Vertices", "Edges", "Faces" };
constexpr int PartDimensions[3] = { 2, 1, 0 }; ///< Faces first: the order of the output.

constexpr const char* OwnUnit = "File's own";

using Lines = std::vector<std::string>;

/// The number of threads, from that of findThreads, for the program that reads, which has no
/// vtkSMPTools.
int RunThreads(int threads)
{
  return threads > 0 ? threads : vtkSMPTools::GetEstimatedNumberOfThreads();
}

cadrefine::DrawingShare ShareOf(const cadrefine::RankExchange& exchange)
{
  return { exchange.rank(), exchange.size() };
}

/// cadrefine::agreeOnFailure, where what `work` throws does not name the file.
template<class Work>
void AgreeOnFailureOf(cadrefine::RankExchange& exchange, const char* file, const Work& work)
{
  cadrefine::agreeOnFailure(exchange,
    [&]
    {
      try
      {
        work();
      }
      catch (const cadrefine::Error& error)
      {
        throw cadrefine::Error(std::string(file) + ": " + error.what());
      }
    });
}

/// The lines of all ranks, each once: the same on any number of them.
Lines LinesOfAll(cadrefine::RankExchange& exchange, const Lines& mine)
{
  std::vector<char> text;
  for (const std::string& line : mine)
  {
    text.insert(text.end(), line.begin(), line.end());
    text.push_back('\n');
  }
  const auto toAll = std::vector<std::vector<char>>(exchange.size(), text);
  Lines all;
  for (const std::vector<char>& ofRank : exchange.allToAll(toAll))
  {
    std::istringstream stream(std::string(ofRank.begin(), ofRank.end()));
    for (std::string line; std::getline(stream, line);)
    {
      all.push_back(line);
    }
  }
  cadrefine::sortUniquely(all);
  return all;
}

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

/// A line for each entity, such as: #15: STEP ADVANCED_FACE "wing": its trim curves enclose no area
Lines EntityLines(const std::vector<cadrefine::UnreadEntity>& entities)
{
  Lines lines;
  for (const auto& entity : entities)
  {
    const bool iges = entity.type.rfind("IGES", 0) == 0;
    std::ostringstream line;
    if (entity.entity > 0)
    {
      line << (iges ? "DE " : "#") << entity.entity; // as the formats write it
    }
    else
    {
      line << "file";
    }
    line << ": " << entity.type;
    if (!entity.name.empty())
    {
      line << " \"" << entity.name << '"';
    }
    line << ": " << entity.reason;
    lines.push_back(line.str());
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

void AddLength(vtkDataObject* output, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
}

/// A heading and the first of the lines; all of them are in the field array `array`.
std::string Section(const char* heading, const Lines& lines, const char* array)
{
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, lines.size()); ++i)
  {
    text += "\n  " + lines[i];
  }
  if (lines.size() > most)
  {
    text += "\n  and " + std::to_string(lines.size() - most) + " more: see field array " + array;
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

/// What is less exact than a user may expect.
Lines InexactLines(const cadrefine::CADModel& model)
{
  constexpr double mostDeviation = 1e-4; // of the size
  constexpr double mostFitError = 1e-7;  // the same
  Lines lines;
  const auto add = [&](const std::string& what, double length, double most)
  {
    if (length > most * model.size())
    {
      std::ostringstream line;
      line << what << " by up to " << length << ", " << length / model.size()
           << " of the model's size";
      lines.push_back(line.str());
    }
  };
  add("trim curves of faces lie off their edges", model.trimDeviation(), mostDeviation);
  add("offset surfaces are fitted, and lie off", model.fitError(), mostFitError);
  return lines;
}

void AddReport(vtkDataObject* output, const cadrefine::CADModel& model, const Lines& repairs)
{
  const cadrefine::CADReport& report = model.report();
  vtkNew<vtkIntArray> counts;
  counts->SetName("CADCounts");
  for (int dimension = 0; dimension < 3; ++dimension)
  {
    counts->InsertNextValue(model.count(dimension));
  }
  output->GetFieldData()->AddArray(counts);
  AddStrings(output, "CADUnit", { report.unit });
  AddStrings(output, "CADUnread", EntityLines(report.unread));
  AddStrings(output, "CADLeftOut", EntityLines(report.leftOut));
  AddStrings(output, "CADRepairs", repairs);
  AddStrings(output, "CADInexact", InexactLines(model));
  AddLength(output, "CADSewingTolerance", report.sewingTolerance);
  AddLength(output, "CADTrimDeviation", model.trimDeviation());
  output->GetFieldData()->AddArray(GapArray(report.gaps));
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
  this->SetUnit(nullptr);
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
  cadrefine::RankExchange& exchange, int threads, vtkPartitionedDataSetCollection* output)
{
  std::vector<char> bytes;
  cadrefine::agreeOnFailure(exchange,
    [&]
    {
      if (!this->FileName || !*this->FileName)
      {
        throw cadrefine::Error("no CAD file is given (FileName)");
      }
      if (exchange.rank() == 0)
      {
        this->StampRead = cadrefine::fileStamp(this->FileName); // before: it may change meanwhile
        const std::string unit = this->Unit ? this->Unit : "";
        bytes =
          cadrefine::readCADBytes(this->FileName, unit == OwnUnit ? "" : unit, RunThreads(threads));
      }
    });
  bytes = exchange.broadcast(bytes, 0);
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(vtkCADModelCache::ModelArrayName());
  array->SetNumberOfValues(static_cast<vtkIdType>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  output->GetFieldData()->AddArray(array);
  std::shared_ptr<const cadrefine::CADModel> model;
  AgreeOnFailureOf(
    exchange, this->FileName, [&] { model = vtkCADModelCache::Get(output, threads); });
  return model;
}

cadrefine::ModelDrawing vtkCADReader::Draw(
  cadrefine::RankExchange& exchange, int threads, const cadrefine::CADModel& model)
{
  this->Say(0.6, "drawing the CAD");
  cadrefine::ModelDrawing drawing;
  AgreeOnFailureOf(exchange, this->FileName,
    [&]
    {
      drawing = cadrefine::drawModel(
        model, this->TessellationTolerance * model.size(), ShareOf(exchange), RunThreads(threads));
    });
  drawing.undrawn = LinesOfAll(exchange, drawing.undrawn);
  return drawing;
}

void vtkCADReader::Say(double progress, const std::string& text)
{
  this->SetProgressText(text.c_str());
  this->UpdateProgress(progress);
}

void vtkCADReader::Warn(const cadrefine::CADModel& model, const Lines& repairs)
{
  const cadrefine::CADReport& report = model.report();
  const std::string text = Section("not read:", EntityLines(report.unread), "CADUnread") +
                           Section("repaired:", repairs, "CADRepairs") +
                           Section("inexact:", InexactLines(model), "CADInexact") +
                           Section("gaps between faces (not sewn):", GapLines(report), "CADGaps");
  if (!text.empty())
  {
    vtkWarningMacro(<< this->FileName << ":" << text
                    << Section("left out by the rules of the format:", EntityLines(report.leftOut),
                         "CADLeftOut"));
  }
}

void vtkCADReader::Read(cadrefine::RankExchange& exchange, vtkPartitionedDataSetCollection* output)
{
  this->Say(0, "reading the CAD file");
  const int threads = cadrefine::findThreads(exchange);
  const auto model = this->ReadModel(exchange, threads, output);
  const cadrefine::ModelDrawing drawing =
    this->Drawing ? this->Draw(exchange, threads, *model) : cadrefine::ModelDrawing();
  Lines repairs = model->report().repairs;
  repairs.insert(repairs.end(), drawing.undrawn.begin(), drawing.undrawn.end());
  if (exchange.rank() == 0)
  {
    this->Warn(*model, repairs);
  }
  AddReport(output, *model, repairs);
  for (unsigned int part = 0; part < 3; ++part)
  {
    const int dimension = PartDimensions[part];
    this->Say(0.7 + 0.1 * part, std::string("drawing ") + PartNames[dimension]);
    vtkNew<vtkPartitionedDataSet> partitions;
    partitions->SetPartition(0, this->Drawing
                                  ? cadrefine::draw(*model, drawing, dimension, ShareOf(exchange))
                                  : cadrefine::drawNothing(*model, dimension));
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
    cadrefine::runCollectively(exchange, [&] { this->Read(exchange, output); });
    return 1;
  }
  catch (...)
  {
    output->Initialize();
    cadrefine::reportOnce(this, this->Controller);
    return 0;
  }
}

void vtkCADReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Unit: " << (this->Unit ? this->Unit : OwnUnit) << "\n";
  os << indent << "Drawing: " << this->Drawing << "\n";
  os << indent << "TessellationTolerance: " << this->TessellationTolerance << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
