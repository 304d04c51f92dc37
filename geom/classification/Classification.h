// Where the vertices of a mesh lie on the CAD.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/MeshTypes.h>
#include <cadrefine/nurbs/ClosestPointSearch.h>

#include <array>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// CAD entity, parameters and distance of each vertex.
struct Classification
{
  std::vector<EntityId> entities;
  std::vector<std::array<double, 2>> parameters;
  std::vector<double> distances; ///< How far the vertex still is from its place on the CAD.

  /// `count` vertices that are not on the CAD.
  explicit Classification(std::size_t count = 0) { resize(count); }
  void resize(std::size_t count);
  void set(Index vertex, const ClosestPoint& where);
};

} // namespace cadrefine
