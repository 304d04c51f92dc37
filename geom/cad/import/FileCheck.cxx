#include <cadrefine/cad/import/FileCheck.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/IgesLine.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

namespace cadrefine
{
namespace
{

std::string extensionOf(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void checkReadable(const std::string& path)
{
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
  {
    throw Error(path + ": no such file");
  }
  if (error)
  {
    throw Error(path + ": " + error.message());
  }
  if (status.type() == std::filesystem::file_type::directory)
  {
    throw Error(path + ": is a directory, not a CAD file");
  }
  if (status.type() != std::filesystem::file_type::regular)
  {
    throw Error(path + ": is a device or a pipe, not a CAD file"); // may have no end
  }
  errno = 0;
  if (!std::ifstream(path, std::ios::binary))
  {
    throw Error(path + ": cannot be opened: " + std::strerror(errno));
  }
}

std::string beginning(const std::string& path)
{
  std::string text(4096, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// An IGES line has 80 columns, the section's letter in the 73rd ('S', 'C' or 'B' at first) and a
/// number after it. Some files have no line ends.
bool looksLikeIges(const std::string& text)
{
  const std::size_t end = text.find_first_of("\r\n");
  const bool endless = end == std::string::npos && text.size() > igesLineColumns;
  const std::string line = text.substr(0, endless ? igesLineColumns : end);
  return line.size() > igesSectionColumn &&
         std::strchr("SCB", line[igesSectionColumn]) != nullptr &&
         std::all_of(line.begin() + igesSectionColumn + 1, line.end(),
           [](unsigned char c) { return std::isdigit(c) || std::isspace(c); });
}

/// The version line is checked whole: Open CASCADE would write to the console about others.
bool looksLikeBrep(const std::string& text)
{
  const std::size_t at = text.find("CASCADE Topology V");
  const std::string line =
    at == std::string::npos ? "" : text.substr(at, text.find_first_of("\r\n", at) - at);
  return line.find(", (c)") != std::string::npos || text.find("Open CASCADE Topology") == 0 ||
         text.find("\nOpen CASCADE Topology") != std::string::npos;
}

bool isBinary(CADFormat format, const std::string& text)
{
  return format == CADFormat::Brep && text.find("CASCADE Topology V") == std::string::npos;
}

/// Throws Error where a whole page of a text is zeros: interrupted copies and downloads leave such
/// holes. Work: reads the file once, up to there.
void checkHoles(const std::string& path)
{
  constexpr std::size_t page = 4096;
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(page);
  for (std::uint64_t at = 0; file; at += page)
  {
    file.read(block.data(), page);
    const bool full = file.gcount() == static_cast<std::streamsize>(page);
    if (full && std::all_of(block.begin(), block.end(), [](char c) { return c == 0; }))
    {
      throw Error(path + ": the file is damaged: it holds zeros instead of text from byte " +
                  std::to_string(at) + " on");
    }
  }
}

bool looksLike(CADFormat format, const std::string& text)
{
  switch (format)
  {
    case CADFormat::Iges:
      return looksLikeIges(text);
    case CADFormat::Step:
      return text.find("ISO-10303-21") != std::string::npos;
    default:
      return looksLikeBrep(text);
  }
}

std::string nameOf(CADFormat format)
{
  return format == CADFormat::Iges ? "IGES" : format == CADFormat::Step ? "STEP" : "BREP";
}

} // namespace

std::optional<CADFormat> formatOf(const std::string& path)
{
  static const std::map<std::string, CADFormat> formats{ { ".igs", CADFormat::Iges },
    { ".iges", CADFormat::Iges }, { ".stp", CADFormat::Step }, { ".step", CADFormat::Step },
    { ".brep", CADFormat::Brep } };
  const auto found = formats.find(extensionOf(path));
  return found == formats.end() ? std::nullopt : std::optional(found->second);
}

CADFormat checkFile(const std::string& path)
{
  checkReadable(path);
  if (!formatOf(path))
  {
    throw Error(path + ": unknown extension '" + extensionOf(path) +
                "'; CAD files are .igs, .iges, .stp, .step or .brep");
  }
  const CADFormat format = *formatOf(path);
  const std::string text = beginning(path);
  if (text.empty())
  {
    throw Error(path + ": the file is empty");
  }
  if (!looksLike(format, text))
  {
    throw Error(path + ": does not begin like a file in " + nameOf(format) + " format");
  }
  if (!isBinary(format, text))
  {
    checkHoles(path);
  }
  return format;
}

} // namespace cadrefine
