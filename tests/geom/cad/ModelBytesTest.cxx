// A model rebuilt from its bytes is the same, bit for bit.

#include "TestFiles.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace cadrefine;

bool same(const BezierPatch& a, const BezierPatch& b)
{
  return a.degreeU == b.degreeU && a.degreeV == b.degreeV && a.u0 == b.u0 && a.u1 == b.u1 &&
         a.v0 == b.v0 && a.v1 == b.v1 && a.points == b.points;
}

bool same(const BezierCurve& a, const BezierCurve& b)
{
  return a.t0 == b.t0 && a.t1 == b.t1 && a.points == b.points;
}

bool same(const BezierCurve2& a, const BezierCurve2& b)
{
  return a.points == b.points;
}

bool same(const NurbsFace& a, const NurbsFace& b);
bool same(const NurbsEdge& a, const NurbsEdge& b);
bool same(const NurbsVertex& a, const NurbsVertex& b);

template<typename T>
bool same(const std::vector<T>& a, const std::vector<T>& b)
{
  return std::equal(
    a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

bool same(const NurbsFace& a, const NurbsFace& b)
{
  return same(a.patches, b.patches) && a.patchesU == b.patchesU && same(a.loops, b.loops) &&
         a.reversed == b.reversed && a.edges == b.edges && a.tolerance == b.tolerance;
}

bool same(const NurbsEdge& a, const NurbsEdge& b)
{
  return same(a.segments, b.segments) && a.firstVertex == b.firstVertex &&
         a.lastVertex == b.lastVertex && a.faces == b.faces && a.sharp == b.sharp &&
         a.tolerance == b.tolerance;
}

bool same(const NurbsVertex& a, const NurbsVertex& b)
{
  return a.point == b.point && a.edges == b.edges && a.tolerance == b.tolerance;
}

std::shared_ptr<const CADModel> readSample()
{
  const cadtest::TemporaryFolder folder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(2, 2, 2).Shape();
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(2, 2, 1.9), 1).Shape();
  cadtest::writeShape(BRepAlgoAPI_Cut(box, ball).Shape(), folder.file("sample.igs"), "INCH");
  return readCADFile(folder.file("sample.igs"));
}

TEST(ModelBytes, roundTripIsIdentical)
{
  const auto model = readSample();
  const auto again = CADModel::fromBytes(model->toBytes());
  EXPECT_EQ(again->toBytes(), model->toBytes());
  EXPECT_EQ(again->unit(), "in");
  EXPECT_EQ(again->size(), model->size());
  EXPECT_GT(model->count(2), 5);
  EXPECT_TRUE(same(again->nurbs().faces, model->nurbs().faces));
  EXPECT_TRUE(same(again->nurbs().edges, model->nurbs().edges));
  EXPECT_TRUE(same(again->nurbs().vertices, model->nurbs().vertices));
}

TEST(ModelBytes, readingTwiceGivesTheSameBytes)
{
  EXPECT_EQ(readSample()->toBytes(), readSample()->toBytes());
}

TEST(ModelBytes, damagedBytesAreAnError)
{
  const std::vector<char> bytes = readSample()->toBytes();
  EXPECT_THROW(CADModel::fromBytes({}), Error);
  EXPECT_THROW(CADModel::fromBytes(std::vector<char>(1000, 'x')), Error);
  for (const std::size_t cut :
    { std::size_t(5), std::size_t(30), bytes.size() / 2, bytes.size() - 1 })
  {
    EXPECT_THROW(CADModel::fromBytes({ bytes.begin(), bytes.begin() + cut }), Error) << cut;
  }
  for (std::size_t at = 20; at < bytes.size(); at += bytes.size() / 50)
  {
    std::vector<char> damaged = bytes;
    damaged[at] ^= 0x40;
    EXPECT_THROW(CADModel::fromBytes(damaged), Error) << at;
  }
}

} // namespace
