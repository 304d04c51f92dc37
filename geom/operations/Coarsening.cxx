#include <cadrefine/operations/Coarsening.h>

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/operations/Improvement.h>
#include <cadrefine/operations/ImprovementRule.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

using Freedom = EditableMesh::Freedom;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Cells below this are improved so that more vertices can go.
constexpr double aim = 0.5;

/// The number of facets of the boundary on the CAD (of a planar mesh: segments).
double countFacetsOnCAD(const EditableMesh& mesh)
{
  const auto count = [](const auto& store)
  {
    double result = 0;
    for (std::size_t s = 0; s < store.size(); ++s)
    {
      result += store[static_cast<Index>(s)].label >= 0 ? 1 : 0;
    }
    return result;
  };
  return mesh.kind() == EditableMesh::Kind::Plane ? count(mesh.segments()) : count(mesh.facets());
}

/// The vertices that are to go and are free to move at all, the freest first.
std::vector<Index> candidates(const EditableMesh& mesh, const std::vector<VertexFate>& fates)
{
  std::vector<std::pair<Freedom, Index>> sorted;
  for (std::size_t v = 0; v < fates.size(); ++v)
  {
    const auto vertex = static_cast<Index>(v);
    const Freedom freedom = fates[v] == VertexFate::Goes ? mesh.freedomOf(vertex) : Freedom::None;
    if (freedom != Freedom::None)
    {
      sorted.emplace_back(freedom, vertex);
    }
  }
  std::stable_sort(
    sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Index> vertices(sorted.size());
  std::transform(sorted.begin(), sorted.end(), vertices.begin(),
    [](const auto& candidate) { return candidate.second; });
  return vertices;
}

template<int Dimension>
std::int64_t countCells(const EditableMesh& mesh)
{
  const auto& cells = mesh.cellsOf<Dimension>();
  std::int64_t count = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    count += cells.exists(static_cast<Index>(c)) ? 1 : 0;
  }
  return count;
}

/// Flags the vertices whose fate is to stay, so that no operation moves them or takes them out.
void holdStaying(const std::vector<VertexFate>& fates, EditableMesh& mesh)
{
  for (std::size_t v = 0; v < fates.size(); ++v)
  {
    EditableMesh::Vertex vertex = mesh.vertex(static_cast<Index>(v));
    if (fates[v] == VertexFate::Stays && !vertex.stays)
    {
      vertex.stays = true;
      mesh.setVertex(static_cast<Index>(v), vertex);
    }
  }
}

template<int Dimension>
class Coarsener
{
public:
  Coarsener(EditableMesh& mesh, const SurfaceRule& rule, std::vector<VertexFate>& fates,
    const CoarseningLimits& limits, double& errorLeft)
    : mesh_(mesh), rule_(rule), fates_(fates), minimumQuality_(limits.minimumQuality),
      judge_(mesh, &rule,
        { aim, limits.minimumQuality,
          { limits.distance, false, SurfaceLimits::Walls::LoseVertices } }),
      errorLeft_(errorLeft), waits_(fates.size(), 0)
  {
  }

  /// Takes out vertices and returns the number of collapses. `exchanges`: where a vertex cannot go,
  /// a neighbour may go into it. `fewest`: once there are so few cells, no vertex goes any more; if
  /// given, a neighbour that is exchanged may also go elsewhere.
  std::int64_t run(bool exchanges, std::optional<std::int64_t> fewest)
  {
    exchanges_ = exchanges;
    fewest_ = fewest;
    const std::vector<Index> vertices = candidates(mesh_, fates_);
    const auto ofBoundary = std::count_if(vertices.begin(), vertices.end(),
      [&](Index vertex) { return mesh_.freedomOf(vertex) != Freedom::Space; });
    const double share = errorLeft_ / static_cast<double>(std::max<std::ptrdiff_t>(ofBoundary, 1));
    for (const Index vertex : vertices)
    {
      waits_[vertex] = 1;
    }
    // The cheap ones first.
    for (const double most : { share, 3 * share, infinity })
    {
      mostGain_ = most;
      tryAll(vertices);
    }
    return collapses_;
  }

private:
  /// A way to take a vertex out.
  struct Collapse
  {
    double worst; ///< Quality of the worst cell after it.
    Index from;
    Index to;
  };

  void tryAll(const std::vector<Index>& vertices)
  {
    std::vector<Index> costly;
    bool changes = true;
    while (changes)
    {
      changes = false;
      for (const Index vertex : vertices)
      {
        if (waits_[vertex] && (!fewest_ || cellCount_ > *fewest_))
        {
          waits_[vertex] = 0;
          costsTooMuch_ = false;
          changes = takeOut(vertex) || changes;
          if (costsTooMuch_)
          {
            costly.push_back(vertex);
          }
        }
      }
    }
    for (const Index vertex : costly)
    {
      waits_[vertex] = fates_[vertex] == VertexFate::Goes;
    }
  }

  using Corners = std::array<Index, Dimension + 1>;

  const SimplexStore<Dimension + 1>& cells() const { return mesh_.template cellsOf<Dimension>(); }

  std::vector<Index> remainingNeighbours(Index vertex) const
  {
    std::vector<Index> neighbours;
    for (const Index cell : cells().at(vertex))
    {
      for (const Index corner : cells()[cell].corners)
      {
        if (corner != vertex && fates_[corner] != VertexFate::Goes)
        {
          neighbours.push_back(corner);
        }
      }
    }
    sortUniquely(neighbours);
    return neighbours;
  }

  /// The worst cell once the vertex has gone to another; -1 where that is below `least`.
  double worstAfter(Index vertex, Index to, double least) const
  {
    double worst = infinity;
    for (const Index cell : cells().at(vertex))
    {
      Corners corners = cells()[cell].corners;
      if (!hasCorner(corners, to))
      {
        std::replace(corners.begin(), corners.end(), vertex, to);
        worst = std::min(worst, mesh_.quality(corners));
        if (worst < least)
        {
          return -1;
        }
      }
    }
    return worst;
  }

  /// Adds the collapses of a vertex into these neighbours that leave no cell too bad.
  void addWays(Index from, const std::vector<Index>& neighbours, std::vector<Collapse>& ways) const
  {
    const double least = std::min(minimumQuality_, mesh_.worst(cells().at(from)));
    for (const Index to : neighbours)
    {
      const double worst = worstAfter(from, to, least);
      if (worst >= 0)
      {
        ways.push_back({ worst, from, to });
      }
    }
  }

  bool takeOut(Index vertex)
  {
    const std::vector<Index> neighbours = remainingNeighbours(vertex);
    std::vector<Collapse> ways;
    addWays(vertex, neighbours, ways);
    return collapseByBest(ways) ||
           (exchanges_ && (takeOutNeighbour(vertex, neighbours, false) ||
                            (fewest_ && takeOutNeighbour(vertex, neighbours, true))));
  }

  /// Takes out a neighbour in place of the vertex: into the vertex, or `elsewhere`.
  bool takeOutNeighbour(Index vertex, const std::vector<Index>& neighbours, bool elsewhere)
  {
    std::vector<Collapse> ways;
    for (const Index from : neighbours)
    {
      if (mesh_.freedomOf(from) != Freedom::None)
      {
        addWays(from, elsewhere ? remainingNeighbours(from) : std::vector<Index>{ vertex }, ways);
      }
    }
    const bool goes = collapseByBest(ways);
    if (goes)
    {
      fates_[vertex] = VertexFate::MayGo;
      waits_[vertex] = 0;
    }
    return goes;
  }

  /// Collapses by the way that adds least to the error; of those that add nothing, by the one with
  /// the best worst cell.
  bool collapseByBest(std::vector<Collapse>& ways)
  {
    std::stable_sort(ways.begin(), ways.end(),
      [](const Collapse& a, const Collapse& b) { return a.worst > b.worst; });
    const Collapse* best = nullptr;
    double leastGain = infinity;
    for (const Collapse& way : ways)
    {
      const double gain = isAllowed(way) ? errorGain() : infinity;
      if (gain < leastGain)
      {
        best = &way;
        leastGain = gain;
      }
      if (gain <= 0)
      {
        break;
      }
    }
    if (!best || leastGain > std::min(mostGain_, errorLeft_))
    {
      costsTooMuch_ = costsTooMuch_ || best;
      return false;
    }
    proposeCollapse(mesh_, best->from, best->to, cavity_);
    errorLeft_ -= leastGain;
    carryOut(*best);
    return true;
  }

  bool isAllowed(const Collapse& way)
  {
    return proposeCollapse(mesh_, way.from, way.to, cavity_) && mesh_.isValid(cavity_) &&
           judge_.keepsCurrentQuality(cavity_) && judge_.keepsSurface(cavity_);
  }

  /// What the collapse that is proposed adds to the error, where that is limited.
  double errorGain() const
  {
    return errorLeft_ == infinity || !mesh_.touchesBoundary(cavity_)
             ? 0
             : rule_.errorGain(mesh_, cavity_);
  }

  void carryOut(const Collapse& way)
  {
    cellCount_ += static_cast<std::int64_t>(cavity_.newCellsOf<Dimension>().size()) -
                  static_cast<std::int64_t>(cavity_.cellsOf<Dimension>().size());
    mesh_.replace(cavity_);
    ++collapses_;
    fates_[way.from] = VertexFate::Stays;
    for (const auto& cell : cavity_.newCellsOf<Dimension>())
    {
      for (const Index corner : cell.corners)
      {
        waits_[corner] = fates_[corner] == VertexFate::Goes;
      }
    }
  }

  EditableMesh& mesh_;
  const SurfaceRule& rule_;
  std::vector<VertexFate>& fates_;
  const double minimumQuality_;
  const ImprovementRule<Dimension> judge_;
  double& errorLeft_;
  std::vector<unsigned char> waits_; ///< 1: the vertex is to be tried.
  double mostGain_ = infinity;       ///< Most that a collapse may add to the error.
  bool costsTooMuch_ = false;        ///< The vertex last looked at adds too much error.
  bool exchanges_ = false;
  std::optional<std::int64_t> fewest_; ///< How many cells are to be left.
  std::int64_t cellCount_ = countCells<Dimension>(mesh_);
  Cavity cavity_;
  std::int64_t collapses_ = 0;
};

template<int Dimension>
OperationResult coarsen(EditableMesh& mesh, const SurfaceRule& rule, std::vector<VertexFate>& fates,
  const CoarseningLimits& limits)
{
  holdStaying(fates, mesh);
  double errorLeft =
    limits.errorPerFacet < infinity ? limits.errorPerFacet * countFacetsOnCAD(mesh) : infinity;
  std::optional<std::int64_t> fewest;
  if (limits.cellsPerVertex)
  {
    const auto flagged = static_cast<double>(candidates(mesh, fates).size());
    fewest = countCells<Dimension>(mesh) - std::llround(*limits.cellsPerVertex * flagged);
  }
  const std::int64_t collapses =
    Coarsener<Dimension>(mesh, rule, fates, limits, errorLeft).run(false, fewest);
  if (candidates(mesh, fates).empty())
  {
    OperationResult result;
    result.counts.collapses = collapses;
    return result;
  }
  const SurfaceLimits surface{ 0, true, SurfaceLimits::Walls::LoseVertices };
  OperationResult result = improveCells(
    mesh, &rule, { std::max(limits.minimumQuality, aim), limits.minimumQuality, surface });
  result.counts.collapses += collapses;
  for (std::size_t v = 0; v < fates.size(); ++v)
  {
    const bool isThere = !mesh.cellsOf<Dimension>().at(static_cast<Index>(v)).empty();
    fates[v] = isThere ? fates[v] : VertexFate::Stays;
  }
  fates.resize(mesh.vertexCount(), VertexFate::MayGo);
  result.counts.collapses +=
    Coarsener<Dimension>(mesh, rule, fates, limits, errorLeft).run(true, fewest);
  return result;
}

} // namespace

OperationResult coarsenCells(EditableMesh& mesh, const SurfaceRule& rule,
  std::vector<VertexFate>& fates, const CoarseningLimits& limits)
{
  return mesh.dimension() == 3 ? coarsen<3>(mesh, rule, fates, limits)
                               : coarsen<2>(mesh, rule, fates, limits);
}

} // namespace cadrefine
