// The entities that a query may still answer with. Private to geom/nurbs.
#pragma once

#include <cadrefine/base/EntityId.h>

#include <boost/container/small_vector.hpp>

#include <limits>

namespace cadrefine
{

/// A point of the model seen by a query.
struct Candidate
{
  EntityId id;         ///< What the answer would name.
  bool border = false; ///< It is an edge that stands for the border of face `id`.
  double distance = std::numeric_limits<double>::infinity();
  int patch = -1; ///< Patch or segment of the search structure that the point is on.
  double s = 0;   ///< Its local parameters there.
  double t = 0;
};

/// Keeps, of all candidates offered, those that can still win: within the tie tolerance of the
/// nearest, and not preceded by one that is as near. So the winner, the smallest id among those
/// equally near, does not depend on the order of the offers.
class CandidateSet
{
public:
  CandidateSet(double maximumDistance, double tieTolerance)
    : nearest_(maximumDistance), tieTolerance_(tieTolerance)
  {
  }

  /// Lets the first candidate win.
  void takeAny() { takesAny_ = true; }

  /// Smallest distance so far; at first the largest that is asked for.
  double nearest() const { return nearest_; }
  /// Points farther than this cannot win.
  double limit() const { return nearest_ + tieTolerance_; }
  void offer(const Candidate& candidate);
  /// The winner; null where nothing was near enough.
  const Candidate* winner() const;

private:
  static bool precedes(const Candidate& a, const Candidate& b)
  {
    return a.id == b.id ? a.border < b.border : a.id < b.id;
  }

  static constexpr int usual = 8;
  boost::container::small_vector<Candidate, usual> kept_;
  double nearest_;
  double tieTolerance_;
  bool takesAny_ = false;
};

} // namespace cadrefine
