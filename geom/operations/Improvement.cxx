#include <cadrefine/operations/Improvement.h>

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/Relocation.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

namespace cadrefine
{
namespace
{

/// What the worst cell must gain, of what it lacks.
constexpr double leastGain = 0.01;
constexpr int mostPasses = 10;

class Improver
{
public:
  Improver(EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits)
    : mesh_(mesh), rule_(rule), limits_(limits)
  {
  }

  /// One round over all cells below the floor. Returns whether something was done.
  bool pass()
  {
    std::vector<std::pair<double, Index>> bad;
    for (std::size_t c = 0; c < mesh_.cells().size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      if (mesh_.cells().exists(cell))
      {
        const double quality = mesh_.quality(mesh_.cells()[cell].corners);
        if (quality < limits_.floor)
        {
          bad.emplace_back(quality, cell);
        }
      }
    }
    std::sort(bad.begin(), bad.end());
    bool changed = false;
    for (const auto& [quality, cell] : bad)
    {
      if (!isWorthATry(cell))
      {
        continue;
      }
      ++result_.counts.cells;
      if (improve(cell))
      {
        changed = true;
      }
      else
      {
        tried_[cell] = now_;
      }
    }
    return changed;
  }

  OperationResult result() { return std::move(result_); }

private:
  using Count = std::int64_t OperationCounts::*;

  /// The best operation so far.
  struct Best
  {
    Cavity cavity;
    double worst = -std::numeric_limits<double>::infinity();
    Count count = nullptr;
    Index moved = -1;
    Point3 place{};
    AddedVertex added{}; ///< Where an edge is halved.
    EditableMesh::Vertex middle;
  };

  /// Whether a cell is there, bad, and not as it was when nothing helped.
  bool isWorthATry(Index cell) const
  {
    if (!mesh_.cells().exists(cell))
    {
      return false;
    }
    const auto& corners = mesh_.cells()[cell].corners;
    const auto last = tried_.find(cell);
    return mesh_.quality(corners) < limits_.floor &&
           (last == tried_.end() ||
             std::any_of(corners.begin(), corners.end(),
               [&](Index vertex) { return changedAt(vertex) > last->second; }));
  }

  /// When the cells at a vertex last changed.
  std::int64_t changedAt(Index vertex) const
  {
    const auto v = static_cast<std::size_t>(vertex);
    return v < changes_.size() ? changes_[v] : 0;
  }

  /// Of these cells.
  void noteChange(const std::vector<LabelledSimplex<4>>& cells)
  {
    changes_.resize(std::max(changes_.size(), mesh_.vertexCount()), 0);
    for (const auto& cell : cells)
    {
      for (const Index vertex : cell.corners)
      {
        changes_[vertex] = now_;
      }
    }
  }

  std::vector<LabelledSimplex<4>> cellsOf(const std::vector<Index>& numbers) const
  {
    std::vector<LabelledSimplex<4>> cells;
    cells.reserve(numbers.size());
    for (const Index number : numbers)
    {
      cells.push_back(mesh_.cells()[number]);
    }
    return cells;
  }

  /// One operation, if one makes the worst cell better: the best of those that cost least.
  bool improve(Index cell)
  {
    const auto corners = mesh_.cells()[cell].corners;
    best_ = {};
    for (const auto& [i, j] : tetrahedronEdges)
    {
      consider(
        proposeEdgeRemoval(mesh_, corners[i], corners[j], cavity_), &OperationCounts::edgeRemovals);
    }
    for (int k = 0; k < 4; ++k)
    {
      consider(proposeFaceRemoval(mesh_, cell, k, cavity_), &OperationCounts::faceRemovals);
      considerMove(corners[k]);
    }
    if (!best_.count)
    {
      collapse(corners);
    }
    if (!best_.count && mesh_.quality(corners) < limits_.minimum)
    {
      split(corners);
    }
    return carryOut();
  }

  static bool gains(double before, double after)
  {
    return after > before + leastGain * (1 - before);
  }

  /// Whether the operation in the cavity is the best so far.
  bool consider(bool isPossible, Count count)
  {
    if (!isPossible)
    {
      return false;
    }
    double after = std::numeric_limits<double>::infinity();
    const double before = mesh_.worst(cavity_.cells);
    for (const auto& cell : cavity_.newCells)
    {
      after = std::min(after, mesh_.quality(cell.corners));
      if (after <= best_.worst || !gains(before, after))
      {
        return false;
      }
    }
    const bool isValid = std::all_of(cavity_.newCells.begin(), cavity_.newCells.end(),
      [&](const auto& cell) { return mesh_.isValid(cell.corners); });
    if (!isValid || !keepsPresentQuality() || !keepsSurface())
    {
      return false;
    }
    best_.cavity = cavity_;
    best_.worst = after;
    best_.count = count;
    best_.moved = -1;
    return true;
  }

  /// The worst of the cells where the vertices are, so far as that is bad: no operation may leave a
  /// worse one, as vertices may never come to where they are wanted.
  double worstPresent(const std::vector<Index>& cells) const
  {
    double worst = limits_.minimum;
    for (const Index cell : cells)
    {
      worst = std::min(worst, mesh_.presentQuality(mesh_.cells()[cell].corners));
    }
    return worst;
  }

  bool keepsPresentQuality() const
  {
    const double least = worstPresent(cavity_.cells);
    return std::all_of(cavity_.newCells.begin(), cavity_.newCells.end(),
      [&](const auto& cell) { return mesh_.presentQuality(cell.corners) >= least; });
  }

  bool keepsSurface() const
  {
    return (cavity_.facets.empty() && cavity_.newFacets.empty()) ||
           (rule_ && rule_->accepts(mesh_, cavity_));
  }

  void considerMove(Index vertex)
  {
    std::int64_t& stuck = stuck_.try_emplace(vertex, -1).first->second;
    if (changedAt(vertex) <= stuck || mesh_.freedomOf(vertex) != EditableMesh::Freedom::Space)
    {
      return;
    }
    const Point3 start = mesh_.vertex(vertex).point;
    const std::vector<Index>& around = mesh_.cells().at(vertex);
    const double before = mesh_.worst(around);
    const double present = worstPresent(around);
    Simplices<4> cells;
    for (const Index cell : around)
    {
      cells.push_back(mesh_.cells()[cell].corners);
    }
    const double after = relocate(mesh_, vertex, cells);
    if (!gains(before, after))
    {
      stuck = now_;
    }
    else if (after > best_.worst && worstPresent(around) >= present)
    {
      best_.worst = after;
      best_.count = &OperationCounts::moves;
      best_.moved = vertex;
      best_.place = mesh_.vertex(vertex).point;
    }
    mesh_.moveVertex(vertex, start);
  }

  bool carryOut()
  {
    if (!best_.count)
    {
      return false;
    }
    ++(result_.counts.*best_.count);
    ++now_;
    if (best_.count == &OperationCounts::splits)
    {
      mesh_.setVertex(middle_, best_.middle);
      result_.added.push_back(best_.added);
      middle_ = -1;
    }
    if (best_.moved >= 0)
    {
      mesh_.moveVertex(best_.moved, best_.place);
      noteChange(cellsOf(mesh_.cells().at(best_.moved)));
    }
    else
    {
      replace(best_.cavity);
    }
    return true;
  }

  /// Gives the new cells the parents that they lie in.
  void replace(Cavity& cavity)
  {
    for (auto& cell : cavity.newCells)
    {
      if (cell.parent < 0)
      {
        cell.parent = parentOf(cell.corners, cavity.cells);
      }
    }
    mesh_.replace(cavity);
    noteChange(cavity.newCells);
  }

  /// The parent of the cell that the centroid lies in, or least outside of.
  Index parentOf(const std::array<Index, 4>& corners, const std::vector<Index>& cells) const
  {
    const auto at = [&](Index v) -> const Point3& { return mesh_.vertex(v).point; };
    const Point3 centroid =
      0.25 * (at(corners[0]) + at(corners[1]) + at(corners[2]) + at(corners[3]));
    Index parent = -1;
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Index cell : cells)
    {
      const auto& c = mesh_.cells()[cell].corners;
      const double volume = sixfoldVolume(at(c[0]), at(c[1]), at(c[2]), at(c[3]));
      double depth = std::numeric_limits<double>::infinity();
      for (const auto& face : tetrahedronFaces)
      {
        const double part =
          -sixfoldVolume(at(c[face[0]]), at(c[face[1]]), at(c[face[2]]), centroid);
        depth = std::min(depth, volume > 0 ? part / volume : part);
      }
      if (depth > deepest)
      {
        deepest = depth;
        parent = mesh_.cells()[cell].parent;
      }
    }
    return parent;
  }

  void collapse(const std::array<Index, 4>& corners)
  {
    for (const auto& [i, j] : tetrahedronEdges)
    {
      consider(
        proposeCollapse(mesh_, corners[i], corners[j], cavity_), &OperationCounts::collapses);
      consider(
        proposeCollapse(mesh_, corners[j], corners[i], cavity_), &OperationCounts::collapses);
    }
  }

  /// Halves the edge for which that gains most.
  void split(const std::array<Index, 4>& corners)
  {
    for (const auto& [i, j] : tetrahedronEdges)
    {
      considerSplit(corners[i], corners[j]);
    }
  }

  void considerSplit(Index a, Index b)
  {
    const EditableMesh::Vertex one = mesh_.vertex(a);
    const EditableMesh::Vertex other = mesh_.vertex(b);
    if (middle_ < 0)
    {
      middle_ = mesh_.addVertex({});
    }
    if (!proposeSplit(mesh_, a, b, middle_, cavity_))
    {
      return;
    }
    EditableMesh::Vertex vertex;
    vertex.point = 0.5 * (one.point + other.point);
    vertex.wanted = vertex.point;
    AddedVertex added{ { a, b }, {} };
    if (!cavity_.facets.empty())
    {
      added.where = rule_ ? rule_->placeOfMiddle(mesh_, a, b) : ClosestPoint{};
      if (!added.where.entity)
      {
        return;
      }
      vertex.point = added.where.point;
      vertex.wanted = added.where.point;
      vertex.entity = added.where.entity;
    }
    mesh_.setVertex(middle_, vertex);
    Simplices<4> cells;
    for (const auto& cell : cavity_.newCells)
    {
      cells.push_back(cell.corners);
    }
    if (!std::all_of(
          cells.begin(), cells.end(), [&](const auto& cell) { return mesh_.isValid(cell); }))
    {
      return; // too short to be halved, or in the way of what would go onto the CAD
    }
    const bool isOfOneLabel = std::all_of(cavity_.newCells.begin(), cavity_.newCells.end(),
      [&](const auto& cell) { return cell.label == cavity_.newCells.front().label; });
    if (cavity_.facets.empty() && isOfOneLabel)
    {
      relocate(mesh_, middle_, cells);
    }
    if (consider(true, &OperationCounts::splits))
    {
      best_.middle = mesh_.vertex(middle_);
      best_.added = added;
    }
  }

  EditableMesh& mesh_;
  const SurfaceRule* rule_;
  const ImprovementLimits limits_;
  Index middle_ = -1; ///< A vertex without cells.
  Cavity cavity_;
  Best best_;
  std::int64_t now_ = 0;                          ///< Operations so far.
  std::vector<std::int64_t> changes_;             ///< See changedAt.
  std::unordered_map<Index, std::int64_t> tried_; ///< When nothing helped a cell.
  std::unordered_map<Index, std::int64_t> stuck_; ///< When no move helped a vertex.
  OperationResult result_;
};

} // namespace

OperationResult improveCells(
  EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits)
{
  Improver improver(mesh, rule, limits);
  for (int k = 0; k < mostPasses && improver.pass(); ++k)
  {
  }
  return improver.result();
}

} // namespace cadrefine
