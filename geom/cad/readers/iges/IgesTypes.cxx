#include <cadrefine/cad/readers/iges/IgesTypes.h>

#include <cadrefine/cad/model/LengthUnit.h>

#include <map>

namespace cadrefine
{
namespace
{

const std::map<int, const char*>& typeNames()
{
  static const std::map<int, const char*> names{ { 100, "circular arc" },
    { 102, "composite curve" }, { 104, "conic arc" }, { 106, "copious data" }, { 108, "plane" },
    { 110, "line" }, { 112, "parametric spline curve" }, { 114, "parametric spline surface" },
    { 116, "point" }, { 118, "ruled surface" }, { 120, "surface of revolution" },
    { 122, "tabulated cylinder" }, { 123, "direction" }, { 124, "transformation matrix" },
    { 126, "rational B-spline curve" }, { 128, "rational B-spline surface" },
    { 130, "offset curve" }, { 140, "offset surface" }, { 141, "boundary" },
    { 142, "curve on a parametric surface" }, { 143, "bounded surface" },
    { 144, "trimmed surface" }, { 150, "block" }, { 152, "right angular wedge" },
    { 154, "right circular cylinder" }, { 156, "right circular cone frustum" }, { 158, "sphere" },
    { 160, "torus" }, { 162, "solid of revolution" }, { 164, "solid of linear extrusion" },
    { 168, "ellipsoid" }, { 180, "Boolean tree" }, { 184, "solid assembly" },
    { 186, "manifold solid B-rep object" }, { 190, "plane surface" },
    { 192, "right circular cylindrical surface" }, { 194, "right circular conical surface" },
    { 196, "spherical surface" }, { 198, "toroidal surface" }, { 308, "subfigure definition" },
    { 402, "group" }, { 408, "singular subfigure" }, { 430, "solid instance" },
    { 502, "vertex list" }, { 504, "edge list" }, { 508, "loop" }, { 510, "face" },
    { 514, "shell" } };
  return names;
}

} // namespace

std::string igesTypeName(int type)
{
  const auto found = typeNames().find(type);
  const std::string name = "IGES " + std::to_string(type);
  return found == typeNames().end() ? name : name + " (" + found->second + ")";
}

bool isIgesPartOfModel(int type)
{
  switch (type)
  {
    case 123: // directions, matrices, flashes, finite elements
    case 124:
    case 125:
    case 132:
    case 134:
    case 136:
    case 138:
    case 146:
    case 148:
      return false;
    default: // unbounded analytic surfaces (190 to 198) and B-rep parts only carry faces
      return (type >= 100 && type <= 186) || type == 430 || type == 510 || type == 514;
  }
}

bool isIgesGroup(int type)
{
  return type == 402 || type == 308 || type == 408;
}

std::string igesUnitName(int flag, const std::string& name)
{
  static const std::map<int, const char*> names{ { 1, "in" }, { 2, "mm" }, { 4, "ft" }, { 5, "mi" },
    { 6, "m" }, { 7, "km" }, { 8, "mil" }, { 9, "um" }, { 10, "cm" }, { 11, "uin" } };
  const auto found = names.find(flag);
  return found != names.end() ? found->second : shortUnitName(name);
}

} // namespace cadrefine
