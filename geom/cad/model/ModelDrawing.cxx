#include <cadrefine/cad/model/ModelDrawing.h>

#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/model/ByteRecords.h>

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

/// Why the entity cannot be drawn; empty: `drawing` is it.
std::string drawEntity(
  const CADModel& model, EntityId entity, double deflection, Tessellation& drawing)
{
  try
  {
    Tessellation made = model.tessellate(entity, deflection);
    if (!std::all_of(made.points.begin(), made.points.end(), isFinite))
    {
      return "a point is not finite";
    }
    drawing = std::move(made);
    return "";
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

/// The items of ReadStep::Drawing.
std::vector<EntityId> drawnEntities(const CADModel& model, const DrawingShare& share)
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
  std::vector<EntityId> entities;
  for (int e = 0; e < model.count(1); ++e)
  {
    if (edges[e])
    {
      entities.push_back({ 1, e });
    }
  }
  for (int f = share.rank; f < model.count(2); f += share.size)
  {
    entities.push_back({ 2, f });
  }
  return entities;
}

/// Adds lines for those entities of the share that have a fault.
void addUndrawn(const DrawingShare& share, const std::vector<EntityId>& entities,
  const std::vector<std::string>& faults, std::vector<std::string>& lines)
{
  for (std::size_t i = 0; i < entities.size(); ++i)
  {
    const EntityId entity = entities[i];
    if (!faults[i].empty() && share.has(entity.index))
    {
      lines.push_back((entity.dimension == 1 ? "edge " : "face ") + std::to_string(entity.index) +
                      " is not drawn: " + faults[i]);
    }
  }
}

ModelDrawing drawShare(
  const CADModel& model, double deflection, const DrawingShare& share, const ReadOptions& options)
{
  const std::vector<EntityId> entities = drawnEntities(model, share);
  ModelDrawing drawing;
  drawing.edges.resize(model.count(1));
  drawing.faces.resize(model.count(2));
  std::vector<std::string> faults(entities.size());
  forEachIndex(forOnOwnThreads(options.threads), entities.size(), 1,
    [&](std::size_t i)
    {
      const EntityId entity = entities[i];
      const int item = static_cast<int>(i);
      options.noteItem(ReadStep::Drawing, item);
      const auto leftOut = options.withoutDrawings.find(item);
      faults[i] = leftOut != options.withoutDrawings.end()
                    ? leftOut->second
                    : drawEntity(model, entity, deflection,
                        (entity.dimension == 1 ? drawing.edges : drawing.faces)[entity.index]);
    });
  noteStep(static_cast<int>(ReadStep::Other));
  drawing.undrawn = options.notes();
  addUndrawn(share, entities, faults, drawing.undrawn);
  return drawing;
}

void write(ByteWriter& writer, const std::vector<Tessellation>& drawings)
{
  writer.list(drawings,
    [&](const Tessellation& drawing)
    {
      writer.array(drawing.points);
      writer.array(drawing.normals);
      writer.array(drawing.triangles);
      writer.array(drawing.line);
    });
}

std::vector<Tessellation> readTessellations(ByteReader& reader)
{
  return reader.list(
    [&]
    {
      Tessellation drawing;
      drawing.points = reader.array<Point3>();
      drawing.normals = reader.array<Vector3>();
      drawing.triangles = reader.array<std::array<int, 3>>();
      drawing.line = reader.array<int>();
      return drawing;
    });
}

std::vector<char> encode(const ModelDrawing& drawing)
{
  ByteWriter writer;
  write(writer, drawing.edges);
  write(writer, drawing.faces);
  writer.list(drawing.undrawn, [&](const std::string& line) { writer.text(line); });
  return std::move(writer.bytes);
}

ModelDrawing decode(const std::vector<char>& bytes)
{
  ByteReader reader(bytes.data(), bytes.data() + bytes.size());
  ModelDrawing drawing;
  drawing.edges = readTessellations(reader);
  drawing.faces = readTessellations(reader);
  drawing.undrawn = reader.list([&] { return reader.text(); });
  return drawing;
}

/// By the size of the model's bytes. Far more than drawing takes: a terrain's one face, 7 s for
/// each megabyte of its file.
RunLimits limitsFor(std::size_t bytes)
{
  constexpr int day = 86400;
  const double megabytes = 1e-6 * static_cast<double>(bytes);
  RunLimits limits;
  limits.cpuSeconds = day;
  limits.stepSeconds = static_cast<int>(std::min<double>(day, 20 + 60 * megabytes));
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
  const std::string context = "drawing the CAD model";
  return decode(runAttempts(context, limitsFor(model.toBytes().size()), threads,
    [&](const ReadOptions& options)
    {
      return guardOcc(
        context, [&] { return encode(drawShare(model, deflection, share, options)); });
    }));
}

} // namespace cadrefine
