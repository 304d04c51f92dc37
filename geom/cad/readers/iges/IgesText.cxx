// 1. Sort the lines into sections (IgesSections).
// 2. Find each entity's parameter lines. Both the directory (first line and count) and the lines
//    themselves (directory entry number) tell; where they disagree, the one that makes sense for
//    the whole file is taken.
// 3. Where some lines run one column too far, decide for all.

#include <cadrefine/cad/readers/iges/IgesText.h>

#include <cadrefine/cad/readers/iges/IgesSections.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace cadrefine
{
namespace
{

/// Both delimiters stand at the start of the global section: "1H,,1H;," or nothing for defaults.
void findDelimiters(IgesText& text)
{
  std::string global;
  for (const std::string& line : text.global)
  {
    global += line.substr(0, igesSectionColumn);
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

IgesStatus statusOf(const std::string& line)
{
  const auto digits = [&](std::size_t column)
  { return std::atoi(line.substr(igesDataColumns + column, 2).c_str()); };
  return { digits(0) == 1, digits(2), digits(4), digits(6) };
}

IgesEntry makeEntry(const std::string& first, const std::string& second, std::size_t line)
{
  IgesEntry entry;
  entry.first = first;
  entry.second = second;
  entry.number = static_cast<int>(line) + 1;
  entry.type = igesField(first, 1);
  entry.matrix = igesField(first, 7);
  entry.form = igesField(second, 5);
  entry.status = statusOf(first);
  return entry;
}

enum class Width
{
  Regular,
  Unclear, ///< The column after the data holds a zero, which may be padding or data.
  Wide
};

/// The directory entry number that a parameter line names.
int ownerOf(const std::string& line)
{
  constexpr std::size_t digits = 7;
  return std::atoi(
    line.substr(igesDataColumns + (isShiftedIgesLine(line) ? 2 : 1), digits).c_str());
}

Width widthOf(const std::string& line, int number)
{
  if (isShiftedIgesLine(line))
  {
    return Width::Wide;
  }
  if (line[igesDataColumns] == ' ' || ownerOf(line) != number)
  {
    return Width::Regular;
  }
  return line[igesDataColumns] == '0' ? Width::Unclear : Width::Wide;
}

/// The numbers of the parameter lines of each entry.
using LineNumbers = std::vector<std::vector<std::size_t>>;

LineNumbers linesByDirectory(const IgesText& text, std::size_t count)
{
  LineNumbers numbers(text.entries.size());
  for (std::size_t e = 0; e < text.entries.size(); ++e)
  {
    const int from = std::max(igesField(text.entries[e].first, 2) - 1, 0);
    const int lines = std::max(igesField(text.entries[e].second, 4), 1);
    for (int i = from; i < from + lines && i < static_cast<int>(count); ++i)
    {
      numbers[e].push_back(static_cast<std::size_t>(i));
    }
  }
  return numbers;
}

LineNumbers linesByOwner(const IgesText& text, const std::vector<std::string>& lines)
{
  LineNumbers numbers(text.entries.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    const int owner = ownerOf(lines[i]);
    const std::size_t entry = static_cast<std::size_t>(owner) / 2;
    if (owner > 0 && owner % 2 == 1 && entry < numbers.size())
    {
      numbers[entry].push_back(i);
    }
  }
  return numbers;
}

/// True where each line belongs to one entry, and each entry has lines.
bool isPartition(const LineNumbers& numbers, std::size_t count)
{
  std::vector<int> uses(count, 0);
  for (const auto& lines : numbers)
  {
    if (lines.empty())
    {
      return false;
    }
    for (const std::size_t i : lines)
    {
      ++uses[i];
    }
  }
  return std::all_of(uses.begin(), uses.end(), [](int use) { return use == 1; });
}

LineNumbers assignLines(IgesText& text, const std::vector<std::string>& lines)
{
  LineNumbers byDirectory = linesByDirectory(text, lines.size());
  LineNumbers byOwner = linesByOwner(text, lines);
  if (byDirectory == byOwner)
  {
    return byDirectory;
  }
  if (isPartition(byOwner, lines.size()))
  {
    text.faults.emplace_back("the directory gives wrong parameter lines or counts of lines");
    return byOwner;
  }
  if (isPartition(byDirectory, lines.size()))
  {
    text.faults.emplace_back("parameter lines name wrong directory entries");
  }
  return byDirectory;
}

/// `unclear`: what to take lines of unclear width for.
void takeParameterLines(IgesEntry& entry, const std::vector<std::size_t>& numbers,
  const std::vector<std::string>& lines, Width unclear)
{
  entry.data.clear();
  entry.overrun = false;
  for (const std::size_t i : numbers)
  {
    Width width = widthOf(lines[i], entry.number);
    width = width == Width::Unclear ? unclear : width;
    const bool wide = width == Width::Wide;
    entry.overrun = entry.overrun || wide;
    entry.data.push_back(lines[i].substr(0, igesDataColumns + (wide ? 1 : 0)));
  }
}

/// Takes the parameter lines of all entries. Where some lines surely run too far, the unclear ones
/// do too.
void takeAllParameters(IgesText& text, const std::vector<std::string>& lines)
{
  const LineNumbers numbers = assignLines(text, lines);
  const auto take = [&](Width unclear)
  {
    for (std::size_t e = 0; e < text.entries.size(); ++e)
    {
      takeParameterLines(text.entries[e], numbers[e], lines, unclear);
    }
  };
  take(Width::Regular);
  if (std::any_of(
        text.entries.begin(), text.entries.end(), [](const IgesEntry& e) { return e.overrun; }) &&
      std::none_of(lines.begin(), lines.end(), isShiftedIgesLine))
  {
    take(Width::Wide);
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

} // namespace

IgesText readIgesText(const std::string& path)
{
  IgesText text;
  IgesSections sections = readIgesSections(path);
  text.start = std::move(sections.start);
  text.global = std::move(sections.global);
  text.faults = std::move(sections.faults);
  text.complete = sections.terminated;
  findDelimiters(text);
  for (std::size_t i = 0; i + 1 < sections.directory.size(); i += 2)
  {
    text.entries.push_back(makeEntry(sections.directory[i], sections.directory[i + 1], i));
  }
  takeAllParameters(text, sections.parameters);
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
  if (!trimmed(value).empty())
  {
    parameters.values.push_back(trimmed(value));
  }
  return parameters;
}

} // namespace cadrefine
