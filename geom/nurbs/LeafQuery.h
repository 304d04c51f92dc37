// One query's work on the leaves. Private to geom/nurbs.
#pragma once

#include "CandidateSet.h"
#include "SearchStructure.h"

namespace cadrefine
{

/// State of one query while it runs over the leaves.
class LeafQuery
{
public:
  LeafQuery(const SearchStructure& structure, const Point3& q, double maximumDistance);

  /// Leaves outside the trim loops count too: for points known to be on the border.
  void ignoreTrim() { ignoreTrim_ = true; }

  /// Offers the nearest point of a leaf under the name `id`. Leaves over which the distance is
  /// convex are solved by Newton's method, the others are subdivided.
  void visit(const SearchLeaf& leaf, EntityId id, bool border);

  const CandidateSet& candidates() const { return candidates_; }
  bool converged() const { return converged_; }

private:
  friend class LeafSubdivision;

  void visitVertex(const SearchLeaf& leaf);
  /// Solves within `part` and offers the result, unless it is trimmed away.
  void solve(const SearchLeaf& leaf, const ParameterRectangle& part, double s, double t);
  const TrimRegion* trimOf(const SearchLeaf& leaf) const;

  const SearchStructure& structure_;
  Point3 q_;
  CandidateSet candidates_;
  double tolerance_;
  bool ignoreTrim_ = false;
  bool converged_ = true;
  double work_ = 0;
  EntityId id_;
  bool border_ = false;
};

} // namespace cadrefine
