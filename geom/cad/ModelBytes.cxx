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

const std::string magic = "CADRefine model 1\n";

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
    this->bytes.insert(this->bytes.end(), raw, raw + sizeof(value));
  }
  void text(const std::string& value)
  {
    this->number(static_cast<std::uint64_t>(value.size()));
    this->bytes.insert(this->bytes.end(), value.begin(), value.end());
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
    std::memcpy(&value, this->take(sizeof(value)), sizeof(value));
    return value;
  }
  std::string text()
  {
    const auto size = this->number<std::uint64_t>();
    const char* const begin = this->take(size);
    return { begin, begin + size };
  }

private:
  const char* take(std::uint64_t size)
  {
    if (size > static_cast<std::uint64_t>(this->end_ - this->at_))
    {
      throw Error("the bytes of the CAD model are damaged");
    }
    const char* const begin = this->at_;
    this->at_ += size;
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

} // namespace

std::vector<char> encodeModel(const ModelContent& content)
{
  Writer writer;
  writer.bytes.assign(magic.begin(), magic.end());
  writer.text(content.unit);
  writer.number(static_cast<std::uint64_t>(content.unread.size()));
  for (const UnreadEntity& unread : content.unread)
  {
    writer.number(static_cast<std::int32_t>(unread.entity));
    writer.text(unread.type);
    writer.text(unread.reason);
  }
  writer.number(static_cast<std::uint64_t>(content.faces.size()));
  for (const FaceLook& face : content.faces)
  {
    writer.text(face.name);
    writer.number(face.color);
  }
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
  content.unit = reader.text();
  for (auto count = reader.number<std::uint64_t>(); count > 0; --count)
  {
    UnreadEntity unread;
    unread.entity = reader.number<std::int32_t>();
    unread.type = reader.text();
    unread.reason = reader.text();
    content.unread.push_back(unread);
  }
  for (auto count = reader.number<std::uint64_t>(); count > 0; --count)
  {
    FaceLook face;
    face.name = reader.text();
    face.color = reader.number<std::array<float, 3>>();
    content.faces.push_back(face);
  }
  content.size = reader.number<double>();
  const std::string shape = reader.text();
  content.shape = guardOcc("rebuilding the CAD model", [&] { return shapeFromText(shape); });
  return content;
}

} // namespace cadrefine
