// The same mesh, bit for bit, whichever way cells are dealt out to ranks.

#include "DataSets.h"
#include "MeshChecks.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "RandomProblem.h"
#include "SamePieces.h"
#include "TestShapes.h"
#include "refinement/BulkMarking.h"

#include <vtkCellData.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace propertytest
{

namespace
{

using namespace cadrefine;

/// A rank for each item: any, in blocks of any size, or on few ranks, also on one only.
std::vector<int> randomRanks(Random& random, std::size_t items, int ranks)
{
  std::vector<int> usable(static_cast<std::size_t>(ranks));
  std::iota(usable.begin(), usable.end(), 0);
  std::shuffle(usable.begin(), usable.end(), random.engine());
  usable.resize(static_cast<std::size_t>(random.chance(0.5) ? ranks : random.among(1, ranks)));
  const auto last = static_cast<int>(usable.size()) - 1;
  std::vector<int> rankOf(items);
  const double change = random.chance(0.5) ? 1 : std::pow(10.0, random.between(-2.5, -0.5));
  int here = usable[random.among(0, last)];
  for (int& rank : rankOf)
  {
    here = random.chance(change) ? usable[random.among(0, last)] : here;
    rank = here;
  }
  return rankOf;
}

class PartitionProperty : public ParallelTest
{
protected:
  /// On rank 0 alone. An exception must not leave the other ranks waiting.
  Plan::Steps runAlone(
    const Plan& plan, const std::string& cadFile, vtkPointSet* whole, std::size_t count)
  {
    Plan::Steps steps(count);
    bool failed = false;
    if (exchange.rank() == 0)
    {
      try
      {
        steps = plan.run(cadtest::FilterRun(cadFile), whole, 1);
      }
      catch (const std::exception& error)
      {
        ADD_FAILURE() << "on one rank: " << error.what();
        failed = true;
      }
    }
    return exchange.any(failed) ? Plan::Steps{} : steps;
  }

  /// The steps of this rank's piece.
  Plan::Steps expectSameAsOnOneRank(Random& random, const FilterProblem& problem)
  {
    const Plan plan(random, problem);
    const vtkSmartPointer<vtkPointSet> whole = problem.dataSet();
    if (random.chance(0.6))
    {
      cadtest::addGlobalIds(whole);
    }
    if (random.chance(0.7))
    {
      whole->GetCellData()->RemoveArray("Tag"); // which keeps all cells apart
    }
    const bool ghosts = random.chance(0.3);
    const auto rankOfCell =
      randomRanks(random, static_cast<std::size_t>(whole->GetNumberOfCells()), exchange.size());
    const cadtest::TemporaryFolder folder;
    const std::string cadFile = cadtest::writeInto(folder, problem.shape, ".brep");
    const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), ghosts);
    Plan::Steps pieces = plan.run(cadtest::FilterRun(cadFile, worldController()), piece, 1);
    const Plan::Steps serial = runAlone(plan, cadFile, whole, pieces.size());
    for (std::size_t step = 0; step < serial.size(); ++step)
    {
      SCOPED_TRACE("after step " + std::to_string(step));
      cadtest::expectSame(exchange, pieces[step], serial[step]);
    }
    return pieces;
  }

  /// Valid, bounded by its listed sides if those of the problem were listed.
  void expectSound(const FilterProblem& problem, vtkPointSet* piece)
  {
    const cadtest::CanonicalMesh gathered = cadtest::gather(exchange, piece);
    if (exchange.rank() > 0)
    {
      return;
    }
    Mesh mesh = cadtest::toMesh(gathered);
    const bool isTurned = !problem.mesh.wedges.empty() && !cadtest::isValid(problem.mesh);
    if (isTurned)
    {
      for (auto& w : mesh.wedges)
      {
        w = { w[3], w[4], w[5], w[0], w[1], w[2] };
      }
    }
    EXPECT_TRUE(cadtest::isValid(mesh));
    if (problem.isBoundaryListed)
    {
      EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
    }
    else if (problem.isSurface)
    {
      EXPECT_TRUE(cadtest::isWatertight(mesh, [](const auto&) { return false; }));
    }
  }
};

TEST_F(PartitionProperty, meshesAreTheSame)
{
  forEachSeed(12, [this](Random& random) { expectSameAsOnOneRank(random, FilterProblem(random)); });
}

/// A pyramid on a base that rises over its apex cannot be refined uniformly.
bool isRefused(const std::exception& error)
{
  return std::string(error.what()).find("too distorted to be cut") != std::string::npos;
}

TEST_F(PartitionProperty, meshesOfAllShapesAreTheSame)
{
  int refused = 0;
  int rounds = 0;
  forEachSeed(3,
    [&](Random& random)
    {
      const FilterProblem problem = FilterProblem::mixed(random);
      ++rounds;
      try
      {
        for (const auto& piece : expectSameAsOnOneRank(random, problem))
        {
          expectSound(problem, piece);
        }
      }
      catch (const std::exception& error)
      {
        ++refused;
        EXPECT_TRUE(exchange.rank() > 0 || isRefused(error)) << error.what(); // rank 0 reports
      }
    });
  EXPECT_LE(refused, 1 + rounds / 20);
}

/// Whole numbers, so that sums are exact, of which many are equal.
std::vector<double> randomValues(Random& random)
{
  std::vector<double> values(static_cast<std::size_t>(random.among(1, 400)));
  const double largest = std::pow(10.0, random.between(0, 12));
  for (double& value : values)
  {
    value = random.chance(0.1) ? 0 : std::floor(random.between(0, largest));
  }
  return values;
}

/// Largest first, of equal ones the smaller id.
std::vector<unsigned char> fewestThatCarry(
  const std::vector<double>& values, const std::vector<std::int64_t>& ids, double fraction)
{
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    { return std::pair(-values[a], ids[a]) < std::pair(-values[b], ids[b]); });
  const double target = fraction * std::accumulate(values.begin(), values.end(), 0.0);
  std::vector<unsigned char> marks(values.size(), 0);
  double carried = 0;
  for (std::size_t k = 0; k < order.size() && carried < target; ++k)
  {
    marks[order[k]] = 1;
    carried += values[order[k]];
  }
  return marks;
}

TEST_F(PartitionProperty, bulkMarkingIsTheLeast)
{
  forEachSeed(200,
    [this](Random& random)
    {
      const std::vector<double> values = randomValues(random);
      std::vector<std::int64_t> ids(values.size());
      const std::int64_t step = random.chance(0.5) ? 1 : 1000000007;
      for (std::size_t i = 0; i < ids.size(); ++i)
      {
        ids[i] = step * static_cast<std::int64_t>(i);
      }
      std::shuffle(ids.begin(), ids.end(), random.engine());
      const double fraction =
        random.chance(0.1) ? 1 : std::pow(10.0, random.between(random.chance(0.5) ? -6 : -0.3, 0));
      const auto rankOf = randomRanks(random, values.size(), exchange.size());
      std::vector<double> ownValues;
      std::vector<std::int64_t> ownIds;
      std::vector<unsigned char> expected;
      const auto all = fewestThatCarry(values, ids, fraction);
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        if (rankOf[i] == exchange.rank())
        {
          ownValues.push_back(values[i]);
          ownIds.push_back(ids[i]);
          expected.push_back(all[i]);
        }
      }
      EXPECT_EQ(markBulk(exchange, ownValues, ownIds, fraction), expected);
    });
}

} // namespace

} // namespace propertytest
