#include <cadrefine/cad/import/ReadJobs.h>

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/FileCheck.h>
#include <cadrefine/cad/import/ReadAttempts.h>
#include <cadrefine/cad/model/ModelBytes.h>
#include <cadrefine/cad/readers/ShapeReaders.h>
#include <cadrefine/cad/readers/healing/ConvertibleShape.h>
#include <cadrefine/cad/readers/healing/GapSearch.h>
#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

ReadShape readShape(const std::string& path, CADFormat format, OptionalSteps& steps)
{
  switch (format)
  {
    case CADFormat::Iges:
      return readIges(path, steps);
    case CADFormat::Step:
      return readStep(path, steps);
    default:
      return readBrep(path, steps);
  }
}

/// The diagonal of the box round all faces and edges; round splines that of their poles, which may
/// be larger than it must be (BRepBndLib::AddOptimal takes longer than all the rest of reading).
double diagonalOf(const TopoDS_Shape& shape)
{
  constexpr bool useTriangulation = false;
  Bnd_Box box;
  BRepBndLib::Add(shape, box, useTriangulation);
  box.SetGap(0);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

template<typename Shape>
std::vector<EntityAttributes> attributesOf(
  const std::vector<Shape>& shapes, const AttributeMap& attributeMap)
{
  std::vector<EntityAttributes> result;
  result.reserve(shapes.size());
  for (const Shape& shape : shapes)
  {
    result.push_back(attributeMap.of(shape));
  }
  return result;
}

std::string listOf(const std::string& what, const std::vector<UnreadEntity>& unread)
{
  constexpr std::size_t most = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(unread.size(), most); ++i)
  {
    const UnreadEntity& u = unread[i];
    list += list.empty() ? " (" + what + ": " : "; ";
    list += u.entity > 0 ? std::to_string(u.entity) + " " + u.type + ": " : "";
    list += u.reason;
  }
  if (unread.size() > most)
  {
    list += "; and " + std::to_string(unread.size() - most) + " more";
  }
  return list.empty() ? list : list + ")";
}

template<typename Item>
void append(std::vector<Item>& list, const std::vector<Item>& more)
{
  list.insert(list.end(), more.begin(), more.end());
}

/// The part of what the file holds that becomes a model.
TopoDS_Shape makeModelShape(ReadShape& read, const ReadOptions& options, OptionalSteps& steps)
{
  const PreparedShape prepared = prepareShape(read.shape, read.attributeMap, steps);
  append(read.report.unread, prepared.unread);
  append(read.report.leftOut, prepared.leftOut);
  read.report.sewingTolerance = prepared.sewingTolerance;
  if (prepared.shape.IsNull())
  {
    return {};
  }
  const ConvertibleShape convertible = keepConvertible(prepared.shape, read.attributeMap, options);
  append(read.report.unread, convertible.unread);
  append(read.report.repairs, convertible.repairs);
  return convertible.shape;
}

/// Makes all lengths but those of the shape ones in this unit. A file without a unit is taken to
/// be in millimetres, as Open CASCADE's own files are.
void convertTo(const std::string& unit, const std::string& path, ModelContent& content)
{
  CADReport& report = content.report;
  if (report.unit.empty())
  {
    report.repairs.emplace_back("the file names no unit of length: taken as mm");
    report.unit = "mm";
  }
  content.scale = { unitLength(report.unit), unitLength(shortUnitName(unit)) };
  if (content.scale.from == 0)
  {
    throw Error(path + ": its unit of length, \"" + report.unit +
                "\", is not known, so it cannot be converted to " + unit + " (Unit)");
  }
  const LengthScale& scale = content.scale;
  report.unit = shortUnitName(unit);
  report.sewingTolerance = scale(report.sewingTolerance);
  for (Gap& gap : report.gaps)
  {
    gap.width = scale(gap.width);
    gap.point = scale(gap.point);
  }
  content.size = scale(content.size);
}

ModelContent readContent(
  const std::string& path, CADFormat format, const std::string& unit, const ReadOptions& options)
{
  OptionalSteps steps(options);
  noteStep(static_cast<int>(ReadStep::Loading));
  ReadShape read = readShape(path, format, steps);
  noteStep(static_cast<int>(ReadStep::Other));
  ModelContent content;
  content.shape = makeModelShape(read, options, steps);
  if (content.shape.IsNull())
  {
    throw Error(path + ": contains no face or curve that can be read" +
                listOf("unread", read.report.unread) + listOf("left out", read.report.leftOut));
  }
  const ShapeIndex index(content.shape);
  content.size = diagonalOf(content.shape);
  content.report = std::move(read.report);
  steps.run(ReadStep::Gaps, [&] { content.report.gaps = findGaps(index, content.size); });
  if (!read.attributeMap.empty())
  {
    content.faceAttributes = attributesOf(index.faces(), read.attributeMap);
    content.edgeAttributes = attributesOf(index.edges(), read.attributeMap);
  }
  append(content.report.repairs, steps.notes());
  if (!unit.empty())
  {
    convertTo(unit, path, content);
  }
  return content;
}

} // namespace

std::vector<char> readJob(const std::string& path, ByteReader& input)
{
  const ReadOptions options = takeOptions(input);
  const auto format = input.number<CADFormat>();
  const std::string unit = input.text();
  return encodeModel(readContent(path, format, unit, options));
}

} // namespace cadrefine
