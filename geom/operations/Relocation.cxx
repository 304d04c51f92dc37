#include <cadrefine/operations/Relocation.h>

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/ShapeEnergy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr int newtonSteps = 4;
constexpr double shortestStep = 1.0 / 8;

/// Moves the vertex there; the smallest quality of the cells, if it is above the bar; -2 where one
/// is invalid.
double worstAt(
  EditableMesh& mesh, Index vertex, const Simplices<4>& cells, const Point3& point, double bar = -2)
{
  mesh.moveVertex(vertex, point);
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& cell : cells)
  {
    if (worst <= bar || !mesh.isValid(cell))
    {
      return -2;
    }
    worst = std::min(worst, mesh.quality(cell));
  }
  return worst;
}

ShapeEnergy energyAt(const EditableMesh& mesh, Index vertex, const Simplices<4>& cells)
{
  const auto at = [&](Index v) -> const Point3& { return mesh.vertex(v).wanted; };
  double smallest = 1;
  std::vector<double> sizes;
  sizes.reserve(cells.size());
  for (const auto& [a, b, c, d] : cells)
  {
    const double size = equilateralMeasure(3, squaredEdgeLengths(at(a), at(b), at(c), at(d)));
    smallest =
      size > 0 ? std::min(smallest, sixfoldVolume(at(a), at(b), at(c), at(d)) / size) : smallest;
    sizes.push_back(size);
  }
  const double delta = regularisation(smallest);
  ShapeEnergy energy(3);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    const auto& cell = cells[c];
    const auto& face = tetrahedronFaces[std::find(cell.begin(), cell.end(), vertex) - cell.begin()];
    energy.addTetrahedron(
      at(cell[face[0]]), at(cell[face[2]]), at(cell[face[1]]), delta * sizes[c]);
  }
  return energy;
}

} // namespace

double relocate(EditableMesh& mesh, Index vertex, const Simplices<4>& cells)
{
  Point3 best = mesh.vertex(vertex).point;
  double worst = worstAt(mesh, vertex, cells, best);
  for (int k = 0; k < newtonSteps; ++k)
  {
    const ShapeEnergy energy = energyAt(mesh, vertex, cells);
    if (!std::isfinite(energy.at(best)))
    {
      break;
    }
    const Vector3 step = energy.step(best, Directions::everywhere());
    const Point3 from = best;
    for (double length = 1; length >= shortestStep && best == from && step != Vector3{};
         length *= 0.5)
    {
      const Point3 next = from + length * step;
      const double there = worstAt(mesh, vertex, cells, next, worst);
      if (there > worst)
      {
        worst = there;
        best = next;
      }
    }
    mesh.moveVertex(vertex, best);
    if (best == from)
    {
      break;
    }
  }
  return worst;
}

} // namespace cadrefine
