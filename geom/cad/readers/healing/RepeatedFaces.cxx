#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <BinTools.hxx>
#include <BinTools_FormatVersion.hxx>

#include <set>
#include <sstream>
#include <string>

namespace cadrefine
{

DistinctFaces distinctFaces(const std::vector<TopoDS_Shape>& faces)
{
  constexpr bool withTriangles = false;
  constexpr bool withNormals = false;
  std::set<std::string> known;
  DistinctFaces distinct;
  for (const TopoDS_Shape& face : faces)
  {
    std::ostringstream stream(std::ios::binary);
    BinTools::Write(face, stream, withTriangles, withNormals, BinTools_FormatVersion_CURRENT);
    (known.insert(stream.str()).second ? distinct.faces : distinct.repeated).push_back(face);
  }
  return distinct;
}

} // namespace cadrefine
