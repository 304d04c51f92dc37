// What the steps of the initial projection work on.
#pragma once

#include "classification/DistributedBoundary.h"
#include "mesh/DistributedMesh.h"

#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/classification/CADAdjacency.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{

struct ProjectionOptions
{
  /// The box xmin xmax ymin ymax zmin zmax, if only vertices inside it take part.
  std::optional<std::array<double, 6>> region;
  /// The CAD faces (see selectEntities), if only facets on these take part; empty: on any.
  std::vector<std::string> faces;
  /// Vertices farther than this from the CAD stay; without it, the limit is a vertex's longest
  /// boundary edge (points alone: no limit).
  std::optional<double> maximumDistance;
  /// Cells that are inverted or flat are to be mended (see MoveSettings).
  bool mendCells = false;
  /// The minimum of improveMesh; none: no local operations.
  std::optional<double> minimumQuality;
  /// See MoveSettings.
  std::vector<std::uint64_t> tags = {};

  bool inRegion(const Point3& p) const
  {
    const auto inside = [&](int k)
    { return p[k] >= (*region)[2 * k] && p[k] <= (*region)[2 * k + 1]; };
    return !region || (inside(0) && inside(1) && inside(2));
  }
};

struct ProjectionTask
{
  RankExchange& exchange;
  const DistributedMesh& mesh;
  const BoundaryProjector& projector;
  const DistributedBoundary& boundary;
  const ProjectionOptions& options;

  const std::vector<Point3>& points() const { return mesh.mesh().points; }
  const CADModel& model() const { return projector.model(); }
  bool ofFaces() const { return boundary.kind == BoundaryKind::Faces; }
  /// How far a vertex may be from the CAD.
  double limit(std::size_t vertex) const
  {
    return options.maximumDistance.value_or(boundary.longestEdge[vertex]);
  }
  /// The distance from the CAD up to which a vertex lies on it already.
  double exact(std::size_t vertex) const
  {
    return exactDistance(model(), boundary.shortestEdge[vertex]);
  }
  /// The distance up to which it lies there but for the few digits of a file's coordinates.
  double rounded(std::size_t vertex) const
  {
    return roundedDistance(model(), boundary.shortestEdge[vertex]);
  }
};

/// A few CAD entities of one dimension: the smallest indices of those that were added, ascending.
/// The union of two does not depend on their order.
class SmallEntitySet
{
public:
  SmallEntitySet() { indices_.fill(none); }
  void add(std::int32_t index);
  void add(const SmallEntitySet& other);
  bool has(std::int32_t index) const;

  const std::int32_t* begin() const { return indices_.data(); }
  const std::int32_t* end() const;
  std::size_t size() const { return static_cast<std::size_t>(end() - begin()); }
  bool empty() const { return size() == 0; }

private:
  static constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();
  std::array<std::int32_t, 8> indices_;
};

} // namespace cadrefine
