#include "ShapePreparation.h"

#include <BinTools.hxx>
#include <BinTools_FormatVersion.hxx>

#include <set>
#include <sstream>
#include <string>

namespace cadrefine
{

std::vector<TopoDS_Shape> distinctFaces(const std::vector<TopoDS_Shape>& faces)
{
  constexpr bool withTriangles = false;
  constexpr bool withNormals = false;
  std::set<std::string> known;
  std::vector<TopoDS_Shape> distinct;
  for (const TopoDS_Shape& face : faces)
  {
    std::ostringstream stream(std::ios::binary);
    BinTools::Write(face, stream, withTriangles, withNormals, BinTools_FormatVersion_CURRENT);
    if (known.insert(stream.str()).second)
    {
      distinct.push_back(face);
    }
  }
  return distinct;
}

} // namespace cadrefine
