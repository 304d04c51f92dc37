// 1. See that the file is there, can be read and begins as its kind of file does.
// 2. In a program of its own (Open CASCADE crashes or loops on many damaged files): read it, sew
//    and heal what it holds, leave out what becomes no NURBS, and turn it into the model's bytes.
// 3. Where that dies in an optional step, or over one face or edge, do it again without.
// 4. Build the model from the bytes: so it is the same on every rank.

#include <cadrefine/cad/import/CADFile.h>

#include <cadrefine/cad/import/FileCheck.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/model/CADModelBuilder.h>
#include <cadrefine/cad/model/LengthUnit.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <sys/stat.h>

namespace cadrefine
{
namespace
{

/// Throws Error where the unit that a user asked for is none of the usual ones.
void checkUnit(const std::string& unit)
{
  const std::string name = shortUnitName(unit);
  std::string known;
  for (const LengthUnit& usual : usualUnits)
  {
    if (name == usual.name)
    {
      return;
    }
    known += (known.empty() ? "" : ", ") + std::string(usual.name);
  }
  throw Error("the unit of length \"" + unit + "\" (Unit) is not one of " + known);
}

/// Far more than reading takes, and yet little for a small file. Measured: mostly up to 0.5 s and
/// 40 MiB for each megabyte; 12 s a megabyte of a terrain, of which one step, drawing its face,
/// takes more than 7; 21 s for 500 subfigures in each other, of 0.2 MB. After a step that took all
/// of its time some is left for an attempt without.
RunLimits limitsFor(const std::string& path)
{
  constexpr double day = 86400;
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
  RunLimits limits;
  limits.cpuSeconds = static_cast<int>(std::min(day, 25 + 60 * megabytes));
  limits.stepSeconds = static_cast<int>(std::min(day, 20 + 20 * megabytes));
  limits.megabytes = static_cast<std::uint64_t>(2048 + 100 * megabytes);
  return limits;
}

} // namespace

std::vector<char> readCADBytes(const std::string& path, const std::string& unit, int threads)
{
  if (!unit.empty())
  {
    checkUnit(unit); // before a long file is read
  }
  ByteWriter input;
  input.number(checkFile(path));
  input.text(unit);
  try
  {
    return runAttempts("read", path, limitsFor(path), threads, input.bytes);
  }
  catch (const RunFailure& failure)
  {
    if (static_cast<ReadStep>(failure.place().step) == ReadStep::Loading)
    {
      throw Error(path + ": the file is damaged: " + failure.cause());
    }
    throw;
  }
}

std::shared_ptr<const CADModel> readCADFile(
  const std::string& path, const std::string& unit, int threads)
{
  std::vector<char> bytes = readCADBytes(path, unit, threads);
  try
  {
    return CADModelBuilder::build(std::move(bytes), forOnOwnThreads(threads));
  }
  catch (const Error& error)
  {
    throw Error(path + ": " + error.what());
  }
}

std::string fileStamp(const std::string& path)
{
  struct stat facts = {};
  if (stat(path.c_str(), &facts) != 0)
  {
    return "none";
  }
  std::ostringstream stamp;
  stamp << facts.st_dev << ' ' << facts.st_ino << ' ' << facts.st_size << ' '
        << facts.st_mtim.tv_sec << ' ' << facts.st_mtim.tv_nsec << ' ' << facts.st_ctim.tv_sec
        << ' ' << facts.st_ctim.tv_nsec;
  return stamp.str();
}

} // namespace cadrefine
