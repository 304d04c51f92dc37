// CAD files that the tests write with Open CASCADE.
#pragma once

#include <TopoDS_Shape.hxx>

#include <filesystem>
#include <string>
#include <vector>

namespace cadtest
{

/// A folder of its own for each test, removed at the end.
class TemporaryFolder
{
public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (this->path_ / name).string(); }
  /// Writes `text` to a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;

private:
  std::filesystem::path path_;
};

/// Writes `shape` in the format that the extension of `path` names; `unit` as Open CASCADE spells
/// it ("MM", "INCH", "M"). The shape's coordinates are millimetres to Open CASCADE.
void writeShape(const TopoDS_Shape& shape, const std::string& path, const std::string& unit = "MM");

std::vector<std::string> linesOf(const std::string& path);
void writeLines(const std::string& path, const std::vector<std::string>& lines);

/// The message of the Error that reading `path` throws; "" where it throws none.
std::string errorOfReading(const std::string& path);

} // namespace cadtest
