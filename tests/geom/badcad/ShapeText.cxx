#include "ShapeText.h"

#include "TestFiles.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/IsolatedRun.h>

#include <BinTools.hxx>

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace badcad
{
namespace
{

BadFile changedFile(
  std::string text, const std::string& extension, const Change& change, bool every)
{
  const auto& [from, to] = change;
  std::size_t at = text.find(from);
  if (at == std::string::npos)
  {
    throw std::logic_error("there is no '" + from + "' in the " + extension + " file");
  }
  for (bool first = true; at != std::string::npos && (first || every); first = false)
  {
    text.replace(at, from.size(), to);
    at = text.find(from, at + to.size());
  }
  return { (every ? "each '" : "'") + from + "' made '" + to + "'", extension, text };
}

} // namespace

std::string textOf(const TopoDS_Shape& shape, const std::string& extension)
{
  const cadtest::TemporaryFolder folder;
  const auto write = [&]
  {
    const std::string path = folder.file("shape" + extension);
    cadtest::writeShape(shape, path); // chatters
    std::ifstream file(path, std::ios::binary);
    return std::vector<char>{ std::istreambuf_iterator<char>(file),
      std::istreambuf_iterator<char>() };
  };
  try
  {
    const std::vector<char> bytes = cadrefine::runIsolated("writing", { 60 }, write);
    return { bytes.begin(), bytes.end() };
  }
  catch (const cadrefine::Error&)
  {
    return "";
  }
}

std::string binaryTextOf(const TopoDS_Shape& shape)
{
  std::ostringstream stream(std::ios::binary);
  BinTools::Write(shape, stream);
  return stream.str();
}

void addChanged(std::vector<BadFile>& files, const std::string& text, const std::string& extension,
  const std::vector<Change>& changes)
{
  for (const Change& change : changes)
  {
    files.push_back(changedFile(text, extension, change, false));
  }
}

void addChangedAll(std::vector<BadFile>& files, const std::string& text,
  const std::string& extension, const std::vector<Change>& changes)
{
  for (const Change& change : changes)
  {
    files.push_back(changedFile(text, extension, change, true));
  }
}

} // namespace badcad
