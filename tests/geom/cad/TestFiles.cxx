#include "TestFiles.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>

#include <BRepTools.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <UnitsMethods.hxx>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <stdlib.h>

namespace cadtest
{

TemporaryFolder::TemporaryFolder()
{
  std::string name = (std::filesystem::temp_directory_path() / "cadrefine-XXXXXX").string();
  if (!mkdtemp(name.data()))
  {
    throw std::runtime_error("cannot make a temporary folder");
  }
  this->path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
  std::error_code ignored;
  std::filesystem::remove_all(this->path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name, const std::string& text) const
{
  std::ofstream(this->file(name), std::ios::binary) << text;
  return this->file(name);
}

namespace
{

bool writeIges(const TopoDS_Shape& shape, const std::string& path, const std::string& unit)
{
  constexpr int facesAsTrimmedSurfaces = 0;
  IGESControl_Controller::Init();
  IGESControl_Writer writer(unit.c_str(), facesAsTrimmedSurfaces);
  return writer.AddShape(shape) && (writer.ComputeModel(), writer.Write(path.c_str()));
}

bool writeStep(const TopoDS_Shape& shape, const std::string& path, const std::string& unit)
{
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  STEPControl_Writer writer;
  // Open CASCADE 7.8 writes the unit's name without scaling to it, if not told its length too.
  writer.Model()->SetWriteLengthUnit(
    UnitsMethods::GetLengthFactorValue(Interface_Static::IVal("write.step.unit")));
  return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
         writer.Write(path.c_str()) == IFSelect_RetDone;
}

} // namespace

void writeShape(const TopoDS_Shape& shape, const std::string& path, const std::string& unit)
{
  const std::string extension = std::filesystem::path(path).extension().string();
  const bool written = extension == ".igs"    ? writeIges(shape, path, unit)
                       : extension == ".step" ? writeStep(shape, path, unit)
                                              : BRepTools::Write(shape, path.c_str());
  if (!written)
  {
    throw std::runtime_error("cannot write " + path);
  }
}

std::vector<std::string> linesOf(const std::string& path)
{
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

void writeLines(const std::string& path, const std::vector<std::string>& lines)
{
  std::ofstream file(path);
  for (const std::string& line : lines)
  {
    file << line << "\n";
  }
}

std::string errorOfReading(const std::string& path)
{
  try
  {
    cadrefine::readCADFile(path);
  }
  catch (const cadrefine::Error& error)
  {
    return error.what();
  }
  return "";
}

} // namespace cadtest
