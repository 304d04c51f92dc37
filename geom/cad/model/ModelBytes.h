// The portable form of a model: a small header, the shape in Open CASCADE's binary form, and a
// check sum. Private to geom/cad.
#pragma once

#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/cad/model/LengthUnit.h>

#include <TopoDS_Shape.hxx>

#include <vector>

namespace cadrefine
{

/// All that a model is rebuilt from.
struct ModelContent
{
  TopoDS_Shape shape;
  LengthScale scale; ///< From the shape's coordinates to those of all the rest, and of the model.
  CADReport report;
  std::vector<EntityAttributes> faceAttributes; ///< In the order of the faces, or empty.
  std::vector<EntityAttributes> edgeAttributes;
  double size = 0; ///< Diagonal of the bounding box.
};

std::vector<char> encodeModel(const ModelContent& content);

/// Throws Error where `bytes` were not made by encodeModel, are cut short or damaged.
ModelContent decodeModel(const std::vector<char>& bytes);

/// Whether Open CASCADE reads the shape back that it writes.
bool canBeWritten(const TopoDS_Shape& shape);

} // namespace cadrefine
