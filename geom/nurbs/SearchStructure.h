// What closest-point queries run on: the model's pieces and the tree over them. Private to
// geom/nurbs.
#pragma once

#include <cadrefine/nurbs/BoundingBoxTree.h>
#include <cadrefine/nurbs/ConvexityBounds.h>
#include <cadrefine/nurbs/NurbsModel.h>
#include <cadrefine/nurbs/ParameterRectangle.h>
#include <cadrefine/nurbs/PatchView.h>
#include <cadrefine/nurbs/Seams.h>
#include <cadrefine/nurbs/TrimRegion.h>

#include <deque>
#include <memory>
#include <vector>

namespace cadrefine
{

/// A patch of a face or a segment of an edge, whole; or a curve in space along a part of a face's
/// border, where no edge covers that.
struct SearchPatch
{
  PatchView view;
  /// Range of the entity's own parameters; along a border of those of `trim`.
  ParameterRectangle range;
  int entity = -1; ///< Number in SearchStructure::entities.
  /// Which of the sides s = 0, s = 1, t = 0, t = 1 are shared with another patch of the face.
  std::array<bool, 4> joined{ false, false, false, false };
  const BezierCurve2* trim = nullptr; ///< For a border, the trim curve that it follows.

  /// The entity's parameters at local ones; exact at the borders.
  std::array<double, 2> parametersAt(double s, double t) const
  {
    return { (1.0 - s) * range.s0 + s * range.s1, (1.0 - t) * range.t0 + t * range.t1 };
  }
  /// The point at the entity's parameters, evaluated as anyone else would.
  Point3 evaluateAt(const std::array<double, 2>& parameters) const
  {
    return evaluateLocal(view, range.width() > 0 ? (parameters[0] - range.s0) / range.width() : 0.0,
      range.height() > 0 ? (parameters[1] - range.t0) / range.height() : 0.0);
  }
};

/// Part of a patch or segment over which the distance is simple for points near it. It fills four
/// cache lines.
struct alignas(64) SearchLeaf
{
  /// The part in the patch's local parameters, which halving leaves exact in single precision.
  ParameterRectangle part() const { return { sides[0], sides[1], sides[2], sides[3] }; }

  ConvexityBounds bounds;
  std::array<float, 4> sides{ 0, 1, 0, 1 };
  int patch = -1; ///< -1: a vertex.
  int entity = -1;
  bool cut = false; ///< Trim loops run through it.
};

struct SearchEntity
{
  EntityId id;
  /// Tree over the entity's own leaves; none where nothing is left of it.
  BoundingBoxTree::Root root = BoundingBoxTree::none;
  /// For a face, the tree over these leaves and those of its edges and their vertices.
  BoundingBoxTree::Root closure = BoundingBoxTree::none;
  bool sharp = false; ///< For an edge, whether it is a crease.
  bool stray = false; ///< See SearchScope::strays.
  int face = -1;      ///< For an edge, the first face whose border it covers; -1: none.
  std::unique_ptr<const TrimRegion> trim; ///< For a face, its trimmed region.
  int firstPatch = 0; ///< Its patches are consecutive, in a grid; then come those of its border.
  int rows = 0;
  int columns = 0;
  Seams seams;
};

/// Built once for a model; immutable. Memory: about 350 bytes a leaf.
struct SearchStructure
{
  /// Throws Error as checkModel does.
  explicit SearchStructure(const NurbsModel& model);

  /// The patch of an entity that holds these of its parameters, the first of several.
  const SearchPatch& patchAt(int entity, const std::array<double, 2>& parameters) const;

  /// The parameters of a face, moved onto its patches where they are beyond them.
  std::array<double, 2> onGrid(int entity, const std::array<double, 2>& parameters) const;

  int entityNumber(EntityId id) const { return firstEntity[id.dimension] + id.index; }

  const NurbsModel& model;
  std::vector<SearchPatch> patches;
  std::deque<std::vector<ControlPoint>> borders; ///< Control points of the curves along borders.
  std::vector<SearchLeaf> leaves;
  std::vector<SearchEntity> entities; ///< Vertices, then edges, then faces.
  std::array<int, 3> firstEntity{};   ///< Number of the first entity of each dimension.
  BoundingBoxTree tree;
  BoundingBoxTree::Root root = BoundingBoxTree::none; ///< Tree over all leaves.
  Point3 centre{};                                    ///< Middle of the bounding box.
  double size = 0;                                    ///< Its diagonal.
};

} // namespace cadrefine
