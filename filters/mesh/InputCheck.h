// What must hold of a data set so that it can be read at all.
#pragma once

class vtkPointSet;

namespace cadrefine
{

/// Throws Error where reading the data set would read outside its arrays or misread them: a point
/// or cell array (named) with another number of tuples than there are points or cells (cell arrays
/// of a data set without cells are not read, and may be of any length), a ghost array of cells that
/// is not of unsigned characters with one component, lists of cells that contradict themselves,
/// more points or cells than an Index counts. Whether cells name points that there are is seen when
/// they are read. Work: a look at each offset of the cells.
void checkInput(vtkPointSet* input);

} // namespace cadrefine
