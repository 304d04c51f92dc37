// The table of an adaptation.
#pragma once

#include <vtkNew.h>

#include <cstdint>
#include <string>

class vtkFieldData;
class vtkTable;

namespace cadrefine
{

/// A row a step; see adaptMesh.
class ConvergenceTable
{
public:
  /// An empty table with all of its columns.
  ConvergenceTable();

  /// Appends a row for a measured mesh, given its field data.
  void addStep(std::int64_t markedCells, vtkFieldData* ofMesh);
  void setStopReason(const std::string& reason);

  vtkTable* table() const { return table_; }

private:
  vtkNew<vtkTable> table_;
};

} // namespace cadrefine
