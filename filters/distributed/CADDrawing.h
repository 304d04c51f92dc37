// Poly data that shows a CAD model.
#pragma once

#include "CADModel.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace cadrefine
{

/// Which entities one rank draws, and how finely.
struct DrawingShare
{
  int rank = 0;
  int size = 1;
  double tolerance = CADModel::drawingTolerance; ///< Deflection as a part of the model's size.
};

/// This rank's share of the entities of a dimension (indices rank, rank + size, ...) as vertices,
/// lines or triangles with the cell array CADEntity, and with the normals of the faces if there
/// are. Where the file names or colours any entity of the dimension, there are cell arrays Name
/// (strings) and Color (red, green, blue, 0 to 255; white where it has none).
vtkSmartPointer<vtkPolyData> draw(const CADModel& model, int dimension, const DrawingShare& share);

} // namespace cadrefine
