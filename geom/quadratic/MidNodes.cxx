#include <cadrefine/quadratic/MidNodes.h>

#include <cadrefine/mesh/Quality.h>

namespace cadrefine
{

Vector3 sideOfCell(
  const SimplexMesh& mesh, const std::array<Index, 3>& triangle, const Vector3& plane)
{
  const auto& p = mesh.points;
  return plane != Vector3{} ? plane
                            : twofoldAreaVector(p[triangle[0]], p[triangle[1]], p[triangle[2]]);
}

std::vector<unsigned char> findValidCells(
  const SimplexMesh& mesh, const MidNodes& nodes, const Vector3& plane)
{
  std::vector<unsigned char> valid;
  const auto nodeAt = [&](Index edge) { return nodes.points[edge]; };
  if (mesh.dimension == 3)
  {
    for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    {
      valid.push_back(
        isValid(gatherNodes(mesh, mesh.tetrahedra[c], nodes.table.ofTetrahedra[c], nodeAt)));
    }
    return valid;
  }
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    const auto& triangle = mesh.triangles[c];
    valid.push_back(isValid(gatherNodes(mesh, triangle, nodes.table.ofTriangles[c], nodeAt),
      sideOfCell(mesh, triangle, plane)));
  }
  return valid;
}

} // namespace cadrefine
