// Numbers, texts and lists as bytes. Private to geom/cad.
#pragma once

#include <cadrefine/base/Error.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace cadrefine
{

class ByteWriter
{
public:
  template<typename Number>
  void number(Number value)
  {
    this->raw(&value, sizeof(value));
  }
  void text(const std::string& value)
  {
    number(static_cast<std::uint64_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
  }
  /// Writes the count of `items`, and each of them by write(item).
  template<typename Items, typename Write>
  void list(const Items& items, const Write& write)
  {
    number(static_cast<std::uint64_t>(items.size()));
    for (const auto& item : items)
    {
      write(item);
    }
  }
  /// Writes the count of items, and these as they lie in memory.
  template<typename Item>
  void array(const std::vector<Item>& items)
  {
    static_assert(std::is_trivially_copyable_v<Item>, "its memory is all of it");
    number(static_cast<std::uint64_t>(items.size()));
    this->raw(items.data(), items.size() * sizeof(Item));
  }

  std::vector<char> bytes;

private:
  void raw(const void* data, std::size_t size)
  {
    const char* const begin = static_cast<const char*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  }
};

/// Reads what ByteWriter wrote. Throws Error where the bytes end before.
class ByteReader
{
public:
  ByteReader(const char* begin, const char* end) : at_(begin), end_(end) {}

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
  /// Reads what ByteWriter::list wrote, each item by read().
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
  template<typename Item>
  std::vector<Item> array()
  {
    const auto count = number<std::uint64_t>();
    if (count > static_cast<std::uint64_t>(end_ - at_) / sizeof(Item))
    {
      throwDamaged();
    }
    std::vector<Item> items(count);
    if (count > 0)
    {
      std::memcpy(items.data(), take(count * sizeof(Item)), count * sizeof(Item));
    }
    return items;
  }

private:
  [[noreturn]] static void throwDamaged() { throw Error("the bytes of the CAD model are damaged"); }

  const char* take(std::uint64_t size)
  {
    if (size > static_cast<std::uint64_t>(end_ - at_))
    {
      throwDamaged();
    }
    const char* const begin = at_;
    at_ += size;
    return begin;
  }

  const char* at_;
  const char* end_;
};

} // namespace cadrefine
