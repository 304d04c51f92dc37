// Trim loops of a face. Private to geom/cad.
#pragma once

#include "NurbsModel.h"

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
/// lie side by side. A period of 0 stands for none.
std::vector<TrimLoop> extractLoops(const TopoDS_Face& face, double periodU, double periodV);

/// Hull of the loops' control points.
ParameterBox hullOf(const std::vector<TrimLoop>& loops);

/// True where `loops` is one loop that runs once round `box` along its border.
bool followsBorder(const std::vector<TrimLoop>& loops, const ParameterBox& box);

} // namespace cadrefine
