// The portable form of a model: a small header, the shape in Open CASCADE's binary form, and a
// check sum. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <TopoDS_Shape.hxx>

#include <vector>

namespace cadrefine
{

/// All that a model is rebuilt from.
struct ModelContent
{
  TopoDS_Shape shape;
  CADReport report;
  std::vector<EntityLook> faceLooks; ///< In the order of the faces, or empty.
  std::vector<EntityLook> edgeLooks;
  double size = 0; ///< Diagonal of the bounding box.
};

std::vector<char> encodeModel(const ModelContent& content);

/// Throws Error where `bytes` were not made by encodeModel, are cut short or damaged.
ModelContent decodeModel(const std::vector<char>& bytes);

} // namespace cadrefine
