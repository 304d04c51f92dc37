// Trim loops of a face. Private to geom/cad.
#pragma once

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/nurbs/NurbsModel.h>

#include <TopoDS_Face.hxx>

#include <vector>

namespace cadrefine
{

/// Rectangle of parameters.
struct ParameterBox
{
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
};

/// Closed loops of the wires of `face`, shifted by whole periods so that each is connected and all
/// lie side by side. A period of 0 stands for none. With `index`, curves know their edges.
std::vector<TrimLoop> extractLoops(
  const TopoDS_Face& face, double periodU, double periodV, const ShapeIndex* index);

/// Hull of the loops' control points.
ParameterBox hullOf(const std::vector<TrimLoop>& loops);

/// Extent of the loops themselves, of points along them.
ParameterBox extentOf(const std::vector<TrimLoop>& loops);

/// True where `loops` is one loop that runs once round `box` along its border.
bool followsBorder(const std::vector<TrimLoop>& loops, const ParameterBox& box);

} // namespace cadrefine
