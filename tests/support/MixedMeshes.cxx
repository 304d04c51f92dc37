#include "MixedMeshes.h"

#include <cadrefine/mesh/Facets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace cadtest
{

using namespace cadrefine;

namespace
{

constexpr double pi = 3.14159265358979323846;

using Diagonal = std::optional<std::array<Index, 2>>; ///< None: the side is a quadrilateral.

/// How the hexahedra's sides are cut, as far as that is settled.
class Sides
{
public:
  static std::array<Index, 4> keyOf(std::array<Index, 4> side)
  {
    std::sort(side.begin(), side.end());
    return side;
  }

  bool isSettled(const std::array<Index, 4>& side) const { return of_.count(keyOf(side)) > 0; }
  Diagonal at(const std::array<Index, 4>& side) const { return of_.at(keyOf(side)); }
  bool mayBeWhole(const std::array<Index, 4>& side) const
  {
    return !isSettled(side) || !at(side).has_value();
  }
  void settle(const std::array<Index, 4>& side, const Diagonal& diagonal)
  {
    of_.emplace(keyOf(side), diagonal);
  }
  /// From which corner of the side the diagonal starts, 0 or 1; -1: it must not have one.
  int startOf(const std::array<Index, 4>& side) const
  {
    const Diagonal diagonal = at(side);
    return !diagonal ? -1 : side[0] == (*diagonal)[0] || side[0] == (*diagonal)[1] ? 0 : 1;
  }

private:
  std::map<std::array<Index, 4>, Diagonal> of_;
};

constexpr int lowSides[3][4] = { { 0, 1, 2, 3 }, { 0, 3, 7, 4 }, { 0, 4, 5, 1 } };
constexpr int highSides[3][4] = { { 4, 5, 6, 7 }, { 1, 2, 6, 5 }, { 3, 7, 6, 2 } };

std::array<Index, 4> sideOf(const std::array<Index, 8>& cell, const int (&corners)[4])
{
  return { cell[corners[0]], cell[corners[1]], cell[corners[2]], cell[corners[3]] };
}

int directionOf(BoxKind kind)
{
  return kind == BoxKind::Wedges ? 0 : kind == BoxKind::WedgesAlongX ? 1 : 2;
}

/// Makes mixed meshes of hexahedra.
class Mixing
{
public:
  Mixing(const Mesh& hexahedra, std::uint64_t seed) : coarse_(hexahedra), random_(seed)
  {
    mesh_.points = hexahedra.points;
  }

  Mesh run(const std::function<BoxKind(std::size_t)>& kindOf)
  {
    std::vector<BoxKind> kinds;
    for (std::size_t c = 0; c < coarse_.hexahedra.size(); ++c)
    {
      kinds.push_back(settled(coarse_.hexahedra[c], kindOf(c)));
    }
    for (std::size_t c = 0; c < kinds.size(); ++c)
    {
      add(coarse_.hexahedra[c], kinds[c]);
    }
    shuffleIds(mesh_, random_);
    return std::move(mesh_);
  }

private:
  BoxKind settled(const std::array<Index, 8>& cell, BoxKind kind)
  {
    if (kind == BoxKind::Fan)
    {
      return kind;
    }
    const bool hasEnds = kind != BoxKind::Hexahedron;
    const auto low = sideOf(cell, lowSides[directionOf(kind)]);
    const auto high = sideOf(cell, highSides[directionOf(kind)]);
    const auto isEnd = [&](const std::array<Index, 4>& side)
    {
      return hasEnds &&
             (Sides::keyOf(side) == Sides::keyOf(low) || Sides::keyOf(side) == Sides::keyOf(high));
    };
    for (const auto& face : shapes::Hexahedron::faces)
    {
      const auto side = sideOf(cell, face);
      if (!isEnd(side) && !sides_.mayBeWhole(side))
      {
        return BoxKind::Fan;
      }
    }
    int start = static_cast<int>(random_() % 2);
    if (hasEnds)
    {
      const int below = sides_.isSettled(low) ? sides_.startOf(low) : start;
      const int above = sides_.isSettled(high) ? sides_.startOf(high) : below;
      start = sides_.isSettled(low) ? below : above;
      if (start < 0 || above != start)
      {
        return BoxKind::Fan;
      }
      sides_.settle(low, std::array<Index, 2>{ low[start], low[start + 2] });
      sides_.settle(high, std::array<Index, 2>{ high[start], high[start + 2] });
    }
    for (const auto& face : shapes::Hexahedron::faces)
    {
      sides_.settle(sideOf(cell, face), {});
    }
    return kind;
  }

  void add(const std::array<Index, 8>& cell, BoxKind kind)
  {
    if (kind == BoxKind::Hexahedron)
    {
      mesh_.hexahedra.push_back(cell);
    }
    else if (kind == BoxKind::Fan)
    {
      addFan(cell);
    }
    else
    {
      const auto a = sideOf(cell, lowSides[directionOf(kind)]);
      const auto b = sideOf(cell, highSides[directionOf(kind)]);
      const int i = sides_.startOf(a);
      const int last = (i + 3) % 4;
      mesh_.wedges.push_back({ a[i], a[i + 1], a[i + 2], b[i], b[i + 1], b[i + 2] });
      mesh_.wedges.push_back({ a[i], a[i + 2], a[last], b[i], b[i + 2], b[last] });
    }
  }

  void addFan(const std::array<Index, 8>& cell)
  {
    const auto middle = static_cast<Index>(mesh_.points.size());
    Point3 sum{};
    for (const Index v : cell)
    {
      sum = sum + 0.125 * coarse_.points[v];
    }
    mesh_.points.push_back(sum);
    for (const auto& face : shapes::Hexahedron::faces)
    {
      auto side = sideOf(cell, face);
      std::reverse(side.begin(), side.end());
      if (!sides_.isSettled(side))
      {
        const int start = static_cast<int>(random_() % 2);
        sides_.settle(
          side, random_() % 2 ? Diagonal{} : std::array<Index, 2>{ side[start], side[start + 2] });
      }
      const int i = sides_.startOf(side);
      if (i < 0)
      {
        mesh_.pyramids.push_back({ side[0], side[1], side[2], side[3], middle });
      }
      else
      {
        mesh_.tetrahedra.push_back({ side[i], side[i + 1], side[i + 2], middle });
        mesh_.tetrahedra.push_back({ side[i], side[i + 2], side[(i + 3) % 4], middle });
      }
    }
  }

  const Mesh& coarse_;
  std::mt19937_64 random_;
  Mesh mesh_;
  Sides sides_;
};

/// Some of the quadrilaterals from `first` on become two triangles.
void halveSome(Mesh& mesh, std::size_t first, std::mt19937_64& random)
{
  Cells<4> left(
    mesh.quadrilaterals.begin(), mesh.quadrilaterals.begin() + static_cast<std::ptrdiff_t>(first));
  for (std::size_t q = first; q < mesh.quadrilaterals.size(); ++q)
  {
    const auto& v = mesh.quadrilaterals[q];
    const auto i = static_cast<std::size_t>(random() % 4);
    if (i > 1)
    {
      left.push_back(v);
    }
    else
    {
      mesh.triangles.push_back({ v[i], v[i + 1], v[i + 2] });
      mesh.triangles.push_back({ v[i], v[i + 2], v[(i + 3) % 4] });
    }
  }
  mesh.quadrilaterals = left;
}

/// Lists a side as a cell.
void list(const Facet& side, Mesh& mesh)
{
  const auto& v = side.vertices;
  switch (side.corners())
  {
    case 2:
      mesh.segments.push_back({ v[0], v[1] });
      break;
    case 3:
      mesh.triangles.push_back({ v[0], v[1], v[2] });
      break;
    default:
      mesh.quadrilaterals.push_back(v);
  }
}

} // namespace

Mesh mixedMesh(
  const Mesh& hexahedra, const std::function<BoxKind(std::size_t)>& kindOf, std::uint64_t seed)
{
  return Mixing(hexahedra, seed).run(kindOf);
}

Mesh randomlyMixedMesh(const Mesh& hexahedra, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  if (hexahedra.dimension == 2)
  {
    Mesh mesh = hexahedra;
    halveSome(mesh, 0, random);
    return mesh;
  }
  return mixedMesh(
    hexahedra, [&](std::size_t) { return static_cast<BoxKind>(random() % 5); }, seed);
}

Mesh quadrilateralRingMesh(
  double radius, double offset, int corners, const std::vector<double>& heights)
{
  Mesh mesh;
  mesh.dimension = 2;
  for (std::size_t level = 0; level <= heights.size() + 1; ++level)
  {
    for (int c = 0; c < corners; ++c)
    {
      const double angle = 2 * pi * c / corners;
      const double wall = radius * (1 + offset * (c % 3 - 1));
      const double r = level == 0                ? wall
                       : level <= heights.size() ? wall + heights[level - 1]
                                                 : 3 * radius;
      mesh.points.push_back({ r * std::cos(angle), r * std::sin(angle), 0 });
    }
  }
  for (std::size_t level = 0; level <= heights.size(); ++level)
  {
    const auto first = static_cast<Index>(level) * corners;
    for (Index a = 0; a < corners; ++a)
    {
      const Index b = (a + 1) % corners;
      mesh.quadrilaterals.push_back(
        { first + a, first + corners + a, first + corners + b, first + b });
    }
  }
  std::mt19937_64 random(1);
  halveSome(mesh, heights.size() * static_cast<std::size_t>(corners), random);
  shuffleIds(mesh, random);
  return mesh;
}

Mesh withListedBoundary(Mesh mesh)
{
  for (const Facet& facet : findOuterFacets(mesh))
  {
    list(facet, mesh);
  }
  return mesh;
}

Mesh withListedSides(Mesh mesh, std::size_t first, std::size_t count)
{
  const auto isAmong = [&](Index vertex)
  {
    const auto v = static_cast<std::size_t>(vertex);
    return v >= first && v < first + count;
  };
  std::set<std::set<Index>> known;
  std::vector<Facet> sides;
  forEachSide(mesh,
    [&](const Facet& side)
    {
      if (std::all_of(side.begin(), side.end(), isAmong) &&
          known.emplace(side.begin(), side.end()).second)
      {
        sides.push_back(side);
      }
    });
  for (const Facet& side : sides)
  {
    list(side, mesh);
  }
  return mesh;
}

Mesh withMixedOrder(Mesh mesh, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  visitShapes(mesh, [&](auto, auto& cells) { std::shuffle(cells.begin(), cells.end(), random); });
  return mesh;
}

} // namespace cadtest
