#include <cadrefine/cad/readers/iges/IgesSections.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>

namespace cadrefine
{
namespace
{

constexpr std::size_t fieldColumns = 8;

/// The next line, which may end in LF, CR or CR LF; of one that is far too long, the start. False
/// at the end of the file.
bool readLine(std::streambuf& file, std::string& line)
{
  constexpr std::size_t longest = 1000;
  constexpr int end = std::streambuf::traits_type::eof();
  line.clear();
  int c = file.sbumpc();
  if (c == end)
  {
    return false;
  }
  for (; c != end && c != '\r' && c != '\n'; c = file.sbumpc())
  {
    if (line.size() < longest)
    {
      line += static_cast<char>(c);
    }
  }
  if (c == '\r' && file.sgetc() == '\n')
  {
    file.sbumpc();
  }
  return true;
}

/// The next line of a file without line ends.
bool readRecord(std::streambuf& file, std::string& line)
{
  line.assign(igesLineColumns, ' ');
  return file.sgetn(line.data(), static_cast<std::streamsize>(line.size())) > 0;
}

bool isSectionLetter(char c)
{
  return std::string("SGDPT").find(c) != std::string::npos;
}

bool endsWell(const std::string& line)
{
  return line.size() > igesSectionColumn && isSectionLetter(line[igesSectionColumn]);
}

/// Each tab to the next multiple of 8 columns, or, where that does not bring the section's letter
/// into its column, to one blank.
std::string withoutTabs(const std::string& line)
{
  std::string wide;
  for (const char c : line)
  {
    const std::size_t blanks = fieldColumns - wide.size() % fieldColumns;
    wide += c == '\t' ? std::string(blanks, ' ') : std::string(1, c);
  }
  if (endsWell(wide))
  {
    return wide;
  }
  std::string narrow = line;
  std::replace(narrow.begin(), narrow.end(), '\t', ' ');
  return narrow;
}

/// What a pass over the lines finds.
struct Counts
{
  int tabs = 0;
  int tooLong = 0;
  int misnumbered = 0;
  std::string terminate;
};

/// Whether the file is one line without end, in which two records of 80 columns come first.
bool hasNoLineEnds(const std::string& path)
{
  std::string start(2 * igesLineColumns, '\n');
  std::ifstream(path, std::ios::binary)
    .read(start.data(), static_cast<std::streamsize>(start.size()));
  return start.find_first_of("\r\n") == std::string::npos && endsWell(start) &&
         isSectionLetter(start[igesLineColumns + igesSectionColumn]);
}

void sortLine(std::string line, IgesSections& sections, Counts& counts)
{
  if (line.find('\t') != std::string::npos)
  {
    ++counts.tabs;
    line = withoutTabs(line);
  }
  line.resize(std::max(line.size(), igesLineColumns), ' ');
  const bool shifted = isShiftedIgesLine(line);
  const std::size_t width = igesLineColumns + (shifted ? 1 : 0);
  const char letter = shifted ? 'P' : line[igesSectionColumn];
  if (!isSectionLetter(letter))
  {
    return;
  }
  if (line.size() > width)
  {
    ++counts.tooLong;
    line.resize(width);
  }
  if (letter == 'T')
  {
    counts.terminate = line;
    return;
  }
  auto& section = letter == 'S'   ? sections.start
                  : letter == 'G' ? sections.global
                  : letter == 'D' ? sections.directory
                                  : sections.parameters;
  section.push_back(line);
  const int number = std::atoi(line.c_str() + igesSectionColumn + (shifted ? 2 : 1));
  counts.misnumbered += number == static_cast<int>(section.size()) ? 0 : 1;
}

void noteLines(const Counts& counts, std::vector<std::string>& faults)
{
  const auto note = [&](int count, const std::string& what)
  {
    if (count > 0)
    {
      faults.push_back(std::to_string(count) + " lines " + what);
    }
  };
  note(counts.tabs, "hold tabs");
  note(counts.tooLong, "have more than 80 columns");
  note(counts.misnumbered, "have wrong sequence numbers");
}

void noteTerminate(const std::string& terminate, IgesSections& sections)
{
  if (terminate.empty())
  {
    sections.faults.emplace_back("the terminate section is missing");
    return;
  }
  sections.terminated = true;
  const std::array<const std::vector<std::string>*, 4> all{ &sections.start, &sections.global,
    &sections.directory, &sections.parameters };
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const char letter = "SGDP"[i];
    const std::string field = terminate.substr(i * fieldColumns, fieldColumns);
    const int count = std::atoi(field.c_str() + 1);
    if (field[0] != letter || count != static_cast<int>(all[i]->size()))
    {
      sections.faults.push_back("the terminate section counts " + std::to_string(count) + " " +
                                letter + " lines, there are " + std::to_string(all[i]->size()));
    }
  }
}

} // namespace

bool isShiftedIgesLine(const std::string& line)
{
  return line.size() > igesSectionColumn + 1 && line[igesSectionColumn + 1] == 'P' &&
         std::isdigit(static_cast<unsigned char>(line[igesSectionColumn]));
}

int igesField(const std::string& line, int field)
{
  return std::atoi(line.substr((field - 1) * fieldColumns, fieldColumns).c_str());
}

IgesSections readIgesSections(const std::string& path)
{
  IgesSections sections;
  Counts counts;
  std::filebuf file;
  file.open(path, std::ios::in | std::ios::binary);
  const bool endless = hasNoLineEnds(path);
  if (endless)
  {
    sections.faults.emplace_back("its lines have no ends");
  }
  for (std::string line; endless ? readRecord(file, line) : readLine(file, line);)
  {
    sortLine(line, sections, counts);
  }
  noteLines(counts, sections.faults);
  noteTerminate(counts.terminate, sections);
  if (sections.directory.size() % 2 != 0)
  {
    sections.faults.emplace_back("the directory section ends with half an entry");
    sections.directory.pop_back();
  }
  return sections;
}

} // namespace cadrefine
