#include "ModelBytes.h"

#include "OccGuard.h"

#include <BinTools.hxx>
#include <BinTools_FormatVersion.hxx>

#include <cstdint>
#include <cstring>
#include <sstream>

namespace cadrefine
{
namespace
{

const std::string magic = "CADRefine model 2\n";

std::uint64_t checkSum(const char* data, std::size_t size)
{
  std::uint64_t hash = 14695981039346656037ULL; // FNV-1a
  for (std::size_t i = 0; i < size; ++i)
  {
    hash = (hash ^ static_cast<unsigned char>(data[i])) * 1099511628211ULL;
  }
  return hash;
}

class Writer
{
public:
  template<typename Number>
  void number(Number value)
  {
    const char* const raw = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), raw, raw + sizeof(value));
  }
  void text(const std::string& value)
  {
    number(static_cast<std::uint64_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
  }
  /// The count of `items`, and each of them by write(item).
  template<typename Items, typename Write>
  void list(const Items& items, const Write& write)
  {
    number(static_cast<std::uint64_t>(items.size()));
    for (const auto& item : items)
    {
      write(item);
    }
  }

  std::vector<char> bytes;
};

class Reader
{
public:
  Reader(const char* begin, const char* end) : at_(begin), end_(end) {}

  template<typename Number>
  Number number()
  {
    Number value;
    std::memcpy(&value, take(sizeof(value)), sizeof(value));
    return value;
  }
  std::string text()
  {
    const auto size = number<std::uint64_t>();
    const char* const begin = take(size);
    return { begin, begin + size };
  }
  /// What Writer::list wrote, each item made by read().
  template<typename Read>
  auto list(const Read& read) -> std::vector<decltype(read())>
  {
    std::vector<decltype(read())> items;
    for (auto count = number<std::uint64_t>(); count > 0; --count)
    {
      items.push_back(read());
    }
    return items;
  }

private:
  const char* take(std::uint64_t size)
  {
    if (size > static_cast<std::uint64_t>(end_ - at_))
    {
      throw Error("the bytes of the CAD model are damaged");
    }
    const char* const begin = at_;
    at_ += size;
    return begin;
  }

  const char* at_;
  const char* end_;
};

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

void writeEntities(Writer& writer, const std::vector<UnreadEntity>& entities)
{
  writer.list(entities,
    [&](const UnreadEntity& entity)
    {
      writer.number(static_cast<std::int32_t>(entity.entity));
      writer.text(entity.type);
      writer.text(entity.reason);
    });
}

std::vector<UnreadEntity> readEntities(Reader& reader)
{
  return reader.list(
    [&]
    {
      UnreadEntity entity;
      entity.entity = reader.number<std::int32_t>();
      entity.type = reader.text();
      entity.reason = reader.text();
      return entity;
    });
}

void writeReport(Writer& writer, const CADReport& report)
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

CADReport readReport(Reader& reader)
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

void writeLooks(Writer& writer, const std::vector<EntityLook>& looks)
{
  writer.list(looks,
    [&](const EntityLook& look)
    {
      writer.text(look.name);
      writer.number(static_cast<char>(look.colour ? 1 : 0));
      writer.number(look.colour.value_or(std::array<float, 3>{}));
    });
}

std::vector<EntityLook> readLooks(Reader& reader)
{
  return reader.list(
    [&]
    {
      EntityLook look;
      look.name = reader.text();
      const bool coloured = reader.number<char>() != 0;
      const auto colour = reader.number<std::array<float, 3>>();
      look.colour = coloured ? std::optional(colour) : std::nullopt;
      return look;
    });
}

} // namespace

std::vector<char> encodeModel(const ModelContent& content)
{
  Writer writer;
  writer.bytes.assign(magic.begin(), magic.end());
  writeReport(writer, content.report);
  writeLooks(writer, content.faceLooks);
  writeLooks(writer, content.edgeLooks);
  writer.number(content.size);
  writer.text(guardOcc("writing the CAD model", [&] { return shapeToText(content.shape); }));
  writer.number(checkSum(writer.bytes.data(), writer.bytes.size()));
  return std::move(writer.bytes);
}

ModelContent decodeModel(const std::vector<char>& bytes)
{
  checkFrame(bytes);
  Reader reader(bytes.data() + magic.size(), bytes.data() + bytes.size() - sizeof(std::uint64_t));
  ModelContent content;
  content.report = readReport(reader);
  content.faceLooks = readLooks(reader);
  content.edgeLooks = readLooks(reader);
  content.size = reader.number<double>();
  const std::string shape = reader.text();
  content.shape = guardOcc("rebuilding the CAD model", [&] { return shapeFromText(shape); });
  return content;
}

} // namespace cadrefine
