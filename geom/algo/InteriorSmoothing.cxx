#include "InteriorSmoothing.h"

#include "Quality.h"

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// Positions are whole multiples of size / 2^36; with weights up to 2^8 and up to 2^19 cells round
/// a vertex the sums stay below 2^63.
constexpr double stepsPerSize = 68719476736.0;
constexpr double largestWeight = 256;

template<std::size_t Corners>
bool touches(const std::array<Index, Corners>& cell, const std::vector<unsigned char>& flags)
{
  return std::any_of(cell.begin(), cell.end(), [&](Index vertex) { return flags[vertex] != 0; });
}

std::int64_t weightOf(double quality)
{
  const double badness = 1 - std::clamp(quality, 0.0, 1.0);
  return 1 + static_cast<std::int64_t>((largestWeight - 1) * badness * badness);
}

/// Apex of the equilateral tetrahedron over face `k`, on the side of vertex k.
Point3 idealApex(const std::array<Index, 4>& cell, int k, const std::vector<Point3>& wanted)
{
  const auto& face = tetrahedronFaces[k];
  const Point3& a = wanted[cell[face[0]]];
  const Point3& b = wanted[cell[face[1]]];
  const Point3& c = wanted[cell[face[2]]];
  const Vector3 outward = twofoldAreaVector(a, b, c);
  const double side = std::sqrt(2 * norm(outward) / std::sqrt(3.0));
  return (1.0 / 3.0) * (a + b + c) - (side * std::sqrt(2.0 / 3.0)) * normalized(outward);
}

/// Apex of the equilateral triangle over the edge opposite to corner k, in the triangle's plane.
Point3 idealApex(
  const std::array<Index, 3>& cell, int k, const std::vector<Point3>& wanted, const Vector3& normal)
{
  const Point3& a = wanted[cell[(k + 1) % 3]];
  const Point3& b = wanted[cell[(k + 2) % 3]];
  return 0.5 * (a + b) + (0.5 * std::sqrt(3.0)) * cross(normal, b - a);
}

void add(Proposal& sum, const ProposalGrid& grid, const Point3& position, std::int64_t weight)
{
  Proposal part;
  part.weight = weight;
  part.weightedPosition = grid.steps(position);
  for (auto& coordinate : part.weightedPosition)
  {
    coordinate *= weight;
  }
  sum = sum + part;
}

} // namespace

Point3 ProposalGrid::position(const Proposal& sum) const
{
  Point3 result;
  for (int k = 0; k < 3; ++k)
  {
    result[k] = origin[k] + static_cast<double>(sum.weightedPosition[k]) /
                              static_cast<double>(sum.weight) * (size / stepsPerSize);
  }
  return result;
}

std::array<std::int64_t, 3> ProposalGrid::steps(const Point3& point) const
{
  std::array<std::int64_t, 3> result;
  for (int k = 0; k < 3; ++k)
  {
    const double part = std::clamp((point[k] - origin[k]) / size, -1.0, 2.0);
    result[k] = std::llround(part * stepsPerSize);
  }
  return result;
}

std::vector<Proposal> proposeInteriorPositions(const SimplexMesh& mesh,
  const std::vector<Point3>& wanted, const std::vector<unsigned char>& interior,
  const std::vector<unsigned char>& stuck, const ProposalGrid& grid)
{
  std::vector<Proposal> sums(mesh.points.size());
  for (const auto& cell : mesh.tetrahedra)
  {
    if (mesh.dimension == 3 && touches(cell, stuck) && touches(cell, interior))
    {
      const std::int64_t weight =
        weightOf(meanRatio(wanted[cell[0]], wanted[cell[1]], wanted[cell[2]], wanted[cell[3]]));
      for (int k = 0; k < 4; ++k)
      {
        if (interior[cell[k]])
        {
          add(sums[cell[k]], grid, idealApex(cell, k, wanted), weight);
        }
      }
    }
  }
  for (const auto& cell : mesh.triangles)
  {
    if (mesh.dimension == 2 && touches(cell, stuck) && touches(cell, interior))
    {
      const auto& p = mesh.points;
      const Vector3 normal = normalized(twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]]));
      const std::int64_t weight =
        weightOf(meanRatio(wanted[cell[0]], wanted[cell[1]], wanted[cell[2]]));
      for (int k = 0; k < 3; ++k)
      {
        if (interior[cell[k]])
        {
          add(sums[cell[k]], grid, idealApex(cell, k, wanted, normal), weight);
        }
      }
    }
  }
  return sums;
}

} // namespace cadrefine
