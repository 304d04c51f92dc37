// An IGES file (fixed 80 column form) as text: its sections and the parameters of its entities.
// Private to geom/cad.
#pragma once

#include <string>
#include <vector>

namespace cadrefine
{

/// A directory entry with the parameter lines that belong to it.
struct IgesEntry
{
  std::string first; ///< Its two lines in the directory section.
  std::string second;
  int number = 0; ///< Directory entry number, odd.
  int type = 0;
  std::vector<std::string> data; ///< Data columns of its parameter lines.
  /// The data of a line goes one column too far, into the field of the directory entry number: a
  /// fault of some writers, which costs Open CASCADE the whole entity. `data` has all of it.
  bool overrun = false;
};

struct IgesText
{
  std::vector<std::string> head; ///< Start and global section, unchanged.
  char separator = ',';
  char terminator = ';';
  std::vector<IgesEntry> entries;
};

/// Takes a file apart; without entries where it is not of this form (compressed or binary).
IgesText readIgesText(const std::string& path);

/// The parameters of an entry up to the terminator, without blanks around them; strings keep
/// their "nH".
struct IgesParameters
{
  std::vector<std::string> values;
  bool terminated = false;
};
IgesParameters parametersOf(const IgesEntry& entry, const IgesText& text);

/// Writes the file; parameter lines are numbered anew.
void writeIgesText(const IgesText& text, const std::string& path);

} // namespace cadrefine
