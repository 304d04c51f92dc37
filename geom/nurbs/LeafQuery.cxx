#include <cadrefine/nurbs/LeafQuery.h>

#include <cadrefine/nurbs/DistanceMinimizer.h>
#include <cadrefine/nurbs/FetchAhead.h>
#include <cadrefine/nurbs/LeafSubdivision.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

/// Distances that differ by less than this part of the model's size are a tie.
constexpr double tieTolerance = 1e-12;
/// How much nearer than the answer, in terms of the model's size, a point may be that is not looked
/// for.
constexpr double searchTolerance = 5e-10;
/// Most control points of a patch that are fetched ahead.
constexpr int mostFetched = 16;

} // namespace

LeafQuery::LeafQuery(const SearchStructure& structure, const Point3& q, double maximumDistance)
  : structure_(structure), q_(q), candidates_(maximumDistance, tieTolerance * structure.size),
    tolerance_(searchTolerance * structure.size)
{
}

const TrimRegion* LeafQuery::trimOf(const SearchLeaf& leaf) const
{
  return leaf.cut && !ignoreTrim_ ? structure_.entities[leaf.entity].trim.get() : nullptr;
}

void LeafQuery::visitVertex(const SearchLeaf& leaf)
{
  Candidate candidate;
  candidate.id = structure_.entities[leaf.entity].id;
  candidate.distance = distance(structure_.model.vertices[candidate.id.index].point, q_);
  candidates_.offer(candidate);
}

bool LeafQuery::isWithinLimit(double squaredDistance) const
{
  const double limit = candidates_.limit();
  return squaredDistance <= limit * limit;
}

void LeafQuery::offer(const SearchLeaf& leaf, double s, double t, double distance)
{
  if (!(distance <= candidates_.limit()))
  {
    return;
  }
  if (const TrimRegion* trim = trimOf(leaf))
  {
    const auto uv = structure_.patches[leaf.patch].parametersAt(s, t);
    if (!trim->contains(uv[0], uv[1]))
    {
      return;
    }
  }
  candidates_.offer({ id_, border_, distance, leaf.patch, s, t });
}

void LeafQuery::solve(
  const SearchLeaf& leaf, const ParameterRectangle& part, double s, double t, double squaredLimit)
{
  const DistanceMinimizer foot = minimizeDistance(
    structure_.patches[leaf.patch].view, q_, part, s, t, leaf.bounds.radius(), squaredLimit);
  offer(leaf, foot.s, foot.t, std::sqrt(foot.squaredDistance));
}

void LeafQuery::visit(const SearchLeaf& leaf, EntityId id, bool border, double squaredBound)
{
  if (leaf.patch < 0)
  {
    visitVertex(leaf);
    return;
  }
  const SearchPatch& patch = structure_.patches[leaf.patch];
  if ((ignoreTrim_ && patch.trim) || isDone(leaf.patch))
  {
    return;
  }
  fetchAhead(patch.view.points, std::min(patch.view.count(), mostFetched));
  const ConvexityBounds::Answer answer = leaf.bounds.ask(q_);
  const double bound = std::max(squaredBound, answer.squaredDistanceBound);
  if (!isWithinLimit(bound))
  {
    return;
  }
  if (waiting_.size() == mostWaiting)
  {
    finish();
  }
  const ParameterRectangle part = leaf.part();
  const Waiting waiting = { &leaf, id, border, answer.convex, bound,
    part.s0 + answer.s * part.width(), part.t0 + answer.t * part.height() };
  waiting_.push_back(waiting);
  id_ = id;
  border_ = border;
  const Point3 start =
    answer.convex ? evaluateLocal(patch.view, waiting.s, waiting.t) : leaf.bounds.middle();
  offer(leaf, waiting.s, waiting.t, distance(start, q_));
}

bool LeafQuery::isDone(int patch) const
{
  return std::find(donePatches_.begin(), donePatches_.end(), patch) != donePatches_.end();
}

/// Solves a leaf over which the distance is convex: its minimum is unique. Where it is trimmed
/// away, that over what is left of the leaf is on the trim border, which edges cover, or curves
/// along it.
void LeafQuery::finishConvex(const Waiting& waiting)
{
  const double limit = candidates_.limit();
  solve(*waiting.leaf, waiting.leaf->part(), waiting.s, waiting.t, limit * limit);
}

bool LeafQuery::isWholePatchBetter(int patch) const
{
  constexpr int many = 6;
  const auto isOfPatch = [&](const Waiting& waiting) {
    return waiting.leaf->patch == patch && !waiting.convex && isWithinLimit(waiting.squaredBound);
  };
  return donePatches_.size() < donePatches_.capacity() &&
         std::count_if(waiting_.begin(), waiting_.end(), isOfPatch) >= many;
}

void LeafQuery::subdivideWhole(int patch)
{
  donePatches_.push_back(patch);
  const SearchPatch& of = structure_.patches[patch];
  SearchLeaf whole;
  whole.bounds = ConvexityBounds(of.view);
  whole.patch = patch;
  whole.entity = of.entity;
  whole.cut = structure_.entities[of.entity].trim != nullptr && !of.trim;
  LeafSubdivision(*this, whole).run();
}

void LeafQuery::subdivide(const Waiting& waiting)
{
  const int patch = waiting.leaf->patch;
  if (isDone(patch))
  {
    return;
  }
  if (isWholePatchBetter(patch))
  {
    subdivideWhole(patch);
  }
  else
  {
    LeafSubdivision(*this, *waiting.leaf).run();
  }
}

void LeafQuery::finish()
{
  const auto earlier = [](const Waiting& a, const Waiting& b)
  { return a.convex != b.convex ? a.convex : a.squaredBound < b.squaredBound; };
  std::sort(waiting_.begin(), waiting_.end(), earlier);
  for (const Waiting& waiting : waiting_)
  {
    if (!isWithinLimit(waiting.squaredBound))
    {
      continue;
    }
    id_ = waiting.id;
    border_ = waiting.border;
    waiting.convex ? finishConvex(waiting) : subdivide(waiting);
  }
  waiting_.clear();
}

} // namespace cadrefine
