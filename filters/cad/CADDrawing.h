// Poly data that shows a CAD model.
#pragma once

#include <cadrefine/cad/model/ModelDrawing.h>

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace cadrefine
{

/// The share of the entities of a dimension that `drawing` has, as vertices, lines or triangles
/// with the cell arrays CADDimension and CADEntity, and with the normals of the faces if there are.
/// Where the file names or colours any entity of the dimension, there are cell arrays Name
/// (strings) and Color (red, green, blue, 0 to 255; white where it has none).
vtkSmartPointer<vtkPolyData> draw(
  const CADModel& model, const ModelDrawing& drawing, int dimension, const DrawingShare& share);

/// The drawing of a dimension without any entity.
vtkSmartPointer<vtkPolyData> drawNothing(const CADModel& model, int dimension);

} // namespace cadrefine
