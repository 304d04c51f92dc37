#include "LeafQuery.h"

#include "LeafSubdivision.h"
#include "SquareMinimum.h"

#include <cmath>

namespace cadrefine
{
namespace
{

/// Of the model's size: distances that differ by less are a tie.
constexpr double tieTolerance = 1e-12;
/// Of the model's size: how much nearer than the answer a point may be that is not looked for.
constexpr double searchTolerance = 5e-10;

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

void LeafQuery::solve(const SearchLeaf& leaf, const ParameterRectangle& part, double s, double t)
{
  const SearchPatch& patch = structure_.patches[leaf.patch];
  const SquareMinimum foot = minimizeDistance(patch.view, q_, part, s, t, leaf.bounds.radius());
  Candidate candidate = { id_, border_, std::sqrt(foot.squaredDistance), leaf.patch, foot.s,
    foot.t };
  if (!(candidate.distance <= candidates_.limit()))
  {
    return;
  }
  if (const TrimRegion* trim = trimOf(leaf))
  {
    const auto uv = patch.parametersAt(foot.s, foot.t);
    if (!trim->contains(uv[0], uv[1]))
    {
      return;
    }
  }
  candidates_.offer(candidate);
}

void LeafQuery::visit(const SearchLeaf& leaf, EntityId id, bool border)
{
  if (leaf.patch < 0)
  {
    visitVertex(leaf);
    return;
  }
  id_ = id;
  border_ = border;
  const ConvexityBounds::Answer answer = leaf.bounds.ask(q_);
  if (!answer.convex)
  {
    LeafSubdivision(*this, leaf).run();
    return;
  }
  const double limit = candidates_.limit();
  if (answer.squaredDistanceBound > limit * limit)
  {
    return;
  }
  // Over a convex leaf the minimum is unique. Where it is trimmed away, that over what is left of
  // the leaf is on the trim border, which the edges cover.
  const ParameterRectangle& part = leaf.part;
  solve(leaf, part, part.s0 + answer.s * part.width(), part.t0 + answer.t * part.height());
}

} // namespace cadrefine
