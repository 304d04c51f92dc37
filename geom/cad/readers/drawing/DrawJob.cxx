#include <cadrefine/cad/import/ReadJobs.h>

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/OwnThreads.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/model/DrawnEntity.h>
#include <cadrefine/cad/model/ModelBytes.h>
#include <cadrefine/cad/readers/drawing/ShapeTessellation.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

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

} // namespace cadrefine
