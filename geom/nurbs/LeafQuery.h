// One query's work on the leaves. Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/CandidateSet.h>
#include <cadrefine/nurbs/SearchStructure.h>

#include <boost/container/static_vector.hpp>

namespace cadrefine
{

/// State of one query while it runs over the leaves, in two steps: while leaves are visited, a
/// cheap point of each brings the limit down; those that remain within it are then solved, the most
/// promising first. Leaves over which the distance is convex are solved by Newton's method, the
/// others are subdivided; where there are many of one patch, as round a centre of curvature, the
/// patch is, as a whole.
class LeafQuery
{
public:
  LeafQuery(const SearchStructure& structure, const Point3& q, double maximumDistance);

  /// Ends at the first point that is within the largest distance.
  void takeAny() { candidates_.takeAny(); }
  /// Leaves outside the trim loops count too: for points known to be on the border.
  void ignoreTrim() { ignoreTrim_ = true; }

  /// Takes a leaf into account under the name `id`. No point of it is nearer than the square root
  /// of `squaredBound`.
  void visit(const SearchLeaf& leaf, EntityId id, bool border, double squaredBound);
  /// Must follow the last visit.
  void finish();

  const CandidateSet& candidates() const { return candidates_; }
  bool converged() const { return converged_; }

private:
  friend class LeafSubdivision;

  /// A leaf that may hold the nearest point.
  struct Waiting
  {
    const SearchLeaf* leaf;
    EntityId id;
    bool border;
    bool convex;
    double squaredBound;
    double s, t; // of the patch, where to start
  };

  void visitVertex(const SearchLeaf& leaf);
  /// Offers a point of the leaf at work, unless it is trimmed away.
  void offer(const SearchLeaf& leaf, double s, double t, double distance);
  bool isWithinLimit(double squaredDistance) const;
  /// Solves within `part` and offers the result. May give up where the distance is convex over it
  /// and not within the square root of `squaredLimit`.
  void solve(const SearchLeaf& leaf, const ParameterRectangle& part, double s, double t,
    double squaredLimit = std::numeric_limits<double>::infinity());
  const TrimRegion* trimOf(const SearchLeaf& leaf) const;
  void finishConvex(const Waiting& waiting);
  void subdivide(const Waiting& waiting);
  bool isWholePatchBetter(int patch) const;
  bool isDone(int patch) const;
  void subdivideWhole(int patch);

  const SearchStructure& structure_;
  Point3 q_;
  CandidateSet candidates_;
  double tolerance_;
  bool ignoreTrim_ = false;
  bool converged_ = true;
  double work_ = 0;
  static constexpr int mostWaiting = 64;
  boost::container::static_vector<Waiting, mostWaiting> waiting_;
  /// Patches that were subdivided as a whole.
  boost::container::static_vector<int, mostWaiting> donePatches_;
  EntityId id_; // of the leaf at work
  bool border_ = false;
};

} // namespace cadrefine
