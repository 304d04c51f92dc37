// Names of CAD entities.
#pragma once

#include <cstdint>
#include <tuple>

namespace cadrefine
{

/// A CAD entity: its dimension (0 vertex, 1 edge, 2 face) and its index among those of that
/// dimension. The default value stands for no entity. Ordered by (dimension, index): this order
/// decides between entities that are equally near.
struct EntityId
{
  std::int8_t dimension = -1;
  std::int32_t index = -1;

  explicit operator bool() const { return dimension >= 0; }
  friend bool operator==(EntityId a, EntityId b)
  {
    return a.dimension == b.dimension && a.index == b.index;
  }
  friend bool operator!=(EntityId a, EntityId b) { return !(a == b); }
  friend bool operator<(EntityId a, EntityId b)
  {
    return std::tie(a.dimension, a.index) < std::tie(b.dimension, b.index);
  }
};

} // namespace cadrefine
