#include "ShapeText.h"

#include "TestFiles.h"

#include <BinTools.hxx>

#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

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

/// In a process of its own: Open CASCADE chatters, and crashes on some shapes. False if it does.
bool writeAlone(const TopoDS_Shape& shape, const std::string& path)
{
  constexpr unsigned seconds = 60;
  const pid_t child = fork();
  if (child == 0)
  {
    alarm(seconds);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    cadtest::writeShape(shape, path); // what it throws ends this process
    _exit(0);
  }
  int status = -1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

} // namespace

std::string textOf(const TopoDS_Shape& shape, const std::string& extension)
{
  const cadtest::TemporaryFolder folder;
  const std::string path = folder.file("shape" + extension);
  if (!writeAlone(shape, path))
  {
    return "";
  }
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
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
