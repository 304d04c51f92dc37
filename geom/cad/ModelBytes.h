// The portable form of a model: a small header, the shape in Open CASCADE's binary form, and a
// check sum. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <TopoDS_Shape.hxx>

#include <array>
#include <string>
#include <vector>

namespace cadrefine
{

/// Name and colour of a face, as in NurbsFace.
struct FaceLook
{
  std::string name;
  std::array<float, 3> color{ -1, -1, -1 };
};

/// All that a model is rebuilt from.
struct ModelContent
{
  TopoDS_Shape shape;
  std::string unit;
  std::vector<UnreadEntity> unread;
  std::vector<FaceLook> faces; ///< In the order of the faces, or empty.
  double size = 0;             ///< Diagonal of the bounding box.
};

std::vector<char> encodeModel(const ModelContent& content);

/// Throws Error where `bytes` were not made by encodeModel, are cut short or damaged.
ModelContent decodeModel(const std::vector<char>& bytes);

} // namespace cadrefine
