// 1. The old cells that are gone or have another shape, and the new ones, are found; those that are
//    the same keep their values.
// 2. The overlaps of new cells with old ones are found, a list for each new one.
// 3. Their means, and the shares of what old cells hold, are the rows of cells.
// 4. Vertices with a new place are sought in the old cells.

#include <cadrefine/operations/FieldRows.h>

#include <cadrefine/mesh/Overlap.h>
#include <cadrefine/nurbs/BoundingBoxTree.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// An overlap of less than this part of the smaller of two cells is rounding.
constexpr double leastOverlap = 1e-13;
/// A vertex whose barycentric coordinates are not below this lies in a cell, but for rounding.
constexpr double leastCoordinate = -1e-9;

/// A cell of the mesh before or after the operations.
template<std::size_t Corners>
struct Shape
{
  Index number; ///< Number of the cell in the store.
  SimplexFrame<Corners> frame;

  double size() const { return frame.size(); }
  const SimplexPoints<Corners>& points() const { return frame.points(); }
};

struct Overlap
{
  Index old; ///< Place in the list of old cells.
  double size;
};

/// Finds shapes by their bounding boxes.
template<std::size_t Corners>
class ShapeSearch
{
public:
  explicit ShapeSearch(const std::vector<Shape<Corners>>& shapes)
  {
    BoundingBox all;
    std::vector<BoundingBoxTree::Entry> entries;
    for (const Shape<Corners>& shape : shapes)
    {
      boxes_.push_back(boxOf(shape.points()));
      all.include(boxes_.back());
      entries.push_back({ boxes_.back(), static_cast<int>(entries.size()) });
    }
    if (!entries.empty())
    {
      tree_ = BoundingBoxTree(all.middle(), all.diagonal());
      root_ = tree_.build(entries);
    }
  }

  /// Places of the shapes whose boxes meet this one, ascending.
  std::vector<Index> near(const BoundingBox& box) const
  {
    std::vector<Index> found;
    const double radius = 0.5 * box.diagonal();
    tree_.visitNear(
      root_, box.middle(), [&] { return radius * radius; }, [](int) {},
      [&](int item, double)
      {
        if (boxes_[item].meets(box))
        {
          found.push_back(item);
        }
      });
    std::sort(found.begin(), found.end());
    return found;
  }

private:
  std::vector<BoundingBox> boxes_;
  BoundingBoxTree tree_;
  BoundingBoxTree::Root root_ = BoundingBoxTree::none;
};

template<std::size_t Corners>
Point3 centroidOf(const SimplexPoints<Corners>& points)
{
  Point3 sum{};
  for (const Point3& point : points)
  {
    sum = sum + point;
  }
  return (1.0 / Corners) * sum;
}

/// The distance of the point from the nearest facet of the cell that it lies in, negative outside
/// of the cell or off the triangle's plane.
template<std::size_t Corners>
double depthIn(
  const Shape<Corners>& cell, const std::array<double, Corners>& coordinates, const Point3& point)
{
  double depth = std::numeric_limits<double>::infinity();
  Point3 inPlane{};
  for (std::size_t k = 0; k < Corners; ++k)
  {
    SimplexPoints<Corners - 1> facet;
    std::copy(cell.points().begin(), cell.points().begin() + k, facet.begin());
    std::copy(cell.points().begin() + k + 1, cell.points().end(), facet.begin() + k);
    if constexpr (Corners == 4)
    {
      depth = std::min(depth, 3 * coordinates[k] * cell.size() / measure(facet));
    }
    else
    {
      depth = std::min(depth, 2 * coordinates[k] * cell.size() / distance(facet[0], facet[1]));
      inPlane = inPlane + coordinates[k] * cell.points()[k];
    }
  }
  return Corners == 4 ? depth : depth - distance(inPlane, point);
}

template<std::size_t Corners>
class RowFinder
{
public:
  RowFinder(const EditableMesh& mesh, const SimplexStore<Corners>& cells, const MeshBefore& before)
    : mesh_(mesh), cells_(cells), before_(before)
  {
    findMoved();
    findChanged();
  }

  FieldRows find(const CellRowKinds& kinds)
  {
    const ShapeSearch<Corners> search(old_);
    if (kinds.means || kinds.densities)
    {
      std::transform(new_.begin(), new_.end(), std::back_inserter(overlaps_),
        [&](const Shape<Corners>& cell) { return overlapsOf(cell, search); });
    }
    if (kinds.means)
    {
      addMeans();
    }
    if (kinds.densities)
    {
      addDensities();
    }
    addVertices(search);
    return std::move(rows_);
  }

private:
  using Corner = std::array<Index, Corners>;

  bool isOld(Index vertex) const
  {
    return static_cast<std::size_t>(vertex) < before_.points.size();
  }

  void findMoved()
  {
    for (std::size_t v = 0; v < before_.points.size(); ++v)
    {
      moved_.push_back(mesh_.vertex(static_cast<Index>(v)).point != before_.points[v]);
    }
  }

  bool hasOldPlaces(const Corner& corners) const
  {
    return std::all_of(corners.begin(), corners.end(),
      [&](Index vertex) { return isOld(vertex) && !moved_[vertex]; });
  }

  Shape<Corners> shapeOf(Index cell, bool isBefore) const
  {
    SimplexPoints<Corners> points;
    const Corner& corners = cells_[cell].corners;
    std::transform(corners.begin(), corners.end(), points.begin(),
      [&](Index v) { return isBefore ? before_.points[v] : mesh_.vertex(v).point; });
    return { cell, SimplexFrame<Corners>(points) };
  }

  /// The old cells and the new ones, but for those that are in both.
  void findChanged()
  {
    std::map<Corner, Index> gone; // cells whose vertices are where they were
    std::vector<Index> old;
    std::vector<Index> made;
    for (std::size_t c = 0; c < cells_.size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      const bool wasThere = c < before_.cells;
      const bool isInPlace = hasOldPlaces(cells_[cell].corners);
      if (wasThere && cells_.exists(cell) && isInPlace)
      {
        continue;
      }
      if (wasThere)
      {
        old.push_back(cell);
        if (isInPlace)
        {
          gone.emplace(sorted(cells_[cell].corners), cell);
        }
      }
      if (cells_.exists(cell))
      {
        made.push_back(cell);
      }
    }
    for (const Index cell : made)
    {
      const auto same = gone.find(sorted(cells_[cell].corners));
      if (same != gone.end())
      {
        same_.emplace(cell, same->second);
        old.erase(std::lower_bound(old.begin(), old.end(), same->second));
      }
      else
      {
        new_.push_back(shapeOf(cell, false));
      }
    }
    std::transform(old.begin(), old.end(), std::back_inserter(old_),
      [&](Index cell) { return shapeOf(cell, true); });
  }

  Index labelOf(const Shape<Corners>& cell) const { return cells_[cell.number].label; }

  /// The overlaps of a new cell with old cells of its label; at least one, unless there are none.
  std::vector<Overlap> overlapsOf(
    const Shape<Corners>& cell, const ShapeSearch<Corners>& search) const
  {
    std::vector<Overlap> found;
    for (const Index place : search.near(boxOf(cell.points())))
    {
      const Shape<Corners>& old = old_[place];
      if (labelOf(old) == labelOf(cell))
      {
        const double size = overlap(old.frame, cell.frame);
        if (size > leastOverlap * std::min(old.size(), cell.size()))
        {
          found.push_back({ place, size });
        }
      }
    }
    if (found.empty())
    {
      const Index nearest = nearestTo(cell, old_);
      if (nearest >= 0)
      {
        found.push_back({ nearest, cell.size() });
      }
    }
    return found;
  }

  /// The place in the list of the cell of the same label whose centroid is nearest, and which is
  /// not flat; -1: none.
  Index nearestTo(const Shape<Corners>& cell, const std::vector<Shape<Corners>>& list) const
  {
    Index nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    const Point3 centroid = centroidOf<Corners>(cell.points());
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      const double squared = squaredNorm(centroidOf<Corners>(list[i].points()) - centroid);
      if (labelOf(list[i]) == labelOf(cell) && squared < least && list[i].size() > 0)
      {
        least = squared;
        nearest = static_cast<Index>(i);
      }
    }
    return nearest;
  }

  /// Adds the rows in the order of the cells; addOf(n) adds the entries of the n-th new cell.
  template<class AddOf>
  void addRows(WeightedRows& rows, const AddOf& addOf) const
  {
    auto same = same_.begin();
    const auto addSameBefore = [&](Index cell)
    {
      for (; same != same_.end() && same->first < cell; ++same)
      {
        rows.add(same->second, 1);
        rows.endRow(same->first);
      }
    };
    for (std::size_t n = 0; n < new_.size(); ++n)
    {
      addSameBefore(new_[n].number);
      addOf(n);
      rows.endRow(new_[n].number);
    }
    addSameBefore(static_cast<Index>(cells_.size()));
  }

  void addMeans()
  {
    addRows(rows_.ofCells,
      [&](std::size_t n)
      {
        double sum = 0;
        for (const Overlap& part : overlaps_[n])
        {
          sum += part.size;
        }
        for (const Overlap& part : overlaps_[n])
        {
          rows_.ofCells.add(old_[part.old].number, sum > 0 ? part.size / sum : 1);
        }
      });
  }

  void addDensities()
  {
    std::vector<double> sums(old_.size(), 0);
    for (const auto& parts : overlaps_)
    {
      for (const Overlap& part : parts)
      {
        sums[part.old] += part.size;
      }
    }
    std::vector<std::vector<Index>> given(new_.size()); // by old cells that overlap nothing
    for (std::size_t o = 0; o < old_.size(); ++o)
    {
      const Index nearest = sums[o] > 0 ? -1 : nearestTo(old_[o], new_);
      if (nearest >= 0)
      {
        given[nearest].push_back(static_cast<Index>(o));
      }
    }
    addRows(rows_.ofDensities,
      [&](std::size_t n)
      {
        for (const Overlap& part : overlaps_[n])
        {
          const Shape<Corners>& old = old_[part.old];
          rows_.ofDensities.add(old.number,
            new_[n].size() > 0 ? part.size / sums[part.old] * (old.size() / new_[n].size()) : 1);
        }
        for (const Index place : given[n])
        {
          rows_.ofDensities.add(old_[place].number, old_[place].size() / new_[n].size());
        }
      });
  }

  void addVertices(const ShapeSearch<Corners>& search)
  {
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v)
    {
      const auto vertex = static_cast<Index>(v);
      if (!cells_.at(vertex).empty() && (!isOld(vertex) || moved_[v] != 0))
      {
        addVertex(vertex, search);
      }
    }
  }

  /// Adds the interpolation in the old cell that the vertex lies deepest in, or least outside of.
  void addVertex(Index vertex, const ShapeSearch<Corners>& search)
  {
    const Point3& point = mesh_.vertex(vertex).point;
    const auto [cell, coordinates] = deepest(point, search.near({ point, point }));
    const bool isInside =
      cell >= 0 && *std::min_element(coordinates.begin(), coordinates.end()) >= leastCoordinate;
    if (isInside)
    {
      addVertexRow(vertex, cell, coordinates);
    }
    else if (isOld(vertex) || !mesh_.vertex(vertex).entity)
    {
      const auto [nearest, outside] = leastOutside(vertex, search);
      if (nearest >= 0)
      {
        addVertexRow(vertex, nearest, outside);
      }
    }
  }

  /// The old cell that a vertex lies least outside of, and its coordinates there: of those near the
  /// cells that it has now, or of all where there are none.
  std::pair<Index, std::array<double, Corners>> leastOutside(
    Index vertex, const ShapeSearch<Corners>& search) const
  {
    BoundingBox box;
    for (const Index cell : cells_.at(vertex))
    {
      for (const Index corner : cells_[cell].corners)
      {
        box.include(mesh_.vertex(corner).point);
      }
    }
    const Point3& point = mesh_.vertex(vertex).point;
    const auto found = deepest(point, search.near(box));
    if (found.first >= 0)
    {
      return found;
    }
    std::vector<Index> all(old_.size());
    std::iota(all.begin(), all.end(), 0);
    return deepest(point, all);
  }

  std::pair<Index, std::array<double, Corners>> deepest(
    const Point3& point, const std::vector<Index>& places) const
  {
    std::pair<Index, std::array<double, Corners>> best{ -1, {} };
    double depth = -std::numeric_limits<double>::infinity();
    for (const Index place : places)
    {
      if (old_[place].size() > 0)
      {
        const auto coordinates = old_[place].frame.coordinates(point);
        const double here = depthIn<Corners>(old_[place], coordinates, point);
        if (here > depth)
        {
          depth = here;
          best = { place, coordinates };
        }
      }
    }
    return best;
  }

  void addVertexRow(Index vertex, Index place, std::array<double, Corners> coordinates)
  {
    double sum = 0;
    for (double& coordinate : coordinates)
    {
      coordinate = std::max(coordinate, 0.0);
      sum += coordinate;
    }
    const Corner& corners = cells_[old_[place].number].corners;
    for (std::size_t k = 0; k < Corners; ++k)
    {
      if (coordinates[k] > 0)
      {
        rows_.ofVertices.add(corners[k], coordinates[k] / sum);
      }
    }
    rows_.ofVertices.endRow(vertex);
  }

  const EditableMesh& mesh_;
  const SimplexStore<Corners>& cells_;
  const MeshBefore& before_;
  std::vector<unsigned char> moved_;
  std::vector<Shape<Corners>> old_;
  std::vector<Shape<Corners>> new_;
  std::map<Index, Index> same_;                ///< Old cells by the new ones that equal them.
  std::vector<std::vector<Overlap>> overlaps_; ///< The overlaps of each new cell.
  FieldRows rows_;
};

} // namespace

FieldRows findFieldRows(
  const EditableMesh& mesh, const MeshBefore& before, const CellRowKinds& kinds)
{
  return mesh.dimension() == 3 ? RowFinder<4>(mesh, mesh.cells(), before).find(kinds)
                               : RowFinder<3>(mesh, mesh.facets(), before).find(kinds);
}

} // namespace cadrefine
