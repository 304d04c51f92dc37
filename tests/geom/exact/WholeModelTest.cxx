// Every model, from thousands of points, against Open CASCADE.

#include "ModelList.h"
#include "OccOracle.h"
#include "SamplePoints.h"

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>

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
  void expectMeasures();
  void expectBox();

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
      {
        ask(forwards, i);
      }
    });
  std::thread second(
    [&]
    {
      for (std::size_t i = samples.size(); i > 0; --i)
      {
        ask(backwards, i - 1);
      }
    });
  first.join();
  second.join();
  EXPECT_TRUE(forwards == backwards);
}

/// Areas and lengths by Open CASCADE.
void WholeModel::expectMeasures()
{
  const ShapeIndex index(shape);
  std::array<double, 2> expected{};
  std::array<double, 2> found{};
  std::vector<std::array<double, 2>> areas;
  for (std::size_t i = 0; i < index.faces().size(); ++i)
  {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(index.faces()[i], properties, 1e-4);
    areas.push_back({ std::abs(properties.Mass()), model->measure({ 2, static_cast<int>(i) }) });
    expected[1] += areas.back()[0];
    found[1] += areas.back()[1];
  }
  for (std::size_t i = 0; i < index.edges().size(); ++i)
  {
    GProp_GProps properties;
    BRepGProp::LinearProperties(index.edges()[i], properties);
    expected[0] += properties.Mass();
    found[0] += model->measure({ 1, static_cast<int>(i) });
  }
  EXPECT_NEAR(found[0], expected[0], 1e-2 * expected[0]);
  EXPECT_NEAR(found[1], expected[1], 2e-2 * expected[1]);
  for (std::size_t i = 0; i < areas.size(); ++i)
  {
    EXPECT_NEAR(areas[i][1], areas[i][0], 0.1 * areas[i][0] + 1e-3 * expected[1]) << "face " << i;
  }
}

/// It holds what is on the model, and is in the box round its poles.
void WholeModel::expectBox()
{
  const auto [low, high] = model->box();
  constexpr bool useTriangulation = false;
  Bnd_Box box;
  BRepBndLib::Add(shape, box, useTriangulation);
  std::array<double, 6> outer{};
  box.Get(outer[0], outer[1], outer[2], outer[3], outer[4], outer[5]);
  const double exactness = 1e-6 * size + model->trimDeviation();
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_GE(low[k], outer[k] - exactness);
    EXPECT_LE(high[k], outer[3 + k] + exactness);
    for (const SamplePoint& sample : samples)
    {
      const Point3 point = model->nearest(sample.point).point;
      EXPECT_GE(point[k], low[k] - exactness);
      EXPECT_LE(point[k], high[k] + exactness);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Exact, WholeModel, testing::ValuesIn(allModels()),
  [](const auto& model) { return model.param.name; });

/// One test, since some models take a minute to read.
TEST_P(WholeModel, answersAreExact)
{
  expectNothingNearer();
  expectParametersToGiveThePoint();
  expectTheSameInAnyOrderAndOnThreads();
  expectMeasures();
  expectBox();
}

} // namespace
