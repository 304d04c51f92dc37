// An independent, slow closest point to compare with, and the checks that every answer must pass.
#pragma once

#include <cadrefine/nurbs/ClosestPointSearch.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace cadrefine::reference
{

inline Point3 evaluateOn(const NurbsModel& model, EntityId id, const std::array<double, 2>& at)
{
  if (id.dimension == 0)
  {
    return model.vertices[id.index].point;
  }
  if (id.dimension == 1)
  {
    const auto& segments = model.edges[id.index].segments;
    const auto holds = [&](const BezierCurve& s) { return at[0] <= s.t1; };
    const auto found = std::find_if(segments.begin(), segments.end(), holds);
    return evaluate(found == segments.end() ? segments.back() : *found, at[0]);
  }
  const auto& patches = model.faces[id.index].patches;
  const auto holds = [&](const BezierPatch& p)
  { return at[0] <= p.u1 && at[0] >= p.u0 && at[1] <= p.v1 && at[1] >= p.v0; };
  const auto found = std::find_if(patches.begin(), patches.end(), holds);
  return evaluate(found == patches.end() ? patches.back() : *found, at[0], at[1]);
}

/// The answer lies on the entity that it names, where it says.
inline void expectConsistent(
  const NurbsModel& model, double size, const Point3& q, const ClosestPoint& answer)
{
  ASSERT_TRUE(static_cast<bool>(answer.entity));
  const Point3 there = evaluateOn(model, answer.entity, answer.parameters);
  EXPECT_LE(distance(there, answer.point), 1e-12 * size);
  EXPECT_NEAR(answer.distance, distance(q, answer.point), 1e-12 * size);
}

/// Distance from q to a patch: samples, and a compass search from the best of them. Never smaller
/// than the true one.
inline double patchDistance(const BezierPatch& patch, const Point3& q)
{
  constexpr int n = 24;
  struct Sample
  {
    double distance, u, v;
  };
  std::vector<Sample> samples;
  const double width = patch.u1 - patch.u0;
  const double height = patch.v1 - patch.v0;
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; j <= n; ++j)
    {
      const double u = patch.u0 + width * i / n;
      const double v = patch.v0 + height * j / n;
      samples.push_back({ distance(evaluate(patch, u, v), q), u, v });
    }
  }
  const auto nearer = [](const Sample& a, const Sample& b) { return a.distance < b.distance; };
  std::partial_sort(samples.begin(), samples.begin() + 4, samples.end(), nearer);
  double best = samples[0].distance;
  for (int k = 0; k < 4; ++k)
  {
    Sample here = samples[k];
    for (double step = 1.0 / n; step > 1e-8;)
    {
      const Sample before = here;
      for (const auto& [a, b] : { std::pair<int, int>{ 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } })
      {
        const double u = std::clamp(here.u + a * step * width, patch.u0, patch.u1);
        const double v = std::clamp(here.v + b * step * height, patch.v0, patch.v1);
        here = std::min(here, Sample{ distance(evaluate(patch, u, v), q), u, v }, nearer);
      }
      step = here.distance < before.distance ? step : 0.5 * step;
    }
    best = std::min(best, here.distance);
  }
  return best;
}

inline double faceDistance(const NurbsFace& face, const Point3& q)
{
  double best = std::numeric_limits<double>::infinity();
  for (const BezierPatch& patch : face.patches)
  {
    best = std::min(best, patchDistance(patch, q));
  }
  return best;
}

} // namespace cadrefine::reference
