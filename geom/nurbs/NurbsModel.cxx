#include <cadrefine/nurbs/NurbsModel.h>

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
