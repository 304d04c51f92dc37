#include "Mutation.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace badcad
{
namespace
{

/// SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014): the
/// same numbers with every library.
class Random
{
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next()
  {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// Below `end`; 0 where that is 0.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : next() % end; }

private:
  std::uint64_t state_;
};

struct Range
{
  std::size_t from = 0;
  std::size_t length = 0;
};

bool isOfNumber(char c)
{
  return std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' ||
         c == 'E' || c == 'e';
}

/// The number at or after a random place.
Range randomNumber(const std::string& text, Random& random)
{
  std::size_t from = random.below(text.size());
  while (from < text.size() && !std::isdigit(static_cast<unsigned char>(text[from])))
  {
    ++from;
  }
  std::size_t to = from;
  while (from > 0 && isOfNumber(text[from - 1]))
  {
    --from;
  }
  while (to < text.size() && isOfNumber(text[to]))
  {
    ++to;
  }
  return { from, to - from };
}

/// The line that holds a random place, with its end.
Range randomLine(const std::string& text, Random& random)
{
  const std::size_t at = random.below(text.size());
  const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t from = before == std::string::npos ? 0 : before + 1;
  const std::size_t end = text.find('\n', at);
  return { from, (end == std::string::npos ? text.size() : end + 1) - from };
}

Range randomBlock(const std::string& text, Random& random)
{
  constexpr std::size_t longest = 200;
  const std::size_t from = random.below(text.size());
  return { from, std::min(random.below(longest) + 1, text.size() - from) };
}

/// Puts `value` in place of the range; `keepColumns`: without moving what follows, as far as it
/// fits (the columns of an IGES file tell what its text means).
void put(std::string& text, const Range& range, std::string value, bool keepColumns)
{
  if (keepColumns && value.size() < range.length)
  {
    value.insert(0, range.length - value.size(), ' ');
  }
  const std::size_t taken = keepColumns ? std::max(range.length, value.size()) : range.length;
  text.replace(range.from, taken, value);
}

void replaceNumber(std::string& text, Random& random)
{
  constexpr std::array<const char*, 18> odd{ "nan", "inf", "1e300", "-1e300", "1e-300", "0", "-1",
    "1", "2", "3", "30", "1000", "99999999", "2147483648", "-2147483648", "1e999", "1e15", "0.5" };
  put(text, randomNumber(text, random), odd[random.below(odd.size())], random.below(4) != 0);
}

void swapNumbers(std::string& text, Random& random)
{
  const Range a = randomNumber(text, random);
  const Range b = randomNumber(text, random);
  const std::string first = text.substr(a.from, a.length);
  put(text, a, text.substr(b.from, b.length), true);
  put(text, b, first, true);
}

void changeDigit(std::string& text, Random& random)
{
  const Range range = randomNumber(text, random);
  const std::size_t at = range.from + random.below(range.length);
  if (at < text.size())
  {
    text[at] = "0123456789-.,E"[random.below(14)];
  }
}

void changeByte(std::string& text, Random& random)
{
  const std::size_t at = random.below(text.size());
  const char byte = static_cast<char>(random.below(256));
  switch (random.below(3))
  {
    case 0:
      text[at] = byte;
      break;
    case 1:
      text.erase(at, 1);
      break;
    default:
      text.insert(at, 1, byte);
  }
}

void changeLines(std::string& text, Random& random)
{
  const Range a = randomLine(text, random);
  const std::string line = text.substr(a.from, a.length);
  switch (random.below(3))
  {
    case 0:
      text.erase(a.from, a.length);
      break;
    case 1:
      text.insert(a.from, line);
      break;
    default:
      text.erase(a.from, a.length);
      text.insert(randomLine(text, random).from, line);
  }
}

void copyBlock(std::string& text, Random& random)
{
  const Range from = randomBlock(text, random);
  text.replace(random.below(text.size()), from.length, text.substr(from.from, from.length));
}

void addGarbage(std::string& text, Random& random)
{
  const Range range = randomBlock(text, random);
  for (std::size_t i = range.from; i < range.from + range.length; ++i)
  {
    text[i] = static_cast<char>(random.below(256));
  }
}

void damage(std::string& text, Random& random)
{
  constexpr std::array<void (*)(std::string&, Random&), 10> kinds{ replaceNumber, replaceNumber,
    replaceNumber, replaceNumber, swapNumbers, changeDigit, changeByte, changeLines, copyBlock,
    addGarbage };
  kinds[random.below(kinds.size())](text, random);
}

} // namespace

std::string mutate(const std::string& text, std::uint64_t seed)
{
  constexpr std::size_t mostDamages = 4;
  constexpr std::size_t cutOneIn = 20;
  Random random(seed);
  std::string result = text;
  for (std::size_t count = 1 + random.below(mostDamages); count > 0 && !result.empty(); --count)
  {
    damage(result, random);
  }
  if (random.below(cutOneIn) == 0)
  {
    result.resize(random.below(result.size() + 1));
  }
  return result;
}

std::string garbage(std::size_t size, std::uint64_t seed)
{
  Random random(seed);
  std::string bytes(size, '\0');
  std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<char>(random.below(256)); });
  return bytes;
}

} // namespace badcad
