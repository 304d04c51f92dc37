#include <cadrefine/operations/Improvement.h>

#include <cadrefine/operations/FailedAttempts.h>
#include <cadrefine/operations/ImprovementRule.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/ParentCells.h>
#include <cadrefine/operations/Relocation.h>
#include <cadrefine/operations/SplitSwaps.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr int mostPasses = 10;

/// The local edges of a tetrahedron or a triangle.
template<int Dimension>
constexpr const auto& edgesOfCell()
{
  if constexpr (Dimension == 3)
  {
    return tetrahedronEdges;
  }
  else
  {
    return triangleEdges;
  }
}

/// Improves the cells of a mesh of this dimension.
template<int Dimension>
class Improver
{
public:
  using Corners = std::array<Index, Dimension + 1>;
  using Cell = LabelledSimplex<Dimension + 1>;

  Improver(EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits)
    : mesh_(mesh), rule_(rule), limits_(limits), judge_(mesh, rule, limits)
  {
  }

  /// One round over all cells below the floor. Returns whether something was done.
  bool pass()
  {
    std::vector<std::pair<double, Index>> bad;
    for (std::size_t c = 0; c < cells().size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      if (cells().exists(cell))
      {
        const double quality = mesh_.qualityOf(cell);
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
        noteFailure(cell);
      }
    }
    return changed;
  }

  OperationResult result() { return std::move(result_); }

private:
  using Count = std::int64_t OperationCounts::*;

  const SimplexStore<Dimension + 1>& cells() const { return mesh_.cellsOf<Dimension>(); }
  const std::vector<Index>& removedCells() const { return cavity_.cellsOf<Dimension>(); }
  const std::vector<Cell>& newCells() const { return cavity_.newCellsOf<Dimension>(); }

  /// The best operation so far.
  struct Best
  {
    Cavity cavity;
    double worst = -std::numeric_limits<double>::infinity();
    Count count = nullptr;
    Index moved = -1;
    Point3 place{};
    AddedVertex added{}; ///< The new vertex of a split.
    EditableMesh::Vertex middle;
  };

  /// Whether a cell is there, bad, and not as it was when nothing helped.
  bool isWorthATry(Index cell) const
  {
    return cells().exists(cell) && mesh_.qualityOf(cell) < limits_.floor &&
           !failed_.hasCell(cell, cells()[cell].corners);
  }

  /// Notes that nothing helped a cell, and so nothing that was tried with its edges: other cells
  /// need not try the same again.
  void noteFailure(Index cell)
  {
    failed_.noteCell(cell);
    const auto& corners = cells()[cell].corners;
    const bool withSplit = mesh_.qualityOf(cell) < limits_.minimum;
    for (const auto& [i, j] : edgesOfCell<Dimension>())
    {
      failed_.noteEdge(corners[i], corners[j], withSplit);
    }
  }

  std::vector<Cell> copiesOf(const std::vector<Index>& numbers) const
  {
    std::vector<Cell> copies;
    copies.reserve(numbers.size());
    for (const Index number : numbers)
    {
      copies.push_back(cells()[number]);
    }
    return copies;
  }

  Cells<Dimension + 1> cornersOf(const std::vector<Index>& numbers) const
  {
    Cells<Dimension + 1> corners;
    corners.reserve(numbers.size());
    for (const Index number : numbers)
    {
      corners.push_back(cells()[number].corners);
    }
    return corners;
  }

  /// Does one operation, if any makes cells better: the best of those that cost least.
  bool improve(Index cell)
  {
    const auto corners = cells()[cell].corners;
    best_ = {};
    forEdges(corners, false,
      [&](Index a, Index b)
      {
        consider(proposeEdgeRemoval(mesh_, a, b, cavity_, NewCells::NoWorse),
          &OperationCounts::edgeRemovals);
      });
    for (int k = 0; k <= Dimension; ++k)
    {
      if constexpr (Dimension == 3)
      {
        consider(proposeFaceRemoval(mesh_, cell, k, cavity_), &OperationCounts::faceRemovals);
      }
      considerMove(corners[k]);
      if (Dimension == 2)
      {
        considerMoveOnCAD(corners[k]);
      }
    }
    if (!best_.count && mesh_.qualityOf(cell) < limits_.collapseBelow)
    {
      forEdges(corners, false,
        [&](Index a, Index b)
        {
          considerCollapse(a, b);
          considerCollapse(b, a);
        });
    }
    const bool isBad = mesh_.qualityOf(cell) < limits_.minimum;
    if (!best_.count && isBad)
    {
      for (const Index vertex : corners)
      {
        considerMoveOnCAD(vertex);
      }
      forEdges(corners, true, [&](Index a, Index b) { considerSplit(a, b, Dimension == 2); });
    }
    if (!best_.count && isBad && Dimension == 3)
    {
      forEdges(corners, true, [&](Index a, Index b) { considerSplit(a, b, true); });
    }
    return carryOut();
  }

  /// Visits those edges of a cell at which something may be gained.
  template<class Visit>
  void forEdges(const Corners& corners, bool withSplit, const Visit& visit)
  {
    for (const auto& [i, j] : edgesOfCell<Dimension>())
    {
      if (!failed_.hasEdge(corners[i], corners[j], withSplit))
      {
        visit(corners[i], corners[j]);
      }
    }
  }

  /// Takes the operation in the cavity if it is the best so far, and returns whether it is.
  bool consider(bool isPossible, Count count)
  {
    if (!isPossible)
    {
      return false;
    }
    const GroupQuality before = judge_.qualityOf(removedCells());
    GroupQuality after;
    for (const Cell& cell : newCells())
    {
      judge_.add(mesh_.quality(cell.corners), after);
      if (after.worst <= best_.worst || !judge_.gains(before, after))
      {
        return false;
      }
    }
    if (!mesh_.isValid(cavity_) || !judge_.keepsCurrentQuality(cavity_) ||
        !judge_.keepsSurface(cavity_))
    {
      return false;
    }
    best_.cavity = cavity_;
    best_.worst = after.worst;
    best_.count = count;
    best_.moved = -1;
    return true;
  }

  /// Whether a vertex is inside the mesh: it may go anywhere.
  bool isInside(Index vertex) const
  {
    using Freedom = EditableMesh::Freedom;
    return mesh_.kind() != EditableMesh::Kind::Surface && !mesh_.vertex(vertex).entity &&
           mesh_.freedomOf(vertex) == (Dimension == 3 ? Freedom::Space : Freedom::Facet);
  }

  /// Whether a vertex may go along the CAD: where it has got there.
  bool isOnCAD(Index number) const
  {
    using Freedom = EditableMesh::Freedom;
    const EditableMesh::Vertex& vertex = mesh_.vertex(number);
    if (!rule_ || !vertex.entity || vertex.point != vertex.wanted)
    {
      return false;
    }
    const Freedom freedom = mesh_.freedomOf(number);
    const auto& facets = mesh_.facets().at(number);
    return (freedom == Freedom::Facet || freedom == Freedom::Segment) &&
           vertex.entity.dimension == (freedom == Freedom::Facet ? 2 : 1) &&
           (Dimension == 2 || std::all_of(facets.begin(), facets.end(),
                                [&](Index facet) { return mesh_.facets()[facet].label >= 0; }));
  }

  void considerMove(Index vertex)
  {
    if (isInside(vertex))
    {
      considerMove(vertex,
        [&](const auto& corners)
        {
          relocate(mesh_, vertex, corners);
          return true;
        });
    }
  }

  /// Considers moving a vertex along the CAD, so that the boundary follows the CAD as well as
  /// before.
  void considerMoveOnCAD(Index vertex)
  {
    if (!isOnCAD(vertex) || limits_.surface.keepsError)
    {
      return; // what a move adds to the error is not asked
    }
    considerMove(vertex,
      [&](const auto& corners)
      {
        const Point3 start = mesh_.vertex(vertex).point;
        relocateOnCAD(mesh_, vertex, corners, rule_->projector());
        const Point3 place = mesh_.vertex(vertex).point;
        if (place == start)
        {
          return false;
        }
        const SurfaceRule::Fit after = rule_->fitAt(mesh_, vertex);
        mesh_.moveVertex(vertex, start);
        const SurfaceRule::Fit before = rule_->fitAt(mesh_, vertex);
        mesh_.moveVertex(vertex, place);
        return SurfaceRule::isAsGood(after, before);
      });
  }

  /// `move` moves the vertex, given the corners of the cells at it, and returns whether it may.
  template<class Move>
  void considerMove(Index vertex, const Move& move)
  {
    if (failed_.hasVertex(vertex))
    {
      return;
    }
    const std::vector<Index>& around = cells().at(vertex);
    const Cells<Dimension + 1> corners = cornersOf(around);
    const GroupQuality before = judge_.qualityOf(around);
    if (!judge_.mayGain(before.cost, corners, vertex))
    {
      failed_.noteVertex(vertex);
      return;
    }
    const Point3 start = mesh_.vertex(vertex).point;
    const double present = judge_.worstCurrent(around);
    const bool mayMove = move(corners);
    const GroupQuality after = judge_.qualityOf(around);
    if (!mayMove || !judge_.gains(before, after))
    {
      failed_.noteVertex(vertex);
    }
    else if (after.worst > best_.worst && judge_.worstCurrent(around) >= present)
    {
      best_.worst = after.worst;
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
    if (best_.count == &OperationCounts::splits)
    {
      mesh_.setVertex(middle_, best_.middle);
      result_.added.push_back(best_.added);
      middle_ = -1;
    }
    if (best_.moved >= 0)
    {
      mesh_.moveVertex(best_.moved, best_.place);
      failed_.noteChange(copiesOf(cells().at(best_.moved)));
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
    for (Cell& cell : cavity.newCellsOf<Dimension>())
    {
      if (cell.parent < 0)
      {
        cell.parent = parentOf(mesh_, cells(), cell.corners, cavity.cellsOf<Dimension>());
      }
    }
    mesh_.replace(cavity);
    failed_.noteChange(cavity.newCellsOf<Dimension>());
  }

  /// Considers a collapse. The cheaper check comes first: whether cells get too bad, then what the
  /// corners tell.
  void considerCollapse(Index from, Index to)
  {
    if (mesh_.vertex(from).stays || mesh_.vertex(from).isOnRim)
    {
      return;
    }
    const std::vector<Index>& around = cells().at(from);
    const GroupQuality before = judge_.qualityOf(around);
    GroupQuality after;
    for (const Index cell : around)
    {
      Corners corners = cells()[cell].corners;
      if (!hasCorner(corners, to))
      {
        std::replace(corners.begin(), corners.end(), from, to);
        judge_.add(mesh_.quality(corners), after);
        if (after.worst <= best_.worst || !judge_.gains(before, after))
        {
          return;
        }
      }
    }
    consider(proposeCollapse(mesh_, from, to, cavity_), &OperationCounts::collapses);
  }

  /// The corners of the new cells at the vertex of a split.
  Cells<Dimension + 1> newCellsAtMiddle() const
  {
    Cells<Dimension + 1> corners;
    for (const Cell& cell : newCells())
    {
      if (hasCorner(cell.corners, middle_))
      {
        corners.push_back(cell.corners);
      }
    }
    return corners;
  }

  /// Considers a split; one without swaps only where the faces that stay let the halves of cells be
  /// better.
  void considerSplit(Index a, Index b, bool withSwaps)
  {
    if (middle_ < 0)
    {
      middle_ = mesh_.addVertex({});
    }
    if (!proposeSplit(mesh_, a, b, middle_, cavity_) ||
        (!withSwaps &&
          !judge_.mayGain(judge_.qualityOf(removedCells()).cost, newCellsAtMiddle(), middle_)))
    {
      return;
    }
    AddedVertex added{ { a, b }, mesh_.touchesBoundary(cavity_), {} };
    added.where.point = 0.5 * (mesh_.vertex(a).point + mesh_.vertex(b).point);
    if (added.onBoundary)
    {
      const auto place = rule_ ? rule_->placeOfMiddle(mesh_, a, b) : std::nullopt;
      if (!place)
      {
        return;
      }
      added.where = *place;
    }
    EditableMesh::Vertex vertex;
    vertex.point = vertex.wanted = added.where.point;
    vertex.entity = added.where.entity;
    mesh_.setVertex(middle_, vertex);
    if (!mesh_.isValid(cavity_))
    {
      return; // too short to be halved, or in the way of what would go onto the CAD
    }
    const bool isOfOneLabel = std::all_of(newCells().begin(), newCells().end(),
      [&](const Cell& cell) { return cell.label == newCells().front().label; });
    const bool mayMove = !added.onBoundary && isOfOneLabel;
    if (withSwaps)
    {
      swapRoundMiddle(mesh_, middle_, cavity_);
    }
    if (mayMove)
    {
      relocate(mesh_, middle_, newCellsAtMiddle());
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
  const ImprovementRule<Dimension> judge_;
  Index middle_ = -1; ///< A vertex without cells.
  Cavity cavity_;
  Best best_;
  FailedAttempts failed_;
  OperationResult result_;
};

template<int Dimension>
OperationResult improve(
  EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits)
{
  Improver<Dimension> improver(mesh, rule, limits);
  for (int k = 0; k < mostPasses && improver.pass(); ++k)
  {
  }
  return improver.result();
}

} // namespace

OperationResult improveCells(
  EditableMesh& mesh, const SurfaceRule* rule, const ImprovementLimits& limits)
{
  return mesh.dimension() == 3 ? improve<3>(mesh, rule, limits) : improve<2>(mesh, rule, limits);
}

} // namespace cadrefine
