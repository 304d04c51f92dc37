// An IGES file (fixed 80 column form) as text: its entities and their parameters. Private to
// geom/cad.
#pragma once

#include <string>
#include <vector>

namespace cadrefine
{

/// Field 9 of a directory entry.
struct IgesStatus
{
  bool blanked = false;
  int subordinate = 0; ///< 0 independent, 1 physically dependent, 2 logically, 3 both.
  int use = 0;         ///< 0 geometry, 1 annotation, 2 definition, 3 other, 4 logical,
                       ///< 5 parametric, 6 construction.
  int hierarchy = 0;   ///< 0: what it says holds for its physically dependent parts.
};

/// A directory entry with the parameter lines that belong to it.
struct IgesEntry
{
  std::string first; ///< Its two lines in the directory section.
  std::string second;
  int number = 0; ///< Directory entry number, odd.
  int type = 0;
  int form = 0;
  int matrix = 0; ///< Directory entry of its transformation, or 0.
  IgesStatus status;
  std::vector<std::string> data; ///< Data columns of its parameter lines.
  /// The data of a line goes one column too far, into the field of the directory entry number: a
  /// fault of some writers, which costs Open CASCADE the whole entity. `data` has all of it.
  bool overrun = false;
};

struct IgesText
{
  std::vector<std::string> start, global; ///< Unchanged.
  char separator = ',';
  char terminator = ';';
  std::vector<IgesEntry> entries;
  bool complete = false; ///< False where the end may be missing.
  /// What is wrong with the file and put right by writeIgesText, each in a phrase.
  std::vector<std::string> faults;
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

/// Makes the parameter lines of an entry anew, cut between the values where these fit.
std::vector<std::string> wrapParameters(const IgesParameters& parameters, const IgesText& text);

/// Writes the file; all lines are numbered and counted anew.
void writeIgesText(const IgesText& text, const std::string& path);

} // namespace cadrefine
