#include "pipeline/Coarsening.h"

#include "error/DistributedError.h"
#include "operations/VertexRemoval.h"
#include "pipeline/CellImprovement.h"
#include "pipeline/LocalOperations.h"
#include "pipeline/MeshSummary.h"

#include <cadrefine/base/MixedBits.h>
#include <cadrefine/operations/Coarsening.h>

#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace cadrefine
{
namespace
{

/// What is to become of vertices in this level (VertexFate); it goes along where cells are sent to
/// other ranks. A new vertex gets the fate of that end of its edge with the smaller id (see
/// refineArrays).
constexpr const char* fatesArray = "cadrefine:fates";
constexpr int maximumRounds = 8;

class Coarsening
{
public:
  Coarsening(const PipelineContext& context, MeshState& state, const CoarseningOptions& options)
    : context_(context), exchange_(context.exchange), state_(state), options_(options)
  {
  }

  /// Returns how many vertices went.
  std::int64_t run()
  {
    for (int level = 0; level < options_.levels && coarsenOnce(level); ++level)
    {
    }
    summariseMesh(exchange_, state_.mesh, qualityOf(exchange_, state_), state_.arrays.ofMesh);
    summariseProjection(exchange_, state_.mesh, *state_.classification, 0, state_.arrays.ofMesh);
    return gone_;
  }

private:
  /// Coarsens by one level. Returns whether vertices went.
  bool coarsenOnce(int level)
  {
    const Progress::Part part(exchange_.progress(), static_cast<double>(level) / options_.levels,
      static_cast<double>(level + 1) / options_.levels);
    exchange_.progress().say(0, "choosing vertices to take out");
    const std::int64_t before = countMesh(exchange_, state_.mesh).vertices;
    const std::vector<unsigned char> mayGo = verticesThatMayGo();
    addFates(mayGo, verticesToRemove(exchange_, state_.mesh, *state_.classification,
                      boundaryOf(context_, state_), mayGo));
    wanted_ = countSimplices() / (state_.mesh.mesh().dimension == 3 ? 8 : 4);
    const std::int64_t flagged = countFates(VertexFate::Goes);
    takeOutFlagged();
    if (isCounted() && flagged > 0 && flagMore(flagged))
    {
      takeOutFlagged();
    }
    state_.arrays.ofVertices->RemoveArray(fatesArray);
    improveMesh(
      context_, state_, { options_.minimumQuality, {}, options_.largestBlock, { 0, true }, false });
    const std::int64_t gone = before - countMesh(exchange_, state_.mesh).vertices;
    gone_ += gone;
    return gone > 0;
  }

  /// 1 for vertices that are not listed and all of whose cells are simplices and not marked.
  /// Collective.
  std::vector<unsigned char> verticesThatMayGo()
  {
    const Mesh& mesh = state_.mesh.mesh();
    std::vector<unsigned char> mayGo(mesh.points.size(), 1);
    const auto keep = [&](const auto& corners)
    {
      for (const Index vertex : corners)
      {
        mayGo[vertex] = 0;
      }
    };
    const auto keepMarked = [&](const auto& cells)
    {
      const auto marks = markCells(exchange_, state_.mesh, state_.arrays, options_.criteria);
      for (std::size_t c = 0; c < cells.size(); ++c)
      {
        if (marks[c])
        {
          keep(cells[c]);
        }
      }
    };
    if (!options_.criteria.empty())
    {
      visitOwnSimplices(mesh, keepMarked);
    }
    std::for_each(mesh.vertices.begin(), mesh.vertices.end(), keep);
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        if (!isSimplex(shape))
        {
          std::for_each(cells.begin(), cells.end(), keep);
        }
      });
    combineSmallest(exchange_, state_.mesh.shared, mayGo);
    return mayGo;
  }

  void addFates(const std::vector<unsigned char>& mayGo, const std::vector<unsigned char>& goes)
  {
    vtkNew<vtkUnsignedCharArray> array;
    array->SetName(fatesArray);
    array->SetNumberOfValues(static_cast<vtkIdType>(goes.size()));
    std::transform(mayGo.begin(), mayGo.end(), goes.begin(), fates(array),
      [](unsigned char may, unsigned char does) {
        return does ? VertexFate::Goes : may ? VertexFate::MayGo : VertexFate::Stays;
      });
    state_.arrays.ofVertices->AddArray(array);
  }

  /// The fate of each vertex; null where there is no such array.
  VertexFate* fates() const
  {
    auto* array =
      vtkUnsignedCharArray::SafeDownCast(state_.arrays.ofVertices->GetAbstractArray(fatesArray));
    return array ? fates(array) : nullptr;
  }

  static VertexFate* fates(vtkUnsignedCharArray* array)
  {
    return reinterpret_cast<VertexFate*>(array->GetPointer(0));
  }

  /// A maximal set that stays may be larger than that of the vertices before. Where nearly all
  /// flagged ones (so many at first) went, but too few cells with them, flags some of those that
  /// stay, evenly over the mesh. Returns whether it did. Collective.
  bool flagMore(std::int64_t flagged)
  {
    constexpr double nearlyAll = 0.05; // of the flagged ones, at most, are left
    const MeshCounts counts = countMesh(exchange_, state_.mesh);
    const double excess = static_cast<double>(counts.cells - wanted_) *
                          static_cast<double>(counts.vertices) / static_cast<double>(counts.cells);
    const auto staying = static_cast<double>(countFates(VertexFate::MayGo));
    const auto left = static_cast<double>(countFates(VertexFate::Goes));
    if (exchange_.any(state_.mesh.mesh().hasNonSimplices()) || excess < 1 || excess > staying ||
        left > nearlyAll * static_cast<double>(flagged))
    {
      return false;
    }
    const auto& ids = state_.mesh.mesh().ids;
    const double part = std::ldexp(excess / staying, 64);
    for (std::size_t v = 0; v < ids.size(); ++v)
    {
      if (fates()[v] == VertexFate::MayGo &&
          static_cast<double>(mixedBits(static_cast<std::uint64_t>(ids[v]))) < part)
      {
        fates()[v] = VertexFate::Goes;
      }
    }
    return true;
  }

  /// The number of vertices with this fate, over all ranks. Collective.
  std::int64_t countFates(VertexFate fate)
  {
    const std::vector<char> owned = state_.mesh.ownedPoints();
    std::int64_t count = 0;
    for (std::size_t v = 0; v < owned.size(); ++v)
    {
      count += fates()[v] == fate && owned[v];
    }
    return exchange_.sum(count);
  }

  /// Takes out flagged vertices in rounds, as long as the one before took out at least a hundredth
  /// of what was left.
  void takeOutFlagged()
  {
    std::int64_t before = std::numeric_limits<std::int64_t>::max();
    for (int round = 0; round < maximumRounds; ++round)
    {
      const std::int64_t left = countFates(VertexFate::Goes);
      if (left == 0 || left >= before - before / 100)
      {
        return;
      }
      takeOut(round, left);
      before = left;
    }
  }

  /// Makes a round of collapses; `left` vertices are flagged.
  void takeOut(int round, std::int64_t left)
  {
    std::vector<unsigned char> flagged(state_.mesh.mesh().points.size());
    std::transform(fates(), fates() + flagged.size(), flagged.begin(),
      [](VertexFate fate) { return static_cast<unsigned char>(fate == VertexFate::Goes); });
    exchange_.progress().say(static_cast<double>(round) / maximumRounds,
      "taking out vertices, round " + std::to_string(round + 1) + " of at most " +
        std::to_string(maximumRounds));
    const CoarseningLimits limits = findLimits(left);
    const auto work = [&](BlockMesh& block, const SurfaceRule& rule)
    {
      VertexFate* ofPiece = fates();
      std::vector<VertexFate> ofBlock(block.vertices().size());
      std::transform(block.vertices().begin(), block.vertices().end(), ofBlock.begin(),
        [&](Index vertex) { return ofPiece[vertex]; });
      OperationResult result = coarsenCells(block.mesh(), rule, ofBlock, limits);
      // Those on the border of blocks, which other threads read, do not change.
      for (std::size_t v = 0; v < block.vertices().size(); ++v)
      {
        const Index vertex = block.vertices()[v];
        if (ofPiece[vertex] != ofBlock[v])
        {
          ofPiece[vertex] = ofBlock[v];
        }
      }
      return result;
    };
    operateOnMesh(context_, state_, flagged,
      { 2, round, options_.largestBlock, [](Index) { return true; } }, work);
  }

  /// Whether all of the mesh is to have cells that are twice as large, so that it is known how
  /// many.
  bool isCounted() const { return options_.criteria.empty() && options_.targetError > 0; }

  /// The number of simplices of the mesh's own dimension, over all ranks. Collective.
  std::int64_t countSimplices() { return exchange_.sum(countOwnSimplices(state_.mesh.mesh())); }

  /// The limits of a round in which `left` vertices are flagged. Collective.
  CoarseningLimits findLimits(std::int64_t left)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CoarseningLimits limits{ options_.minimumQuality, options_.maximumDistance, infinity, {} };
    if (isCounted())
    {
      const auto excess = static_cast<double>(countSimplices() - wanted_);
      limits.cellsPerVertex = std::max(0.0, excess / static_cast<double>(left));
    }
    if (options_.targetError > 0)
    {
      ClassifiedBoundary& boundary = boundaryOf(context_, state_);
      const double error = measureError(
        exchange_, state_.mesh, boundary, *state_.classification, { 0, {} }, state_.cache, false)
                             .global;
      const auto& facets = boundary.classes.facets;
      const std::int64_t count = exchange_.sum(std::count_if(
        facets.begin(), facets.end(), [](const FacetRecord& facet) { return facet.onCAD != 0; }));
      limits.errorPerFacet = std::max(0.0, options_.targetError - error) /
                             static_cast<double>(std::max<std::int64_t>(count, 1));
      limits.distance = options_.maximumDistance > 0 ? options_.maximumDistance : infinity;
    }
    else if (options_.maximumDistance <= 0)
    {
      limits.errorPerFacet = 0; // the boundary follows the CAD as well as it does
    }
    return limits;
  }

  const PipelineContext& context_;
  RankExchange& exchange_;
  MeshState& state_;
  const CoarseningOptions& options_;
  std::int64_t wanted_ = 0; ///< Simplices after the level, if their edges are twice as long.
  std::int64_t gone_ = 0;
};

} // namespace

std::int64_t coarsenMesh(
  const PipelineContext& context, MeshState& state, const CoarseningOptions& options)
{
  return Coarsening(context, state, options).run();
}

} // namespace cadrefine
