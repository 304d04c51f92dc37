// The bytes of a model as they come out of a file that was saved long ago. What comes before the
// shape is the input's; the shape, which Open CASCADE reads, is a sound one; the check sum is
// right.

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepPrimAPI_MakeBox.hxx>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace
{

constexpr std::size_t sumSize = sizeof(std::uint64_t);

/// What an empty report and no looks take, between the magic and the size of the model.
struct Sample
{
  std::vector<char> magic, shape;
};

const Sample& sample()
{
  static const Sample parts = []
  {
    cadrefine::ModelContent content;
    content.shape = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
    content.size = 1;
    const std::vector<char> small = cadrefine::encodeModel(content);
    content.report.unit = "x";
    const std::vector<char> large = cadrefine::encodeModel(content);
    const auto differ = std::mismatch(small.begin(), small.end(), large.begin()).first;
    // From behind: the check sum, the shape, its length (8), the size (8).
    const double one = 1;
    char raw[sizeof(one)];
    std::memcpy(raw, &one, sizeof(one));
    const auto size = std::search(differ, small.end(), raw, raw + sizeof(raw));
    return Sample{ { small.begin(), differ }, { size, small.end() - sumSize } };
  }();
  return parts;
}

std::uint64_t checkSum(const std::vector<char>& bytes)
{
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : bytes)
  {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return hash;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  std::vector<char> bytes = sample().magic;
  bytes.insert(bytes.end(), data, data + size);
  bytes.insert(bytes.end(), sample().shape.begin(), sample().shape.end());
  const std::uint64_t sum = checkSum(bytes);
  const char* const raw = reinterpret_cast<const char*>(&sum);
  bytes.insert(bytes.end(), raw, raw + sumSize);
  try
  {
    cadrefine::decodeModel(bytes);
  }
  catch (const cadrefine::Error&)
  {
  }
  return 0;
}
