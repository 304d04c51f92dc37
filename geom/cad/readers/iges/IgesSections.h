// The lines of an IGES file (fixed 80 column form), sorted into its sections. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IgesLine.h>

#include <string>
#include <vector>

namespace cadrefine
{

struct IgesSections
{
  std::vector<std::string> start, global, directory, parameters; ///< At least 80 columns each.
  bool terminated = false; ///< True where the terminate section is there.
  /// What is wrong with the lines and was put right here, each in a phrase.
  std::vector<std::string> faults;
};

/// Reads the sections of a file. Lines may end in LF, CR or CR LF. Tabs become blanks, longer lines
/// are cut, lines of no section are left out. The counts of the terminate section are compared with
/// the lines found.
IgesSections readIgesSections(const std::string& path);

/// Whether this is a parameter line of 81 columns, whose section letter has moved.
bool isShiftedIgesLine(const std::string& line);

/// The integer in a field of 8 columns; fields count from 1.
int igesField(const std::string& line, int field);

} // namespace cadrefine
