#include <cadrefine/cad/model/ModelBytes.h>

#include <cadrefine/cad/import/OccGuard.h>
#include <cadrefine/cad/model/ByteRecords.h>

#include <BinTools.hxx>
#include <BinTools_FormatVersion.hxx>

#include <cstdint>
#include <cstring>
#include <sstream>

namespace cadrefine
{
namespace
{

const std::string magic = "CADRefine model 5\n";

std::uint64_t checkSum(const char* data, std::size_t size)
{
  std::uint64_t hash = 14695981039346656037ULL; // FNV-1a
  for (std::size_t i = 0; i < size; ++i)
  {
    hash = (hash ^ static_cast<unsigned char>(data[i])) * 1099511628211ULL;
  }
  return hash;
}

std::string shapeToText(const TopoDS_Shape& shape)
{
  constexpr bool withTriangles = false;
  constexpr bool withNormals = false;
  std::ostringstream stream(std::ios::binary);
  BinTools::Write(shape, stream, withTriangles, withNormals, BinTools_FormatVersion_CURRENT);
  return stream.str();
}

TopoDS_Shape shapeFromText(const std::string& text)
{
  std::istringstream stream(text, std::ios::binary);
  TopoDS_Shape shape;
  BinTools::Read(shape, stream);
  if (shape.IsNull())
  {
    throw Error("the bytes of the CAD model hold no shape");
  }
  return shape;
}

void checkFrame(const std::vector<char>& bytes)
{
  if (bytes.size() < magic.size() + sizeof(std::uint64_t) ||
      std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
  {
    throw Error("these bytes are not a CAD model of this version of CADRefine");
  }
  const std::size_t size = bytes.size() - sizeof(std::uint64_t);
  std::uint64_t expected = 0;
  std::memcpy(&expected, bytes.data() + size, sizeof(expected));
  if (checkSum(bytes.data(), size) != expected)
  {
    throw Error("the bytes of the CAD model are damaged");
  }
}

void writeEntities(ByteWriter& writer, const std::vector<UnreadEntity>& entities)
{
  writer.list(entities,
    [&](const UnreadEntity& entity)
    {
      writer.number(static_cast<std::int32_t>(entity.entity));
      writer.text(entity.type);
      writer.text(entity.reason);
      writer.text(entity.name);
    });
}

std::vector<UnreadEntity> readEntities(ByteReader& reader)
{
  return reader.list(
    [&]
    {
      UnreadEntity entity;
      entity.entity = reader.number<std::int32_t>();
      entity.type = reader.text();
      entity.reason = reader.text();
      entity.name = reader.text();
      return entity;
    });
}

void writeReport(ByteWriter& writer, const CADReport& report)
{
  writer.text(report.unit);
  writeEntities(writer, report.unread);
  writeEntities(writer, report.leftOut);
  writer.list(report.repairs, [&](const std::string& repair) { writer.text(repair); });
  writer.number(report.sewingTolerance);
  writer.list(report.gaps,
    [&](const Gap& gap)
    {
      writer.number(gap.width);
      writer.number(gap.point);
      writer.number(gap.edges);
    });
}

CADReport readReport(ByteReader& reader)
{
  CADReport report;
  report.unit = reader.text();
  report.unread = readEntities(reader);
  report.leftOut = readEntities(reader);
  report.repairs = reader.list([&] { return reader.text(); });
  report.sewingTolerance = reader.number<double>();
  report.gaps = reader.list(
    [&]
    {
      Gap gap;
      gap.width = reader.number<double>();
      gap.point = reader.number<Point3>();
      gap.edges = reader.number<std::array<int, 2>>();
      return gap;
    });
  return report;
}

void writeAttributes(ByteWriter& writer, const std::vector<EntityAttributes>& allAttributes)
{
  writer.list(allAttributes,
    [&](const EntityAttributes& attributes)
    {
      writer.text(attributes.name);
      writer.number(static_cast<char>(attributes.colour ? 1 : 0));
      writer.number(attributes.colour.value_or(std::array<float, 3>{}));
    });
}

std::vector<EntityAttributes> readAttributes(ByteReader& reader)
{
  return reader.list(
    [&]
    {
      EntityAttributes attributes;
      attributes.name = reader.text();
      const bool coloured = reader.number<char>() != 0;
      const auto colour = reader.number<std::array<float, 3>>();
      attributes.colour = coloured ? std::optional(colour) : std::nullopt;
      return attributes;
    });
}

} // namespace

std::vector<char> encodeModel(const ModelContent& content)
{
  ByteWriter writer;
  writer.bytes.assign(magic.begin(), magic.end());
  writeReport(writer, content.report);
  writeAttributes(writer, content.faceAttributes);
  writeAttributes(writer, content.edgeAttributes);
  writer.number(content.size);
  writer.number(content.scale);
  writer.text(guardOcc("writing the CAD model", [&] { return shapeToText(content.shape); }));
  writer.number(checkSum(writer.bytes.data(), writer.bytes.size()));
  return std::move(writer.bytes);
}

ModelContent decodeModel(const std::vector<char>& bytes)
{
  checkFrame(bytes);
  ByteReader reader(
    bytes.data() + magic.size(), bytes.data() + bytes.size() - sizeof(std::uint64_t));
  ModelContent content;
  content.report = readReport(reader);
  content.faceAttributes = readAttributes(reader);
  content.edgeAttributes = readAttributes(reader);
  content.size = reader.number<double>();
  content.scale = reader.number<LengthScale>();
  const std::string shape = reader.text();
  content.shape = guardOcc("rebuilding the CAD model", [&] { return shapeFromText(shape); });
  return content;
}

bool canBeWritten(const TopoDS_Shape& shape)
{
  try
  {
    return !shapeFromText(shapeToText(shape)).IsNull();
  }
  catch (const Standard_Failure&)
  {
    return false;
  }
  catch (const Error&)
  {
    return false;
  }
}

} // namespace cadrefine
