#include "IgesText.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace cadrefine
{
namespace
{

constexpr std::size_t lineColumns = 80;
constexpr std::size_t dataColumns = 64;
constexpr std::size_t sectionColumn = 72;
constexpr std::size_t fieldColumns = 8;

/// A line of 81 columns, whose section letter has moved.
bool isShifted(const std::string& line)
{
  return line.size() > sectionColumn + 1 && line[sectionColumn + 1] == 'P' &&
         std::isdigit(static_cast<unsigned char>(line[sectionColumn]));
}

struct Sections
{
  std::vector<std::string> head, directory, parameters;
};

Sections splitSections(const std::string& path)
{
  Sections sections;
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);)
  {
    line.erase(line.find_last_not_of("\r\n") + 1);
    line.resize(std::max(line.size(), lineColumns), ' ');
    if (isShifted(line))
    {
      sections.parameters.push_back(line);
      continue;
    }
    switch (line[sectionColumn])
    {
      case 'S':
      case 'G':
        sections.head.push_back(line);
        break;
      case 'D':
        sections.directory.push_back(line);
        break;
      case 'P':
        sections.parameters.push_back(line);
        break;
      default:
        break;
    }
  }
  return sections;
}

int fieldOf(const std::string& line, int field)
{
  return std::atoi(line.substr((field - 1) * fieldColumns, fieldColumns).c_str());
}

void setField(std::string& line, int field, int value)
{
  char text[16];
  std::snprintf(text, sizeof(text), "%8d", value);
  line.replace((field - 1) * fieldColumns, fieldColumns, text);
}

/// Both delimiters stand at the start of the global section: "1H,,1H;," or nothing for defaults.
void findDelimiters(IgesText& text)
{
  std::string global;
  for (const std::string& line : text.head)
  {
    if (line[sectionColumn] == 'G')
    {
      global += line.substr(0, sectionColumn);
    }
  }
  std::size_t at = 0;
  const auto take = [&](char& delimiter)
  {
    if (at + 2 < global.size() && global.compare(at, 2, "1H") == 0)
    {
      delimiter = global[at + 2];
      at += 3;
    }
    ++at;
  };
  take(text.separator);
  take(text.terminator);
}

enum class Width
{
  Regular,
  Unclear, ///< The column after the data holds a zero, which may be padding or data.
  Wide
};

Width widthOf(const std::string& line, int number)
{
  if (isShifted(line))
  {
    return Width::Wide;
  }
  const std::string field = line.substr(dataColumns, fieldColumns);
  if (field[0] == ' ' || std::atoi(field.c_str() + 1) != number)
  {
    return Width::Regular;
  }
  return field[0] == '0' ? Width::Unclear : Width::Wide;
}

/// `unclear`: what to take lines of unclear width for.
void takeParameterLines(IgesEntry& entry, const std::vector<std::string>& lines, Width unclear)
{
  const int from = fieldOf(entry.first, 2) - 1;
  const int count = std::max(1, fieldOf(entry.second, 4));
  entry.data.clear();
  entry.overrun = false;
  for (int i = std::max(from, 0); i < from + count && i < static_cast<int>(lines.size()); ++i)
  {
    Width width = widthOf(lines[i], entry.number);
    width = width == Width::Unclear ? unclear : width;
    const bool wide = width == Width::Wide;
    entry.overrun = entry.overrun || wide;
    entry.data.push_back(lines[i].substr(0, wide ? dataColumns + 1 : dataColumns));
  }
}

/// Where some lines surely run too far, the unclear ones do too.
void takeAllParameters(std::vector<IgesEntry>& entries, const std::vector<std::string>& lines)
{
  for (IgesEntry& entry : entries)
  {
    takeParameterLines(entry, lines, Width::Regular);
  }
  if (std::any_of(entries.begin(), entries.end(), [](const IgesEntry& e) { return e.overrun; }) &&
      std::none_of(lines.begin(), lines.end(), isShifted))
  {
    for (IgesEntry& entry : entries)
    {
      takeParameterLines(entry, lines, Width::Wide);
    }
  }
}

std::string trimmed(const std::string& text)
{
  const std::size_t from = text.find_first_not_of(' ');
  return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(' ') - from + 1);
}

/// Characters of a string constant "nH..." that begins at `at`, 0 where there is none.
std::size_t stringLength(const std::string& text, std::size_t at)
{
  std::size_t end = at;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
  {
    ++end;
  }
  const bool isString = end > at && end - at < 7 && end < text.size() && text[end] == 'H';
  return isString ? end + 1 - at + std::stoul(text.substr(at, end - at)) : 0;
}

void writeLine(std::ofstream& file, std::string text, char section, int number)
{
  text.resize(sectionColumn, ' ');
  char end[16];
  std::snprintf(end, sizeof(end), "%c%7d", section, number);
  file << text << end << "\n";
}

std::string parameterLine(const std::string& data, int entry)
{
  std::string line = data;
  line.resize(sectionColumn, ' ');
  setField(line, 9, entry);
  return line;
}

} // namespace

IgesText readIgesText(const std::string& path)
{
  IgesText text;
  Sections sections = splitSections(path);
  text.head = std::move(sections.head);
  findDelimiters(text);
  for (std::size_t i = 0; i + 1 < sections.directory.size(); i += 2)
  {
    IgesEntry entry;
    entry.first = sections.directory[i];
    entry.second = sections.directory[i + 1];
    entry.number = static_cast<int>(i) + 1;
    entry.type = fieldOf(entry.first, 1);
    text.entries.push_back(std::move(entry));
  }
  takeAllParameters(text.entries, sections.parameters);
  return text;
}

IgesParameters parametersOf(const IgesEntry& entry, const IgesText& text)
{
  std::string all;
  for (const std::string& line : entry.data)
  {
    all += line;
  }
  IgesParameters parameters;
  std::string value;
  for (std::size_t at = 0; at < all.size() && !parameters.terminated;)
  {
    const std::size_t length = trimmed(value).empty() ? stringLength(all, at) : 0;
    if (length > 0)
    {
      value = all.substr(at, length);
      at += length;
      continue;
    }
    const char c = all[at++];
    parameters.terminated = c == text.terminator;
    if (c == text.separator || parameters.terminated)
    {
      parameters.values.push_back(trimmed(value));
      value.clear();
    }
    else
    {
      value += c;
    }
  }
  return parameters;
}

void writeIgesText(const IgesText& text, const std::string& path)
{
  std::ofstream file(path, std::ios::binary);
  for (const std::string& line : text.head)
  {
    file << line << "\n";
  }
  int parameterLines = 0;
  for (const IgesEntry& entry : text.entries)
  {
    std::string first = entry.first;
    std::string second = entry.second;
    setField(first, 1, entry.type);
    setField(first, 2, parameterLines + 1);
    setField(second, 1, entry.type);
    setField(second, 4, static_cast<int>(entry.data.size()));
    writeLine(file, first, 'D', entry.number);
    writeLine(file, second, 'D', entry.number + 1);
    parameterLines += static_cast<int>(entry.data.size());
  }
  int number = 0;
  for (const IgesEntry& entry : text.entries)
  {
    for (const std::string& data : entry.data)
    {
      writeLine(file, parameterLine(data, entry.number), 'P', ++number);
    }
  }
  const auto startLines = std::count_if(text.head.begin(), text.head.end(),
    [](const std::string& line) { return line[sectionColumn] == 'S'; });
  char terminate[lineColumns];
  std::snprintf(terminate, sizeof(terminate), "S%7dG%7dD%7dP%7d", static_cast<int>(startLines),
    static_cast<int>(text.head.size()) - static_cast<int>(startLines),
    2 * static_cast<int>(text.entries.size()), number);
  writeLine(file, terminate, 'T', 1);
}

} // namespace cadrefine
