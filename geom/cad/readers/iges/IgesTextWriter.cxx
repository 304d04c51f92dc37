#include <cadrefine/cad/readers/iges/IgesSections.h>
#include <cadrefine/cad/readers/iges/IgesText.h>

#include <cstdio>
#include <fstream>

namespace cadrefine
{
namespace
{

std::string eightColumns(int value)
{
  char text[16];
  std::snprintf(text, sizeof(text), "%8d", value);
  return text;
}

void setField(std::string& line, int field, int value)
{
  const std::string text = eightColumns(value);
  line.replace((field - 1) * text.size(), text.size(), text);
}

void writeLine(std::ofstream& file, std::string text, char section, std::size_t number)
{
  text.resize(igesSectionColumn, ' ');
  char end[16];
  std::snprintf(end, sizeof(end), "%c%7d", section, static_cast<int>(number));
  file << text << end << "\n";
}

void writeSection(std::ofstream& file, const std::vector<std::string>& lines, char section)
{
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    writeLine(file, lines[i], section, i + 1);
  }
}

std::string parameterLine(const std::string& data, int entry)
{
  std::string line = data;
  line.resize(igesSectionColumn, ' ');
  setField(line, 9, entry);
  return line;
}

} // namespace

std::vector<std::string> wrapParameters(const IgesParameters& parameters, const IgesText& text)
{
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < parameters.values.size(); ++i)
  {
    const bool last = i + 1 == parameters.values.size();
    std::string piece = parameters.values[i] + (last ? text.terminator : text.separator);
    if (lines.back().size() + piece.size() > igesDataColumns && piece.size() <= igesDataColumns)
    {
      lines.emplace_back();
    }
    while (!piece.empty())
    {
      if (lines.back().size() == igesDataColumns)
      {
        lines.emplace_back();
      }
      const std::size_t room = igesDataColumns - lines.back().size();
      lines.back() += piece.substr(0, room);
      piece.erase(0, room);
    }
  }
  return lines;
}

void writeIgesText(const IgesText& text, const std::string& path)
{
  std::vector<std::string> directory, parameters;
  for (const IgesEntry& entry : text.entries)
  {
    std::string first = entry.first;
    std::string second = entry.second;
    setField(first, 1, entry.type);
    setField(first, 2, static_cast<int>(parameters.size()) + 1);
    setField(second, 1, entry.type);
    setField(second, 4, static_cast<int>(entry.data.size()));
    directory.push_back(first);
    directory.push_back(second);
    for (const std::string& data : entry.data)
    {
      parameters.push_back(parameterLine(data, entry.number));
    }
  }
  std::ofstream file(path, std::ios::binary);
  writeSection(file, text.start, 'S');
  writeSection(file, text.global, 'G');
  writeSection(file, directory, 'D');
  writeSection(file, parameters, 'P');
  char terminate[igesLineColumns];
  std::snprintf(terminate, sizeof(terminate), "S%7dG%7dD%7dP%7d",
    static_cast<int>(text.start.size()), static_cast<int>(text.global.size()),
    static_cast<int>(directory.size()), static_cast<int>(parameters.size()));
  writeLine(file, terminate, 'T', 1);
}

} // namespace cadrefine
