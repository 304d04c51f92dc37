// The parts of the aeroplane, each a closed solid that reaches into its neighbours.
#pragma once

#include <TopoDS_Shape.hxx>

#include <vector>

namespace aeroplane
{

/// How the parts' surfaces are cut into patches.
enum class Layout
{
  Patches, ///< At every frame and stringer.
  Plain    ///< Into as few faces as bound a solid; the same surfaces.
};

struct Part
{
  const char* name; ///< At most eight letters: the label of IGES.
  int color;        ///< IGES colour number.
  TopoDS_Shape solid;
};

/// Open CASCADE's length of a metre, the unit of all numbers in the formulas: its fixed tolerances
/// mean millimetres.
constexpr double metre = 1000;

/// Fuselage, canopy, fin, and on both sides wing, tailplane, nacelle and pylon.
std::vector<Part> makeParts(Layout layout);

} // namespace aeroplane
