// Cuts patches and segments into leaves. Private to geom/nurbs.
#pragma once

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/nurbs/SearchStructure.h>

#include <vector>

namespace cadrefine
{

struct LeafLimits
{
  double smallestRadius = 0; ///< Leaves smaller than this are not split, however curved.
  double largestRadius = 0;  ///< Larger ones are split, however flat.
  int mostLeaves = 0;        ///< Largest number of leaves of one patch.
};

struct BuiltLeaf
{
  SearchLeaf leaf;
  BoundingBox box;
};

/// Splits until the distance to each leaf is convex for points nearer than the leaf's radius, as
/// far as `limits` allow. What lies outside `trim` (null: untrimmed) is dropped.
std::vector<BuiltLeaf> buildLeaves(
  const SearchPatch& patch, const TrimRegion* trim, const LeafLimits& limits);

} // namespace cadrefine
