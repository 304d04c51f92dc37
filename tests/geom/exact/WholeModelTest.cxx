// Every model, from thousands of points, against Open CASCADE.

#include "ModelBytes.h"
#include "ModelList.h"
#include "OccOracle.h"
#include "SamplePoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <thread>

namespace
{

using namespace cadrefine;
using namespace exacttest;

class WholeModel : public testing::TestWithParam<TestModel>
{
protected:
  void expectNothingNearer();
  void expectParametersToGiveThePoint();
  void expectTheSameInAnyOrderAndOnThreads();

  std::shared_ptr<const CADModel> model = readModel(GetParam());
  TopoDS_Shape shape = decodeModel(model->toBytes()).shape;
  double size = model->size();
  double tolerance = 1e-9 * size;
  std::vector<SamplePoint> samples = samplePoints(shape, size);

  /// For a message.
  static std::string describe(const SamplePoint& sample, const ClosestPoint& answer)
  {
    std::ostringstream text;
    text.precision(17);
    text << nameOf(sample.kind) << " point (" << sample.point[0] << ", " << sample.point[1] << ", "
         << sample.point[2] << "): entity " << answer.entity.index << " of dimension "
         << static_cast<int>(answer.entity.dimension) << " at " << answer.distance;
    return text.str();
  }
};

void WholeModel::expectNothingNearer()
{
  ASSERT_GE(samples.size(), 2000u);
  const OccOracle oracle(shape, size);
  int inFavour = 0;
  for (const SamplePoint& sample : samples)
  {
    const ClosestPoint answer = model->nearest(sample.point);
    ASSERT_TRUE(answer.entity) << describe(sample, answer);
    EXPECT_TRUE(answer.converged) << describe(sample, answer);
    EXPECT_LE(answer.distance, sample.bound + tolerance) << describe(sample, answer);
    const OccOracle::Nearest expected = oracle.nearest(sample.point, answer.distance + tolerance);
    EXPECT_LE(answer.distance, expected.distance + tolerance) << describe(sample, answer);
    if (answer.distance < expected.distance - tolerance)
    {
      ++inFavour;
      EXPECT_TRUE(oracle.liesOn(answer.entity, answer.point, tolerance))
        << describe(sample, answer) << ", Open CASCADE: " << expected.distance;
    }
  }
  RecordProperty("points", static_cast<int>(samples.size()));
  RecordProperty("points_nearer_than_open_cascade", inFavour);
}

void WholeModel::expectParametersToGiveThePoint()
{
  for (const SamplePoint& sample : samples)
  {
    const ClosestPoint answer = model->nearest(sample.point);
    const Point3 again = model->evaluate(answer.entity, answer.parameters);
    EXPECT_LE(distance(again, answer.point), 1e-12 * size) << describe(sample, answer);
    EXPECT_LE(std::abs(distance(sample.point, answer.point) - answer.distance), 1e-12 * size)
      << describe(sample, answer);
  }
}

/// The bits of what an answer says.
std::array<std::uint64_t, 6> bitsOf(const ClosestPoint& answer)
{
  const std::array<double, 6> numbers{ answer.point[0], answer.point[1], answer.point[2],
    answer.parameters[0], answer.parameters[1],
    answer.entity.index + 1e6 * static_cast<double>(answer.entity.dimension) };
  std::array<std::uint64_t, 6> bits{};
  std::memcpy(bits.data(), numbers.data(), sizeof(bits));
  return bits;
}

void WholeModel::expectTheSameInAnyOrderAndOnThreads()
{
  using Answers = std::vector<std::array<std::uint64_t, 6>>;
  Answers forwards(samples.size());
  Answers backwards(samples.size());
  const auto ask = [&](Answers& answers, std::size_t i)
  { answers[i] = bitsOf(model->nearest(samples[i].point)); };
  std::thread first(
    [&]
    {
      for (std::size_t i = 0; i < samples.size(); ++i)
        ask(forwards, i);
    });
  std::thread second(
    [&]
    {
      for (std::size_t i = samples.size(); i > 0; --i)
        ask(backwards, i - 1);
    });
  first.join();
  second.join();
  EXPECT_TRUE(forwards == backwards);
}

INSTANTIATE_TEST_SUITE_P(Exact, WholeModel, testing::ValuesIn(allModels()),
  [](const auto& model) { return model.param.name; });

/// One test, since some models take a minute to read.
TEST_P(WholeModel, AnswersAreExact)
{
  expectNothingNearer();
  expectParametersToGiveThePoint();
  expectTheSameInAnyOrderAndOnThreads();
}

} // namespace
