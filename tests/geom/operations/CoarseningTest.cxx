// Vertices go by collapses: volumes and labels stay, cells are valid, what must stay does.

#include "SpoiltCube.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Coarsening.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace
{

using namespace cadrefine;

/// Volumes of the cells of each label.
std::array<double, 2> volumesOf(const EditableMesh& mesh)
{
  std::array<double, 2> volumes{};
  for (std::size_t c = 0; c < mesh.cells().size(); ++c)
  {
    const auto cell = static_cast<Index>(c);
    if (mesh.cells().exists(cell))
    {
      const auto& [corners, label, parent] = mesh.cells()[cell];
      EXPECT_TRUE(mesh.isValid(corners));
      const auto at = [&, &v = corners](int k) { return mesh.vertex(v[k]).point; };
      volumes[label] += sixfoldVolume(at(0), at(1), at(2), at(3)) / 6;
    }
  }
  return volumes;
}

class Coarsenings : public testing::TestWithParam<unsigned>
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::sphere(1));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
  SurfaceRule rule{ projector };
};

TEST_P(Coarsenings, keepVolumesAndTakeOutFlaggedVerticesAlone)
{
  EditableMesh mesh = cadtest::spoiltCube(GetParam());
  const auto before = volumesOf(mesh);
  const EditableMesh first = mesh;
  std::vector<VertexFate> fates(mesh.vertexCount());
  for (std::size_t v = 0; v < fates.size(); ++v)
  {
    fates[v] = v % 3 == 0 ? VertexFate::Stays : VertexFate::Goes;
  }
  const std::size_t count = fates.size();
  const OperationResult result = coarsenCells(mesh, rule, fates, { 0.05 });
  EXPECT_GT(result.counts.collapses, 0);
  const auto after = volumesOf(mesh);
  EXPECT_NEAR(after[0], before[0], 1e-14);
  EXPECT_NEAR(after[1], before[1], 1e-14);
  std::int64_t gone = 0;
  for (std::size_t v = 0; v < count; ++v)
  {
    const auto vertex = static_cast<Index>(v);
    const bool isThere = !mesh.cells().at(vertex).empty();
    gone += isThere ? 0 : 1;
    EXPECT_TRUE(isThere || first.freedomOf(vertex) == EditableMesh::Freedom::Space) << v;
  }
  EXPECT_GT(gone, 5);
}

TEST_P(Coarsenings, leaveNoCellWorseThanAllowed)
{
  constexpr double least = 0.2;
  EditableMesh mesh = cadtest::spoiltCube(GetParam());
  const auto worstOf = [](const EditableMesh& cells)
  {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < cells.cells().size(); ++c)
    {
      const auto cell = static_cast<Index>(c);
      if (cells.cells().exists(cell))
      {
        worst = std::min(worst, cells.quality(cells.cells()[cell].corners));
      }
    }
    return worst;
  };
  const double before = worstOf(mesh);
  std::vector<VertexFate> fates(mesh.vertexCount(), VertexFate::Goes);
  coarsenCells(mesh, rule, fates, { least });
  EXPECT_GE(worstOf(mesh), std::min(before, least));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Coarsenings, testing::Range(1U, 6U));

} // namespace
