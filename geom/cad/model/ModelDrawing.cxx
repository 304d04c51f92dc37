#include <cadrefine/cad/model/ModelDrawing.h>

#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/model/DrawnEntity.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

/// The items of ReadStep::Drawing.
std::vector<DrawnEntity> drawnEntities(const CADModel& model, const DrawingShare& share)
{
  std::vector<bool> edges(model.count(1));
  for (int e = 0; e < model.count(1); ++e)
  {
    edges[e] = share.has(e);
  }
  for (int v = 0; v < model.count(0); ++v)
  {
    const auto& atVertex = model.nurbs().vertices[v].edges;
    if (share.has(v) && !atVertex.empty())
    {
      edges[atVertex.front()] = true;
    }
  }
  std::vector<DrawnEntity> entities;
  for (int e = 0; e < model.count(1); ++e)
  {
    if (edges[e])
    {
      entities.push_back({ { 1, e }, firstFaceAt(model.nurbs(), { 1, e }) });
    }
  }
  for (int f = share.rank; f < model.count(2); f += share.size)
  {
    entities.push_back({ { 2, f }, f });
  }
  return entities;
}

/// Puts what became of an entity into its place.
void take(DrawnItem item, EntityId entity, ModelDrawing& drawing)
{
  const bool isEdge = entity.dimension == 1;
  if (!item.fault.empty())
  {
    drawing.undrawn.push_back(
      (isEdge ? "edge " : "face ") + std::to_string(entity.index) + " is not drawn: " + item.fault);
  }
  (isEdge ? drawing.edges : drawing.faces)[entity.index] = std::move(item.drawing);
}

/// Limits by the size of the model's bytes. Far more than drawing takes: a terrain's one face, 7 s
/// for each megabyte of its file.
RunLimits limitsFor(std::size_t bytes)
{
  constexpr int day = 86400;
  const double megabytes = 1e-6 * static_cast<double>(bytes);
  RunLimits limits;
  limits.cpuSeconds = day;
  limits.stepSeconds = static_cast<int>(std::min<double>(day, 10 + 60 * megabytes));
  limits.megabytes = static_cast<std::uint64_t>(2048 + 300 * megabytes);
  return limits;
}

} // namespace

ModelDrawing drawModel(
  const CADModel& model, double deflection, const DrawingShare& share, int threads)
{
  if (!(deflection > 0))
  {
    throw Error("the deflection of a drawing must be positive");
  }
  const std::vector<DrawnEntity> entities = drawnEntities(model, share);
  const std::vector<char> bytes = model.toBytes();
  ByteWriter input;
  input.number(deflection);
  input.array(entities);
  input.array(bytes);
  const std::vector<char> answer =
    runAttempts("draw", "drawing the CAD model", limitsFor(bytes.size()), threads, input.bytes);
  ByteReader reader(answer.data(), answer.data() + answer.size());
  std::vector<DrawnItem> items = reader.list([&] { return readItem(reader); });
  ModelDrawing drawing;
  drawing.edges.resize(model.count(1));
  drawing.faces.resize(model.count(2));
  drawing.undrawn = reader.list([&] { return reader.text(); });
  for (std::size_t i = 0; i < entities.size(); ++i)
  {
    take(std::move(items[i]), entities[i].entity, drawing);
  }
  return drawing;
}

} // namespace cadrefine
