#include <cadrefine/operations/Relocation.h>

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/motion/PatchOptimiser.h>
#include <cadrefine/motion/ShapeEnergy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr int newtonSteps = 4;
constexpr double shortestStep = 1.0 / 8;

/// Where a vertex may go that is not on the CAD.
struct Inside
{
  Directions directions;

  Directions directionsAt(const Point3&) const { return directions; }
  std::optional<Point3> place(const Point3& point) const { return point; }
};

/// Where a vertex on the CAD may go.
struct OnEntity
{
  const BoundaryProjector& projector;
  EntityId entity;

  Directions directionsAt(const Point3& point) const
  {
    return directionsOn(projector, entity, point);
  }
  /// The nearest point of the entity; none where that is on its border.
  std::optional<Point3> place(const Point3& point) const
  {
    const ClosestPoint where = projector.nearestOn(entity, point);
    const bool isWithin =
      where.entity == entity && projector.nearestOn(entity, where.point).entity == entity;
    return isWithin ? std::optional(where.point) : std::nullopt;
  }
};

/// The cells at a vertex; for triangles also unit normals, which they keep to.
template<std::size_t Corners>
struct Star
{
  Index vertex;
  const Cells<Corners>& cells;
  std::vector<Vector3> sides;

  Star(const EditableMesh& mesh, Index center, const Cells<Corners>& around)
    : vertex(center), cells(around), sides(around.size(), mesh.plane())
  {
    if constexpr (Corners == 3)
    {
      for (std::size_t c = 0; c < cells.size() && mesh.plane() == Vector3{}; ++c)
      {
        const auto at = [&](int k) -> const Point3& { return mesh.vertex(cells[c][k]).point; };
        sides[c] = normalized(twofoldAreaVector(at(0), at(1), at(2)));
      }
    }
  }
};

/// Moves the vertex to `point` and returns the smallest quality of its cells; -2 where one is
/// invalid, or the quality is found to be no more than `bar`.
template<std::size_t Corners>
double worstAt(EditableMesh& mesh, const Star<Corners>& star, const Point3& point, double bar = -2)
{
  mesh.moveVertex(star.vertex, point);
  double worst = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < star.cells.size(); ++c)
  {
    if (worst <= bar || !mesh.isValid(star.cells[c], star.sides[c]))
    {
      return -2;
    }
    worst = std::min(worst, mesh.quality(star.cells[c]));
  }
  return worst;
}

/// The measure of a cell (see ShapeEnergy) where its vertices are wanted, and that of the
/// equilateral cell of its size.
struct Measure
{
  double present;
  double equilateral;
};

Measure measureOf(const EditableMesh& mesh, const std::array<Index, 4>& cell, const Vector3&)
{
  const auto at = [&](int k) -> const Point3& { return mesh.vertex(cell[k]).wanted; };
  return { sixfoldVolume(at(0), at(1), at(2), at(3)),
    equilateralMeasure(3, squaredEdgeLengths(at(0), at(1), at(2), at(3))) };
}

Measure measureOf(const EditableMesh& mesh, const std::array<Index, 3>& cell, const Vector3& side)
{
  const auto at = [&](int k) -> const Point3& { return mesh.vertex(cell[k]).wanted; };
  const double lengths = squaredEdgeLengths(at(0), at(1), at(2));
  return { dot(side, twofoldAreaVector(at(0), at(1), at(2))), equilateralMeasure(2, lengths) };
}

void addTo(ShapeEnergy& energy, const EditableMesh& mesh, Index vertex,
  const std::array<Index, 4>& cell, const Vector3&, double delta)
{
  const auto at = [&](int k) -> const Point3& { return mesh.vertex(cell[k]).wanted; };
  const auto& face = faceOppositeTo(vertex, cell);
  energy.addTetrahedron(at(face[0]), at(face[2]), at(face[1]), delta);
}

void addTo(ShapeEnergy& energy, const EditableMesh& mesh, Index vertex,
  const std::array<Index, 3>& cell, const Vector3& side, double delta)
{
  const auto at = [&](std::ptrdiff_t k) -> const Point3&
  { return mesh.vertex(cell[k % 3]).wanted; };
  const auto k = std::find(cell.begin(), cell.end(), vertex) - cell.begin();
  energy.addTriangle(at(k + 1), at(k + 2), side, delta);
}

template<std::size_t Corners>
ShapeEnergy energyAt(const EditableMesh& mesh, const Star<Corners>& star)
{
  double smallest = 1;
  std::vector<double> sizes;
  sizes.reserve(star.cells.size());
  for (std::size_t c = 0; c < star.cells.size(); ++c)
  {
    const auto [present, size] = measureOf(mesh, star.cells[c], star.sides[c]);
    smallest = size > 0 ? std::min(smallest, present / size) : smallest;
    sizes.push_back(size);
  }
  const double delta = regularisation(smallest);
  ShapeEnergy energy(mesh.dimension());
  for (std::size_t c = 0; c < star.cells.size(); ++c)
  {
    addTo(energy, mesh, star.vertex, star.cells[c], star.sides[c], delta * sizes[c]);
  }
  return energy;
}

template<std::size_t Corners, class Path>
void relocate(EditableMesh& mesh, const Star<Corners>& star, const Path& path)
{
  Point3 best = mesh.vertex(star.vertex).point;
  double worst = worstAt(mesh, star, best);
  for (int k = 0; k < newtonSteps; ++k)
  {
    const ShapeEnergy energy = energyAt(mesh, star);
    if (!std::isfinite(energy.at(best)))
    {
      break;
    }
    const Vector3 step = energy.step(best, path.directionsAt(best));
    const Point3 from = best;
    for (double length = 1; length >= shortestStep && best == from && step != Vector3{};
         length *= 0.5)
    {
      const std::optional<Point3> next = path.place(from + length * step);
      const double there = next ? worstAt(mesh, star, *next, worst) : -2;
      if (there > worst)
      {
        worst = there;
        best = *next;
      }
    }
    mesh.moveVertex(star.vertex, best);
    if (best == from)
    {
      break;
    }
  }
}

} // namespace

void relocate(EditableMesh& mesh, Index vertex, const Cells<4>& cells)
{
  relocate(mesh, Star(mesh, vertex, cells), Inside{ Directions::everywhere() });
}

void relocate(EditableMesh& mesh, Index vertex, const Cells<3>& cells)
{
  relocate(mesh, Star(mesh, vertex, cells), Inside{ Directions::across(mesh.plane()) });
}

void relocateOnCAD(
  EditableMesh& mesh, Index vertex, const Cells<4>& cells, const BoundaryProjector& projector)
{
  relocate(mesh, Star(mesh, vertex, cells), OnEntity{ projector, mesh.vertex(vertex).entity });
}

void relocateOnCAD(
  EditableMesh& mesh, Index vertex, const Cells<3>& cells, const BoundaryProjector& projector)
{
  relocate(mesh, Star(mesh, vertex, cells), OnEntity{ projector, mesh.vertex(vertex).entity });
}

} // namespace cadrefine
