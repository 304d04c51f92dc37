// 1. See that the file is there, can be read and begins as its kind of file does.
// 2. In a process of its own (Open CASCADE crashes or loops on many damaged files): read it, sew
//    and heal what it holds, turn it into the model's bytes, and draw it once.
// 3. Build the model from the bytes: so it is the same on every rank.

#include "CADFile.h"

#include "CADModelBuilder.h"
#include "FileCheck.h"
#include "GapSearch.h"
#include "IsolatedRun.h"
#include "ModelBytes.h"
#include "OccGuard.h"
#include "ShapeIndex.h"
#include "ShapePreparation.h"
#include "ShapeReaders.h"

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace cadrefine
{
namespace
{

ReadShape readShape(const std::string& path, CADFormat format)
{
  switch (format)
  {
    case CADFormat::Iges:
      return readIges(path);
    case CADFormat::Step:
      return readStep(path);
    default:
      return readBrep(path);
  }
}

/// Of the box round all faces and edges; round splines that of their poles, which may be larger
/// than it must be (BRepBndLib::AddOptimal takes longer than all the rest of reading).
double diagonalOf(const TopoDS_Shape& shape)
{
  constexpr bool useTriangulation = false;
  Bnd_Box box;
  BRepBndLib::Add(shape, box, useTriangulation);
  box.SetGap(0);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

template<typename Shape>
std::vector<EntityLook> looksOf(const std::vector<Shape>& shapes, const LookMap& looks)
{
  std::vector<EntityLook> result;
  result.reserve(shapes.size());
  for (const Shape& shape : shapes)
  {
    result.push_back(looks.of(shape));
  }
  return result;
}

std::string listOf(const std::string& what, const std::vector<UnreadEntity>& unread)
{
  constexpr std::size_t most = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(unread.size(), most); ++i)
  {
    const UnreadEntity& u = unread[i];
    list += list.empty() ? " (" + what + ": " : "; ";
    list += u.entity > 0 ? std::to_string(u.entity) + " " + u.type + ": " : "";
    list += u.reason;
  }
  if (unread.size() > most)
  {
    list += "; and " + std::to_string(unread.size() - most) + " more";
  }
  return list.empty() ? list : list + ")";
}

ModelContent readContent(const std::string& path, CADFormat format)
{
  ReadShape read = readShape(path, format);
  ModelContent content;
  const PreparedShape prepared = prepareShape(read.shape, read.looks);
  if (prepared.removedFaces > 0)
  {
    read.report.unread.push_back({ 0, "face",
      std::to_string(prepared.removedFaces) + " of them have neither border nor end" });
  }
  if (prepared.repeatedFaces > 0)
  {
    read.report.leftOut.push_back({ 0, "face",
      std::to_string(prepared.repeatedFaces) + " of them are another one over again" });
  }
  if (prepared.shape.IsNull())
  {
    throw Error(path + ": holds no face and no curve that can be read" +
                listOf("unread", read.report.unread) + listOf("left out", read.report.leftOut));
  }
  const ShapeIndex index(prepared.shape);
  content.shape = prepared.shape;
  content.size = diagonalOf(prepared.shape);
  content.report = std::move(read.report);
  content.report.sewingTolerance = prepared.sewingTolerance;
  content.report.gaps = findGaps(index, content.size);
  if (!read.looks.empty())
  {
    content.faceLooks = looksOf(index.faces(), read.looks);
    content.edgeLooks = looksOf(index.edges(), read.looks);
  }
  return content;
}

bool isFinite(const Point3& p)
{
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Throws Error where a point of the drawing is not finite.
void drawAll(const CADModel& model)
{
  const double deflection = CADModel::drawingTolerance * model.size();
  for (const std::int8_t dimension : { 1, 2 })
  {
    for (int i = 0; i < model.count(dimension); ++i)
    {
      const std::vector<Point3> points = model.tessellate({ dimension, i }, deflection).points;
      if (!std::all_of(points.begin(), points.end(), isFinite))
      {
        throw Error("CAD model: " + std::string(dimension == 2 ? "face " : "edge ") +
                    std::to_string(i) + " cannot be drawn in finite numbers");
      }
      noteProgress();
    }
  }
}

/// The model is built and drawn once here, to see that this works where a crash does no harm.
std::vector<char> readBytes(const std::string& path, CADFormat format)
{
  std::vector<char> bytes = encodeModel(guardOcc(path, [&] { return readContent(path, format); }));
  try
  {
    drawAll(*CADModelBuilder::build(bytes));
  }
  catch (const Error& error)
  {
    throw Error(path + ": " + error.what());
  }
  return bytes;
}

/// Far more than reading takes, and yet little for a small file. Measured: mostly up to 0.5 s and
/// 40 MiB for each megabyte; 12 s a megabyte of a terrain, of which one step, drawing its face,
/// takes more than 7.
RunLimits limitsFor(const std::string& path)
{
  constexpr double day = 86400;
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path));
  RunLimits limits;
  limits.cpuSeconds = static_cast<int>(std::min(day, 20 + 60 * megabytes));
  limits.stepSeconds = static_cast<int>(std::min(day, 20 + 20 * megabytes));
  limits.megabytes = static_cast<std::uint64_t>(2048 + 100 * megabytes);
  return limits;
}

} // namespace

std::shared_ptr<const CADModel> readCADFile(const std::string& path)
{
  const CADFormat format = checkFile(path);
  return CADModelBuilder::build(
    runIsolated(path, limitsFor(path), [&] { return readBytes(path, format); }));
}

} // namespace cadrefine
