// What became of many files.
#pragma once

#include "ReadProbe.h"

#include <string>

namespace badcad
{

struct Tally
{
  int inputs = 0;
  int models = 0;
  int errors = 0;
  int childCrashes = 0; ///< Of the errors.
  int childTimeOuts = 0;
  int childMemory = 0;
  int bad = 0;
  double megabytes = 0; ///< The most.
  double seconds = 0;   ///< Of computing, the most.

  void add(const ReadOutcome& outcome);

  /// A row of a table.
  void print(const std::string& name) const;
  static void printHeading();
};

} // namespace badcad
