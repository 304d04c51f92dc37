// A mesh of bad cells to operate on.
#pragma once

#include "TestMeshes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/EditableMesh.h>

#include <algorithm>
#include <random>

namespace cadtest
{

inline double volumeOf(const cadrefine::EditableMesh& mesh)
{
  using namespace cadrefine;
  double volume = 0;
  for (Index c = 0; c < static_cast<Index>(mesh.cells().size()); ++c)
  {
    if (mesh.cells().exists(c))
    {
      const auto& v = mesh.cells()[c].corners;
      volume += sixfoldVolume(mesh.vertex(v[0]).point, mesh.vertex(v[1]).point,
                  mesh.vertex(v[2]).point, mesh.vertex(v[3]).point) /
                6;
    }
  }
  return volume;
}

/// A cube with inner vertices at random, so far as cells stay valid. Its boundary stays.
inline cadrefine::EditableMesh spoiltCube(unsigned seed)
{
  using namespace cadrefine;
  Mesh boxes = cubeMesh(4, 0.1, seed);
  std::mt19937 random(seed);
  EditableMesh mesh;
  for (const Point3& point : boxes.points)
  {
    const bool isInside =
      std::all_of(point.begin(), point.end(), [](double x) { return x > 0 && x < 1; });
    mesh.addVertex({ point, point, {}, false, !isInside });
  }
  for (std::size_t c = 0; c < boxes.tetrahedra.size(); ++c)
  {
    // Two materials, on either side of a plane of vertices that are at random places.
    const auto& cell = boxes.tetrahedra[c];
    mesh.addCell(
      { cell, static_cast<Index>(c / (boxes.tetrahedra.size() / 2)), static_cast<Index>(c) });
  }
  for (std::size_t v = 0; v < boxes.points.size(); ++v)
  {
    const auto vertex = static_cast<Index>(v);
    if (mesh.vertex(vertex).isOnRim)
    {
      continue;
    }
    const Point3 start = mesh.vertex(vertex).point;
    const auto part = [&] { return 0.4 * (static_cast<double>(random() % 1000) / 1000 - 0.5); };
    mesh.moveVertex(vertex, start + Point3{ part(), part(), part() });
    const auto& cells = mesh.cells().at(vertex);
    if (!std::all_of(cells.begin(), cells.end(),
          [&](Index cell) { return mesh.isValid(mesh.cells()[cell].corners); }))
    {
      mesh.moveVertex(vertex, start);
    }
  }
  return mesh;
}

/// The same as a mesh without materials.
inline cadrefine::Mesh spoiltCubeMesh(unsigned seed)
{
  using namespace cadrefine;
  const EditableMesh spoilt = spoiltCube(seed);
  Mesh mesh;
  for (std::size_t v = 0; v < spoilt.vertexCount(); ++v)
  {
    mesh.points.push_back(spoilt.vertex(static_cast<Index>(v)).point);
  }
  for (std::size_t c = 0; c < spoilt.cells().size(); ++c)
  {
    mesh.tetrahedra.push_back(spoilt.cells()[static_cast<Index>(c)].corners);
  }
  return mesh;
}

} // namespace cadtest
