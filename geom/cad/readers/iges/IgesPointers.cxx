// IGES 5.3, chapter 4: the parameters of each type.

#include <cadrefine/cad/readers/iges/IgesPointers.h>

#include <algorithm>
#include <cstdlib>

namespace cadrefine
{
namespace
{

/// Walks over the parameters; beyond the end all are zero.
class Walk
{
public:
  explicit Walk(const std::vector<std::string>& values) : values_(values) {}

  int integer(std::size_t at) const
  {
    return at < values_.size() ? std::atoi(values_[at].c_str()) : 0;
  }
  /// A count of things that follow; no more than there are parameters.
  std::size_t count(std::size_t at) const
  {
    return std::min<std::size_t>(std::max(integer(at), 0), values_.size());
  }

private:
  const std::vector<std::string>& values_;
};

using Places = std::vector<std::size_t>;

/// `count` places from `first` on, `stride` apart.
void addPlaces(Places& places, std::size_t first, std::size_t count, std::size_t stride = 1)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    places.push_back(first + i * stride);
  }
}

/// A boundary (141): each curve in space with its curves in the parameter plane.
Places placesOfBoundary(const Walk& walk)
{
  Places places{ 3 };
  std::size_t at = 5;
  for (std::size_t curve = 0; curve < walk.count(4); ++curve)
  {
    places.push_back(at);
    const std::size_t inPlane = walk.count(at + 2);
    addPlaces(places, at + 3, inPlane);
    at += 3 + inPlane;
  }
  return places;
}

/// A loop (508): each edge's list, and its curves in the parameter plane.
Places placesOfLoop(const Walk& walk)
{
  Places places;
  std::size_t at = 2;
  for (std::size_t edge = 0; edge < walk.count(1); ++edge)
  {
    places.push_back(at + 1);
    const std::size_t inPlane = walk.count(at + 4);
    addPlaces(places, at + 6, inPlane, 2);
    at += 5 + 2 * inPlane;
  }
  return places;
}

Places placesOfEdges(const Walk& walk)
{
  Places places;
  for (const std::size_t first : { 2, 3, 5 })
  {
    addPlaces(places, first, walk.count(1), 5);
  }
  return places;
}

/// A Boolean tree (180) gives its operands as negative pointers.
Places placesOfTree(const Walk& walk)
{
  Places places;
  for (std::size_t at = 2; at < 2 + walk.count(1); ++at)
  {
    if (walk.integer(at) < 0)
    {
      places.push_back(at);
    }
  }
  return places;
}

Places listAfter(const Walk& walk, std::size_t countAt, Places places = {}, std::size_t stride = 1)
{
  addPlaces(places, countAt + 1, walk.count(countAt), stride);
  return places;
}

/// The places of the parameters of curves and surfaces that point to others.
Places placesInSurfaces(int type, const Walk& walk)
{
  switch (type)
  {
    case 102:
      return listAfter(walk, 1);
    case 108:
      return { 5 };
    case 118:
    case 120:
      return { 1, 2 };
    case 122:
      return { 1 };
    case 130:
      return { 1, 3 };
    case 140:
      return { 5 };
    case 141:
      return placesOfBoundary(walk);
    case 142:
      return { 2, 3, 4 };
    case 143:
      return listAfter(walk, 3, { 2 });
    case 144: // surface, flag, number of inner loops, outer loop, inner loops
    {
      Places places{ 1, 4 };
      addPlaces(places, 5, walk.count(3));
      return places;
    }
    case 190:
    case 192:
    case 194:
    case 198: // location, axis, sizes, and in form 1 a direction
    {
      const std::size_t sizes = type == 190 ? 0 : type == 192 ? 1 : 2;
      return { 1, 2, 3 + sizes };
    }
    case 196:
      return { 1, 3, 4 };
    default:
      return {};
  }
}

Places placesInSolids(int type, int form, const Walk& walk)
{
  switch (type)
  {
    case 162:
    case 164:
      return { 1 };
    case 180:
      return placesOfTree(walk);
    case 184:
      return listAfter(walk, 1);
    case 186:
      return listAfter(walk, 3, { 1 }, 2);
    case 308:
      return listAfter(walk, 3);
    case 402: // groups, and (form 9) a plane with those that are its holes
    {
      Places places;
      addPlaces(places, form == 9 ? 3 : 2, form == 9 ? walk.count(2) + 1 : walk.count(1));
      return places;
    }
    case 408:
    case 430:
      return { 1 };
    case 504:
      return placesOfEdges(walk);
    case 508:
      return placesOfLoop(walk);
    case 510: // surface, number of loops, flag, loops
    {
      Places places{ 1 };
      addPlaces(places, 4, walk.count(2));
      return places;
    }
    case 514:
      return listAfter(walk, 1, {}, 2);
    default:
      return {};
  }
}

std::size_t countInPath(const Walk& walk)
{
  const std::size_t points = walk.count(2);
  return walk.integer(1) == 1 ? 4 + 2 * points : 3 + (walk.integer(1) == 2 ? 3 : 6) * points;
}

std::size_t countInSplineSurface(const Walk& walk)
{
  const std::size_t m = walk.count(3) + 1;
  const std::size_t n = walk.count(4) + 1;
  return 5 + m + n + 48 * m * n;
}

/// Number of parameters of a spline curve (126): knots, weights, points and the range.
std::size_t countInCurve(const Walk& walk)
{
  const std::size_t points = walk.count(1) + 1;
  return 7 + points + walk.count(2) + 1 + 4 * points + 2;
}

/// Number of parameters of a spline surface (128): knots, weights, points and the ranges.
std::size_t countInSurface(const Walk& walk)
{
  const std::size_t m = walk.count(1) + 1;
  const std::size_t n = walk.count(2) + 1;
  return 10 + m + walk.count(3) + 1 + n + walk.count(4) + 1 + 4 * m * n + 4;
}

} // namespace

std::vector<int> igesParts(const IgesEntry& entry, const IgesParameters& parameters)
{
  const bool isOtherAssociation = entry.type == 402 && entry.form != 1 && entry.form != 7 &&
                                  entry.form != 9 && entry.form != 14 && entry.form != 15;
  const Walk walk(parameters.values);
  Places places = placesInSurfaces(entry.type, walk);
  if (!isOtherAssociation)
  {
    const Places more = placesInSolids(entry.type, entry.form, walk);
    places.insert(places.end(), more.begin(), more.end());
  }
  std::vector<int> parts;
  for (const std::size_t at : places)
  {
    const int part = std::abs(walk.integer(at));
    if (part != 0)
    {
      parts.push_back(part);
    }
  }
  return parts;
}

std::size_t igesParameterCount(const IgesEntry& entry, const IgesParameters& parameters)
{
  const Walk walk(parameters.values);
  switch (entry.type)
  {
    case 100:
      return 8;
    case 102:
      return 2 + walk.count(1);
    case 104:
      return 12;
    case 106:
      return countInPath(walk);
    case 108:
      return 10;
    case 110:
      return 7;
    case 112:
      return 5 + 13 * (walk.count(4) + 1);
    case 114:
      return countInSplineSurface(walk);
    case 116:
    case 123:
      return 4;
    case 118:
    case 120:
    case 122:
      return 5;
    case 124:
      return 13;
    case 126:
      return countInCurve(walk);
    case 128:
      return countInSurface(walk);
    case 130:
      return 15;
    case 140:
    case 142:
      return 6;
    case 143:
      return 4 + walk.count(3);
    case 144:
      return 5 + walk.count(3);
    case 186:
      return 4 + 2 * walk.count(3);
    case 502:
      return 2 + 3 * walk.count(1);
    case 504:
      return 2 + 5 * walk.count(1);
    case 510:
      return 4 + walk.count(2);
    case 514:
      return 2 + 2 * walk.count(1);
    default:
      return 0;
  }
}

} // namespace cadrefine
