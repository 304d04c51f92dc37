#include "refinement/FacetMarking.h"

#include "error/BoundaryAngles.h"

#include <algorithm>
#include <numeric>

namespace cadrefine
{
namespace
{

class FacetMarking
{
public:
  FacetMarking(const ClassifiedBoundary& classified, const Classification& classification,
    const EdgeTable& table, EdgeMarks& marks)
    : classified_(classified), boundary_(classified.boundary), classification_(classification),
      table_(table), marks_(marks)
  {
  }

  void run(const std::vector<unsigned char>& cellMarks)
  {
    for (const std::size_t f : facetsByCell(cellMarks))
    {
      markLongest(f);
      if (!ofCell_.empty() && boundary_.facets[ofCell_.front()].cell != boundary_.facets[f].cell)
      {
        ofCell_.clear();
      }
      for (const std::size_t other : ofCell_)
      {
        markBetween(f, other);
      }
      ofCell_.push_back(f);
    }
  }

private:
  /// The facets on the CAD of marked cells.
  std::vector<std::size_t> facetsByCell(const std::vector<unsigned char>& cellMarks) const
  {
    std::vector<std::size_t> facets(boundary_.facets.size());
    std::iota(facets.begin(), facets.end(), std::size_t{ 0 });
    facets.erase(
      std::remove_if(facets.begin(), facets.end(),
        [&](std::size_t f)
        { return !classified_.classes.facets[f].onCAD || !cellMarks[boundary_.facets[f].cell]; }),
      facets.end());
    std::sort(facets.begin(), facets.end(),
      [&](std::size_t a, std::size_t b)
      { return boundary_.facets[a].cell < boundary_.facets[b].cell; });
    return facets;
  }

  void markLongest(std::size_t f)
  {
    std::vector<Index> edges;
    for (const Index e : boundary_.facetEdges[f])
    {
      if (e >= 0)
      {
        const auto [a, b] = boundary_.edges.edges()[e];
        edges.push_back(table_.find(a, b));
      }
    }
    marks_[EdgeOrder(table_).longest(edges)] = 1;
  }

  /// The corner of a facet that is not one of another facet of its cell.
  Index ownCorner(std::size_t f, std::size_t other) const
  {
    const Facet& mine = boundary_.facets[f];
    const Facet& its = boundary_.facets[other];
    return *std::find_if(mine.begin(), mine.end(),
      [&](Index v) { return std::find(its.begin(), its.end(), v) == its.end(); });
  }

  bool meetSmoothly(std::size_t f, std::size_t other) const
  {
    if (boundary_.kind == BoundaryKind::Faces)
    {
      const auto& mine = boundary_.facetEdges[f];
      const auto& its = boundary_.facetEdges[other];
      const auto shared = std::find_first_of(mine.begin(), mine.end(), its.begin(), its.end());
      return shared != mine.end() && *shared >= 0 &&
             isSmooth(classified_.classes.ofEdges[*shared], classified_.projector.model());
    }
    const auto& mine = boundary_.facets[f].vertices;
    const auto& its = boundary_.facets[other].vertices;
    const auto end = mine.begin() + 2;
    const auto shared = std::find_first_of(mine.begin(), end, its.begin(), its.begin() + 2);
    return shared != end && classification_.entities[*shared].dimension != 0;
  }

  void markBetween(std::size_t f, std::size_t other)
  {
    if (meetSmoothly(f, other))
    {
      const Index edge = table_.find(ownCorner(f, other), ownCorner(other, f));
      if (edge >= 0) // of a simplex
      {
        marks_[edge] = 1;
      }
    }
  }

  const ClassifiedBoundary& classified_;
  const DistributedBoundary& boundary_;
  const Classification& classification_;
  const EdgeTable& table_;
  EdgeMarks& marks_;
  std::vector<std::size_t> ofCell_; ///< Facets of the same cell that came before.
};

} // namespace

void markFacets(const ClassifiedBoundary& classified, const Classification& classification,
  const EdgeTable& table, const std::vector<unsigned char>& cellMarks, EdgeMarks& marks)
{
  FacetMarking(classified, classification, table, marks).run(cellMarks);
}

} // namespace cadrefine
