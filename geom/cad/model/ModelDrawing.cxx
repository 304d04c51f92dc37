#include <cadrefine/cad/model/ModelDrawing.h>

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/extraction/ShapeTessellation.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/import/ReadJobs.h>
#include <cadrefine/cad/model/ByteRecords.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

bool isFinite(const Point3& p)
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

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

/// What became of one item.
struct DrawnItem
{
  Tessellation drawing; ///< Empty where there is a fault.
  std::string fault;
};

DrawnItem drawItem(
  const ShapeIndex& index, const LengthScale& scale, const DrawnEntity& drawn, double deflection)
{
  try
  {
    Tessellation drawing = tessellate(index, scale, drawn, deflection);
    const bool finite = std::all_of(drawing.points.begin(), drawing.points.end(), isFinite);
    return finite ? DrawnItem{ std::move(drawing), "" } : DrawnItem{ {}, "a point is not finite" };
  }
  catch (const Error& error)
  {
    return { {}, error.what() };
  }
}

std::vector<DrawnItem> drawItems(const ModelContent& content,
  const std::vector<DrawnEntity>& entities, double deflection, const ReadOptions& options)
{
  const ShapeIndex index(content.shape);
  std::vector<DrawnItem> items(entities.size());
  forEachIndex(forOnOwnThreads(options.threads), entities.size(), 1,
    [&](std::size_t i)
    {
      const int item = static_cast<int>(i);
      options.noteItem(ReadStep::Drawing, item);
      const auto leftOut = options.withoutDrawings.find(item);
      items[i] = leftOut != options.withoutDrawings.end()
                   ? DrawnItem{ {}, leftOut->second }
                   : drawItem(index, content.scale, entities[i], deflection);
    });
  noteStep(static_cast<int>(ReadStep::Other));
  return items;
}

void write(ByteWriter& writer, const DrawnItem& item)
{
  writer.array(item.drawing.points);
  writer.array(item.drawing.normals);
  writer.array(item.drawing.triangles);
  writer.array(item.drawing.line);
  writer.text(item.fault);
}

DrawnItem readItem(ByteReader& reader)
{
  DrawnItem item;
  item.drawing.points = reader.array<Point3>();
  item.drawing.normals = reader.array<Vector3>();
  item.drawing.triangles = reader.array<std::array<int, 3>>();
  item.drawing.line = reader.array<int>();
  item.fault = reader.text();
  return item;
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

/// By the size of the model's bytes. Far more than drawing takes: a terrain's one face, 7 s for
/// each megabyte of its file.
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

std::vector<char> drawJob(const std::string& /*context*/, ByteReader& input)
{
  const ReadOptions options = takeOptions(input);
  const auto deflection = input.number<double>();
  const auto entities = input.array<DrawnEntity>();
  const ModelContent content = decodeModel(input.array<char>());
  ByteWriter writer;
  writer.list(drawItems(content, entities, deflection, options),
    [&](const DrawnItem& item) { write(writer, item); });
  writer.list(options.notes(), [&](const std::string& line) { writer.text(line); });
  return std::move(writer.bytes);
}

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
