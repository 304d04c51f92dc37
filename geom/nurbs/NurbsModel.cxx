#include <cadrefine/nurbs/NurbsModel.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{

const BezierPatch& patchAt(const NurbsFace& face, double u, double v)
{
  int i = 0;
  while (i + 1 < face.patchesU && face.patches[(i + 1) * face.patchesV].u0 <= u)
  {
    ++i;
  }
  int j = 0;
  while (j + 1 < face.patchesV && face.patches[j + 1].v0 <= v)
  {
    ++j;
  }
  return face.patches[i * face.patchesV + j];
}

bool liesInPlane(const NurbsModel& model, const Vector3& normal, double offset, double tolerance)
{
  const auto isIn = [&](const Point3& p) { return std::abs(dot(normal, p) - offset) <= tolerance; };
  const auto areIn = [&](const auto& piece)
  {
    return std::all_of(piece.points.begin(), piece.points.end(),
      [&](const ControlPoint& p) {
        return isIn({ p[0] / p[3], p[1] / p[3], p[2] / p[3] });
      });
  };
  return std::all_of(model.vertices.begin(), model.vertices.end(),
           [&](const NurbsVertex& vertex) { return isIn(vertex.point); }) &&
         std::all_of(model.edges.begin(), model.edges.end(),
           [&](const NurbsEdge& edge)
           { return std::all_of(edge.segments.begin(), edge.segments.end(), areIn); }) &&
         std::all_of(model.faces.begin(), model.faces.end(),
           [&](const NurbsFace& face)
           { return std::all_of(face.patches.begin(), face.patches.end(), areIn); });
}

std::int32_t firstFaceAt(const NurbsModel& model, EntityId entity)
{
  if (entity.dimension == 2)
  {
    return entity.index;
  }
  if (entity.dimension == 1)
  {
    const auto& faces = model.edges[entity.index].faces;
    return faces.empty() ? -1 : faces.front();
  }
  for (const std::int32_t edge : model.vertices[entity.index].edges)
  {
    if (!model.edges[edge].faces.empty())
    {
      return model.edges[edge].faces.front();
    }
  }
  return -1;
}

} // namespace cadrefine
