#include "LeastMarking.h"

#include <cadrefine/base/Vector3.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace cadtest
{

using namespace cadrefine;

namespace
{

/// The rules as they are written in LongestEdgeMarking.h, with sets.
class LeastMixedMarking
{
public:
  LeastMixedMarking(const Mesh& mesh, bool keepLayers) : mesh_(mesh), keepLayers_(keepLayers)
  {
    visitShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        if constexpr (decltype(shape)::dimension > 1)
        {
          for (const auto& cell : cells)
          {
            addCell(shape, cell, decltype(shape)::dimension == mesh_.dimension);
          }
        }
      });
    standAlike();
  }

  std::set<IdPair> close(const std::vector<unsigned char>& cellMarks)
  {
    for (std::size_t c = 0; c < cellMarks.size(); ++c)
    {
      if (cellMarks[c])
      {
        markCell(cells_[c]);
      }
    }
    for (std::size_t before = 0; before != marked_.size();)
    {
      before = marked_.size();
      for (const auto& edges : groups_)
      {
        if (isMarked(edges))
        {
          marked_.insert(longest(edges));
        }
      }
      for (const auto& [a, b] : pairs_)
      {
        if (isMarked({ a, b }))
        {
          marked_.insert({ a, b });
        }
      }
    }
    return marked_;
  }

private:
  using Edges = std::vector<IdPair>;
  struct Rank
  {
    double squaredLength;
    IdPair ids;
    bool operator<(const Rank& other) const
    {
      return std::tie(squaredLength, ids) < std::tie(other.squaredLength, other.ids);
    }
  };

  struct Cell
  {
    Edges all;
    Edges triangles; ///< Of a wedge.
    Edges uprights;  ///< Between these.
    std::vector<Edges> directions;
  };

  IdPair edge(Index a, Index b)
  {
    if (mesh_.ids[b] < mesh_.ids[a])
    {
      std::swap(a, b);
    }
    const IdPair ids{ mesh_.ids[a], mesh_.ids[b] };
    ranks_.emplace(ids, Rank{ squaredNorm(mesh_.points[b] - mesh_.points[a]), ids });
    return ids;
  }

  template<class Shape, class Corners>
  void addCell(Shape, const Corners& corners, bool isOwn)
  {
    Cell cell;
    for (const auto& [i, k] : Shape::edges)
    {
      cell.all.push_back(edge(corners[i], corners[k]));
    }
    if constexpr (Shape::corners == 3 || (Shape::corners == 4 && Shape::dimension == 3))
    {
      groups_.push_back(cell.all);
    }
    if constexpr (Shape::dimension == 3)
    {
      for (const auto& [a, b, c, d] : Shape::faces)
      {
        if (d < 0)
        {
          groups_.push_back({ edge(corners[a], corners[b]), edge(corners[b], corners[c]),
            edge(corners[c], corners[a]) });
        }
      }
    }
    if constexpr (Shape::corners == 6)
    {
      for (int k = 0; k < 3; ++k)
      {
        const IdPair low = edge(corners[k], corners[(k + 1) % 3]);
        const IdPair high = edge(corners[3 + k], corners[3 + (k + 1) % 3]);
        stacked_.emplace_back(low, high);
        cell.triangles.push_back(low);
        cell.triangles.push_back(high);
        cell.uprights.push_back(edge(corners[k], corners[3 + k]));
      }
      wedges_.push_back(cell);
    }
    if constexpr (!isSimplex(Shape{}) && (Shape::corners == 8 || Shape::dimension == 2))
    {
      addDirections(Shape{}, corners, cell);
    }
    if (isOwn)
    {
      cells_.push_back(cell);
    }
  }

  /// Edges that are parallel in the unit cell.
  template<class Shape, class Corners>
  void addDirections(Shape, const Corners& corners, Cell& cell)
  {
    constexpr int at[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
      { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
    cell.directions.resize(Shape::dimension);
    for (const auto& [i, k] : Shape::edges)
    {
      for (int d = 0; d < Shape::dimension; ++d)
      {
        if (at[i][d] != at[k][d])
        {
          cell.directions[d].push_back(edge(corners[i], corners[k]));
        }
      }
    }
    for (int along = 0; keepLayers_ && along < Shape::dimension; ++along)
    {
      candidates_.push_back({ cell, along, {}, Shape::dimension == mesh_.dimension });
      auto& over = candidates_.back().pairs;
      for (const auto& [i, k] : Shape::edges)
      {
        for (const auto& [m, n] : Shape::edges)
        {
          // One step apart in this direction, alike in the others.
          const auto isOver = [&](int a, int b)
          {
            bool same = at[a][along] == 0 && at[b][along] == 1;
            for (int d = 0; d < 3; ++d)
            {
              same = same && (d == along || at[a][d] == at[b][d]);
            }
            return same;
          };
          if ((isOver(i, m) && isOver(k, n)) || (isOver(i, n) && isOver(k, m)))
          {
            over.emplace_back(edge(corners[i], corners[k]), edge(corners[m], corners[n]));
          }
        }
      }
    }
  }

  /// The largest rank of each stack; then which cells are thin or long.
  void standAlike()
  {
    for (bool changed = keepLayers_; changed;)
    {
      changed = false;
      for (const auto& [a, b] : stacked_)
      {
        const Rank largest = std::max(ranks_.at(a), ranks_.at(b));
        for (const IdPair& each : { a, b })
        {
          changed = changed || ranks_.at(each) < largest;
          ranks_.at(each) = largest;
        }
      }
    }
    if (keepLayers_)
    {
      pairs_ = stacked_;
    }
    for (const auto& candidate : candidates_)
    {
      const auto& [cell, along, pairs, isOfLayers] = candidate;
      const bool isThin = thinDirection(cell) == along;
      const int longest = cell.directions.size() == 3 ? longDirection(cell) : -1;
      std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(pairs_),
        [&, isLong = longest == along, use = isOfLayers](const auto& pair)
        {
          const auto isIn = [&](const Edges& edges)
          { return std::find(edges.begin(), edges.end(), pair.first) != edges.end(); };
          return use && (isThin || isLong || (longest >= 0 && isIn(cell.directions[longest])));
        });
    }
    for (const Cell& wedge : wedges_)
    {
      if (keepLayers_ && meanSquare(wedge.uprights) > 4 * meanSquare(wedge.triangles))
      {
        pairs_.emplace_back(wedge.uprights[0], wedge.uprights[1]);
        pairs_.emplace_back(wedge.uprights[0], wedge.uprights[2]);
      }
    }
  }

  double meanSquare(const Edges& edges) const
  {
    double sum = 0;
    for (const IdPair& each : edges)
    {
      sum += ranks_.at(each).squaredLength;
    }
    return sum / static_cast<double>(edges.size());
  }

  int thinDirection(const Cell& cell) const
  {
    return directionOf(cell, [](double its, double other) { return 4 * its < other; });
  }
  int longDirection(const Cell& cell) const
  {
    return directionOf(cell, [](double its, double other) { return its > 4 * other; });
  }

  /// The direction whose mean square compares so with each other one; -1: none.
  template<class Compare>
  int directionOf(const Cell& cell, const Compare& compare) const
  {
    std::vector<double> means;
    for (const Edges& edges : cell.directions)
    {
      means.push_back(meanSquare(edges));
    }
    for (std::size_t d = 0; d < means.size(); ++d)
    {
      bool differs = true;
      for (std::size_t other = 0; other < means.size(); ++other)
      {
        differs = differs && (other == d || compare(means[d], means[other]));
      }
      if (differs)
      {
        return static_cast<int>(d);
      }
    }
    return -1;
  }

  void markCell(const Cell& cell)
  {
    if (cell.directions.empty())
    {
      marked_.insert(longest(keepLayers_ && !cell.triangles.empty() ? cell.triangles : cell.all));
      return;
    }
    const int thin = keepLayers_ ? thinDirection(cell) : -1;
    for (int d = 0; d < static_cast<int>(cell.directions.size()); ++d)
    {
      if (d != thin)
      {
        marked_.insert(cell.directions[d].begin(), cell.directions[d].end());
      }
    }
  }

  bool isMarked(const Edges& edges) const
  {
    return std::any_of(
      edges.begin(), edges.end(), [&](const IdPair& each) { return marked_.count(each) > 0; });
  }

  IdPair longest(const Edges& edges) const
  {
    return *std::max_element(edges.begin(), edges.end(),
      [&](const IdPair& a, const IdPair& b)
      {
        const Rank& first = ranks_.at(a);
        const Rank& second = ranks_.at(b);
        return first < second || (!(second < first) && a < b);
      });
  }

  struct Candidate
  {
    Cell cell;
    int along; ///< The direction along which pairs lie over each other.
    std::vector<std::pair<IdPair, IdPair>> pairs;
    bool isOfLayers = false;
  };

  const Mesh& mesh_;
  bool keepLayers_;
  std::map<IdPair, Rank> ranks_;
  std::vector<Cell> cells_; ///< Of the mesh's own dimension.
  std::vector<Cell> wedges_;
  std::vector<Edges> groups_;
  std::vector<std::pair<IdPair, IdPair>> stacked_;
  std::vector<std::pair<IdPair, IdPair>> pairs_;
  std::vector<Candidate> candidates_;
  std::set<IdPair> marked_;
};

} // namespace

std::set<IdPair> leastMixedMarking(
  const Mesh& mesh, const std::vector<unsigned char>& cellMarks, bool keepLayers)
{
  return LeastMixedMarking(mesh, keepLayers).close(cellMarks);
}

} // namespace cadtest
